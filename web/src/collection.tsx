// The index of a collection: one card per object, searchable by name, tag and number; an object is read when it is selected.
import { signal } from "@preact/signals";
import { useMemo } from "preact/hooks";
import { openEntry } from "./content";
import { numericColumns } from "./plots";
import { index, message, numberText, word } from "./state";

const text = signal("");
const tag = signal("");
const by = signal("");
const from = signal("");
const to = signal("");

/** Numeric columns of the tables: for each column name, the number of each object. */
function quantities(): Map<string, Map<number, number>> {
  const found = new Map<string, Map<number, number>>();
  for (const table of index!.data.tables) {
    if (!table.objects) continue;
    for (const c of numericColumns(table)) {
      const values = new Map<number, number>();
      table.rows.forEach((row, r) => {
        const o = table.objects![r];
        if (o >= 0 && typeof row[c] === "number") values.set(o, row[c]);
      });
      if (values.size > 0) found.set(`${table.title}: ${table.columns[c].title}`, values);
    }
  }
  return found;
}

export function Index() {
  const entries = index!.data.collection!;
  const numbers = useMemo(quantities, []);
  const tags = useMemo(() => {
    const count = new Map<string, number>();
    for (const one of entries) for (const t of one.tags) count.set(t, (count.get(t) ?? 0) + 1);
    return [...count].sort((a, b) => b[1] - a[1] || (a[0] < b[0] ? -1 : 1)).slice(0, 500);
  }, []);
  const wanted = text.value.trim().toLocaleLowerCase();
  const values = numbers.get(by.value);
  const [low, high] = [from.value, to.value].map((x) => (x === "" ? NaN : +x));
  const isShown = (i: number) => {
    const one = entries[i];
    if (tag.value && !one.tags.includes(tag.value)) return false;
    if (wanted && !one.name.toLocaleLowerCase().includes(wanted) && !one.tags.some((t) => t.toLocaleLowerCase().includes(wanted)))
      return false;
    if (!values || (Number.isNaN(low) && Number.isNaN(high))) return true;
    const value = values.get(i);
    return value !== undefined && !(value < low) && !(value > high);
  };
  const shown = entries.map((_, i) => isShown(i));
  const order = entries.map((_, i) => i);
  if (values) order.sort((a, b) => (values.get(a) ?? Infinity) - (values.get(b) ?? Infinity) || a - b);
  return (
    <section aria-labelledby="index-title">
      <h2 id="index-title">
        {word("objects")}{" "}
        <span class="quiet" role="status">
          {word("ofAll", numberText(shown.filter(Boolean).length), numberText(entries.length))} {message.value}
        </span>
      </h2>
      <div class="buttons">
        <label>
          {word("searchObjects")}{" "}
          <input type="search" class="narrow" value={text.value} onInput={(event) => (text.value = event.currentTarget.value)} />
        </label>
        {tags.length > 0 && (
          <label>
            {word("withTag")}{" "}
            <select value={tag.value} onChange={(event) => (tag.value = event.currentTarget.value)}>
              <option value="">{word("any")}</option>
              {tags.map(([name, count]) => (
                <option key={name} value={name}>
                  {name} ({count})
                </option>
              ))}
            </select>
          </label>
        )}
        {numbers.size > 0 && (
          <>
            <label>
              {word("orderBy")}{" "}
              <select value={by.value} onChange={(event) => (by.value = event.currentTarget.value)}>
                <option value="">{word("name")}</option>
                {[...numbers.keys()].map((name) => (
                  <option key={name} value={name}>
                    {name}
                  </option>
                ))}
              </select>
            </label>
            {values && (
              <>
                <label>
                  {word("atLeast")}{" "}
                  <input
                    type="number"
                    step="any"
                    class="narrow"
                    value={from.value}
                    onInput={(event) => (from.value = event.currentTarget.value)}
                  />
                </label>
                <label>
                  {word("upTo")}{" "}
                  <input
                    type="number"
                    step="any"
                    class="narrow"
                    value={to.value}
                    onInput={(event) => (to.value = event.currentTarget.value)}
                  />
                </label>
              </>
            )}
          </>
        )}
      </div>
      <ul class="cards">
        {order.map((i) => (
          <li key={i} hidden={!shown[i]}>
            <button type="button" class="card" data-entry={i} onClick={() => void openEntry(i)}>
              <img src={entries[i].thumbnail} alt="" loading="lazy" width={160} height={120} />
              <span class="tag">{entries[i].name}</span>
              <span class="quiet">
                {values?.has(i) ? numberText(values.get(i)!) : `${numberText(entries[i].vertices)} ${word("vertices")}`}
              </span>
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}
