import { effect } from "@preact/signals";
import { render } from "preact";
import { setFill } from "../content";
import { shared } from "../geometry";
import { followLook } from "../look";
import { drawn, view } from "../picture";
import * as page from "../state";
import "../style.css";
import { App } from "./app";
import * as camera from "./camera";
import * as commands from "./commands";
import * as deform from "./deform";
import * as drop from "./drop";
import * as model from "./model";
import * as selection from "./selection";
import * as tools from "./tools";
import { text } from "./words";
import "./workbench.css";
import * as xr from "./xr";

page.setContent({
  data: { version: 1, title: "Ostraka", notes: [], provenance: "", objects: [], tables: [], drawings: [], blobs: [] },
  blobs: undefined as never,
});

model.link.onState = (open) => {
  model.connected.value = open;
  if (open)
    void model.attempt(text("loading"), async () => {
      const { result } = await model.link.ask("hello");
      model.operations.value = result.operations;
      model.words.value = result.words;
      await model.refresh();
    });
};
model.link.onEvent = (event) => {
  if (event.event === "progress") model.progress.value = { phase: event.phase, share: event.share };
  // Another page changed the same session.
  if (event.event === "changed") void model.attempt(text("loading"), model.refresh);
};
setFill(0.87); // bars lie over the upper and lower edge of the picture
// On a phone names and measures would cover the picture: they are shown when asked for.
const isNarrow = window.innerWidth < 600;
page.allMeasures.value = !isNarrow;
page.labels.value = !isNarrow;
model.link.connect();
commands.attachKeys();
drop.attachDrop();
render(<App />, document.getElementById("app")!);

let follows = false;
model.onShown.push(() => {
  if (!follows && view) {
    follows = true;
    followLook();
  }
  performance.mark("scene shown");
});
effect(() => {
  document.documentElement.lang = page.language.value;
});

// For tests of this page, which query positions on the screen.
Object.defineProperty(window, "ostraka", {
  value: {
    page,
    camera,
    model,
    selection,
    tools,
    deform,
    commands,
    drop,
    xr,
    shared,
    get view() {
      return view;
    },
    get objects() {
      return drawn;
    },
  },
});
