// The lamp over the picture, dragged by hand, and the strength of the relief.
import * as state from "./state";
import { word } from "./state";

const size = 44;
const reach = 18;

/** A direction of the lamp as a place in the disc: at the middle it shines from the reader's eye, at the rim along the surface. */
function within(x: number, y: number): [number, number] {
  const length = Math.hypot(x, y);
  const most = 0.985;
  return length > most ? [(x * most) / length, (y * most) / length] : [x, y];
}

export function Light() {
  const [x, y] = state.lamp.value;
  const set = (to: [number, number]) => (state.lamp.value = within(...to));
  const step = 0.08;
  const keys: Record<string, [number, number]> = {
    ArrowLeft: [x - step, y],
    ArrowRight: [x + step, y],
    ArrowUp: [x, y + step],
    ArrowDown: [x, y - step],
    Home: state.firstLamp,
  };
  const drag = (event: PointerEvent & { currentTarget: HTMLElement }) => {
    const box = event.currentTarget.getBoundingClientRect();
    set([(event.clientX - box.left - box.width / 2) / reach, -(event.clientY - box.top - box.height / 2) / reach]);
  };
  return (
    <span class="light" role="group" aria-label={word("lighting")}>
      <div
        class="lamp"
        role="slider"
        tabIndex={0}
        title={word("lampHelp")}
        aria-label={word("lamp")}
        aria-valuemin={0}
        aria-valuemax={90}
        aria-valuenow={Math.round((Math.asin(Math.hypot(x, y)) * 180) / Math.PI)}
        aria-valuetext={`${Math.round((Math.atan2(x, y) * 180) / Math.PI)}°, ${Math.round((Math.acos(Math.hypot(x, y)) * 180) / Math.PI)}°`}
        onKeyDown={(event) => {
          if (!keys[event.key]) return;
          event.preventDefault();
          set(keys[event.key]);
        }}
        onPointerDown={(event) => {
          event.currentTarget.setPointerCapture(event.pointerId);
          drag(event);
        }}
        onPointerMove={(event) => {
          if (event.currentTarget.hasPointerCapture(event.pointerId)) drag(event);
        }}
        onDblClick={() => set(state.firstLamp)}
      >
        <svg viewBox={`0 0 ${size} ${size}`} aria-hidden="true">
          <circle class="disc" cx={size / 2} cy={size / 2} r={reach + 2} />
          <circle class="spot" cx={size / 2 + reach * x} cy={size / 2 - reach * y} r={5} />
        </svg>
      </div>
      <label class="slider">
        {word("relief")}{" "}
        <input
          type="range"
          min={0}
          max={1}
          step={0.05}
          value={state.relief.value}
          onInput={(event) => (state.relief.value = +event.currentTarget.value)}
        />
      </label>
    </span>
  );
}
