// The list of everything that is measured on the object: sizes of the object and its parts, measures and angles.
import { drawn } from "../picture";
import { angleOf, sizeOf } from "../sizes";
import * as page from "../state";
import { has, part, run } from "./model";
import { setUnit } from "./tools";
import { text } from "./words";

export const units = ["mm", "cm", "m"] as const;

const shortNumber = (x: number) => page.numberText(Number(x.toPrecision(4)));

/** Removes a measure, or an annotation that only measures an angle. */
function remove(annotation: number, measure?: string) {
  const one = page.page.objects[page.object.value].annotations[annotation];
  const more = measure === undefined ? { remove: true } : { "remove-attribute": [measure] };
  void run({
    operation: "annotation edit",
    title: `${text("remove")}: ${measure ?? one.tag}`,
    with: { mesh: part("mesh"), annotations: part("annotations"), annotation: String(one.id), ...more },
    keep: ["output"],
  });
}

function Row(props: { name: string; value: string; hint?: string; onChoose: () => void; onRemove?: () => void }) {
  return (
    <tr>
      <td>
        <button type="button" class="link" onClick={props.onChoose}>
          {props.name}
        </button>
      </td>
      <td class="value" title={props.hint}>
        {props.value}
      </td>
      <td>
        {props.onRemove && (
          <button type="button" class="icon-button" aria-label={`${text("remove")}: ${props.name}`} onClick={props.onRemove}>
            ×
          </button>
        )}
      </td>
    </tr>
  );
}

function UnitChoice() {
  const about = page.page.objects[page.object.value];
  return (
    <label class="field">
      {text("unit")}{" "}
      <select
        value={about.unit}
        onChange={(event) => {
          if (event.currentTarget.value) void setUnit(event.currentTarget.value);
        }}
      >
        {!units.includes(about.unit as "mm") && <option value={about.unit}>{about.unit || "–"}</option>}
        {units.map((one) => (
          <option key={one} value={one}>
            {one}
          </option>
        ))}
      </select>
    </label>
  );
}

export function Measuring() {
  const about = page.page.objects[page.object.value];
  const of = drawn[page.object.value];
  if (!about || !of) return null;
  const rows = about.annotations.flatMap((one, i) => {
    const angle = angleOf(of, i);
    const choose = () => page.choose(i);
    const mine = one.measures.map((m) => (
      <Row
        key={`${one.id} ${m.name}`}
        name={`${m.name} (${one.tag})`}
        value={m.value === null ? "–" : page.withUnit(m.value, m.unit) + (m.uncertainty ? ` ± ${shortNumber(m.uncertainty)}` : "")}
        hint={m.stale ? page.word("stale") : undefined}
        onChoose={choose}
        onRemove={() => remove(i, m.name)}
      />
    ));
    if (angle !== undefined)
      mine.push(
        <Row
          key={one.id}
          name={one.tag}
          value={`${page.numberText(Number(angle.toFixed(1)))}°`}
          onChoose={choose}
          onRemove={() => remove(i)}
        />,
      );
    return mine;
  });
  const sizes = about.annotations.flatMap((one, i) => {
    const size = sizeOf(of, i);
    const isWhole = one.faces !== undefined && one.faces.count === of.top.length;
    if (!size || isWhole) return [];
    return (
      <Row
        key={one.id}
        name={`${text(size.kind)}: ${one.tag}`}
        value={page.withUnit(Number(size.value.toPrecision(4)), size.unit)}
        onChoose={() => page.choose(i)}
      />
    );
  });
  return (
    <>
      <UnitChoice />
      <p>
        {text("sizeOf")}: {about.size.map(shortNumber).join(" × ")} {about.unit}
      </p>
      <section aria-labelledby="measure-list">
        <h2 id="measure-list">{page.word("measures")}</h2>
        {rows.length === 0 ? <p class="quiet">{text("noMeasures")}</p> : <table class="measures">{rows}</table>}
      </section>
      {sizes.length > 0 && (
        <section aria-labelledby="size-list">
          <h2 id="size-list">{text("partSizes")}</h2>
          <table class="measures">{sizes}</table>
        </section>
      )}
      {has("annotations") && about.annotations.length > 0 && (
        <label>
          <input
            type="checkbox"
            checked={page.allMeasures.value}
            onChange={(event) => (page.allMeasures.value = event.currentTarget.checked)}
          />{" "}
          {text("allMeasures")}
        </label>
      )}
    </>
  );
}
