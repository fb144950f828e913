// Tools: actions of the pointer on the view, and the overlay drawn meanwhile.
import { signal } from "@preact/signals";
import CameraControls from "camera-controls";
import { useEffect } from "preact/hooks";
import * as THREE from "three";
import type { DrawnObject } from "../geometry";
import { drawn, view } from "../picture";
import { angleSign } from "../sizes";
import * as page from "../state";
import { paneOf, recipeCamera, type RecipeCamera } from "./camera";
import * as deform from "./deform";
import { has, onShown, part, run } from "./model";
import * as selection from "./selection";
import { restingPlane } from "./stand";
import { text, type Key } from "./words";

export type Tool =
  | "look"
  | "base"
  | "rectangle"
  | "lasso"
  | "path"
  | "closed"
  | "brush"
  | "points"
  | "ruler"
  | "tape"
  | "angle"
  | "bounding"
  | "handles"
  | "move"
  | "rotate"
  | "scale"
  | "stretch";
export const tool = signal<Tool>("look");
export const radius = signal(0);

export const groups: [Key, Tool[]][] = [
  ["look", ["look", "base"]],
  ["select", ["rectangle", "lasso", "closed", "brush", "path", "points"]],
  ["measure", ["ruler", "tape", "angle", "bounding"]],
  ["deform", ["handles", "move", "rotate", "scale", "stretch"]],
];

interface Pick {
  vertex: number;
  point: THREE.Vector3;
  camera: RecipeCamera;
  pixel: [number, number];
}
/** The annotations at the last position clicked with the "look" tool. */
export const clicked = signal<{ x: number; y: number; list: number[] } | undefined>(undefined);

interface Place {
  x: number;
  y: number;
}

/** Direction of the surface around a place: the mean of the normals of faces nearby that face the same way as the picked one. */
function directionAround(of: DrawnObject, face: number, place: THREE.Vector3): THREE.Vector3 {
  const { triangles } = of.shape;
  const corner = (f: number, k: number) => of.vertex(triangles[3 * f + k]);
  const areaNormal = (f: number) => {
    const a = corner(f, 0);
    return corner(f, 1).sub(a).cross(corner(f, 2).sub(a));
  };
  const first = areaNormal(face).normalize();
  const radius = 0.06 * Math.hypot(...of.about.size);
  const sum = new THREE.Vector3();
  for (let f = 0; 3 * f < triangles.length; ++f) {
    if (corner(f, 0).distanceTo(place) > radius) continue;
    const one = areaNormal(f);
    if (one.dot(first) > 0.5 * one.length()) sum.add(one);
  }
  return (sum.lengthSq() > 0 ? sum : first).normalize();
}

/** Stands the object on the base under a position of the picture: on the plane it rests on, such as the ends of four legs. */
async function standOn(at: Place) {
  const hit = view?.pick(at.x, at.y);
  const of = hit && drawn[hit.object];
  if (!hit || !of) {
    page.message.value = text("baseMissed");
    return;
  }
  const outward = directionAround(of, hit.face, hit.point);
  choose("look");
  await setUp((restingPlane(of, outward) ?? outward).negate().toArray());
}

/** States which direction of the object is up, as a step of the session. */
export async function setUp(up: number[]) {
  const given = { mesh: part("mesh"), annotations: annotationsInput(), "set-up": up.map((x) => Number(x.toFixed(9))).join(",") };
  if (await run({ operation: "annotation edit", title: text("base"), with: given, keep: ["output"] })) view?.home();
}

/** States the unit of the object's coordinates, as a step of the session. */
export const setUnit = (unit: string) =>
  run({
    operation: "annotation edit",
    title: `${text("unit")}: ${unit}`,
    with: { mesh: part("mesh"), annotations: annotationsInput(), "set-unit": unit },
    keep: ["output"],
  });

/** The annotations of the active object; an empty set if it has none yet. */
const annotationsInput = () =>
  has("annotations") ? part("annotations") : { document: { format: "ostraka-annotations", version: 1, annotations: [] } };

/** Path of the pointer since it was pressed, and the surface points picked so far. */
const trail = signal<Place[]>([]);
const picks = signal<Pick[]>([]);
const over = signal<DrawnObject | undefined>(undefined);
/** The pointer over the picture while the brush is chosen. */
const brushAt = signal<Place | undefined>(undefined);

const drags: Tool[] = ["rectangle", "lasso", "brush", "move", "rotate", "scale", "stretch", "handles", "bounding"];
const deforms = (t: Tool) => ["handles", "move", "rotate", "scale", "stretch"].includes(t);

export function choose(next: Tool) {
  tool.value = next;
  trail.value = [];
  picks.value = [];
  page.message.value = "";
  page.clicks.value = next === "look";
  if (view) view.controls.mouseButtons.left = drags.includes(next) ? CameraControls.ACTION.NONE : CameraControls.ACTION.ROTATE;
  if (view) view.controls.touches.one = drags.includes(next) ? CameraControls.ACTION.NONE : CameraControls.ACTION.TOUCH_ROTATE;
  if (view) view.controls.mouseButtons.right = drags.includes(next) ? CameraControls.ACTION.ROTATE : CameraControls.ACTION.TRUCK;
}

function pickAt(place: Place): Pick | undefined {
  const hit = view?.pick(place.x, place.y);
  const of = hit && drawn[hit.object];
  if (!hit || !of) return undefined;
  over.value = of;
  return { vertex: hit.vertex, point: hit.point.clone(), camera: recipeCamera(of), pixel: paneOf(of, place.x, place.y) };
}

const asPick = (one: Pick) => ({ camera: one.camera, pixel: one.pixel });

/** Converts the picks to a selection or a measure. */
export async function finish() {
  const list = picks.value;
  const t = tool.value;
  picks.value = [];
  if (t === "path" && list.length >= 2) await selection.add({ path: { points: list.map(asPick) } });
  else if (t === "points" && list.length >= 1) await selection.add({ vertices: list.map(asPick) });
  else if (t === "closed" && list.length >= 4)
    await selection.add({ lasso: { points: list.slice(0, -1).map(asPick), seed: asPick(list[list.length - 1]) } });
  else if ((t === "ruler" || t === "tape") && list.length >= 2)
    await take(
      t,
      list.map((one) => one.vertex),
    );
  else if (t === "angle" && list.length === 3) await takeAngle(list.map((one) => one.vertex));
}

/** A name that no measure of the object has: the given one, with a number if it is taken. */
function freeName(wanted: string): string {
  const { annotations } = page.page.objects[page.object.value];
  const taken = new Set(annotations.flatMap((one) => [one.tag, ...one.measures.map((m) => m.name)]));
  let name = wanted;
  for (let i = 2; taken.has(name); ++i) name = `${wanted} ${i}`;
  return name;
}

/** Takes an angle: an annotation of three points, of which the second is the apex; its value is that of the shown shape. */
function takeAngle(vertices: number[]): Promise<boolean> {
  const tag = freeName(`${angleSign} ${measureName.value || text("angle").toLocaleLowerCase()}`);
  const given: Record<string, unknown> = {
    mesh: part("mesh"),
    expression: JSON.stringify({ vertices }),
    action: "make",
    tag,
    type: "point",
    colour: [160, 0, 60],
  };
  const keep = ["output"];
  if (has("annotations")) given.annotations = part("annotations");
  if (!has("annotations") || has("recipe")) {
    keep.push("recipe");
    if (has("recipe")) given.record = part("recipe");
  }
  return run({ operation: "annotation select", title: text("measured", text("angle")), with: given, keep });
}

/** Takes a measure of the selected annotation or of the object. */
export function take(which: "ruler" | "tape" | "bounding", vertices: number[], direction?: string): Promise<boolean> {
  const chosen = page.page.objects[page.object.value]?.annotations[page.chosen.value];
  const given: Record<string, unknown> = { mesh: part("mesh"), tool: which, name: freeName(measureName.value || which) };
  if (has("annotations")) given.annotations = part("annotations");
  if (vertices.length > 0) given.points = vertices;
  if (direction) given.direction = direction;
  if (chosen) given.annotation = String(chosen.id);
  return run({ operation: "measure take", title: text("measured", text(which)), with: given, keep: ["output"] });
}
export const measureName = signal("");

function rectangleOf(of: DrawnObject, a: Place, b: Place) {
  return {
    rectangle: { camera: recipeCamera(of), from: paneOf(of, a.x, a.y), to: paneOf(of, b.x, b.y), visible: selection.visible.value },
  };
}

/** Simplifies a path to few corners, with deviations of at most 1.5 pixels. */
function simplified(way: Place[]): Place[] {
  const kept = new Array<boolean>(way.length).fill(false);
  const stack: [number, number][] = [[0, way.length - 1]];
  kept[0] = kept[way.length - 1] = true;
  while (stack.length > 0) {
    const [a, b] = stack.pop()!;
    let worst = 1.5;
    let at = -1;
    const [dx, dy] = [way[b].x - way[a].x, way[b].y - way[a].y];
    const length = Math.hypot(dx, dy) || 1;
    for (let i = a + 1; i < b; ++i) {
      const off = Math.abs((way[i].x - way[a].x) * dy - (way[i].y - way[a].y) * dx) / length;
      if (off > worst) [worst, at] = [off, i];
    }
    if (at < 0) continue;
    kept[at] = true;
    stack.push([a, at], [at, b]);
  }
  return way.filter((_, i) => kept[i]);
}

async function drawnBy(t: Tool, way: Place[]) {
  const of = selection.target();
  const [a, b] = [way[0], way[way.length - 1]];
  const far = Math.hypot(b.x - a.x, b.y - a.y);
  if (!of) return;
  if (t === "rectangle" && far > 2) await selection.add(rectangleOf(of, a, b));
  if (t === "lasso" && way.length > 3) {
    const points = simplified(way).map((one) => paneOf(of, one.x, one.y));
    if (points.length >= 3) await selection.add({ polygon: { camera: recipeCamera(of), points, visible: selection.visible.value } });
  }
  if (t === "brush") {
    const camera = recipeCamera(of);
    const points = way
      .filter((_, i) => i === 0 || i === way.length - 1 || i % 3 === 0)
      .filter((one) => view?.pick(one.x, one.y))
      .map((one) => ({ camera, pixel: paneOf(of, one.x, one.y) }));
    if (points.length > 0) await selection.add({ brush: { points, radius: radius.value || brushRadius(of), stroke: points.length > 1 } });
  }
  if (t === "bounding" && far > 2) {
    const inverse = of.group.matrixWorld.clone().invert();
    const right = new THREE.Vector3(1, 0, 0).transformDirection(view!.camera.matrixWorld);
    const up = new THREE.Vector3(0, 1, 0).transformDirection(view!.camera.matrixWorld);
    const along = right
      .multiplyScalar(b.x - a.x)
      .addScaledVector(up, a.y - b.y)
      .transformDirection(inverse);
    await take(
      "bounding",
      [],
      along
        .toArray()
        .map((x) => Number(x.toFixed(6)))
        .join(","),
    );
  }
}

export const brushRadius = (of: DrawnObject) => Number((0.02 * Math.hypot(...of.about.size)).toPrecision(3));

/** Passes pointer and key events of the view to the tool; returns whether it uses them. */
export function attach(canvas: HTMLCanvasElement): () => void {
  let down: Place | undefined;
  let pressed: Place = { x: 0, y: 0 };
  let moved = false;
  const at = (event: PointerEvent): Place => {
    const box = canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  const onClick = (event: MouseEvent) => {
    const box = canvas.getBoundingClientRect();
    const place = { x: event.clientX - box.left, y: event.clientY - box.top };
    if (Math.hypot(place.x - pressed.x, place.y - pressed.y) > 4) return;
    const hit = tool.value === "look" ? view?.pick(place.x, place.y) : undefined;
    const list =
      hit && hit.object === page.object.value ? drawn[hit.object].annotationsOn(hit.face).filter((i) => page.isShown(hit.object, i)) : [];
    clicked.value = list.length > 1 ? { ...place, list } : undefined;
  };
  const onDown = (event: PointerEvent) => {
    clicked.value = undefined;
    pressed = at(event);
    if (event.button !== 0 || tool.value === "look") return;
    down = at(event);
    moved = false;
    if (drags.includes(tool.value)) {
      trail.value = [down];
      canvas.setPointerCapture(event.pointerId);
      if (deforms(tool.value) && tool.value !== "handles") void deform.grab(tool.value as deform.Motion, down);
    }
  };
  const onMove = (event: PointerEvent) => {
    const place = at(event);
    brushAt.value = tool.value === "brush" ? place : undefined;
    if (!down) return;
    moved = moved || Math.hypot(place.x - down.x, place.y - down.y) > 3;
    if (trail.value.length === 0) return;
    const last = trail.value[trail.value.length - 1];
    if (Math.hypot(place.x - last.x, place.y - last.y) < 2) return;
    trail.value = [...trail.value, place];
    if (deforms(tool.value) && tool.value !== "handles") deform.drag(place);
  };
  const onLeave = () => (brushAt.value = undefined);
  const onUp = (event: PointerEvent) => {
    if (!down) return;
    const [start, end, t] = [down, at(event), tool.value];
    const way = trail.value;
    down = undefined;
    trail.value = [];
    if (t === "handles") {
      deform.pick(start, end, selection.erases.value, selection.visible.value);
    } else if (deforms(t)) {
      void deform.release(end);
    } else if (drags.includes(t)) {
      void drawnBy(t, way.length > 1 ? [...way, end] : [start]);
    } else if (t === "base") {
      if (!moved) void standOn(start);
    } else if (!moved) {
      const one = pickAt(start);
      if (!one) return;
      picks.value = [...picks.value, one];
      if (picks.value.length === (t === "ruler" ? 2 : t === "angle" ? 3 : 0)) void finish();
    }
  };
  const onKey = (event: KeyboardEvent) => {
    if (event.key === "Enter" && picks.value.length > 0) {
      event.preventDefault();
      void finish();
    } else if (event.key === "Escape") {
      if (picks.value.length > 0) picks.value = [];
      else selection.clear();
      clicked.value = undefined;
      deform.letGo();
    }
  };
  const onDouble = () => {
    // The second click of a double click has added a pick already.
    if (["path", "tape", "points"].includes(tool.value)) void finish();
  };
  canvas.addEventListener("click", onClick);
  canvas.addEventListener("pointerdown", onDown);
  canvas.addEventListener("pointermove", onMove);
  canvas.addEventListener("pointerup", onUp);
  canvas.addEventListener("pointerleave", onLeave);
  canvas.addEventListener("keydown", onKey);
  canvas.addEventListener("dblclick", onDouble);
  choose(tool.value);
  return () => {
    canvas.removeEventListener("click", onClick);
    canvas.removeEventListener("pointerdown", onDown);
    canvas.removeEventListener("pointermove", onMove);
    canvas.removeEventListener("pointerup", onUp);
    canvas.removeEventListener("pointerleave", onLeave);
    canvas.removeEventListener("keydown", onKey);
    canvas.removeEventListener("dblclick", onDouble);
  };
}

onShown.push(() => {
  picks.value = [];
});

/** The overlay of the current tool. */
export function Drawing() {
  useEffect(() => {
    if (!view) return;
    return attach(view.canvas);
  }, [view]);
  void page.moves.value;
  const way = trail.value;
  const t = tool.value;
  const [a, b] = [way[0], way[way.length - 1]];
  const of = over.value;
  const brush = brushAt.value;
  const brushed = drawn[page.object.value];
  const points = of ? picks.value.map((one) => view!.place(of, one.point)).filter((one) => one !== undefined) : [];
  return (
    <svg class="drawing-now" aria-hidden="true">
      {(t === "rectangle" || t === "handles") && way.length > 1 && (
        <rect x={Math.min(a.x, b.x)} y={Math.min(a.y, b.y)} width={Math.abs(a.x - b.x)} height={Math.abs(a.y - b.y)} />
      )}
      {(t === "lasso" || t === "brush") && way.length > 1 && (
        <path class={t} d={`M${way.map((one) => `${one.x} ${one.y}`).join("L")}${t === "lasso" ? "Z" : ""}`} />
      )}
      {brush && brushed && (
        <circle class="brush-size" cx={brush.x} cy={brush.y} r={(radius.value || brushRadius(brushed)) * view!.pixelsPerUnit(brushed)} />
      )}
      {t === "bounding" && way.length > 1 && <path d={`M${a.x} ${a.y}L${b.x} ${b.y}`} />}
      {points.length > 1 && <path class="picks" d={`M${points.map((one) => `${one.x} ${one.y}`).join("L")}`} />}
      {points.map((one, i) => (
        <circle key={i} cx={one.x} cy={one.y} r={4} />
      ))}
      {deform.reading.value && (
        <text class="reading" x={deform.reading.value.x + 16} y={deform.reading.value.y - 10}>
          {deform.reading.value.text}
        </text>
      )}
    </svg>
  );
}

export const picked = picks;
