// What is made of the open object to take away: a plate for print, and a page for a colleague.
import * as page from "../state";
import { download, files, has, object, part, run, shown } from "./model";
import { text } from "./words";

/** Runs an operation that writes one file, and hands this file to the browser. */
async function make(operation: string, title: string, output: string, file: string, given: Record<string, unknown>) {
  if (!(await run({ operation, title, with: given, keep: [{ output, file }] }))) return;
  const made = files.value.find((one) => one.name === file);
  if (made) await download(made.file);
}

const about = () => page.page.objects[page.object.value];
/** The part of the shape that is shown: of the deformed one if it is. */
const shownPart = (which: "mesh" | "annotations") => {
  const isDeformed = shown.value[page.object.value]?.deformed ?? false;
  const deformed = which === "mesh" ? "deformed" : "deformed annotations";
  return part(isDeformed && has(deformed) ? deformed : which);
};
const plainName = () => object.value!.name.replace(/[^\p{L}\p{N}._-]+/gu, "-");

/** Six views at one scale on a sheet, with scale bar, names and measures. */
export function makePlate() {
  const given: Record<string, unknown> = { meshes: [shownPart("mesh")], views: "six", size: "2480x1754", measures: has("annotations") };
  if (has("annotations")) given.annotations = [shownPart("annotations")];
  if (about().unit) given.unit = about().unit;
  return make("render", text("plate"), "picture", `${plainName()}-plate.pdf`, given);
}

/** A page of one file that shows the object with its parts, relationships and measures. */
export function makePage() {
  const results = [shownPart("mesh"), ...(has("annotations") ? [shownPart("annotations")] : []), ...(has("graph") ? [part("graph")] : [])];
  const given: Record<string, unknown> = { results, title: object.value!.name };
  if (about().unit) given.unit = about().unit;
  return make("report", text("makePage"), "page", `${plainName()}.html`, given);
}
