// State of the workbench: the session as reported by the command, and activities in progress.
import { computed, signal } from "@preact/signals";
import { knownShapes, showContent } from "../content";
import { Blobs, type PageData } from "../data";
import * as page from "../state";
import { Link, RequestError, type Answer } from "./link";
import { text, type Key } from "./words";

export interface OperationInput {
  name: string;
  kind: string;
  required: boolean;
  repeated: boolean;
  help: string;
}
export interface OperationOption {
  name: string;
  type: string;
  help: string;
  required: boolean;
  default?: unknown;
  unit?: string;
  choices?: string[];
  words?: string[];
  minimum?: number;
  maximum?: number;
}
export interface Declaration {
  name: string;
  help: string;
  inputs: OperationInput[];
  outputs: OperationInput[];
  options: OperationOption[];
}
export interface SessionObject {
  name: string;
  parts: Record<string, string>;
}
export interface SessionFile {
  name: string;
  kind: string;
  file: string;
}
export interface Step {
  name: string;
  title: string;
  operation: string;
  holds: boolean;
}

export const link = new Link();
export const operations = signal<Declaration[]>([]);
export const openable = signal<string[]>([]);
/** Labels of vocabularies, by language. */
export const words = signal<Record<string, string[]>>({});
export const objects = signal<SessionObject[]>([]);
export const files = signal<SessionFile[]>([]);
export const active = signal(0);
export const history = signal<Step[]>([]);
export const place = signal(0);
/** For each object of the page: the session's object, and whether it is the deformed state. */
export const shown = signal<{ object: number; deformed: boolean }[]>([]);
export const connected = signal(false);
export const busy = signal("");
export const progress = signal<{ phase: string; share: number } | undefined>(undefined);
export const problem = signal<{ problem: string; remedy: string } | undefined>(undefined);
export const outcome = signal<{ title: string; text: string; holds: boolean; notes: string[] } | undefined>(undefined);

/** What the command noted when an object was opened, by the object's name. */
export const notes = signal<ReadonlyMap<string, string[]>>(new Map());

export const object = computed<SessionObject | undefined>(() => objects.value[active.value]);
export const has = (part: string) => object.value?.parts[part] !== undefined;

/** Objects of the session drawn together with the active one, and the drawing style. */
export const layers = signal<ReadonlySet<string>>(new Set());
export const drawnAs = signal<"surface" | "edges" | "points">("surface");

/** Where the comparison of the shape before and after the deformation divides the picture, from 0 to 1; undefined: it is off. */
export const compare = signal<number | undefined>(undefined);

/** Called when another content is displayed. */
export const onShown: (() => void)[] = [];

function takeSession(result: Answer["result"]) {
  objects.value = result.state.objects;
  files.value = result.state.files;
  active.value = result.state.active;
  history.value = result.history;
  place.value = result.place;
  if (result.openable) openable.value = result.openable;
}

const idOf = (o: number, annotation: number) => page.page?.objects[o]?.annotations[annotation]?.id;

/** Requests the current state of the session. Camera, selection and hidden annotations are kept as far as they still exist. */
export async function refresh() {
  performance.mark("scene asked");
  const answer = await link.ask("scene", { known: knownShapes() });
  performance.mark("scene there");
  const data = JSON.parse(answer.result.content) as PageData;
  const before = page.page && {
    object: shown.value[page.object.value],
    chosen: idOf(page.object.value, page.chosen.value),
    hidden: [...page.hidden.value].map((key) => {
      const [o, i] = key.split("/").map(Number);
      return `${o}/${idOf(o, i)}`;
    }),
    sideBySide: page.sideBySide.value,
    name: page.page.objects[page.object.value]?.name,
    size: page.page.objects[page.object.value]?.size.join(),
  };
  takeSession(answer.result);
  shown.value = answer.result.shown;
  // The deformed state if there is one, otherwise the object itself.
  const wanted = shown.value.findIndex((one) => one.object === active.value && one.deformed);
  const first = wanted >= 0 ? wanted : shown.value.findIndex((one) => one.object === active.value);
  const next = data.objects[first];
  const same = before?.object?.object === active.value && next !== undefined;
  await showContent({ data, blobs: new Blobs(answer.bytes, data.blobs) }, same);
  if (next) {
    page.object.value = first;
    if (same && before) {
      page.chosen.value = next.annotations.findIndex((one) => one.id === before.chosen);
      const hidden = new Set<string>();
      data.objects.forEach((one, o) =>
        one.annotations.forEach((a, i) => before.hidden.includes(`${o}/${a.id}`) && hidden.add(`${o}/${i}`)),
      );
      page.hidden.value = hidden;
      page.sideBySide.value = before.sideBySide;
    }
  }
  page.ready.value = true;
  for (const one of onShown) one();
}

/** Executes an action and reports errors. Returns true if it succeeded. */
export async function attempt(what: string, work: () => Promise<unknown>): Promise<boolean> {
  problem.value = undefined;
  busy.value = what;
  try {
    await work();
    return true;
  } catch (error) {
    problem.value =
      error instanceof RequestError ? { problem: error.about.problem, remedy: error.about.remedy } : { problem: String(error), remedy: "" };
    return false;
  } finally {
    busy.value = "";
    progress.value = undefined;
  }
}

export interface Run {
  operation: string;
  title: string;
  with: Record<string, unknown>;
  keep?: (string | { output: string; file: string })[];
  as?: "deformed";
}

/** Runs an operation of the table on the session. */
export function run(request: Run): Promise<boolean> {
  return attempt(request.title, async () => {
    const { result } = await link.ask("run", request);
    page.message.value = "";
    outcome.value = { title: request.title, text: result.text, holds: result.holds, notes: result.notes };
    await refresh();
  });
}

/** Changes the session without an operation. */
export const change = (title: Key, what: string, more: object = {}) =>
  attempt(text(title), async () => {
    const { result } = await link.ask(what, more);
    outcome.value = undefined;
    page.message.value = "";
    await refresh();
    if (what === "open" && object.value) notes.value = new Map(notes.value).set(object.value.name, result.notes ?? []);
  });

export const goTo = (step: number) => change("undo", "go", { place: step });
/** The step to which undo and redo lead while they are under way, so that five fast presses of a key are five steps. */
let wantedPlace: number | undefined;
let isGoing = false;

async function goBy(by: number): Promise<boolean> {
  const wanted = (wantedPlace ?? place.value) + by;
  if (wanted < 0 || wanted > history.value.length) return false;
  wantedPlace = wanted;
  if (isGoing) return true;
  isGoing = true;
  let went = true;
  while (went && wantedPlace !== undefined && wantedPlace !== place.value) went = await goTo(wantedPlace);
  isGoing = false;
  wantedPlace = undefined;
  return went;
}
export const undo = () => goBy(-1);
export const redo = () => goBy(1);

export const part = (which: string) => ({ part: which });

export async function download(file: string) {
  const answer = await link.ask("file", { file });
  const anchor = document.createElement("a");
  anchor.href = URL.createObjectURL(new Blob([answer.bytes as BlobPart]));
  anchor.download = answer.result.name;
  anchor.click();
  URL.revokeObjectURL(anchor.href);
}
