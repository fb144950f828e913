import { render } from "preact";
import { App } from "./app";
import { readAddress, showContent } from "./content";
import { readPage } from "./data";
import { followLook } from "./look";
import { drawn, view } from "./picture";
import * as state from "./state";
import "./style.css";

async function start() {
  const content = await readPage();
  if (content.data.collection) state.setIndex(content);
  await showContent(content);
  await readAddress();
  followLook();
  window.addEventListener("hashchange", () => void readAddress());
  render(<App />, document.getElementById("app")!);
  // For tests of this page, which query positions on the screen.
  Object.defineProperty(window, "ostraka", {
    value: {
      state,
      get view() {
        return view;
      },
      get objects() {
        return drawn;
      },
    },
  });
}

void start();
