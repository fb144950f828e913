// Tables and drawings that the command made; a row of an annotation chooses it, and is marked where it is chosen.
import { useMemo } from "preact/hooks";
import type { Blobs, Drawing, Table } from "./data";
import { choose, chosen, numberText, object, page, word } from "./state";

function TableView({ table }: { table: Table }) {
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
              const a = table.annotations?.[r] ?? -1;
              const current = o >= 0 && o === object.value && (a < 0 ? !table.annotations : a === chosen.value);
              const go = () => choose(a, o);
              return (
                <tr key={r} class={current ? "chosen" : o >= 0 ? "linked" : ""} data-row={r} onClick={o >= 0 ? go : undefined}>
                  {row.map((cell, c) => {
                    const text = cell === null ? "–" : typeof cell === "number" ? numberText(cell) : cell;
                    return (
                      <td key={c} class={table.columns[c].numeric ? "number" : ""}>
                        {c === 0 && o >= 0 ? (
                          <button type="button" class="link" onClick={go} aria-pressed={current}>
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
    </figure>
  );
}

function DrawingView({ drawing, blobs }: { drawing: Drawing; blobs: Blobs }) {
  // As a picture: scripts and links within an SVG do nothing there.
  const address = useMemo(
    () => URL.createObjectURL(new Blob([blobs.get(drawing.blob) as BlobPart], { type: "image/svg+xml" })),
    [drawing],
  );
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
