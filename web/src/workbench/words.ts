// Texts of the workbench, in the languages of the page.
import { language } from "../state";
import words from "./messages.json";

export type Key = keyof (typeof words)["en"];

export function text(key: Key, ...values: (string | number)[]): string {
  return words[language.value][key].replace(/\{(\d)\}/g, (_, i) => String(values[+i] ?? ""));
}
