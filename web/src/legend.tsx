// Annotations as a containment tree: to show, hide, isolate or select.
import { chosen, choose, hidden, isShown, labels, object, page, search, show, word } from "./state";

function below(annotation: number): number[] {
  const { annotations } = page.objects[object.value];
  const found = [annotation];
  for (let i = 0; i < found.length; ++i)
    annotations.forEach((one, k) => {
      if (one.parent === found[i]) found.push(k);
    });
  return found;
}

export function swatch(colour: [number, number, number], type: string) {
  return <span class={`swatch ${type}`} style={{ "--colour": `rgb(${colour.join(",")})` }} aria-hidden="true" />;
}

function Branch({ annotation, found }: { annotation: number; found: Set<number> }) {
  const { annotations } = page.objects[object.value];
  const one = annotations[annotation];
  const inner = annotations.map((_, i) => i).filter((i) => annotations[i].parent === annotation && found.has(i));
  const shown = isShown(object.value, annotation);
  return (
    <li>
      <div class={chosen.value === annotation ? "row chosen" : "row"}>
        <input
          type="checkbox"
          checked={shown}
          aria-label={`${word("show")}: ${one.tag}`}
          onChange={() => show(object.value, [annotation], !shown)}
        />
        <button
          type="button"
          class="plain"
          data-annotation={annotation}
          aria-pressed={chosen.value === annotation}
          onClick={() => choose(chosen.value === annotation ? -1 : annotation)}
        >
          {swatch(one.colour, one.type)}
          <span class="tag">{one.tag || `#${one.id}`}</span>
          <span class="kind">{word(one.type)}</span>
        </button>
      </div>
      {inner.length > 0 && (
        <ul>
          {inner.map((i) => (
            <Branch key={i} annotation={i} found={found} />
          ))}
        </ul>
      )}
    </li>
  );
}

export function Legend() {
  const { annotations } = page.objects[object.value];
  if (annotations.length === 0) return null;
  const text = search.value.trim().toLocaleLowerCase();
  const found = new Set<number>();
  annotations.forEach((one, i) => {
    if (!one.tag.toLocaleLowerCase().includes(text)) return;
    for (let k = i; k >= 0 && !found.has(k); k = annotations[k].parent) found.add(k);
  });
  const all = annotations.map((_, i) => i);
  const only = () => {
    const wanted = new Set(below(chosen.value));
    show(object.value, all, true);
    show(
      object.value,
      all.filter((i) => !wanted.has(i)),
      false,
    );
  };
  return (
    <section aria-labelledby="legend-title">
      <h2 id="legend-title">{word("annotations")}</h2>
      <input
        type="search"
        value={search.value}
        placeholder={word("search")}
        aria-label={word("search")}
        onInput={(event) => (search.value = event.currentTarget.value)}
      />
      <div class="buttons">
        <button type="button" disabled={hidden.value.size === 0} onClick={() => show(object.value, all, true)}>
          {word("showAll")}
        </button>
        <button type="button" onClick={() => show(object.value, all, false)}>
          {word("hideAll")}
        </button>
        <button type="button" disabled={chosen.value < 0} onClick={only}>
          {word("isolate")}
        </button>
        <label>
          <input type="checkbox" checked={labels.value} onChange={() => (labels.value = !labels.value)} /> {word("labels")}
        </label>
      </div>
      <ul class="tree">
        {all
          .filter((i) => annotations[i].parent < 0 && found.has(i))
          .map((i) => (
            <Branch key={i} annotation={i} found={found} />
          ))}
      </ul>
    </section>
  );
}
