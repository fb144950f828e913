// Control points of the cage: selecting, dragging, and releasing. While they follow one affine map, the view is updated locally; with
// constraints, the command computes the shape.
import { signal } from "@preact/signals";
import * as THREE from "three";
import { flatMaterial, shared, type DrawnObject } from "../geometry";
import { drawn, view } from "../picture";
import * as page from "../state";
import { numbersIn } from "./link";
import { attempt, has, link, object, onShown, part, run } from "./model";
import { text } from "./words";

export type Motion = "move" | "rotate" | "scale" | "stretch";
export const handles = signal<ReadonlySet<number>>(new Set());
export const keepsConstraints = signal(true);
/** Spaces in which the command solves for constraints after release. */
export const spaces = ["auto", "mesh", "cage"] as const;
export const space = signal<(typeof spaces)[number]>("auto");
/** Descriptions of the constraints that the cage cannot satisfy, and the number of all constraints. */
export const reach = signal<{ constraints: number; texts: string[] } | undefined>(undefined);
export const showsPoints = signal(true);
/** What the drag does in numbers, beside the pointer. */
export const reading = signal<{ x: number; y: number; text: string } | undefined>(undefined);
export const latency = signal<number[]>([]);

/** The displayed shape, which is dragged. */
const subject = (): DrawnObject | undefined => {
  const one = drawn[page.object.value];
  return one?.about.cage ? one : undefined;
};

const points = (of: DrawnObject): THREE.Points => (of.cage as THREE.Group).children[1] as THREE.Points;
const lines = (of: DrawnObject): THREE.LineSegments => (of.cage as THREE.Group).children[0] as THREE.LineSegments;

/** Position of a control point relative to the box of the object. */
export function control(of: DrawnObject, index: number): THREE.Vector3 {
  const positions = points(of).geometry.getAttribute("position") as THREE.BufferAttribute;
  return new THREE.Vector3().fromBufferAttribute(positions, index).add((of.cage as THREE.Group).position);
}
export const controls = (of: DrawnObject) => (points(of).geometry.getAttribute("position") as THREE.BufferAttribute).count;

// ---- markers of the selected control points ----

let chosenMark: THREE.Group | undefined;

export function mark() {
  chosenMark?.removeFromParent();
  chosenMark = undefined;
  const of = subject();
  if (of?.cage) points(of).visible = showsPoints.value;
  if (of && handles.value.size > 0 && showsPoints.value) {
    const list = [...handles.value].filter((i) => i < controls(of)).map((i) => control(of, i));
    const seen = list.filter((p) => view!.sees(of, p));
    const behind = list.filter((p) => !view!.sees(of, p));
    chosenMark = new THREE.Group();
    for (const [some, colour] of [
      [seen, [214, 40, 40]],
      [behind, [235, 190, 0]],
    ] as [THREE.Vector3[], [number, number, number]][])
      if (some.length > 0) chosenMark.add(new THREE.Points(new THREE.BufferGeometry().setFromPoints(some), flatMaterial(colour, 12, true)));
    of.group.add(chosenMark);
  }
  view?.draw();
}

export function set(next: Iterable<number>) {
  handles.value = new Set(next);
  mark();
}

/** Selects the control points in a rectangle, or the one nearest to a click. */
export function pick(from: { x: number; y: number }, to: { x: number; y: number }, discards: boolean, visibleOnly: boolean) {
  const of = subject();
  if (!of || !view) return;
  const found: number[] = [];
  const click = Math.hypot(to.x - from.x, to.y - from.y) < 4;
  let nearest = 14;
  for (let i = 0; i < controls(of); ++i) {
    const point = control(of, i);
    const at = view.place(of, point);
    if (!at) continue;
    if (click) {
      const off = Math.hypot(at.x - from.x, at.y - from.y);
      if (off < nearest && (!visibleOnly || view.sees(of, point))) [nearest, found[0]] = [off, i];
    } else if (
      at.x >= Math.min(from.x, to.x) &&
      at.x <= Math.max(from.x, to.x) &&
      at.y >= Math.min(from.y, to.y) &&
      at.y <= Math.max(from.y, to.y) &&
      (!visibleOnly || view.sees(of, point))
    )
      found.push(i);
  }
  const next = new Set(handles.value);
  for (const i of found) {
    if (discards) next.delete(i);
    else next.add(i);
  }
  set(next);
}

/** Selects the control points of an annotation (thesis, section 5.2.3). */
export const ofAnnotation = (id: number, discards = false) =>
  attempt(text("handles"), async () => {
    const { result } = await link.ask("handles", { annotation: id, threshold: "auto-mesh" });
    const next = new Set(handles.value);
    for (const i of result.handles as number[]) {
      if (discards) next.delete(i);
      else next.add(i);
    }
    set(next);
  });

/** Requests which constraints the cage can satisfy, before any edit. */
export const askReach = () =>
  attempt(text("reach"), async () => {
    const { result } = await link.ask("reach");
    reach.value = { constraints: result.constraints as number, texts: result.texts as string[] };
  });

/** Shows the influence of the selected control points on each vertex as colours. */
export const showInfluence = () =>
  attempt(text("influence"), async () => {
    const of = subject();
    if (!of || handles.value.size === 0) return;
    const answer = await link.ask("influence", { handles: [...handles.value] });
    of.paintValues(numbersIn(answer, answer.result.values));
    view?.draw();
  });

// ---- dragging ----

interface Drag {
  of: DrawnObject;
  motion: Motion;
  list: number[];
  /** Positions before the drag. */
  rest: THREE.Vector3[];
  centre: THREE.Vector3;
  from: { x: number; y: number };
  edit: { steps: object[] };
  constrained: boolean;
  /** Number of pending messages, and the positions to send next. */
  asked: number;
  next: THREE.Vector3[] | undefined;
}
let now: Drag | undefined;
/** Set if the pointer was released while a drag was being started: it ends as soon as the command has answered. */
let ended: { x: number; y: number } | undefined;

export async function grab(motion: Motion, from: { x: number; y: number }): Promise<boolean> {
  const of = drawn[page.object.value];
  ended = undefined;
  if (of && !of.about.cage) return grabWhole(of, motion, from);
  if (!of || handles.value.size === 0) return false;
  if (!has("coordinates")) {
    await attempt(text("deform"), () => link.ask("grab", { handles: [...handles.value] }));
    return false;
  }
  return begin(of, motion, from);
}

/** Moves an object without a cage as a whole, such as a fragment. */
async function grabWhole(of: DrawnObject, motion: Motion, from: { x: number; y: number }): Promise<boolean> {
  const { positions } = of.shape;
  const weights = new Float32Array((4 * positions.length) / 3);
  for (let v = 0; v < positions.length / 3; ++v) {
    for (let k = 0; k < 3; ++k) weights[4 * v + k] = positions[3 * v + k];
    weights[4 * v + 3] = 1;
  }
  of.follows(weights);
  const centre = new THREE.Vector3(...of.about.size).multiplyScalar(0.5);
  now = {
    of,
    motion,
    list: [],
    rest: [],
    centre,
    from,
    edit: { steps: [] },
    constrained: false,
    asked: 0,
    next: undefined,
  };
  return true;
}

async function begin(of: DrawnObject, motion: Motion, from: { x: number; y: number }): Promise<boolean> {
  return attempt(text("deform"), async () => {
    const answer = await link.ask("grab", { handles: [...handles.value], constraints: keepsConstraints.value });
    const list = answer.result.handles as number[];
    const rest = list.map((i) => control(of, i));
    const centre = rest.reduce((sum, p) => sum.add(p), new THREE.Vector3()).divideScalar(rest.length);
    of.follows(numbersIn(answer, answer.result.weights));
    now = {
      of,
      motion,
      list,
      rest,
      centre,
      from,
      edit: answer.result.edit,
      constrained: answer.result.constrained,
      asked: 0,
      next: undefined,
    };
    if (ended) await release(ended);
  });
}

/** In the object's own coordinates: size of a pixel, and the directions of the view. */
function frameOf(of: DrawnObject) {
  const inverse = of.group.matrixWorld.clone().invert();
  const width = view!.canvas.clientWidth / Math.max(1, page.panes.value.length);
  const unit = (view!.camera.right - view!.camera.left) / view!.camera.zoom / width / of.group.scale.x;
  const own = (x: number, y: number, z: number) =>
    new THREE.Vector3(x, y, z).transformDirection(view!.camera.matrixWorld).transformDirection(inverse);
  return { unit, right: own(1, 0, 0), up: own(0, 1, 0), toward: own(0, 0, 1) };
}

const plain = (v: THREE.Vector3) => v.toArray().map((x) => Number(x.toPrecision(9)));

/** A step of an edit that moves a region: the map that the edit file names. */
export type Step =
  | { translate: number[] }
  | { rotate: { axis: number[]; angle: number; centre?: number[] } }
  | { scale: { factor: number; centre?: number[] } }
  | { stretch: { direction: number[]; factor: number; from?: string } };

/** Converts a pointer movement to a step of an edit, a map x -> A x + t relative to the box. */
function motionTo(drag: Drag, to: { x: number; y: number }): Step {
  const { unit, right, up, toward } = frameOf(drag.of);
  const [dx, dy] = [to.x - drag.from.x, to.y - drag.from.y];
  const along = right.clone().multiplyScalar(dx).addScaledVector(up, -dy);
  const centre = plain(drag.centre.clone().add(new THREE.Vector3(...drag.of.about.origin)));
  if (drag.motion === "move") return { translate: plain(along.multiplyScalar(unit)) };
  const length = Math.hypot(dx, dy);
  if (drag.motion === "rotate") {
    // About the axis orthogonal to the pointer movement and the view (thesis, appendix A.1).
    const axis = length > 0 ? toward.clone().cross(along).normalize() : up;
    return { rotate: { axis: plain(axis), angle: Number((0.5 * length).toFixed(3)), centre } };
  }
  const factor = Number(Math.exp(-dy / 150).toPrecision(6));
  if (drag.motion === "scale") return { scale: { factor, centre } };
  return stretchTo(drag, along, up, dx, dy);
}

/** A stretch along the drag; a drag about along the object's upward direction is one along it, from the base: up makes higher, down lower. */
function stretchTo(drag: Drag, along: THREE.Vector3, up: THREE.Vector3, dx: number, dy: number): Step {
  const length = Math.hypot(dx, dy);
  const upward = new THREE.Vector3(...drag.of.about.up).normalize();
  const drawn = length > 0 ? along.clone().normalize() : up;
  const isUpward = Math.abs(drawn.dot(upward)) > 0.8;
  const direction = isUpward ? upward : drawn;
  const sign = isUpward && drawn.dot(upward) < 0 ? -1 : 1;
  const factor = Number(Math.max(0.05, 1 + (sign * length) / 150).toFixed(2));
  return { stretch: { direction: plain(direction), factor, from: "base" } };
}

/** The part of the selected control points that a stretch from the base keeps in place. */
function baseOf(drag: Drag, direction: number[]): THREE.Vector3 {
  const d = new THREE.Vector3(...direction);
  // A whole object: the lowest corner of its box.
  if (drag.rest.length === 0) return new THREE.Vector3(...drag.of.about.size.map((x, k) => (direction[k] < 0 ? x : 0)));
  return drag.rest.reduce((lowest, p) => (p.dot(d) < lowest.dot(d) ? p : lowest));
}

/** A step in words: "20 % higher, from its base". */
function inWords(step: Step, of: DrawnObject): string {
  const { numberText, withUnit } = page;
  if ("translate" in step) return withUnit(Number(Math.hypot(...step.translate).toPrecision(3)), of.about.unit);
  if ("rotate" in step) return `${numberText(Number(step.rotate.angle.toFixed(1)))}°`;
  const percent = (factor: number) => numberText(Math.abs(Math.round(100 * (factor - 1))));
  if ("scale" in step) return text(step.scale.factor < 1 ? "percentSmaller" : "percentLarger", percent(step.scale.factor));
  const isUpward = new THREE.Vector3(...step.stretch.direction).dot(new THREE.Vector3(...of.about.up).normalize()) > 0.999;
  const { factor } = step.stretch;
  if (!isUpward) return text("percentLonger", percent(factor));
  return text(factor < 1 ? "percentLower" : "percentHigher", percent(factor));
}

/** The same map as a matrix and a vector. */
export function affine(step: Step, centre: THREE.Vector3): { linear: THREE.Matrix3; shift: THREE.Vector3 } {
  const linear = new THREE.Matrix3();
  if ("translate" in step) return { linear, shift: new THREE.Vector3(...(step.translate as [number, number, number])) };
  if ("rotate" in step) {
    const turn = new THREE.Matrix4().makeRotationAxis(
      new THREE.Vector3(...(step.rotate.axis as [number, number, number])).normalize(),
      (step.rotate.angle * Math.PI) / 180,
    );
    linear.setFromMatrix4(turn);
  } else if ("scale" in step) {
    linear.multiplyScalar(step.scale.factor);
  } else {
    const d = new THREE.Vector3(...(step.stretch.direction as [number, number, number])).normalize();
    const more = step.stretch.factor - 1;
    linear.set(
      1 + more * d.x * d.x,
      more * d.x * d.y,
      more * d.x * d.z,
      more * d.y * d.x,
      1 + more * d.y * d.y,
      more * d.y * d.z,
      more * d.z * d.x,
      more * d.z * d.y,
      1 + more * d.z * d.z,
    );
  }
  return { linear, shift: centre.clone().sub(centre.clone().applyMatrix3(linear)) };
}

export function drag(to: { x: number; y: number }) {
  if (!now) return;
  const step = motionTo(now, to);
  reading.value = { ...to, text: inWords(step, now.of) };
  apply(now, step);
}

function apply(one: Drag, step: Step) {
  const fixed = "stretch" in step && step.stretch.from === "base" ? baseOf(one, step.stretch.direction) : one.centre;
  const { linear, shift } = affine(step, fixed);
  const moved = one.rest.map((p) => p.clone().applyMatrix3(linear).add(shift));
  if (one.constrained) {
    one.next = moved;
    pump(one);
    return;
  }
  const bend = linear.clone();
  for (const i of [0, 4, 8]) bend.elements[i] -= 1;
  shared.bend.value.copy(bend);
  shared.shift.value.copy(shift);
  if (one.list.length > 0) moveControls(one.of, one.list, moved);
  view?.draw();
}

function moveControls(of: DrawnObject, list: number[], places: THREE.Vector3[]) {
  const attribute = points(of).geometry.getAttribute("position") as THREE.BufferAttribute;
  const offset = (of.cage as THREE.Group).position;
  list.forEach((i, k) => attribute.setXYZ(i, places[k].x - offset.x, places[k].y - offset.y, places[k].z - offset.z));
  attribute.needsUpdate = true;
  const shape = points(of).geometry;
  lines(of).geometry.dispose();
  lines(of).geometry = new THREE.EdgesGeometry(shape, 0);
  mark();
}

/** Sends positions: at most two requests are pending; the latest positions replace unsent ones. */
function pump(one: Drag) {
  if (!one.next || one.asked >= 2) return;
  const places = one.next;
  one.next = undefined;
  ++one.asked;
  const began = performance.now();
  const origin = new THREE.Vector3(...one.of.about.origin);
  link
    .ask("drag", { places: places.map((p) => p.clone().add(origin).toArray()) })
    .then((answer) => {
      --one.asked;
      if (now !== one) return;
      one.of.moveVertices(numbersIn(answer, answer.result.positions));
      const cage = numbersIn(answer, answer.result.cage);
      moveControls(
        one.of,
        Array.from({ length: cage.length / 3 }, (_, i) => i),
        Array.from({ length: cage.length / 3 }, (_, i) => new THREE.Vector3().fromArray(cage, 3 * i)),
      );
      view?.draw();
      requestAnimationFrame(() => (latency.value = [...latency.value.slice(-199), performance.now() - began]));
      pump(one);
    })
    .catch(() => {
      --one.asked;
    });
}

/** Ends a drag: the command computes the exact result and adds it to the session. */
export async function release(to: { x: number; y: number }): Promise<boolean> {
  reading.value = undefined;
  const one = now;
  if (!one) {
    ended = to;
    return false;
  }
  if (to.x === one.from.x && to.y === one.from.y) {
    letGo();
    return false;
  }
  return finishWith(one, motionTo(one, to));
}

async function finishWith(one: Drag, step: Step): Promise<boolean> {
  now = undefined;
  ended = undefined;
  if (one.list.length === 0) return finishWhole(one, step);
  const constrained = keepsConstraints.value && has("graph");
  const given: Record<string, unknown> = {
    mesh: part("mesh"),
    cage: part("cage"),
    weights: part("coordinates"),
    edit: { document: { ...one.edit, steps: [...one.edit.steps, { select: { cageVertices: one.list }, ...step }] } },
    conflicts: constrained ? 8 : 0,
  };
  const keep = ["cage-out"];
  if (has("annotations")) {
    given.annotations = part("annotations");
    keep.push("annotations-out");
  }
  if (constrained) Object.assign(given, { graph: part("graph"), space: space.value });
  const done = await run({
    operation: "deform",
    title: text("deformedBy", text(one.motion), one.list.length),
    with: given,
    keep,
    as: "deformed",
  });
  still(one.of);
  return done;
}

async function finishWhole(one: Drag, step: Step): Promise<boolean> {
  const edit = object.value?.parts.edit;
  const before = edit ? JSON.parse(new TextDecoder().decode((await link.ask("file", { file: edit })).bytes)).steps : [];
  const given: Record<string, unknown> = {
    mesh: part("mesh"),
    edit: { document: { format: "ostraka-edit", version: 1, steps: [...before, { select: { all: true }, ...step }] } },
  };
  if (has("annotations")) given.annotations = part("annotations");
  const done = await run({
    operation: "deform",
    title: text("movedWhole", text(one.motion)),
    with: given,
    keep: has("annotations") ? ["annotations-out"] : [],
    as: "deformed",
  });
  still(one.of);
  return done;
}

/** For hands: the map is given for each frame, until it is released as a step. */
export async function hold(motion: Motion): Promise<boolean> {
  const of = subject();
  return of !== undefined && handles.value.size > 0 && begin(of, motion, { x: 0, y: 0 });
}
export function follow(step: Step) {
  if (!now) return;
  apply(now, step);
}
export const held = () => now;
export const letGoWith = (step: Step) => (now ? finishWith(now, step) : Promise.resolve(false));

function still(of: DrawnObject) {
  shared.bend.value.set(0, 0, 0, 0, 0, 0, 0, 0, 0);
  shared.shift.value.set(0, 0, 0);
  of.follows(undefined);
  view?.draw();
}

export function letGo() {
  reading.value = undefined;
  const one = now;
  now = undefined;
  ended = undefined;
  if (!one) return;
  if (one.list.length > 0) moveControls(one.of, one.list, one.rest);
  still(one.of);
}

/** Colours control points by the part they influence; by the mean colour if several parts share one. */
async function colour() {
  const of = subject();
  if (!of || !has("coordinates") || of.about.annotations.length === 0) return;
  const { parts } = (await link.ask("parts")).result as { parts: number[][] };
  const attribute = points(of).geometry.getAttribute("color") as THREE.BufferAttribute;
  parts.forEach((list, i) => {
    if (list.length === 0 || i >= attribute.count) return;
    const mean = [0, 1, 2].map((k) => list.reduce((sum, a) => sum + (of.about.annotations[a]?.colour[k] ?? 128), 0) / list.length);
    (attribute.array as Uint8Array).set(mean, 3 * i);
  });
  attribute.needsUpdate = true;
  view?.draw();
}

/** The files for which the reach was computed. */
let reachOf = "";
const reachFiles = () => ["mesh", "annotations", "graph", "cage", "coordinates"].map((one) => object.value?.parts[one] ?? "").join("\n");

onShown.push(() => {
  if (reachOf !== reachFiles()) reach.value = undefined;
  reachOf = reachFiles();
  colour().catch(() => {}); // dragging also works without colours
  now = undefined;
  shared.bend.value.set(0, 0, 0, 0, 0, 0, 0, 0, 0);
  shared.shift.value.set(0, 0, 0);
  const of = subject();
  if (!of) handles.value = new Set();
  else handles.value = new Set([...handles.value].filter((i) => i < controls(of)));
  mark();
});
