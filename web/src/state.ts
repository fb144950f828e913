// What the page shows, as signals: every part of it follows them.
import { computed, signal } from "@preact/signals";
import type { Language, PageData } from "./data";
import messages from "./messages.json";

export type Word = keyof (typeof messages)["en"];

const stored = (key: string) => {
  try {
    return localStorage.getItem(key);
  } catch {
    return null; // some browsers keep nothing for local files
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

/** The page's content; set once, before anything is drawn. */
export let page: PageData;
export const setPage = (data: PageData) => {
  page = data;
};

export const object = signal(0);
export const sideBySide = signal(false);
export const chosen = signal(-1);
export const hovered = signal<{ object: number; annotations: number[]; vertex: number; x: number; y: number } | undefined>(undefined);
export const hidden = signal<ReadonlySet<string>>(new Set());
export const search = signal("");
export const map = signal(-1);
export const blend = signal(0);
export const clip = signal(1);
export const clipAxis = signal(2);
export const patterns = signal(false);
export const labels = signal(true);
export const cage = signal(true);
export const measuring = signal(false);
export const measured = signal<{ object: number; places: { x: number; y: number; z: number }[] }>({ object: -1, places: [] });
export const message = signal("");

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
  if (of !== object.value) object.value = of;
  chosen.value = annotation;
}

/** The objects in the panes, from left to right. */
export const panes = computed(() => {
  const count = page.objects.length;
  if (!sideBySide.value || count < 2) return [object.value];
  const first = Math.max(0, Math.min(object.value - 1, count - 4));
  return page.objects.map((_, i) => i).slice(first, first + 4);
});

/** The object that the chosen one turns into. */
export const blendPartner = computed(() => {
  const group = page.objects[object.value]?.blend;
  if (group === undefined) return -1;
  const list = page.objects.map((_, i) => i).filter((i) => page.objects[i].blend === group);
  return list[list.indexOf(object.value) + 1] ?? list[0];
});
