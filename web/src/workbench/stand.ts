// Which way is up: a guess for an object that was just opened, and the base on which an object stands after a click.
import * as THREE from "three";
import { ConvexHull } from "three/examples/jsm/math/ConvexHull.js";
import type { DrawnObject } from "../geometry";

export type Up = "x" | "-x" | "y" | "-y" | "z" | "-z";
export const axes: Record<Up, [number, number, number]> = {
  z: [0, 0, 1],
  y: [0, 1, 0],
  x: [1, 0, 0],
  "-z": [0, 0, -1],
  "-y": [0, -1, 0],
  "-x": [-1, 0, 0],
};

/** Files seldom have the object upside down; z and y are the usual axes. */
const usual: Record<Up, number> = { z: 0.15, y: 0.2, x: 0, "-z": -0.15, "-y": -0.15, "-x": -0.15 };

/** How well an object rests with an axis up, from 0 to about 1: how much of its outline its lowest points span, and whether its centre is above them. */
function support(of: DrawnObject, up: Up): number {
  const { positions } = of.shape;
  const k = up.endsWith("x") ? 0 : up.endsWith("y") ? 1 : 2;
  const sign = up.startsWith("-") ? -1 : 1;
  const [u, v] = [(k + 1) % 3, (k + 2) % 3];
  const size = of.about.size;
  const lowest = sign > 0 ? 0 : size[k];
  const near = 0.015 * Math.hypot(...size);
  const sum = [0, 0];
  const [low, high] = [
    [Infinity, Infinity],
    [-Infinity, -Infinity],
  ];
  const count = positions.length / 3;
  for (let i = 0; i < count; ++i) {
    const at = [positions[3 * i + u], positions[3 * i + v]];
    for (const c of [0, 1]) sum[c] += at[c];
    if (sign * (positions[3 * i + k] - lowest) > near) continue;
    for (const c of [0, 1]) {
      low[c] = Math.min(low[c], at[c]);
      high[c] = Math.max(high[c], at[c]);
    }
  }
  if (!(high[0] > low[0]) || !(high[1] > low[1])) return 0;
  const share = ((high[0] - low[0]) * (high[1] - low[1])) / Math.max(1e-12, size[u] * size[v]);
  const rests = [0, 1].every((c) => sum[c] / count > low[c] && sum[c] / count < high[c]);
  return rests ? share : 0.3 * share;
}

/** The upward axis that an object has most likely. glTF prescribes y. */
export function guessUp(of: DrawnObject, file: string): { up: Up; prescribed: boolean } {
  if (/\.(glb|gltf)$/i.test(file)) return { up: "y", prescribed: true };
  let best: Up = "z";
  let most = -1;
  for (const up of Object.keys(axes) as Up[]) {
    const score = support(of, up) + usual[up];
    if (score > most + 1e-9) [best, most] = [up, score];
  }
  return { up: best, prescribed: false };
}

/** The corners of the hull of an object, approximately: its extreme vertices in many directions. */
function extremes(of: DrawnObject): THREE.Vector3[] {
  const { positions } = of.shape;
  const count = positions.length / 3;
  const directions = Math.round(Math.min(600, Math.max(120, 6e7 / count)));
  const kept = new Set<number>();
  for (let k = 0; k < directions; ++k) {
    const z = 1 - (2 * k + 1) / directions;
    const turn = k * Math.PI * (3 - Math.sqrt(5));
    const [x, y] = [Math.sqrt(1 - z * z) * Math.cos(turn), Math.sqrt(1 - z * z) * Math.sin(turn)];
    let best = 0;
    let most = -Infinity;
    for (let i = 0; i < count; ++i) {
      const far = x * positions[3 * i] + y * positions[3 * i + 1] + z * positions[3 * i + 2];
      if (far > most) [best, most] = [i, far];
    }
    kept.add(best);
  }
  return [...kept].map((i) => of.vertex(i));
}

/** The outward direction of the plane on which an object rests best among those that face about the same way as `outward`. */
export function restingPlane(of: DrawnObject, outward: THREE.Vector3): THREE.Vector3 | undefined {
  const points = extremes(of);
  if (points.length < 4) return undefined;
  const facets = new ConvexHull().setFromPoints(points).faces.map((one) => ({ normal: one.normal.clone(), area: one.area }));
  let best: THREE.Vector3 | undefined;
  let most = 0;
  for (const one of facets) {
    const facing = one.normal.dot(outward);
    if (facing < 0.6) continue;
    const alike = facets.filter((other) => other.normal.dot(one.normal) > Math.cos(Math.PI / 45));
    const sum = alike.reduce((all, other) => all.addScaledVector(other.normal, other.area), new THREE.Vector3());
    const score = sum.length() * (facing - 0.5);
    if (score > most) [best, most] = [sum.normalize(), score];
  }
  return best;
}
