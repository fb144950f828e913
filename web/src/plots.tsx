// Scatter plot of two table columns: one point per row, highlighted together with its row.
import { useState } from "preact/hooks";
import type { Table } from "./data";
import { isRowChosen, numberText, word } from "./state";

const width = 460;
const high = 300;
const edge = { left: 64, right: 14, top: 12, bottom: 44 };

/** Range of an axis. */
export const range = (values: number[]): [number, number] => {
  const low = Math.min(...values);
  const top = Math.max(...values);
  return low < top ? [low, top] : [low - 0.5, top + 0.5];
};

/** Numeric columns that are not constant. */
export function numericColumns(table: Table): number[] {
  return table.columns
    .map((_, c) => c)
    .filter((c) => table.columns[c].numeric && new Set(table.rows.map((row) => row[c]).filter((x) => x !== null)).size > 1);
}

export function nameOfRow(table: Table, row: number): string {
  const text = table.rows[row].find((cell) => typeof cell === "string");
  return text === undefined ? String(row + 1) : String(text);
}

export function Plot({ table, go }: { table: Table; go: (row: number) => void }) {
  const numeric = numericColumns(table);
  const [columns, setColumns] = useState<[number, number]>([numeric[0], numeric[1]]);
  if (numeric.length < 2 || table.rows.length < 3) return null;
  const [cx, cy] = columns;
  const list = table.rows
    .map((row, r) => ({ r, x: row[cx], y: row[cy] }))
    .filter((one): one is { r: number; x: number; y: number } => typeof one.x === "number" && typeof one.y === "number");
  const [left, right] = list.length > 0 ? range(list.map((one) => one.x)) : [0, 1];
  const [low, top] = list.length > 0 ? range(list.map((one) => one.y)) : [0, 1];
  const x = (value: number) => edge.left + ((value - left) / (right - left)) * (width - edge.left - edge.right);
  const y = (value: number) => high - edge.bottom - ((value - low) / (top - low)) * (high - edge.top - edge.bottom);
  const step = (event: KeyboardEvent) => {
    const by = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!by || list.length === 0) return;
    event.preventDefault();
    const order = [...list].sort((a, b) => a.x - b.x || a.r - b.r);
    const at = order.findIndex((one) => isRowChosen(table, one.r));
    go(order[(at + by + order.length) % order.length].r);
  };
  const choice = (label: string, value: number, set: (column: number) => void) => (
    <label>
      {label}{" "}
      <select value={String(value)} onChange={(event) => set(+event.currentTarget.value)}>
        {numeric.map((c) => (
          <option key={c} value={c}>
            {table.columns[c].title}
          </option>
        ))}
      </select>
    </label>
  );
  const current = list.find((one) => isRowChosen(table, one.r));
  return (
    <details class="scatter">
      <summary>{word("plot")}</summary>
      <div class="buttons">
        {choice(word("across"), cx, (c) => setColumns([c, cy]))}
        {choice(word("upward"), cy, (c) => setColumns([cx, c]))}
      </div>
      <div tabIndex={0} role="group" aria-label={word("plotKeys", table.title)} onKeyDown={step}>
        <svg class="plot" width={width} height={high} role="img" aria-label={`${table.columns[cy].title} – ${table.columns[cx].title}`}>
          <path class="axis" d={`M${edge.left} ${edge.top}V${high - edge.bottom}H${width - edge.right}`} />
          {[left, right].map((value, i) => (
            <text key={i} x={x(value)} y={high - edge.bottom + 16} text-anchor={i === 0 ? "start" : "end"}>
              {numberText(value)}
            </text>
          ))}
          {[low, top].map((value, i) => (
            <text key={i} x={edge.left - 6} y={y(value) + 4} text-anchor="end">
              {numberText(value)}
            </text>
          ))}
          <text x={(edge.left + width - edge.right) / 2} y={high - 8} text-anchor="middle">
            {table.columns[cx].title}
          </text>
          <text transform={`translate(14 ${(high - edge.bottom) / 2}) rotate(-90)`} text-anchor="middle">
            {table.columns[cy].title}
          </text>
          {list.map((one) => (
            <circle key={one.r} class="point" data-row={one.r} cx={x(one.x)} cy={y(one.y)} r={4.5} onClick={() => go(one.r)}>
              <title>{nameOfRow(table, one.r)}</title>
            </circle>
          ))}
          {current && <circle class="point chosen" cx={x(current.x)} cy={y(current.y)} r={7} />}
        </svg>
      </div>
      <p class="quiet" aria-live="polite">
        {current ? `${nameOfRow(table, current.r)}: ${numberText(current.x)}, ${numberText(current.y)}` : word("plotNothing")}
      </p>
    </details>
  );
}
