// Panels beside the view: annotations, relationships, cage and deformation, results, history.
import { useState } from "preact/hooks";
import { Constraints } from "../constraints";
import { Details } from "../details";
import { Graph } from "../graph";
import { Legend } from "../legend";
import { Slices } from "../slices";
import * as page from "../state";
import { Tables } from "../tables";
import { extract, linkCage, makeCage, makeCageFor } from "./commands";
import * as deform from "./deform";
import { helpOf, Operations } from "./forms";
import { ByNumbers } from "./numbers";
import { AddRelation } from "./relate";
import {
  change,
  compare,
  download,
  files,
  goTo,
  has,
  history,
  object,
  objects,
  outcome,
  part,
  place,
  run,
  words as vocabulary,
} from "./model";
import { cutPlane } from "./camera";
import * as selection from "./selection";
import { text, type Key } from "./words";

const chosenAnnotation = () => page.page.objects[page.object.value]?.annotations[page.chosen.value];

function Button(props: { name: Key; title?: string; disabled?: boolean; onClick: () => void }) {
  return (
    <button type="button" title={props.title} disabled={props.disabled} onClick={props.onClick}>
      {text(props.name)}
    </button>
  );
}

/** Colours of new annotations, in turn: those of Okabe and Ito (2008), which people with colour blindness tell apart, and mixtures. */
const palette = ["#d55e00", "#0072b2", "#009e73", "#e69f00", "#cc79a7", "#56b4e9", "#8c564b", "#b2a800", "#7b5ea7", "#4d9b2f"];

/** Runs "annotation select" with the current selection. */
export function annotate(action: "make" | "replace" | "add to" | "remove from", tag: string, colour: string, id?: number) {
  const given: Record<string, unknown> = { mesh: part("mesh"), expression: JSON.stringify(selection.expression.value), action };
  if (has("annotations")) given.annotations = part("annotations");
  const keep = ["output"];
  // A recipe started with the first annotation reproduces all of them.
  if (!has("annotations") || has("recipe")) {
    keep.push("recipe");
    if (has("recipe")) given.record = part("recipe");
  }
  if (action === "make") {
    given.tag = tag;
    given.type = selection.typeOf(selection.expression.value!);
    const rgb = /^#(..)(..)(..)$/.exec(colour);
    if (rgb) given.colour = rgb.slice(1).map((x) => parseInt(x, 16));
  }
  if (id !== undefined) given.id = id;
  if (selection.typeOf(selection.expression.value!) === "region") given.outline = selection.asDrawn.value ? "free" : "edges";
  return run({ operation: "annotation select", title: `${text("annotate")}: ${tag}`, with: given, keep });
}

/** Runs "annotation edit" on the selected annotation. */
function edit(title: string, more: Record<string, unknown>, one = chosenAnnotation()) {
  if (!one) return;
  void run({
    operation: "annotation edit",
    title: `${title}: ${one.tag}`,
    with: { mesh: part("mesh"), annotations: part("annotations"), annotation: String(one.id), ...more },
    keep: ["output"],
  });
}

/** The area of a region, or the length of a line, with its unit. */
function sizeText(size: number, type: string): string {
  const { unit } = page.page.objects[page.object.value];
  return page.withUnit(Number(size.toPrecision(4)), unit && type === "region" ? `${unit}²` : unit);
}

/** Name and colour of the selected annotation, changed in place, and its removal together with the relationships that name it. */
export function PartEditor() {
  const [asks, setAsks] = useState(false);
  const about = page.page.objects[page.object.value];
  const one = chosenAnnotation();
  if (!about || !one || selection.selected.value) return null;
  const naming = about.relations.filter((relation) => relation.members.includes(page.chosen.value));
  const remove = async () => {
    setAsks(false);
    const named = naming.map((relation) => relation.id);
    if (has("graph") && named.length > 0) {
      const given = { mesh: part("mesh"), annotations: part("annotations"), graph: part("graph"), id: named };
      if (!(await run({ operation: "relation remove", title: `${text("deletePart")}: ${one.tag} (${text("relationList")})`, with: given })))
        return;
    }
    edit(text("deletePart"), { remove: true }, one);
  };
  return (
    <div class="hint part-editor" key={one.id}>
      <input
        type="color"
        aria-label={text("colour")}
        value={`#${one.colour.map((c) => c.toString(16).padStart(2, "0")).join("")}`}
        onChange={(event) => edit(text("colour"), { colour: event.currentTarget.value }, one)}
      />
      <input
        aria-label={text("rename")}
        title={text("rename")}
        value={one.tag}
        onKeyDown={(event) => {
          if (event.key === "Enter") event.currentTarget.blur();
        }}
        onChange={(event) => {
          const tag = event.currentTarget.value.trim();
          if (tag && tag !== one.tag) edit(text("rename"), { tag }, one);
        }}
      />
      <Button name="deletePart" onClick={() => (has("graph") && naming.length > 0 ? setAsks(true) : void remove())} />
      {asks && (
        <div class="question" role="alertdialog" aria-label={text("deletePart")}>
          <p>{text("deletePartAsk", naming.length, one.tag)}</p>
          <div class="buttons">
            <Button name="deleteAll" onClick={() => void remove()} />
            <Button name="keepIt" onClick={() => setAsks(false)} />
          </div>
        </div>
      )}
    </div>
  );
}

export function Annotating() {
  const [tag, setTag] = useState("");
  const [chosenColour, setColour] = useState("");
  // Each new annotation has the next colour of the palette.
  const colour = chosenColour || palette[(page.page.objects[page.object.value]?.annotations.length ?? 0) % palette.length];
  const [name, setName] = useState("");
  const [value, setValue] = useState("");
  const one = chosenAnnotation();
  const chosen = selection.selected.value;
  // Existing tags, and those offered by vocabularies in the reader's language or without a language.
  const offered = [page.language.value, ""].flatMap((language) => vocabulary.value[language] ?? []);
  const words = [...new Set([...page.page.objects.flatMap((o) => o.annotations.map((a) => a.tag)), ...offered])];
  return (
    <>
      <section aria-labelledby="selection-title">
        <h2 id="selection-title">{text("selection")}</h2>
        <p class="quiet" role="status">
          {chosen ? text("selected", chosen.count, text(chosen.type as Key)) : text("nothingSelected")}
          {chosen?.size !== undefined && `, ${sizeText(chosen.size, chosen.type)}`}
        </p>
        <div class="buttons">
          <label>
            <input
              type="checkbox"
              checked={selection.visible.value}
              onChange={(event) => (selection.visible.value = event.currentTarget.checked)}
            />{" "}
            {text("visibleOnly")}
          </label>
          <label>
            <input
              type="checkbox"
              checked={selection.asDrawn.value}
              onChange={(event) => (selection.asDrawn.value = event.currentTarget.checked)}
            />{" "}
            {text("asDrawn")}
          </label>
          <label>
            <input
              type="checkbox"
              checked={selection.erases.value}
              onChange={(event) => (selection.erases.value = event.currentTarget.checked)}
            />{" "}
            {text("erase")}
          </label>
          <Button name="invert" disabled={!chosen} onClick={() => void selection.setSelection({ invert: selection.expression.value! })} />
          <Button
            name="grow"
            disabled={!chosen}
            onClick={() => void selection.setSelection({ grow: { of: selection.expression.value!, rings: 1 } })}
          />
          <Button
            name="shrink"
            disabled={!chosen}
            onClick={() => void selection.setSelection({ shrink: { of: selection.expression.value!, rings: 1 } })}
          />
          <Button name="selectAll" onClick={() => void selection.setSelection({ all: true })} />
          <Button name="clearSelection" disabled={!chosen} onClick={selection.clear} />
        </div>
        <form
          class="annotate"
          onSubmit={async (event) => {
            event.preventDefault();
            if (await annotate("make", tag, colour)) {
              selection.clear();
              setTag("");
              setColour("");
            }
          }}
        >
          <label>
            {text("tag")} <input value={tag} required list="known-tags" onInput={(event) => setTag(event.currentTarget.value)} />
          </label>
          <datalist id="known-tags">
            {words.map((word) => (
              <option key={word} value={word} />
            ))}
          </datalist>
          <label>
            {text("colour")} <input type="color" value={colour} onInput={(event) => setColour(event.currentTarget.value)} />
          </label>
          <button type="submit" disabled={!chosen} title={helpOf("annotation select")}>
            {text("annotate")}
          </button>
        </form>
        {one && (
          <div class="buttons">
            <Button name="replaceSelection" disabled={!chosen} onClick={() => void annotate("replace", one.tag, "", one.id)} />
            <Button name="addToIt" disabled={!chosen} onClick={() => void annotate("add to", one.tag, "", one.id)} />
            <Button name="removeFromIt" disabled={!chosen} onClick={() => void annotate("remove from", one.tag, "", one.id)} />
            <Button name="selectIt" onClick={() => void selection.setSelection({ annotation: one.id })} />
          </div>
        )}
      </section>
      <Legend />
      <Details />
      {one && (
        <section aria-labelledby="edit-title">
          <h2 id="edit-title">{text("editAnnotation")}</h2>
          <form
            class="annotate"
            onSubmit={(event) => {
              event.preventDefault();
              edit(text("attribute"), { attribute: [`${name}=${value}`] });
            }}
          >
            <label>
              {text("name")} <input value={name} required onInput={(event) => setName(event.currentTarget.value)} />
            </label>
            <label>
              {text("value")} <input value={value} required onInput={(event) => setValue(event.currentTarget.value)} />
            </label>
            <button type="submit">{text("attribute")}</button>
          </form>
          <div class="buttons">
            {[...one.attributes.map((a) => a.name), ...one.measures.map((m) => m.name)].map((which) => (
              <button key={which} type="button" onClick={() => edit(text("removeAttribute"), { "remove-attribute": [which] })}>
                {text("removeAttribute")}: {which}
              </button>
            ))}
          </div>
        </section>
      )}
      <More title="transfer" operation="annotation transfer" />
      <More title="edit" operation="annotation edit" />
      <More title="describe" operation="measure describe" />
    </>
  );
}

function More({ title, operation }: { title: Key; operation: string }) {
  const [open, setOpen] = useState(false);
  return (
    <details onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>
        {text(title)} <span class="quiet">({operation})</span>
      </summary>
      {open && <Operations only={operation} />}
    </details>
  );
}

export function Relations() {
  const about = page.page.objects[page.object.value];
  if (!about) return null;
  return (
    <>
      <div class="buttons">
        <Button name="extract" title={helpOf("relation extract")} disabled={!has("annotations")} onClick={() => void extract()} />
        <Button
          name="check"
          title={helpOf("relation check")}
          disabled={!has("graph")}
          onClick={() =>
            void run({
              operation: "relation check",
              title: text("check"),
              with: { mesh: part("mesh"), annotations: part("annotations"), graph: part("graph") },
            })
          }
        />
      </div>
      <Graph />
      <section aria-labelledby="relation-list">
        <h2 id="relation-list">{text("relationList")}</h2>
        {about.relations.length === 0 && <p class="quiet">{text("noRelations")}</p>}
        <ul class="relations">
          {about.relations.map((one, i) => (
            <li key={i} class={one.members.includes(page.chosen.value) ? "chosen" : ""}>
              <button type="button" class="link" onClick={() => page.choose(one.members[0])}>
                {one.type}: {one.members.map((m) => about.annotations[m]?.tag).join(", ")}
              </button>
              {one.constraint && (
                <strong>
                  {" "}
                  {text("constraint")}, {one.weight}
                </strong>
              )}
              {one.holds !== undefined && (
                <span class={one.holds ? "verdict holds" : "verdict broken"}> {text(one.holds ? "holds" : "broken")}</span>
              )}{" "}
              <button
                type="button"
                aria-label={`${text("remove")}: ${one.type} ${i}`}
                onClick={() =>
                  void run({
                    operation: "relation remove",
                    title: `${text("remove")}: ${one.type}`,
                    with: { mesh: part("mesh"), annotations: part("annotations"), graph: part("graph"), id: [one.id] },
                  })
                }
              >
                ×
              </button>
            </li>
          ))}
        </ul>
      </section>
      <AddRelation />
    </>
  );
}

/** Shows the constraints that the cage cannot satisfy, before an edit. */
function Reach() {
  const last = deform.reach.value;
  return (
    <>
      <div class="buttons">
        <Button name="reach" title={helpOf("cage check")} onClick={() => void deform.askReach()} />
      </div>
      {last && (
        <div role="status">
          <p class="quiet">{text("reached", last.constraints - last.texts.length, last.constraints)}</p>
          <ul>
            {last.texts.map((one) => (
              <li key={one}>{one}</li>
            ))}
          </ul>
        </div>
      )}
    </>
  );
}

export function Deforming() {
  const [vertices, setVertices] = useState("100");
  const about = page.page.objects[page.object.value];
  const one = chosenAnnotation();
  const deformed = has("deformed");
  return (
    <>
      <ByNumbers />
      <section aria-labelledby="cage-title">
        <h2 id="cage-title">{text("cage")}</h2>
        <p class="quiet">
          {about?.cage ? text("cageOf", about.cage.vertices) : text("noCage")}{" "}
          {has("coordinates") ? text("linked") : about?.cage ? text("notLinked") : ""}
        </p>
        <div class="buttons">
          <label>
            {text("controlPoints")}{" "}
            <input type="number" min="4" max="100000" value={vertices} onInput={(event) => setVertices(event.currentTarget.value)} />
          </label>
          <Button name="makeCage" title={helpOf("cage make")} onClick={() => void makeCage(Number(vertices))} />
          <Button
            name="makeCageFor"
            title={text("makeCageForHelp")}
            disabled={!has("graph") || !has("annotations")}
            onClick={() => void makeCageFor(Number(vertices))}
          />
          <Button name="linkCage" title={helpOf("cage weights")} disabled={!has("cage")} onClick={() => void linkCage()} />
        </div>
        {has("graph") && has("coordinates") && <Reach />}
      </section>
      <section aria-labelledby="handles-title">
        <h2 id="handles-title">{text("handles")}</h2>
        <p class="quiet" role="status">
          {text("handlesChosen", deform.handles.value.size)}
        </p>
        <div class="buttons">
          <Button name="ofAnnotation" disabled={!one || !has("coordinates")} onClick={() => one && void deform.ofAnnotation(one.id)} />
          <Button
            name="discardAnnotation"
            disabled={!one || !has("coordinates")}
            onClick={() => one && void deform.ofAnnotation(one.id, true)}
          />
          <Button name="clearSelection" disabled={deform.handles.value.size === 0} onClick={() => deform.set([])} />
          <Button name="influence" disabled={deform.handles.value.size === 0} onClick={() => void deform.showInfluence()} />
          <label>
            <input
              type="checkbox"
              checked={deform.keepsConstraints.value}
              disabled={!has("graph")}
              onChange={(event) => (deform.keepsConstraints.value = event.currentTarget.checked)}
            />{" "}
            {text("keepConstraints")}
          </label>
          <label title={text("solvedHelp")}>
            {text("solved")}{" "}
            <select
              value={deform.space.value}
              disabled={!has("graph") || !deform.keepsConstraints.value}
              onChange={(event) => (deform.space.value = event.currentTarget.value as typeof deform.space.value)}
            >
              {deform.spaces.map((one) => (
                <option key={one} value={one}>
                  {text(({ auto: "solvedAuto", mesh: "solvedMesh", cage: "solvedCage" } as const)[one])}
                </option>
              ))}
            </select>
          </label>
          <label>
            <input
              type="checkbox"
              checked={deform.showsPoints.value}
              onChange={(event) => {
                deform.showsPoints.value = event.currentTarget.checked;
                deform.mark();
              }}
            />{" "}
            {text("showPoints")}
          </label>
        </div>
        <p class="quiet">{text("dragHelp")}</p>
        <div class="buttons">
          <Button name="accept" disabled={!deformed} onClick={() => void change("accept", "accept")} />
          <Button name="withdraw" disabled={!deformed} onClick={() => void change("withdraw", "withdraw")} />
        </div>
        {deformed && page.blendPartner.value >= 0 && <BeforeAfter />}
        {deformed && (
          <label>
            <input
              type="checkbox"
              checked={compare.value !== undefined}
              onChange={(event) => (compare.value = event.currentTarget.checked ? 0.5 : undefined)}
            />{" "}
            {text("compare")}
          </label>
        )}
      </section>
      <Constraints />
      <More title="deform" operation="deform" />
      <More title="check" operation="cage check" />
    </>
  );
}

function BeforeAfter() {
  return (
    <label class="slider">
      {text("beforeAfter")}{" "}
      <input
        type="range"
        min={0}
        max={1}
        step={0.01}
        value={page.blend.value}
        onInput={(event) => (page.blend.value = +event.currentTarget.value)}
      />
    </label>
  );
}

export function Fragments() {
  return (
    <>
      <p class="quiet">{text("fragmentsHelp")}</p>
      <More title="fit" operation="fit" />
      <More title="assemble" operation="assemble" />
      <More title="pair" operation="pair" />
    </>
  );
}

/** Slices across the up direction, with descriptors and the profile; the panel's slider selects one. */
function cut(count: number) {
  const name = object.value!.name;
  const given: Record<string, unknown> = { mesh: part("mesh"), count };
  if (has("annotations")) given.annotations = part("annotations");
  const keep = [
    { output: "output", file: `${name}.slices.json` },
    { output: "profile", file: `${name}.profile.svg` },
  ];
  return run({ operation: "slice", title: text("slice"), with: given, keep });
}

/** The slice in the cutting plane of the view, with medial axes. */
function cutHere() {
  const plane = cutPlane();
  if (!plane) return;
  const name = object.value!.name;
  const given: Record<string, unknown> = { mesh: part("mesh"), plane, "medial-axis": [0.01, 0.05, 0.15] };
  if (has("annotations")) given.annotations = part("annotations");
  void run({ operation: "slice", title: text("sliceHere"), with: given, keep: [{ output: "output", file: `${name}.slices.json` }] });
}

export function Slicing() {
  const [count, setCount] = useState("40");
  return (
    <>
      <div class="buttons">
        <label>
          {text("count")} <input type="number" min="1" max="1000" value={count} onInput={(event) => setCount(event.currentTarget.value)} />
        </label>
        <Button name="slice" title={helpOf("slice")} onClick={() => void cut(Number(count))} />
        <Button name="sliceHere" disabled={page.clip.value >= 1} onClick={cutHere} />
      </div>
      <p class="quiet">{text("sliceHelp")}</p>
      <Slices />
      <More title="slice" operation="slice" />
      <More title="axis" operation="axis" />
      <More title="map" operation="measure map" />
    </>
  );
}

export function Everything() {
  return <Operations />;
}

export function History() {
  return (
    <ol class="history">
      <li class={place.value === 0 ? "now" : ""}>
        <button type="button" class="plain" aria-current={place.value === 0 ? "step" : undefined} onClick={() => void goTo(0)}>
          {text("beginning")}
        </button>
      </li>
      {history.value.map((one, i) => (
        <li key={one.name} class={i + 1 === place.value ? "now" : i + 1 > place.value ? "undone" : ""}>
          <button type="button" class="plain" aria-current={i + 1 === place.value ? "step" : undefined} onClick={() => void goTo(i + 1)}>
            {one.title}
            {!one.holds && " ✗"}
            <span class="quiet"> {one.operation}</span>
          </button>
        </li>
      ))}
    </ol>
  );
}

export function Results() {
  const last = outcome.value;
  return (
    <>
      {last && (
        <section aria-labelledby="result-title">
          <h2 id="result-title">
            {last.title} {!last.holds && <span class="verdict broken">{text("answerNo")}</span>}
          </h2>
          {last.text && <pre tabIndex={0}>{last.text}</pre>}
          {last.notes.map((note, i) => (
            <p key={i} class="quiet">
              {note}
            </p>
          ))}
        </section>
      )}
      <section aria-labelledby="files-title">
        <h2 id="files-title">{text("files")}</h2>
        <ul class="files">
          {objects.value.map((one) =>
            Object.entries(one.parts).map(([which, file]) => (
              <li key={one.name + which}>
                <button type="button" class="link" onClick={() => void download(file)}>
                  {one.name}: {which}
                </button>
              </li>
            )),
          )}
          {files.value.map((one) => (
            <li key={one.file}>
              {one.kind === "folder" ? (
                one.name
              ) : (
                <button type="button" class="link" onClick={() => void download(one.file)}>
                  {one.name}
                </button>
              )}
            </li>
          ))}
        </ul>
      </section>
      {object.value && <Tables blobs={page.blobs} />}
    </>
  );
}
