// Theme, language and patterns selected by the reader.
import { effect } from "@preact/signals";
import { shared } from "./geometry";
import { view } from "./picture";
import * as state from "./state";

export function followLook() {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  effect(() => {
    const isDark = state.theme.value === "dark" || (state.theme.value === "system" && dark.matches);
    document.documentElement.dataset.theme = isDark ? "dark" : "light";
    document.documentElement.lang = state.language.value;
    shared.patterns.value = state.patterns.value ? 1 : 0;
    void state.turn.value;
    if (!view) return;
    view.canvas.tabIndex = 0;
    view.canvas.setAttribute("role", "application");
    view.canvas.setAttribute("aria-label", state.word("canvas", state.page.title));
    view.onDrawn = () => {
      if (!state.ready.value) setTimeout(() => (state.ready.value = true));
    };
    view.background = isDark ? 0x1b1d20 : 0xffffff;
    view.draw();
  });
  dark.addEventListener("change", () => (state.theme.value = String(state.theme.value)));
}
