// The choice of the colours of the surface: texture, own colours, annotations, clay, or a map.
import type { Colouring } from "./data";
import { drawn, isShaded } from "./picture";
import * as state from "./state";
import { page, word, type Word } from "./state";

const names: Record<Colouring, Word> = { texture: "texture", own: "ownColours", annotations: "byAnnotation", clay: "clay" };

export function ColouringChoice() {
  const about = page.objects[state.object.value];
  const of = drawn[state.object.value];
  if (!about || !of) return null;
  const list = of.colourings;
  const hasLook = list.includes("texture") || list.includes("own");
  if (about.maps.length === 0 && !hasLook) return null;
  const choose = (value: string) => {
    state.map.value = state.isColouring(value) ? -1 : +value;
    if (state.isColouring(value)) state.colouring.value = value;
  };
  return (
    <>
      <label>
        {word("map")}{" "}
        <select
          data-colours
          value={state.map.value >= 0 ? String(state.map.value) : of.colouring(state.colouring.value)}
          onChange={(event) => choose(event.currentTarget.value)}
        >
          {list.map((one) => (
            <option key={one} value={one}>
              {word(names[one])}
            </option>
          ))}
          {about.maps.map((map, i) => (
            <option key={i} value={String(i)}>
              {map.name}
            </option>
          ))}
        </select>
      </label>
      {hasLook && (
        <label>
          <input type="checkbox" checked={isShaded()} onChange={(event) => (state.shade.value = event.currentTarget.checked)} />{" "}
          {word("shade")}
        </label>
      )}
    </>
  );
}
