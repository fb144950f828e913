// Remedies of errors and notes as buttons: what the command says in words of a terminal is done here by a click.
import { signal } from "@preact/signals";
import { linkCage, makeCage } from "./commands";
import { has, object, operations, part, run } from "./model";
import { choose } from "./tools";
import { text } from "./words";

export interface Remedy {
  label: string;
  action: () => void;
}

export const tabs = [
  "annotating",
  "measuring",
  "relating",
  "deforming",
  "fragments",
  "slicing",
  "everything",
  "results",
  "history",
] as const;
export type Tab = (typeof tabs)[number];
export const tab = signal<Tab>("annotating");
/** Whether the panel is folded away. */
export const folded = signal(false);
/** The operation that the panel "All operations" shows. */
export const wantedForm = signal("mesh info");

export function showTab(which: Tab) {
  tab.value = which;
  folded.value = false;
}

/** Repairs the object: the copy is a new object of the session, and the original stays open. */
export const repairCopy = () =>
  run({ operation: "mesh repair", title: `${text("repairCopy")}: ${object.value?.name ?? ""}`, with: { input: part("mesh") } });

function showForm(name: string) {
  wantedForm.value = name;
  showTab("everything");
}

/** The name of an operation of the table that a text names after "ostraka". */
function operationIn(said: string): string | undefined {
  const named = /\bostraka ([a-z]+(?: [a-z]+)?)/.exec(said)?.[1];
  if (!named) return undefined;
  const names = operations.value.map((one) => one.name);
  return names.find((one) => one === named) ?? names.find((one) => one === named.split(" ")[0]);
}

const rules: { says: RegExp; suits?: () => boolean; remedy: () => Remedy }[] = [
  {
    says: /mesh repair|ostraka import make|oriented manifold|not closed/,
    suits: () => has("mesh"),
    remedy: () => ({ label: text("repairCopy"), action: () => void repairCopy() }),
  },
  { says: /make (a cage|one) first/, remedy: () => ({ label: text("makeCage"), action: () => void makeCage() }) },
  { says: /link (them|the cage)/, remedy: () => ({ label: text("linkCage"), action: () => void linkCage() }) },
  {
    says: /annotate it first|no annotations/,
    remedy: () => ({
      label: text("markPart"),
      action: () => {
        choose("lasso");
        showTab("annotating");
      },
    }),
  },
  {
    says: /add a relationship first|state a constraint first/,
    remedy: () => ({ label: text("makeRelation"), action: () => showTab("relating") }),
  },
  { says: /set-up|upward direction|direction is up/, remedy: () => ({ label: text("standIt"), action: () => choose("base") }) },
  {
    says: /set-unit|no unit|unit is not known|states no unit/,
    remedy: () => ({ label: text("setUnitNow"), action: () => showTab("measuring") }),
  },
  { says: /load the page again/, remedy: () => ({ label: text("reloadPage"), action: () => location.reload() }) },
];

/** The buttons that do what a remedy asks for. */
export function remediesOf(said: string): Remedy[] {
  const found = rules.find((one) => one.says.test(said) && (one.suits?.() ?? true));
  if (found) return [found.remedy()];
  const name = operationIn(said);
  return name ? [{ label: text("openForm", name), action: () => showForm(name) }] : [];
}

/** A text without the commands of a terminal, which a button replaces, and without the folders of files. */
export const withoutCommands = (said: string) =>
  said
    .replace(/(^|\s|')\/(?:[^\s,:;()]+\/)+/g, "$1")
    .replace(/\s*\([^()]*\bostraka [^()]*\)/g, "")
    .replace(/^(run|use): ostraka .*$/, "")
    .replace(/,? (run|use):? '?ostraka [^;,']*'?/g, "");
