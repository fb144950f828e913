// Tables and drawings made by the command. Clicking a row selects its annotation; the row of the selected annotation is highlighted.
import { useEffect, useMemo } from "preact/hooks";
import type { Blobs, Drawing, Table } from "./data";
import { openEntry } from "./content";
import { Plot } from "./plots";
import { choose, isRowChosen, marked, numberText, page, word } from "./state";

function TableView({ table }: { table: Table }) {
  /** Highlights a row, and shows its object or annotation. */
  const go = (r: number) => {
    const o = table.objects?.[r] ?? -1;
    if (o >= 0 && !page.collection) return choose(table.annotations?.[r] ?? -1, o);
    marked.value = { table: table.name, row: r };
    if (o >= 0) void openEntry(o);
  };
  return (
    <figure class="table">
      <figcaption>{table.title}</figcaption>
      <div class="scroll" tabIndex={0} role="region" aria-label={table.title}>
        <table>
          <thead>
            <tr>
              {table.columns.map((c, i) => (
                <th key={i} scope="col" class={c.numeric ? "number" : ""}>
                  {c.title}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {table.rows.map((row, r) => {
              const o = table.objects?.[r] ?? -1;
              const current = isRowChosen(table, r);
              return (
                <tr
                  key={r}
                  class={current ? "chosen" : o >= 0 ? "linked" : ""}
                  data-row={r}
                  onClick={() => (page.collection ? (marked.value = { table: table.name, row: r }) : go(r))}
                >
                  {row.map((cell, c) => {
                    const text = cell === null ? "–" : typeof cell === "number" ? numberText(cell) : cell;
                    return (
                      <td key={c} class={table.columns[c].numeric ? "number" : ""}>
                        {c === 0 && o >= 0 ? (
                          <button type="button" class="link" onClick={() => go(r)} aria-pressed={current}>
                            {text}
                          </button>
                        ) : (
                          text
                        )}
                      </td>
                    );
                  })}
                </tr>
              );
            })}
          </tbody>
        </table>
      </div>
      {table.note && <p class="quiet">{table.note}</p>}
      <Plot table={table} go={(r) => (page.collection ? (marked.value = { table: table.name, row: r }) : go(r))} />
    </figure>
  );
}

function DrawingView({ drawing, blobs }: { drawing: Drawing; blobs: Blobs }) {
  // As an image: scripts and links in an SVG are inactive.
  const address = useMemo(() => URL.createObjectURL(new Blob([blobs.get(drawing.blob) as BlobPart], { type: "image/svg+xml" })), [drawing]);
  useEffect(() => () => URL.revokeObjectURL(address), [address]);
  return (
    <figure class="drawing">
      <img src={address} alt={drawing.title} />
      <figcaption>{drawing.title}</figcaption>
    </figure>
  );
}

export function Tables({ blobs }: { blobs: Blobs }) {
  return (
    <>
      {page.tables.length > 0 && (
        <section aria-labelledby="tables-title">
          <h2 id="tables-title">{word("tables")}</h2>
          {page.tables.map((t) => (
            <TableView key={t.name} table={t} />
          ))}
        </section>
      )}
      {page.drawings.length > 0 && (
        <section aria-labelledby="drawings-title" class="drawings">
          <h2 id="drawings-title">{word("drawings")}</h2>
          {page.drawings.map((d, i) => (
            <DrawingView key={i} drawing={d} blobs={blobs} />
          ))}
        </section>
      )}
    </>
  );
}
