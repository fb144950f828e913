// Slices of the displayed object: a height slider, the contour in 3D and in its plane, and a descriptor over the height.
import { signal } from "@preact/signals";
import type { Slice, Slices as Data } from "./data";
import { drawn } from "./picture";
import { range } from "./plots";
import { level, numberText, object, page, withUnit, word } from "./state";

const column = signal(0);
const width = 300;
const high = 260;
const edge = { left: 58, right: 10, top: 8, bottom: 40 };

function Plot({ slices }: { slices: Data }) {
  const { levels, columns, unit } = slices;
  const shown = columns[column.value] ?? columns[0];
  if (!shown) return null;
  const of = columns.indexOf(shown);
  const known = levels.map((one, i) => ({ i, height: one.height, value: one.values[of] })).filter((one) => one.value !== null);
  const [low, top] = range(levels.map((one) => one.height));
  const [from, to] = known.length > 0 ? range(known.map((one) => one.value!)) : [0, 1];
  const x = (value: number) => edge.left + ((value - from) / (to - from)) * (width - edge.left - edge.right);
  const y = (value: number) => high - edge.bottom - ((value - low) / (top - low)) * (high - edge.top - edge.bottom);
  const choose = (event: PointerEvent) => {
    if (event.type === "pointermove" && event.buttons === 0) return;
    const box = (event.currentTarget as Element).getBoundingClientRect();
    const at = event.clientY - box.top;
    let best = 0;
    levels.forEach((one, i) => {
      if (Math.abs(y(one.height) - at) < Math.abs(y(levels[best].height) - at)) best = i;
    });
    level.value = best;
  };
  const current = known.find((one) => one.i === level.value);
  const label = `${shown.title}${shown.unit ? ` (${shown.unit})` : ""}`;
  return (
    <svg
      class="plot"
      width={width}
      height={high}
      role="img"
      aria-label={`${label} – ${word("height")}`}
      onPointerDown={choose}
      onPointerMove={choose}
    >
      {slices.tube && (
        <rect
          class="tube"
          x={edge.left}
          y={y(slices.tube[1])}
          width={width - edge.left - edge.right}
          height={Math.max(1, y(slices.tube[0]) - y(slices.tube[1]))}
        >
          <title>{word("tube")}</title>
        </rect>
      )}
      <path class="axis" d={`M${edge.left} ${edge.top}V${high - edge.bottom}H${width - edge.right}`} />
      {[low, (low + top) / 2, top].map((value) => (
        <text key={value} x={edge.left - 6} y={y(value) + 4} text-anchor="end">
          {numberText(value)}
        </text>
      ))}
      {[from, to].map((value, i) => (
        <text key={i} x={x(value)} y={high - edge.bottom + 16} text-anchor={i === 0 ? "start" : "end"}>
          {numberText(value)}
        </text>
      ))}
      <text x={(edge.left + width - edge.right) / 2} y={high - 6} text-anchor="middle">
        {label}
      </text>
      <text transform={`translate(12 ${high / 2 - 16}) rotate(-90)`} text-anchor="middle">
        {word("height")}
        {unit && ` (${unit})`}
      </text>
      <polyline class="curve" points={known.map((one) => `${x(one.value!)},${y(one.height)}`).join(" ")} />
      {level.value >= 0 && <path class="here" d={`M${edge.left} ${y(levels[level.value].height)}H${width - edge.right}`} />}
      {current && <circle class="here" cx={x(current.value!)} cy={y(current.height)} r={4} />}
    </svg>
  );
}

/** All contours of a level as one path, v upwards. */
function pathOf(slice: Slice, points: Float32Array, begin: number, filled: boolean): string {
  let text = "";
  let first = begin;
  for (const contour of slice.contours) {
    if (contour.closed === filled)
      for (let i = 0; i < contour.points; ++i) text += `${i === 0 ? "M" : "L"}${points[2 * (first + i)]} ${-points[2 * (first + i) + 1]}`;
    if (contour.closed && filled) text += "Z";
    first += contour.points;
  }
  return text;
}

function Outline({ slices }: { slices: Data }) {
  const of = drawn[object.value];
  const slice = slices.levels[level.value];
  if (!of || !slice) return null;
  const points = of.slicePoints();
  let [left, right, low, top] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let i = 0; i < points.length; i += 2) {
    left = Math.min(left, points[i]);
    right = Math.max(right, points[i]);
    low = Math.min(low, -points[i + 1]);
    top = Math.max(top, -points[i + 1]);
  }
  const size = Math.max(right - left, top - low) || 1;
  const margin = 0.06 * size;
  const power = 10 ** Math.floor(Math.log10(size / 2));
  const bar = [5, 2, 1].map((k) => k * power).find((x) => x <= size / 2) ?? power;
  const begin = of.firstPoint(level.value);
  const foot = top + 2 * margin;
  return (
    <svg
      class="plot"
      width={high}
      height={high}
      role="img"
      aria-label={word("contourAt", withUnit(slice.height, slices.unit))}
      viewBox={`${left - margin} ${low - margin} ${right - left + 2 * margin} ${top - low + 6 * margin}`}
    >
      <path class="cut" d={pathOf(slice, points, begin, true)} stroke-width={size / 150} />
      <path class="open" d={pathOf(slice, points, begin, false)} stroke-width={size / 150} />
      <path class="axis" d={`M${left} ${foot}h${bar}`} stroke-width={size / 90} />
      <text x={left} y={foot + 1.9 * margin} font-size={size / 17}>
        {withUnit(bar, slices.unit)}
      </text>
    </svg>
  );
}

export function Slices() {
  const { slices } = page.objects[object.value];
  if (!slices || slices.levels.length === 0) return null;
  const at = slices.levels[level.value];
  const text = at ? withUnit(at.height, slices.unit) : word("none");
  return (
    <section aria-labelledby="slices-title">
      <h2 id="slices-title">{word("slices")}</h2>
      <div class="buttons">
        <label class="slider">
          {word("height")}{" "}
          <input
            id="slice-level"
            type="range"
            min={-1}
            max={slices.levels.length - 1}
            step={1}
            value={level.value}
            aria-valuetext={text}
            onInput={(event) => (level.value = +event.currentTarget.value)}
          />
          <output for="slice-level">{text}</output>
        </label>
        <label>
          {word("descriptor")}{" "}
          <select value={String(column.value)} onChange={(event) => (column.value = +event.currentTarget.value)}>
            {slices.columns.map((one, i) => (
              <option key={one.name} value={i}>
                {one.title}
              </option>
            ))}
          </select>
        </label>
      </div>
      <div class="side">
        <Plot slices={slices} />
        {at && <Outline slices={slices} />}
        {at && (
          <dl class="values">
            {slices.columns.map((one, i) => (
              <div key={one.name}>
                <dt>{one.title}</dt>
                <dd>{at.values[i] === null ? "–" : withUnit(at.values[i]!, one.unit)}</dd>
              </div>
            ))}
          </dl>
        )}
      </div>
    </section>
  );
}
