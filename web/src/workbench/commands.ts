// Registry of named commands: for the palette, keys, voice, and the wrist menu.
import { signal } from "@preact/signals";
import { view } from "../picture";
import * as page from "../state";
import * as deform from "./deform";
import { change, has, part, redo, run, undo } from "./model";
import * as selection from "./selection";
import { choose, finish, type Tool } from "./tools";
import { text, type Key } from "./words";

export interface Command {
  id: string;
  /** Name in the page's language; also recognised by voice. */
  words: Key;
  key?: string;
  /** Whether a number may follow the name: "level 2". */
  takesNumber?: boolean;
  action: (number?: number) => void;
}

/** The annotation under the gaze, or selected. */
export const gazed = signal(-1);
const annotation = () => page.page?.objects[page.object.value]?.annotations[gazed.value >= 0 ? gazed.value : page.chosen.value];
/** The control point under the gaze. */
export const gazedPoint = signal(-1);

/** Depth of an annotation in the containment tree. */
export function depthOf(i: number): number {
  const { annotations } = page.page.objects[page.object.value];
  let depth = 0;
  for (let k = annotations[i].parent; k >= 0; k = annotations[k].parent) ++depth;
  return depth;
}

/** Shows only the annotations of one level of containment; 0 is the whole. */
export function showLevel(level: number) {
  const { annotations } = page.page.objects[page.object.value];
  const all = annotations.map((_, i) => i);
  page.show(page.object.value, all, true);
  page.show(
    page.object.value,
    all.filter((i) => depthOf(i) !== level),
    false,
  );
  levelShown.value = level;
}
export const levelShown = signal(-1);

function selectGazed(discards: boolean) {
  if (gazedPoint.value >= 0) {
    const next = new Set(deform.handles.value);
    if (discards) next.delete(gazedPoint.value);
    else next.add(gazedPoint.value);
    deform.set(next);
    return;
  }
  const one = annotation();
  if (one) void deform.ofAnnotation(one.id, discards);
}

const useTool = (which: Tool) => () => choose(which);

/** Takes back the last stroke of the selection, or else the last step of the session. */
export const undoLast = () => {
  if (!selection.undoStroke()) void undo();
};
export const redoLast = () => {
  if (!selection.redoStroke()) void redo();
};

export const commands: Command[] = [
  { id: "undo", words: "undo", key: "Ctrl+Z", action: undoLast },
  { id: "redo", words: "redo", key: "Ctrl+Y", action: redoLast },
  { id: "select", words: "sayselect", action: () => selectGazed(false) },
  { id: "discard", words: "saydiscard", action: () => selectGazed(true) },
  { id: "hide-cage", words: "hideCage", action: () => (page.cage.value = false) },
  { id: "show-cage", words: "showCage", action: () => (page.cage.value = true) },
  { id: "hide-points", words: "hidePoints", action: () => ((deform.showsPoints.value = false), deform.mark()) },
  { id: "show-points", words: "showPoints", action: () => ((deform.showsPoints.value = true), deform.mark()) },
  { id: "level", words: "level", takesNumber: true, action: (n) => showLevel(n ?? 0) },
  { id: "influence", words: "influence", action: () => void deform.showInfluence() },
  { id: "clear", words: "clearSelection", key: "Escape", action: () => (selection.clear(), deform.set([])) },
  { id: "accept", words: "accept", action: () => void change("accept", "accept") },
  { id: "withdraw", words: "withdraw", action: () => void change("withdraw", "withdraw") },
  { id: "finish", words: "finishPicks", key: "Enter", action: () => void finish() },
  { id: "whole", words: "whole", key: "0", action: () => view?.home() },
  ...(
    [
      "look",
      "rectangle",
      "lasso",
      "closed",
      "brush",
      "path",
      "points",
      "ruler",
      "tape",
      "angle",
      "bounding",
      "handles",
      "move",
      "rotate",
      "scale",
      "stretch",
    ] as Tool[]
  ).map((which): Command => ({ id: `tool-${which}`, words: which as Key, action: useTool(which) })),
  { id: "make-cage", words: "makeCage", action: () => void makeCage() },
  { id: "link-cage", words: "linkCage", action: () => void linkCage() },
  { id: "extract", words: "extract", action: () => void extract() },
];

export const makeCage = (vertices = 100) =>
  run({ operation: "cage make", title: text("makeCage"), with: { mesh: part("mesh"), vertices } });
/** Makes a cage that is denser around the constraints' parts. */
export const makeCageFor = (vertices: number) =>
  run({
    operation: "cage make",
    title: text("makeCageFor"),
    with: { mesh: part("mesh"), annotations: part("annotations"), for: part("graph"), vertices },
  });
export async function linkCage(): Promise<boolean> {
  const linked = await run({ operation: "cage weights", title: text("linkCage"), with: { mesh: part("mesh"), cage: part("cage") } });
  if (linked && has("graph") && has("coordinates")) await deform.askReach();
  return linked;
}
export const extract = () =>
  run({
    operation: "relation extract",
    title: text("extract"),
    with: { mesh: part("mesh"), annotations: part("annotations"), ...(has("graph") ? { graph: part("graph") } : {}) },
  });

const numbers: Record<string, number> = {
  zero: 0,
  one: 1,
  two: 2,
  three: 3,
  four: 4,
  five: 5,
  null: 0,
  eins: 1,
  zwei: 2,
  drei: 3,
  vier: 4,
  fünf: 5,
  uno: 1,
  due: 2,
  tre: 3,
  quattro: 4,
  cinque: 5,
};

/** Executes a spoken or typed command; false if no command has this name. */
export function say(said: string): boolean {
  const words = said
    .trim()
    .toLocaleLowerCase()
    .replace(/[.!?]$/, "");
  for (const one of commands) {
    const called = text(one.words).toLocaleLowerCase();
    if (words === called) {
      one.action();
      return true;
    }
    if (one.takesNumber && words.startsWith(called + " ")) {
      const rest = words.slice(called.length + 1);
      const n = rest in numbers ? numbers[rest] : Number(rest);
      if (!Number.isInteger(n) || n < 0) return false;
      one.action(n);
      return true;
    }
  }
  return false;
}

export const palette = signal(false);

export function attachKeys() {
  window.addEventListener("keydown", (event) => {
    const typing = event.target instanceof HTMLElement && event.target.matches("input, textarea, select");
    const key = event.key.toLowerCase();
    if ((event.ctrlKey || event.metaKey) && key === "k") {
      event.preventDefault();
      palette.value = !palette.value;
    } else if (typing) {
      return;
    } else if ((event.ctrlKey || event.metaKey) && key === "z") {
      event.preventDefault();
      if (event.shiftKey) redoLast();
      else undoLast();
    } else if ((event.ctrlKey || event.metaKey) && key === "y") {
      event.preventDefault();
      redoLast();
    }
  });
}

// ---- voice, if the browser supports it ----

export const listening = signal(false);
export const heard = signal("");
/** The part of the Web Speech API that is used; TypeScript's library does not declare it. */
interface Recogniser {
  lang: string;
  continuous: boolean;
  onresult: (event: { results: ArrayLike<ArrayLike<{ transcript: string }>> }) => void;
  onend: () => void;
  onerror: (event: { error: string }) => void;
  start(): void;
  stop(): void;
}
interface SpeechWindow {
  SpeechRecognition?: new () => Recogniser;
  webkitSpeechRecognition?: new () => Recogniser;
}
let recogniser: Recogniser | undefined;
export const canListen = () => "webkitSpeechRecognition" in window || "SpeechRecognition" in window;

export function listen(on: boolean) {
  if (!on) {
    recogniser?.stop();
    listening.value = false;
    return;
  }
  const speech = window as SpeechWindow;
  const Maker = speech.SpeechRecognition ?? speech.webkitSpeechRecognition;
  if (!Maker) return;
  recogniser = new Maker();
  recogniser.lang = { en: "en-US", de: "de-DE", it: "it-IT" }[page.language.value];
  recogniser.continuous = true;
  recogniser.onresult = (event) => {
    const said = event.results[event.results.length - 1][0].transcript;
    heard.value = said;
    say(said);
  };
  recogniser.onerror = (event) => (heard.value = String(event.error));
  recogniser.onend = () => (listening.value = false);
  recogniser.start();
  listening.value = true;
}
