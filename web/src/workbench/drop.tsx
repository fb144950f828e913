// Scans dropped onto the page: they are sent to the session's folder, imported there, and opened.
import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { RequestError, type Problem } from "./link";
import * as model from "./model";
import { text, type Key } from "./words";

/** A dropped file with its path below the dropped folder. */
interface Dropped {
  name: string;
  file: File;
}
interface Row {
  name: string;
  size: number;
  sent: number;
  /** Its state: "waiting", "sending", "sent", or the state that the import reports. */
  state: string;
  remarks: string;
}
interface Arrival {
  rows: Row[];
  phase: "sending" | "importing" | "done" | "failed";
  problem?: Problem;
}

export const arrival = signal<Arrival | undefined>(undefined);
const hovering = signal(false);
let request: XMLHttpRequest | undefined;

/** Files that an import may need; others of a folder stay where they are. */
const needed = /\.(obj|mtl|ply|glb|gltf|bin|stl|off|3mf|e57|las|laz|pts|ptx|pcd|xyz|xyzn|xyzrgb|asc|csv|txt|jpe?g|png|webp|gif|ktx2)$/i;
/** Formats that are refused with the name of a converter. */
const refused = /\.(dae|x3d|x3db|fbx|3ds|wrl|vrml|blend|usd[acz]?|abc|ste?p|ige?s|vtk|vtp|drc|zip)$/i;

const entriesOf = (folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> => {
  const reader = folder.createReader();
  const all: FileSystemEntry[] = [];
  return new Promise((done, failed) => {
    const more = () =>
      reader.readEntries((some) => {
        all.push(...some);
        if (some.length === 0) done(all);
        else more();
      }, failed);
    more();
  });
};

async function filesBelow(entry: FileSystemEntry, before: string): Promise<Dropped[]> {
  const name = before + entry.name;
  if (entry.isFile) {
    const file = await new Promise<File>((done, failed) => (entry as FileSystemFileEntry).file(done, failed));
    return [{ name, file }];
  }
  const found: Dropped[] = [];
  for (const one of await entriesOf(entry as FileSystemDirectoryEntry)) found.push(...(await filesBelow(one, `${name}/`)));
  return found;
}

/** The files of a drop, those in folders too. The list of items is valid only during the event. */
function filesOf(transfer: DataTransfer): Promise<Dropped[]> {
  const entries = [...transfer.items].filter((one) => one.kind === "file").map((one) => one.webkitGetAsEntry());
  if (entries.length > 0 && entries.every((one) => one !== null))
    return Promise.all(entries.map((one) => filesBelow(one, ""))).then((lists) => lists.flat());
  return Promise.resolve([...transfer.files].map((file) => ({ name: file.name, file })));
}

function send(batch: string, index: number, row: Dropped): Promise<void> {
  return new Promise((done, failed) => {
    const fail = (problem: string) => failed(new RequestError({ problem, where: row.name, remedy: text("sendAgain") }));
    request = new XMLHttpRequest();
    request.open("POST", model.link.uploadAddress(batch, index));
    request.upload.onprogress = (event) => update(row.name, { sent: event.loaded });
    request.onload = () => {
      if (request?.status === 200) done();
      else fail(`${row.name}: ${request?.responseText.trim() || request?.status}`);
    };
    request.onerror = () => fail(text("notSent", row.name));
    request.onabort = () => fail(text("cancelled"));
    request.send(row.file);
  });
}

function update(name: string, change: Partial<Row>) {
  if (!arrival.value) return;
  arrival.value = { ...arrival.value, rows: arrival.value.rows.map((one) => (one.name === name ? { ...one, ...change } : one)) };
}
const setPhase = (phase: Arrival["phase"], problem?: Problem) => {
  if (arrival.value) arrival.value = { ...arrival.value, phase, problem };
};

interface ImportedObject {
  file: string;
  state: string;
  remarks?: string;
}

/** Sends files to the session, imports the scans among them, and opens the objects. */
export async function take(all: Dropped[]): Promise<void> {
  const list = all.filter((one) => needed.test(one.name) && !one.name.split("/").some((part) => part.startsWith(".")));
  const others = all.filter((one) => refused.test(one.name));
  const row = (one: Dropped, state: string): Row => ({ name: one.name, size: one.file.size, sent: 0, state, remarks: "" });
  arrival.value = { rows: [...list.map((one) => row(one, "waiting")), ...others.map((one) => row(one, "notRead"))], phase: "sending" };
  try {
    if (list.length === 0)
      throw new RequestError({ problem: text("noScan"), where: "", remedy: others.length > 0 ? text("convertFirst") : text("noScanHelp") });
    const { result } = await model.link.ask("upload", { files: list.map((one) => ({ name: one.name, size: one.file.size })) });
    for (const [i, one] of list.entries()) {
      update(one.name, { state: "sending" });
      await send(result.batch, i, one);
      update(one.name, { state: "sent", sent: one.file.size });
    }
    const scans: string[] = result.scans.map((i: number) => list[i].name);
    setPhase("importing");
    model.problem.value = undefined;
    model.busy.value = text("importing");
    const answer = await model.link.ask("run", {
      operation: "import",
      title: `${text("importScan")}: ${scans.join(", ")}`,
      with: { scan: scans.map((name) => ({ upload: result.batch, name })) },
      keep: ["object"],
    });
    model.outcome.value = { title: text("importScan"), text: answer.result.text, holds: answer.result.holds, notes: answer.result.notes };
    for (const object of answer.result.result.objects as ImportedObject[]) {
      const name = scans.find((one) => object.file.endsWith(`/${result.batch}/${one}`)) ?? object.file;
      update(name, { state: object.state, remarks: object.remarks ?? "" });
    }
    await model.refresh();
    setPhase("done");
  } catch (error) {
    setPhase("failed", error instanceof RequestError ? error.about : { problem: String(error), where: "", remedy: "" });
  } finally {
    request = undefined;
    model.busy.value = "";
    model.progress.value = undefined;
  }
}

const isWorking = () => arrival.value?.phase === "sending" || arrival.value?.phase === "importing";
const holdsFiles = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;

/** Listens to files dragged over the whole page. */
export function attachDrop() {
  let depth = 0; // of the elements below the pointer that were entered
  const over = (event: DragEvent) => {
    if (!holdsFiles(event)) return;
    event.preventDefault();
    if (event.dataTransfer) event.dataTransfer.dropEffect = isWorking() ? "none" : "copy";
  };
  window.addEventListener("dragenter", (event) => {
    over(event);
    if (holdsFiles(event)) hovering.value = ++depth > 0;
  });
  window.addEventListener("dragover", over);
  window.addEventListener("dragleave", (event) => {
    if (holdsFiles(event)) hovering.value = --depth > 0;
  });
  window.addEventListener("drop", (event) => {
    if (!event.dataTransfer || !holdsFiles(event)) return;
    event.preventDefault();
    depth = 0;
    hovering.value = false;
    if (!isWorking()) void filesOf(event.dataTransfer).then(take);
  });
}

const states = new Set(["waiting", "sending", "sent", "notRead", "sound", "open", "refused"]);
const stateText = (state: string) => (states.has(state) ? text(`state_${state}` as Key) : state);

/** The button that chooses files, for those who do not drag. */
export function ChooseFiles() {
  const input = useRef<HTMLInputElement>(null);
  return (
    <>
      <button type="button" disabled={isWorking()} onClick={() => input.current?.click()} title={text("importHelp")}>
        {text("importScan")} …
      </button>
      <input
        ref={input}
        type="file"
        multiple
        hidden
        aria-label={text("importScan")}
        onChange={(event) => {
          const files = [...(event.currentTarget.files ?? [])].map((file) => ({ name: file.name, file }));
          event.currentTarget.value = "";
          if (files.length > 0) void take(files);
        }}
      />
    </>
  );
}

/** What is dropped, and what becomes of it. */
export function Arriving() {
  const now = arrival.value;
  const panel = useRef<HTMLElement>(null);
  const failed = now?.phase === "failed";
  useEffect(() => {
    if (failed) panel.current?.focus();
  }, [failed]);
  if (hovering.value) return <div class="dropping">{text("dropHere")}</div>;
  if (!now) return null;
  const sent = now.rows.reduce((sum, one) => sum + one.sent, 0);
  const size = now.rows.reduce((sum, one) => sum + one.size, 0);
  const step = model.progress.value;
  return (
    <section class="arriving" aria-label={text("importScan")} ref={panel} tabIndex={-1}>
      <h2>{text(now.phase === "sending" ? "sendingFiles" : now.phase === "importing" ? "importing" : "importScan")}</h2>
      {now.phase === "sending" && <progress max={Math.max(size, 1)} value={sent} aria-label={text("sendingFiles")} />}
      {now.phase === "importing" && (
        <p>
          {step && `${step.phase} ${Math.round(100 * step.share)} %`}{" "}
          <progress max={1} value={step?.share} aria-label={text("importing")} />
        </p>
      )}
      {now.problem && (
        <p role="alert" class="problem">
          {now.problem.where && !now.problem.problem.includes(now.problem.where) && `${now.problem.where}: `}
          {now.problem.problem}
          {now.problem.remedy && `. ${now.problem.remedy}`}
        </p>
      )}
      <ul>
        {now.rows.map((one) => (
          <li key={one.name} data-state={one.state}>
            {one.name}: {stateText(one.state)}
            {one.state === "sending" && ` ${Math.round((100 * one.sent) / Math.max(one.size, 1))} %`}
            {one.remarks && <span class="quiet"> – {one.remarks}</span>}
          </li>
        ))}
      </ul>
      <div class="buttons">
        {isWorking() ? (
          <button
            type="button"
            onClick={() => {
              request?.abort();
              model.link.cancel();
            }}
          >
            {text("cancel")}
          </button>
        ) : (
          <button type="button" onClick={() => (arrival.value = undefined)}>
            {text("close")}
          </button>
        )}
      </div>
    </section>
  );
}
