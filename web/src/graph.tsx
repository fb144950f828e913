// A drawing of relationships: annotations as a containment tree, and one bracket for each other relationship.
import { useState } from "preact/hooks";
import { choose, chosen, object, page, word } from "./state";

const row = 22;
const lane = 13;
const colours = ["#4477aa", "#ee6677", "#228833", "#aa8800", "#3c9fc0", "#aa3377", "#7a7a7a"];

export function Graph() {
  const { annotations, relations } = page.objects[object.value];
  const types = [...new Set(relations.map((one) => one.type))].filter((type) => type !== "containment").sort();
  const [off, setOff] = useState<ReadonlySet<string>>(new Set());
  if (types.length === 0) return null;
  const { tree: rows } = page.objects[object.value];
  /** Row of the annotation that contains the one of row i. */
  const above = (i: number) => rows.findIndex((one) => one.annotation === annotations[rows[i].annotation].parent);
  const placeOf = new Map(rows.map((one, i) => [one.annotation, i]));
  const list = relations
    .filter((one) => one.lane !== undefined && !off.has(one.type))
    .map((relation) => {
      const places = relation.members.map((m) => placeOf.get(m)!).sort((a, b) => a - b);
      return { relation, low: places[0], high: places[places.length - 1] };
    });
  const lanes = list.map((one) => one.relation.lane!);
  const names = Math.max(...rows.map((one) => 16 * one.depth + 7.2 * (annotations[one.annotation].tag || "#0").length)) + 30;
  const width = names + lane * (Math.max(0, ...lanes) + 2);
  const toggle = (type: string) => {
    const next = new Set(off);
    if (!next.delete(type)) next.add(type);
    setOff(next);
  };
  return (
    <section aria-labelledby="graph-title">
      <h2 id="graph-title">{word("relations")}</h2>
      <div class="buttons">
        {types.map((type, i) => (
          <label key={type}>
            <input type="checkbox" checked={!off.has(type)} onChange={() => toggle(type)} />{" "}
            <span class="swatch line" style={{ "--colour": colours[i % colours.length] }} aria-hidden="true" /> {type} (
            {relations.filter((one) => one.type === type).length})
          </label>
        ))}
      </div>
      <div class="scroll" tabIndex={0} role="region" aria-label={word("relations")}>
        {/* The list of the selected annotation's relationships gives the same information as text. */}
        <svg class="graph" width={width} height={rows.length * row + 8} aria-hidden="true">
          {list.map(({ relation, low, high }, i) => {
            const x = names + lane * (lanes[i] + 0.5);
            const colour = colours[types.indexOf(relation.type) % colours.length];
            const active = relation.members.includes(chosen.value);
            return (
              <g
                key={i}
                stroke={colour}
                stroke-width={(relation.constraint ? 3 : 1.4) + (active ? 1.4 : 0)}
                stroke-dasharray={relation.holds === false ? "4 3" : undefined}
                opacity={chosen.value < 0 || active ? 1 : 0.3}
                fill="none"
              >
                <title>{`${relation.type}: ${relation.members.map((m) => annotations[m].tag).join(", ")}`}</title>
                <path d={`M${x} ${low * row + row / 2}V${high * row + row / 2}`} />
                {relation.members.map((m) => (
                  <path key={m} d={`M${x - lane / 2} ${placeOf.get(m)! * row + row / 2}h${lane / 2}`} />
                ))}
              </g>
            );
          })}
          {rows.map(({ annotation, depth }, i) => (
            <g key={annotation} onClick={() => choose(annotation)} class={chosen.value === annotation ? "node chosen" : "node"}>
              <rect x={0} y={i * row} width={names - 8} height={row} class="back" />
              {depth > 0 && <path class="branch" d={`M${16 * depth - 8} ${above(i) * row + 18}V${i * row + row / 2}h8`} />}
              <rect x={16 * depth + 2} y={i * row + 6} width={11} height={11} fill={`rgb(${annotations[annotation].colour.join(",")})`} />
              <text x={16 * depth + 18} y={i * row + 16}>
                {annotations[annotation].tag || `#${annotations[annotation].id}`}
              </text>
            </g>
          ))}
        </svg>
      </div>
    </section>
  );
}
