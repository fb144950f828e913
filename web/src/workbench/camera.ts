// The camera of the view in the form of recipes (doc/recipes.md): in the object's own coordinates, so that the command uses the same
// view.
import * as THREE from "three";
import type { DrawnObject } from "../geometry";
import { drawn, view } from "../picture";
import * as page from "../state";

const rounded = (x: number) => Number(x.toPrecision(12));

export interface RecipeCamera {
  projection: "orthographic";
  eye: number[];
  target: number[];
  up: number[];
  pixelsPerUnit: number;
  picture: [number, number];
  pane: [number, number, number, number];
}

/** Camera of the pane that shows the object; pixels are relative to the pane's corner. */
export function recipeCamera(of: DrawnObject): RecipeCamera {
  const { camera, canvas } = view!;
  const width = canvas.clientWidth / Math.max(1, page.panes.value.length);
  const height = canvas.clientHeight;
  camera.updateMatrixWorld();
  const inverse = of.group.matrixWorld.clone().invert();
  const toward = new THREE.Vector3(0, 0, 1).transformDirection(camera.matrixWorld);
  const up = new THREE.Vector3(0, 1, 0).transformDirection(camera.matrixWorld);
  // The point of the central ray nearest to the centre of the scene.
  const middle = camera.position.clone().addScaledVector(toward, -camera.position.dot(toward));
  const scale = of.group.scale.x;
  const target = middle.applyMatrix4(inverse);
  const back = toward.clone().transformDirection(inverse);
  const eye = target.clone().addScaledVector(back, 2 * Math.hypot(...of.about.size));
  const own = (p: THREE.Vector3) => p.toArray().map((x, k) => rounded(x + of.about.origin[k]));
  return {
    projection: "orthographic",
    eye: own(eye),
    target: own(target),
    up: up.transformDirection(inverse).toArray().map(rounded),
    pixelsPerUnit: rounded((scale * camera.zoom * width) / (camera.right - camera.left)),
    picture: [Math.max(16, Math.ceil(width)), Math.max(16, Math.ceil(height))],
    pane: [0, 0, rounded(width), rounded(height)],
  };
}

/** Converts a position on the canvas to a pixel of the pane that shows the object. */
export function paneOf(of: DrawnObject, x: number, y: number): [number, number] {
  const list = page.panes.value;
  const width = view!.canvas.clientWidth / Math.max(1, list.length);
  return [rounded(x - Math.max(0, list.indexOf(of.index)) * width), rounded(y)];
}

/** The plane of "Cut at" through the displayed object: a point and the normal, in the object's own coordinates. */
export function cutPlane(): number[] | undefined {
  const of = drawn[page.object.value];
  if (!of || page.clip.value >= 1) return undefined;
  const inverse = of.group.matrixWorld.clone().invert();
  const axis = page.clipAxis.value;
  const point = new THREE.Vector3().setComponent(axis, page.clip.value).applyMatrix4(inverse);
  const normal = new THREE.Vector3().setComponent(axis, 1).transformDirection(inverse);
  return [...point.toArray().map((x, k) => rounded(x + of.about.origin[k])), ...normal.toArray().map(rounded)];
}
