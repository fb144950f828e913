// Deformation in virtual reality (thesis, section 5.2.3): the object on a stand; control points are selected by gaze, by hand or by
// annotation, dragged with one hand, scaled with two; everything else is a command, spoken or selected in the wrist menu.
import { signal } from "@preact/signals";
import * as THREE from "three";
import { flatMaterial, type DrawnObject } from "../geometry";
import { drawn, view } from "../picture";
import * as page from "../state";
import { commands, gazed, gazedPoint } from "./commands";
import * as deform from "./deform";
import { onShown } from "./model";
import { tool } from "./tools";
import { text } from "./words";

export const canEnter = signal(false);
void (navigator as Partial<Navigator>).xr?.isSessionSupported("immersive-vr").then(
  (can: boolean) => (canEnter.value = can),
  () => {},
);

/** Size of the object and height of its position, in metres. */
const size = signal(0.9);
const height = signal(1.25);
export const seated = (on: boolean) => (height.value = on ? 0.85 : 1.25);
export const larger = (factor: number) => (size.value = Math.min(4, Math.max(0.1, size.value * factor)));
commands.push(
  { id: "larger", words: "larger", action: () => larger(1.25) },
  { id: "smaller", words: "smaller", action: () => larger(0.8) },
  { id: "seated", words: "seated", action: () => seated(true) },
  { id: "standing", words: "standing", action: () => seated(false) },
  { id: "leave-vr", words: "leaveVr", action: () => void session?.end() },
);

let session: XRSession | undefined;
let room: THREE.Scene | undefined;
let camera: THREE.PerspectiveCamera;
let stage: THREE.Group;
let gazeMark: THREE.Mesh;
let menu: Menu;
const hands: Hand[] = [];

interface Hand {
  ray: THREE.XRTargetRaySpace;
  mark: THREE.Mesh;
  pressed: boolean;
  start: THREE.Vector3;
  startTurn: THREE.Quaternion;
}

/** Position of the hand in the room. */
const placeOf = (hand: Hand) => hand.ray.getWorldPosition(new THREE.Vector3());
const subject = (): DrawnObject | undefined => drawn[page.object.value];

// ---- the wrist menu ----

const rows = [
  "select",
  "discard",
  "tool-move",
  "tool-rotate",
  "undo",
  "redo",
  "hide-cage",
  "show-cage",
  "hide-points",
  "show-points",
  "influence",
  "clear",
  "larger",
  "smaller",
  "seated",
  "leave-vr",
];

class Menu {
  readonly mesh: THREE.Mesh;
  private readonly canvas = document.createElement("canvas");
  private readonly texture: THREE.CanvasTexture;
  private marked = -2;
  constructor() {
    this.canvas.width = 512;
    this.canvas.height = 40 * rows.length;
    this.texture = new THREE.CanvasTexture(this.canvas);
    const tall = (0.16 * this.canvas.height) / this.canvas.width;
    this.mesh = new THREE.Mesh(
      new THREE.PlaneGeometry(0.16, tall),
      new THREE.MeshBasicMaterial({ map: this.texture, side: THREE.DoubleSide }),
    );
    this.draw(-1);
  }
  draw(marked: number) {
    if (marked === this.marked) return;
    this.marked = marked;
    const to = this.canvas.getContext("2d")!;
    rows.forEach((id, i) => {
      to.fillStyle = i === marked ? "#dbe8f7" : "#ffffff";
      to.fillRect(0, 40 * i, 512, 40);
      to.fillStyle = "#1c1b19";
      to.font = "26px sans-serif";
      to.fillText(text(commands.find((one) => one.id === id)!.words), 16, 40 * i + 29);
    });
    this.texture.needsUpdate = true;
  }
  /** The row hit by a ray; -1: none. */
  row(ray: THREE.Raycaster): number {
    const hit = ray.intersectObject(this.mesh)[0];
    return hit?.uv ? Math.min(rows.length - 1, Math.floor((1 - hit.uv.y) * rows.length)) : -1;
  }
}

// ---- the room ----

function makeRoom() {
  room = new THREE.Scene();
  room.background = new THREE.Color(0xdfe3e8);
  camera = new THREE.PerspectiveCamera(70, 1, 0.02, 50);
  camera.position.set(0, 1.6, 0);
  // A static reference reduces motion sickness.
  const floor = new THREE.GridHelper(8, 16, 0x8a8f96, 0xb9bec5);
  room.add(floor);
  stage = new THREE.Group();
  room.add(stage);
  gazeMark = new THREE.Mesh(
    new THREE.RingGeometry(0.006, 0.009, 24),
    new THREE.MeshBasicMaterial({ color: 0xd62828, side: THREE.DoubleSide, depthTest: false }),
  );
  room.add(gazeMark);
  menu = new Menu();
}

/** Places the displayed object upright on the stage. */
function place() {
  if (!room) return;
  const of = subject();
  for (const one of drawn) if (one !== of && one.group.parent === stage) stage.remove(one.group);
  if (!of) return;
  of.group.visible = true;
  stage.add(of.group);
  stage.rotation.set(-Math.PI / 2, 0, 0);
  stage.position.set(0, height.value, -0.9);
  stage.scale.setScalar(size.value / 2); // the object has size two
  stage.updateMatrixWorld(true);
  deform.mark();
}

// ---- gaze and touch ----

/** The target of the gaze: the nearest control point within three degrees of the centre, else the annotation there. */
function look() {
  const of = subject();
  if (!of || !view) return;
  const head = view.renderer.xr.getCamera();
  // From the midpoint between the eyes: the combined camera is behind them.
  const from = new THREE.Vector3();
  for (const eye of head.cameras) from.addScaledVector(new THREE.Vector3().setFromMatrixPosition(eye.matrixWorld), 1 / head.cameras.length);
  const along = new THREE.Vector3(0, 0, -1).transformDirection(head.matrixWorld);
  let best = Math.cos((3 * Math.PI) / 180);
  let point = -1;
  let at: THREE.Vector3 | undefined;
  if (of.about.cage && deform.showsPoints.value)
    for (let i = 0; i < deform.controls(of); ++i) {
      const there = of.group.localToWorld(deform.control(of, i));
      const cosine = there.clone().sub(from).normalize().dot(along);
      if (cosine > best) [best, point, at] = [cosine, i, there];
    }
  gazedPoint.value = point;
  const inverse = of.group.matrixWorld.clone().invert();
  const ray = new THREE.Ray(from.clone(), along.clone()).applyMatrix4(inverse);
  ray.direction.normalize();
  const hit = of.bvh.raycastFirst(ray, THREE.DoubleSide);
  if (hit && hit.faceIndex != null) {
    gazed.value = of.annotationsOn(hit.faceIndex).filter((i) => page.isShown(of.index, i))[0] ?? -1;
    at ??= of.group.localToWorld(hit.point.clone());
  } else gazed.value = -1;
  gazeMark.visible = at !== undefined;
  if (at) {
    gazeMark.position.copy(at);
    gazeMark.lookAt(from);
  }
}

/** The control point touched by a hand: within four centimetres. */
function touched(hand: Hand): number {
  const of = subject();
  if (!of?.about.cage || !deform.showsPoints.value) return -1;
  const here = placeOf(hand);
  let nearest = 0.04;
  let found = -1;
  for (let i = 0; i < deform.controls(of); ++i) {
    const off = of.group.localToWorld(deform.control(of, i)).distanceTo(here);
    if (off < nearest) [nearest, found] = [off, i];
  }
  return found;
}

const rounded = (v: THREE.Vector3) => v.toArray().map((x) => Number(x.toPrecision(9)));

/** Movement of the selected control points by the hands, as a step of an edit. */
function stepOf(): deform.Step | undefined {
  const of = subject();
  const held = deform.held();
  if (!of || !held) return undefined;
  const inverse = of.group.matrixWorld.clone().invert();
  const own = (v: THREE.Vector3) => v.clone().applyMatrix4(inverse);
  const centre = rounded(held.centre.clone().add(new THREE.Vector3(...of.about.origin)));
  const pressed = hands.filter((hand) => hand.pressed);
  if (held.motion === "scale") {
    if (pressed.length < 2) return last;
    const now = placeOf(pressed[0]).distanceTo(placeOf(pressed[1]));
    const before = pressed[0].start.distanceTo(pressed[1].start) || 1e-6;
    return { scale: { factor: Number(Math.min(10, Math.max(0.1, now / before)).toPrecision(6)), centre } };
  }
  const hand = pressed[0];
  if (!hand) return last;
  if (held.motion === "rotate") {
    const turn = hand.ray.getWorldQuaternion(new THREE.Quaternion()).multiply(hand.startTurn.clone().invert());
    if (turn.w < 0) turn.set(-turn.x, -turn.y, -turn.z, -turn.w);
    const angle = 2 * Math.acos(Math.min(1, turn.w));
    const axis = new THREE.Vector3(turn.x, turn.y, turn.z);
    if (axis.length() < 1e-6) return undefined;
    const there = axis.normalize().transformDirection(inverse);
    return { rotate: { axis: rounded(there), angle: Number(((angle * 180) / Math.PI).toFixed(4)), centre } };
  }
  return { translate: rounded(own(placeOf(hand)).sub(own(hand.start))) };
}
let last: deform.Step | undefined;

function press(hand: Hand) {
  hand.pressed = true;
  hand.start = placeOf(hand);
  hand.startTurn = hand.ray.getWorldQuaternion(new THREE.Quaternion());
  last = undefined;
  const caster = new THREE.Raycaster(hand.start, new THREE.Vector3(0, 0, -1).transformDirection(hand.ray.matrixWorld));
  const row = menu.mesh.parent && menu.mesh.parent !== hand.ray ? menu.row(caster) : -1;
  if (row >= 0) {
    hand.pressed = false;
    commands.find((one) => one.id === rows[row])!.action();
    return;
  }
  const pressed = hands.filter((one) => one.pressed);
  if (pressed.length === 2) {
    // The second hand starts a scaling, from the current positions of both hands.
    deform.letGo();
    for (const one of pressed) one.start = placeOf(one);
    holding = deform.hold("scale");
    return;
  }
  const point = touched(hand);
  if (point >= 0 && !deform.handles.value.has(point)) deform.set([...deform.handles.value, point]);
  holding = deform.hold(tool.value === "rotate" ? "rotate" : "move");
}
/** The drag that the command has been asked to start. */
let holding: Promise<boolean> = Promise.resolve(false);

async function letGo(hand: Hand) {
  if (!hand.pressed) return;
  const step = deform.held() ? stepOf() : undefined;
  const both = hands.every((one) => one.pressed);
  hand.pressed = false;
  if (both) for (const one of hands) one.pressed = false;
  await holding;
  if (!deform.held()) return;
  if (step) await deform.letGoWith(step);
  else deform.letGo();
}

function frame() {
  if (!view || !room) return;
  const { renderer } = view;
  stage.position.y = height.value;
  stage.scale.setScalar(size.value / 2);
  if (deform.held()) {
    const step = stepOf();
    if (step) {
      last = step;
      deform.follow(step);
    }
  }
  look();
  const pointer = hands[1];
  if (pointer && menu.mesh.parent) {
    const caster = new THREE.Raycaster(placeOf(pointer), new THREE.Vector3(0, 0, -1).transformDirection(pointer.ray.matrixWorld));
    menu.draw(menu.row(caster));
  }
  renderer.setScissorTest(false);
  renderer.render(room, camera);
  ++frames.value;
}
/** Number of frames drawn in virtual reality, for code that waits for them. */
export const frames = signal(0);

export async function enter(): Promise<void> {
  if (!view || session) return;
  const { renderer } = view;
  const made: XRSession = await navigator.xr!.requestSession("immersive-vr", { optionalFeatures: ["local-floor", "hand-tracking"] });
  session = made;
  document.body.classList.add("in-vr"); // overlays are misplaced in virtual reality
  if (!room) makeRoom();
  renderer.xr.enabled = true;
  renderer.autoClear = true;
  await renderer.xr.setSession(made);
  hands.length = 0;
  for (const index of [0, 1]) {
    const ray = renderer.xr.getController(index);
    const mark = new THREE.Mesh(new THREE.SphereGeometry(0.012, 12, 8), flatMaterial([29, 79, 145]));
    ray.add(mark);
    const hand: Hand = { ray, mark, pressed: false, start: new THREE.Vector3(), startTurn: new THREE.Quaternion() };
    ray.addEventListener("selectstart", () => press(hand));
    ray.addEventListener("selectend", () => void letGo(hand));
    room!.add(ray);
    hands.push(hand);
  }
  menu.mesh.position.set(0.02, 0.16, -0.04);
  menu.mesh.rotation.set(-0.5, 0.5, 0);
  hands[0].ray.add(menu.mesh);
  place();
  made.addEventListener("end", leave);
  renderer.setAnimationLoop(frame);
}

function leave() {
  session = undefined;
  document.body.classList.remove("in-vr");
  if (!view) return;
  const { renderer } = view;
  renderer.setAnimationLoop(null);
  renderer.xr.enabled = false;
  renderer.autoClear = false;
  for (const hand of hands) hand.ray.removeFromParent();
  hands.length = 0;
  view.adopt();
}

onShown.push(() => {
  if (session) place();
});

export const isInside = () => session !== undefined;
