// The selection: shapes drawn on the view, as an expression of recipes that the command evaluates.
import { computed, signal } from "@preact/signals";
import * as THREE from "three";
import { flatMaterial, type DrawnObject } from "../geometry";
import { drawn, view } from "../picture";
import { areaOf, lengthOf } from "../sizes";
import * as page from "../state";
import { indicesIn } from "./link";
import { attempt, link, onShown, shown } from "./model";
import { text } from "./words";

export type Expression = Record<string, unknown>;
export const expression = signal<Expression | undefined>(undefined);
/** What is selected: its type, how many elements, and its area or length. */
export const selected = signal<{ type: string; count: number; size?: number } | undefined>(undefined);
export const erases = signal(false);
export const visible = signal(true);
/** Whether outlines cut through triangles as drawn, instead of following the nearest edges. */
export const asDrawn = signal(true);

/** Type of annotation that an expression selects. */
export function typeOf(of: Expression): "region" | "line" | "point" {
  if (of.path) return "line";
  if (of.vertices || of.nearest) return "point";
  if (of.annotation !== undefined)
    return page.page.objects[page.object.value]?.annotations.find((one) => one.id === of.annotation)?.type ?? "region";
  const list = (of.union ?? of.difference ?? of.intersection) as Expression[] | undefined;
  return list ? typeOf(list[list[0].all ? 1 : 0]) : "region";
}

let mark: THREE.Object3D | undefined;

/** The object to select on: the undeformed one. */
export function target(): DrawnObject | undefined {
  const one = drawn[page.object.value];
  const about = shown.value[page.object.value];
  return one && about && !about.deformed ? one : undefined;
}

const red: [number, number, number] = [214, 40, 40];

function show(of: DrawnObject, made: THREE.Object3D | undefined) {
  if (mark) mark.removeFromParent();
  mark = made;
  if (made) of.group.add(made);
  view?.draw();
}

function facesMark(of: DrawnObject, list: Uint32Array): THREE.Object3D {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(of.shape.positions, 3));
  const index = new Uint32Array(3 * list.length);
  list.forEach((f, i) => index.set(of.shape.triangles.subarray(3 * f, 3 * f + 3), 3 * i));
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  const material = flatMaterial(red, 0, false, 0.5);
  material.polygonOffset = true;
  material.polygonOffsetFactor = -1;
  material.polygonOffsetUnits = -2;
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

function linesMark(of: DrawnObject, lines: number[][]): THREE.Object3D {
  const group = new THREE.Group();
  for (const one of lines) {
    const geometry = new THREE.BufferGeometry().setFromPoints(one.map((v) => of.vertex(v)));
    group.add(new THREE.Line(geometry, flatMaterial(red, 0, true)));
  }
  return group;
}

function pointsMark(of: DrawnObject, points: number[]): THREE.Object3D {
  return new THREE.Points(new THREE.BufferGeometry().setFromPoints(points.map((v) => of.vertex(v))), flatMaterial(red, 10, true));
}

/** Adds the drawn shape to the selection, or removes it. */
export async function add(drawnNow: Expression): Promise<boolean> {
  const before = expression.value;
  let next: Expression;
  if (!before) next = erases.value ? { difference: [{ all: true }, drawnNow] } : drawnNow;
  else next = erases.value ? { difference: [before, drawnNow] } : { union: [before, drawnNow] };
  return setSelection(next);
}

/** The selections before each stroke since the last annotation, and those that were taken back. */
const before = signal<(Expression | undefined)[]>([]);
const after: (Expression | undefined)[] = [];
/** How many strokes can be taken back. */
export const strokes = computed(() => before.value.length);

/** Takes the last stroke back; false if there is none. */
export function undoStroke(): boolean {
  const list = before.value;
  if (list.length === 0) return false;
  const last = list[list.length - 1];
  after.push(expression.value);
  before.value = list.slice(0, -1);
  void evaluate(last);
  return true;
}
/** Repeats the stroke that was taken back last; false if there is none. */
export function redoStroke(): boolean {
  if (after.length === 0) return false;
  before.value = [...before.value, expression.value];
  void evaluate(after.pop());
  return true;
}

/** Sets the selection; the command evaluates it on the object's own mesh. */
export async function setSelection(next: Expression | undefined): Promise<boolean> {
  const last = expression.value;
  if (!(await evaluate(next))) return false;
  if (next) {
    before.value = [...before.value, last];
    after.length = 0;
  }
  return true;
}

function evaluate(next: Expression | undefined): Promise<boolean> {
  const of = target();
  if (!next || !of) {
    empty();
    return Promise.resolve(true);
  }
  return attempt(text("select"), async () => {
    const answer = await link.ask("select", { expression: next, type: typeOf(next) });
    const { type, count } = answer.result;
    expression.value = next;
    const faces = type === "region" ? indicesIn(answer, answer.result.faces) : undefined;
    const size = faces ? areaOf(of, faces) : type === "line" ? lengthOf(of, answer.result.lines) : undefined;
    selected.value = { type, count, size };
    show(of, faces ? facesMark(of, faces) : type === "line" ? linesMark(of, answer.result.lines) : pointsMark(of, answer.result.points));
  });
}

export function clear() {
  before.value = [];
  after.length = 0;
  empty();
}

function empty() {
  expression.value = undefined;
  selected.value = undefined;
  if (mark) mark.removeFromParent();
  mark = undefined;
  view?.draw();
}

// The selection is cleared with each content.
onShown.push(clear);
