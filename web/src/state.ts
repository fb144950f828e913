// The state of the page as signals, from which all its parts are derived.
import { computed, signal } from "@preact/signals";
import type { Blobs, Colouring, Content, Language, PageData, Table } from "./data";
import messages from "./messages.json";

export type Word = keyof (typeof messages)["en"];

const stored = (key: string) => {
  try {
    return localStorage.getItem(key);
  } catch {
    return null; // some browsers provide no storage for local files
  }
};
const keep = (key: string, value: string) => {
  try {
    localStorage.setItem(key, value);
  } catch {
    // the choice lasts until the page is closed
  }
};

const known: Language[] = ["en", "de", "it"];
const asked = [stored("ostraka-language"), ...navigator.languages.map((l) => l.slice(0, 2))];
export const language = signal<Language>((asked.find((l) => known.includes(l as Language)) as Language) ?? "en");
export const theme = signal<string>(stored("ostraka-theme") ?? "system");

export function setLanguage(value: Language) {
  language.value = value;
  keep("ostraka-language", value);
}
export function setTheme(value: string) {
  theme.value = value;
  keep("ostraka-theme", value);
}

export function word(key: Word, ...values: (string | number)[]): string {
  return messages[language.value][key].replace(/\{(\d)\}/g, (_, i) => String(values[+i] ?? ""));
}
const format = computed(() => new Intl.NumberFormat(language.value, { maximumSignificantDigits: 5 }));
const whole = computed(() => new Intl.NumberFormat(language.value));
export const numberText = (x: number) => (Number.isInteger(x) ? whole.value.format(x) : format.value.format(x));
export const withUnit = (x: number, unit: string) => numberText(x) + (unit ? " " + unit : "");

/** The displayed content: that of the page, or that of an object of a collection. */
export let page: PageData;
export let blobs: Blobs;
/** Number of contents displayed so far; whatever depends on it is recomputed. */
export const turn = signal(0);
export function setContent(content: Content) {
  page = content.data;
  blobs = content.blobs;
  Object.values(defaults).forEach((reset) => reset());
  turn.value += 1;
}

const defaults: (() => void)[] = [];
/** A signal that is reset with each content. */
function fresh<T>(value: T) {
  const made = signal(value);
  defaults.push(() => (made.value = value));
  return made;
}

export const object = fresh(0);
export const sideBySide = fresh(false);
export const chosen = fresh(-1);
/** The highlighted table row, if it belongs to no object. */
export const marked = fresh<{ table: string; row: number }>({ table: "", row: -1 });
export const hovered = fresh<{ object: number; annotations: number[]; vertex: number; x: number; y: number } | undefined>(undefined);
export const hidden = fresh<ReadonlySet<string>>(new Set());
export const search = fresh("");
export const map = fresh(-1);
/** What colours the surfaces where no map does; kept when another content is shown. */
export const colouring = signal<Colouring | "auto">("auto");
export const isColouring = (text: string): text is Colouring => ["texture", "own", "annotations", "clay"].includes(text);
/** Whether colours are shown under light and shade; undefined: unless a material of the object asks for flat light. */
export const shade = signal<boolean | undefined>(undefined);
/** Whether the measures of all shown annotations are drawn, not only those of the selected one. */
export const allMeasures = signal(false);
/** Direction of the lamp: the part of the unit vector towards it that lies in the picture (right, up). */
export const firstLamp: [number, number] = [0.263, 0.473];
export const lamp = signal<[number, number]>(firstLamp);
/** How much ridges are brightened and hollows darkened, from 0 (not at all) to 1. */
export const relief = signal(0);
export const blend = fresh(0);
export const explode = fresh(0);
/** Displayed level of the slices; -1: none. */
export const level = fresh(-1);
export const clip = fresh(1);
export const clipAxis = signal(2);
export const patterns = signal(false);
export const labels = signal(true);
export const cage = signal(true);
/** Whether a click selects; false while a tool uses the pointer. */
export const clicks = signal(true);
export const measuring = signal(false);
export const measured = fresh<{ object: number; places: { x: number; y: number; z: number }[] }>({ object: -1, places: [] });
export const message = signal("");
/** Number of frames drawn; overlays are updated with it. */
export const moves = signal(0);
/** Whether the first frame has been drawn, so that the rest of the page may follow. */
export const ready = signal(false);

/** The index of a collection, if the page is one, and the index of its open object; -1: none. */
export let index: Content | undefined;
export const setIndex = (content: Content) => {
  index = content;
};
export const entry = signal(-1);

export const keyOf = (o: number, annotation: number) => `${o}/${annotation}`;
export const isShown = (o: number, annotation: number) => !hidden.value.has(keyOf(o, annotation));

export function show(o: number, list: number[], shown: boolean) {
  const next = new Set(hidden.value);
  for (const one of list) {
    if (shown) next.delete(keyOf(o, one));
    else next.add(keyOf(o, one));
  }
  hidden.value = next;
}

export function choose(annotation: number, of = object.value) {
  if (of !== object.value) {
    object.value = of;
    level.value = -1;
  }
  chosen.value = annotation;
  marked.value = { table: "", row: -1 };
}

/** Whether a table row is selected. */
export function isRowChosen(table: Table, row: number): boolean {
  const o = table.objects?.[row] ?? -1;
  const a = table.annotations?.[row] ?? -1;
  if (marked.value.table === table.name && marked.value.row === row) return true;
  if (o < 0 || o !== object.value || page.objects.length === 0) return false;
  return a < 0 ? !table.annotations : a === chosen.value;
}

/** The objects in the panes, from left to right. */
export const panes = computed(() => {
  const count = page.objects.length;
  if (!sideBySide.value || count < 2) return [object.value];
  const first = Math.max(0, Math.min(object.value - 1, count - 4));
  return page.objects.map((_, i) => i).slice(first, first + 4);
});

/** The object that the selected one is blended into. */
export const blendPartner = computed(() => {
  const group = page.objects[object.value]?.blend;
  if (group === undefined) return -1;
  const list = page.objects.map((_, i) => i).filter((i) => page.objects[i].blend === group);
  return list[list.indexOf(object.value) + 1] ?? list[0];
});
