// The axes of the view: which way is up, and six views by a click.
import * as THREE from "three";
import { view } from "../picture";
import * as page from "../state";
import { sixViews } from "../view";

const size = 84;
const reach = 30;

/** Direction of each view towards the reader, in the frame in which z points up. */
const towards: Record<string, [number, number, number]> = {
  front: [0, -1, 0],
  right: [1, 0, 0],
  back: [0, 1, 0],
  left: [-1, 0, 0],
  top: [0, 0, 1],
  bottom: [0, 0, -1],
};

/** The ends of the axes that show a letter; the opposite ends are empty. */
const named = new Set(["front", "right", "top"]);

export function Gizmo() {
  void page.moves.value;
  if (!view) return null;
  const turn = view.camera.quaternion.clone().invert();
  const ends = sixViews
    .map(([name, azimuth, elevation]) => {
      const at = new THREE.Vector3(...towards[name]).applyQuaternion(turn);
      return { name, azimuth, elevation, x: size / 2 + reach * at.x, y: size / 2 - reach * at.y, depth: at.z };
    })
    .sort((a, b) => a.depth - b.depth);
  return (
    <div class="gizmo" role="group" aria-label={page.word("view")}>
      <svg viewBox={`0 0 ${size} ${size}`} aria-hidden="true">
        {ends.map((one) => (
          <line key={one.name} x1={size / 2} y1={size / 2} x2={one.x} y2={one.y} class={one.name} />
        ))}
      </svg>
      {ends.map((one) => (
        <button
          key={one.name}
          type="button"
          class={one.name}
          title={page.word(one.name)}
          aria-label={page.word(one.name)}
          style={{ left: `${one.x}px`, top: `${one.y}px`, zIndex: 2 + Math.round(one.depth) }}
          onClick={() => view?.look(one.azimuth, one.elevation)}
        >
          {named.has(one.name) && page.word(one.name).slice(0, 1).toLocaleUpperCase()}
        </button>
      ))}
    </div>
  );
}
