// Sizes of annotations on the shown mesh: areas of regions, lengths of lines, angles of three points.
import type { DrawnObject } from "./geometry";

/** The area of triangles, in the square of the object's unit. */
export function areaOf(of: DrawnObject, faces: ArrayLike<number>): number {
  const { positions, triangles } = of.shape;
  let sum = 0;
  for (let i = 0; i < faces.length; ++i) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * triangles[3 * faces[i] + k]);
    const u = [0, 1, 2].map((k) => positions[b + k] - positions[a + k]);
    const v = [0, 1, 2].map((k) => positions[c + k] - positions[a + k]);
    sum += 0.5 * Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
  }
  return sum;
}

/** The length of poly-lines through vertices. */
export function lengthOf(of: DrawnObject, lines: number[][]): number {
  let sum = 0;
  for (const line of lines) for (let i = 1; i < line.length; ++i) sum += of.vertex(line[i - 1]).distanceTo(of.vertex(line[i]));
  return sum;
}

/** Tags of annotations of three points that measure an angle begin with this sign. */
export const angleSign = "∠";

/** The angle at the second of three points in degrees, if the annotation measures one. */
export function angleOf(of: DrawnObject, annotation: number): number | undefined {
  const one = of.about.annotations[annotation];
  if (one?.type !== "point" || one.points?.length !== 3 || !one.tag.startsWith(angleSign)) return undefined;
  const [a, b, c] = one.points.map((v) => of.vertex(v));
  const [u, v] = [a.sub(b), c.sub(b)];
  const length = u.length() * v.length();
  return length > 0 ? (Math.acos(Math.max(-1, Math.min(1, u.dot(v) / length))) * 180) / Math.PI : undefined;
}

/** The area of a region or the length of a line, with its unit. */
export function sizeOf(of: DrawnObject, annotation: number): { kind: "area" | "length"; value: number; unit: string } | undefined {
  const one = of.about.annotations[annotation];
  const { unit } = of.about;
  const faces = of.regions[annotation];
  if (faces) return { kind: "area", value: areaOf(of, faces), unit: unit ? `${unit}²` : "" };
  if (one.lines) return { kind: "length", value: lengthOf(of, one.lines), unit };
  return undefined;
}
