// Objects as they are drawn: triangles with a colour of their own, regions, lines and points on them.
import * as THREE from "three";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { MeshoptDecoder } from "three/examples/jsm/libs/meshopt_decoder.module.js";
import { MeshBVH } from "three-mesh-bvh";
import { readRuns, type Blobs, type PageObject } from "./data";

/** Vertices and triangles in the order of the object's file. */
export interface Shape {
  positions: Float32Array;
  triangles: Uint32Array;
}

const loader = new GLTFLoader();
loader.setMeshoptDecoder(MeshoptDecoder);

export async function readShape(bytes: Uint8Array): Promise<Shape> {
  const copy = bytes.slice();
  const { scene } = await loader.parseAsync(copy.buffer, "");
  scene.updateMatrixWorld(true);
  let shape: Shape | undefined;
  scene.traverse((node) => {
    const geometry = (node as THREE.Mesh).geometry as THREE.BufferGeometry | undefined;
    if (!geometry || shape) return;
    const given = geometry.getAttribute("position");
    const positions = new Float32Array(3 * given.count);
    const point = new THREE.Vector3();
    for (let i = 0; i < given.count; ++i)
      point.fromBufferAttribute(given, i).applyMatrix4(node.matrixWorld).toArray(positions, 3 * i);
    shape = { positions, triangles: Uint32Array.from(geometry.index?.array ?? []) };
  });
  if (!shape) throw new Error("the page holds no shape");
  return shape;
}

function normalsOf(positions: Float32Array, triangles: Uint32Array): Float32Array {
  const normals = new Float32Array(positions.length);
  for (let i = 0; i < triangles.length; i += 3) {
    const a = 3 * triangles[i];
    const b = 3 * triangles[i + 1];
    const c = 3 * triangles[i + 2];
    const ux = positions[b] - positions[a];
    const uy = positions[b + 1] - positions[a + 1];
    const uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a];
    const vy = positions[c + 1] - positions[a + 1];
    const vz = positions[c + 2] - positions[a + 2];
    const nx = uy * vz - uz * vy;
    const ny = uz * vx - ux * vz;
    const nz = ux * vy - uy * vx;
    for (const v of [a, b, c]) {
      normals[v] += nx;
      normals[v + 1] += ny;
      normals[v + 2] += nz;
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
    normals[i] /= length;
    normals[i + 1] /= length;
    normals[i + 2] /= length;
  }
  return normals;
}

/** The entries of `values` (three for each vertex) of these vertices. */
function gathered(values: Float32Array, vertices: Uint32Array): Float32Array {
  const made = new Float32Array(3 * vertices.length);
  for (let i = 0; i < vertices.length; ++i) {
    const v = 3 * vertices[i];
    made[3 * i] = values[v];
    made[3 * i + 1] = values[v + 1];
    made[3 * i + 2] = values[v + 2];
  }
  return made;
}

/** Triangles by the set of regions that they lie in: a number for each, and the regions of each number. */
function setsOf(triangles: number, regions: (Uint32Array | undefined)[]): { of: Uint32Array; members: number[][] } {
  const of = new Uint32Array(triangles);
  const members: number[][] = [[]];
  regions.forEach((faces, region) => {
    if (!faces) return;
    const grown = new Map<number, number>();
    for (const face of faces) {
      let set = grown.get(of[face]);
      if (set === undefined) {
        set = members.push([...members[of[face]], region]) - 1;
        grown.set(of[face], set);
      }
      of[face] = set;
    }
  });
  return { of, members };
}

/** Vertices that are drawn: one for each vertex and set of regions that meets there, so that each has one colour. */
function splitVertices(vertices: number, triangles: Uint32Array, sets: Uint32Array): { source: Uint32Array; set: Uint32Array; index: Uint32Array } {
  const first = new Int32Array(vertices).fill(-1);
  const source: number[] = [];
  const set: number[] = [];
  const next: number[] = [];
  const index = new Uint32Array(triangles.length);
  for (let i = 0; i < triangles.length; ++i) {
    const v = triangles[i];
    const wanted = sets[(i / 3) | 0];
    let at = first[v];
    while (at >= 0 && set[at] !== wanted) at = next[at];
    if (at < 0) {
      at = source.push(v) - 1;
      set.push(wanted);
      next.push(first[v]);
      first[v] = at;
    }
    index[i] = at;
  }
  return { source: Uint32Array.from(source), set: Uint32Array.from(set), index };
}

/** How the surface is lit and marked; the same for all objects, so that it is compiled once. */
function surfaceMaterial(blend: { value: number }, patterns: { value: number }): THREE.MeshLambertMaterial {
  const material = new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide });
  material.onBeforeCompile = (shader) => {
    shader.uniforms.blend = blend;
    shader.uniforms.patterns = patterns;
    shader.vertexShader = shader.vertexShader
      .replace(
        "#include <common>",
        "#include <common>\nattribute vec3 otherPosition;\nattribute vec3 otherNormal;\nattribute float pattern;\nuniform float blend;\nflat varying float vPattern;",
      )
      .replace("#include <beginnormal_vertex>", "vec3 objectNormal = normalize(mix(normal, otherNormal, blend) + 1e-9);")
      .replace("#include <begin_vertex>", "vec3 transformed = mix(position, otherPosition, blend);\nvPattern = pattern;");
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nuniform float patterns;\nflat varying float vPattern;")
      .replace(
        "#include <color_fragment>",
        `#include <color_fragment>
        if (patterns > 0.5 && vPattern > 0.5) {
          vec2 at = gl_FragCoord.xy;
          float kind = mod(vPattern - 1.0, 6.0), period = 9.0 + 3.0 * floor((vPattern - 1.0) / 6.0);
          float along = kind < 0.5 ? at.x + at.y : kind < 1.5 ? at.x - at.y : kind < 2.5 ? at.x : at.y;
          bool mark = kind < 3.5 ? mod(along, period) < 1.5
                    : kind < 4.5 ? min(mod(at.x, period), mod(at.y, period)) < 1.2
                    : length(mod(at, period) - 0.5 * period) < 1.8;
          if (mark) diffuseColor.rgb *= 0.45;
        }`,
      );
  };
  return material;
}

export const blendShare = { value: 0 };
export const patternShare = { value: 0 };
const surface = surfaceMaterial(blendShare, patternShare);

const clay: [number, number, number] = [201, 184, 160];

/** sRGB bytes to the linear numbers that three.js shades with. */
const linear = Float32Array.from({ length: 256 }, (_, i) => new THREE.Color().setRGB(i / 255, 0, 0, THREE.SRGBColorSpace).r);

export class DrawnObject {
  readonly group = new THREE.Group();
  readonly mesh: THREE.Mesh;
  readonly regions: (Uint32Array | undefined)[];
  /** Annotations whose type is line or point, by their index. */
  readonly marks = new Map<number, THREE.Object3D>();
  readonly pins = new THREE.Group();
  readonly chosen = new THREE.Group();
  /** The smallest visible region of each triangle; -1: none. */
  readonly top: Int32Array;
  cage: THREE.Object3D | undefined;
  private bvhMade: MeshBVH | undefined;
  private readonly normals: Float32Array;
  private readonly sets: ReturnType<typeof setsOf>;
  private readonly split: ReturnType<typeof splitVertices>;
  private other: Shape | undefined;

  constructor(
    readonly index: number,
    readonly about: PageObject,
    readonly shape: Shape,
    private readonly blobs: Blobs,
  ) {
    const { positions, triangles } = shape;
    this.regions = about.annotations.map((one) => (one.faces ? readRuns(blobs.get(one.faces.blob)) : undefined));
    this.sets = setsOf(triangles.length / 3, this.regions);
    this.split = splitVertices(positions.length / 3, triangles, this.sets.of);
    this.normals = normalsOf(positions, triangles);
    const geometry = new THREE.BufferGeometry();
    const count = this.split.source.length;
    geometry.setIndex(new THREE.BufferAttribute(this.split.index, 1));
    geometry.setAttribute("position", new THREE.BufferAttribute(gathered(positions, this.split.source), 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(gathered(this.normals, this.split.source), 3));
    geometry.setAttribute("otherPosition", geometry.getAttribute("position"));
    geometry.setAttribute("otherNormal", geometry.getAttribute("normal"));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * count), 3));
    geometry.setAttribute("pattern", new THREE.BufferAttribute(new Uint8Array(count), 1));
    this.mesh = new THREE.Mesh(geometry, surface);
    this.mesh.frustumCulled = false;
    this.top = new Int32Array(triangles.length / 3);
    this.group.add(this.mesh, this.pins, this.chosen);
    about.annotations.forEach((one, i) => {
      const mark = one.lines ? this.line(one.lines, one.colour) : one.points ? this.dots(one.points, one.colour) : undefined;
      if (!mark) return;
      this.marks.set(i, mark);
      this.group.add(mark);
    });
  }

  /** Made when it is first asked for: triangles keep their numbers. */
  get bvh(): MeshBVH {
    if (!this.bvhMade) {
      const indexed = new THREE.BufferGeometry();
      indexed.setAttribute("position", new THREE.BufferAttribute(this.shape.positions, 3));
      indexed.setIndex(new THREE.BufferAttribute(this.shape.triangles, 1));
      this.bvhMade = new MeshBVH(indexed, { indirect: true });
    }
    return this.bvhMade;
  }

  vertex(index: number): THREE.Vector3 {
    return new THREE.Vector3().fromArray(this.shape.positions, 3 * index);
  }

  private line(lines: number[][], colour: [number, number, number]): THREE.Object3D {
    const group = new THREE.Group();
    const material = new THREE.LineBasicMaterial({ color: new THREE.Color(...(colour.map((c) => linear[c]) as [number, number, number])) });
    const lift = this.lift();
    for (const one of lines) {
      const geometry = new THREE.BufferGeometry().setFromPoints(one.map((v) => this.vertex(v).addScaledVector(lift(v), 1)));
      group.add(new THREE.Line(geometry, material));
    }
    return group;
  }

  private dots(points: number[], colour: [number, number, number]): THREE.Object3D {
    const lift = this.lift();
    const geometry = new THREE.BufferGeometry().setFromPoints(points.map((v) => this.vertex(v).add(lift(v))));
    const material = new THREE.PointsMaterial({
      color: new THREE.Color(...(colour.map((c) => linear[c]) as [number, number, number])),
      size: 11,
      sizeAttenuation: false,
    });
    material.onBeforeCompile = (shader) => {
      shader.fragmentShader = shader.fragmentShader.replace(
        "#include <color_fragment>",
        "#include <color_fragment>\nif (length(gl_PointCoord - 0.5) > 0.5) discard;",
      );
    };
    return new THREE.Points(geometry, material);
  }

  /** A little away from the surface, so that lines and points are not half within it. */
  private lift(): (v: number) => THREE.Vector3 {
    const step = 0.002 * Math.hypot(...this.about.size);
    return (v) => new THREE.Vector3().fromArray(this.normals, 3 * v).multiplyScalar(step);
  }

  /** The shape that `blend` leads to; the same triangles. */
  blendTo(other: DrawnObject | undefined) {
    if (this.other === other?.shape) return;
    this.other = other?.shape;
    const geometry = this.mesh.geometry;
    const of = (values: Float32Array) => new THREE.BufferAttribute(gathered(values, this.split.source), 3);
    geometry.setAttribute("otherPosition", other ? of(other.shape.positions) : geometry.getAttribute("position"));
    geometry.setAttribute("otherNormal", other ? of(other.normals) : geometry.getAttribute("normal"));
  }

  /** Colours by annotations, those that are shown; smaller ones over larger ones. `chosen`: the others are paler. */
  paint(isShown: (annotation: number) => boolean, chosen = -1) {
    const { about, sets, split } = this;
    // Of each set the smallest region that is shown.
    const topOf = sets.members.map((regions) => {
      let best = -1;
      for (const i of regions) if (isShown(i) && (best < 0 || this.regions[i]!.length < this.regions[best]!.length)) best = i;
      return best;
    });
    for (let face = 0; face < this.top.length; ++face) this.top[face] = topOf[sets.of[face]];
    const selects = chosen >= 0 && this.regions[chosen] !== undefined;
    const table = sets.members.map((regions, set) => {
      const [own, pale] = selects && !regions.includes(chosen) ? [0.35, 0.4] : [1, 0];
      return (topOf[set] < 0 ? clay : about.annotations[topOf[set]].colour).map((c) => own * linear[c] + pale);
    });
    const colour = this.mesh.geometry.getAttribute("color") as THREE.BufferAttribute;
    const pattern = this.mesh.geometry.getAttribute("pattern") as THREE.BufferAttribute;
    const colours = colour.array as Float32Array;
    const patterns = pattern.array as Uint8Array;
    for (let i = 0; i < split.set.length; ++i) {
      const entry = table[split.set[i]];
      colours[3 * i] = entry[0];
      colours[3 * i + 1] = entry[1];
      colours[3 * i + 2] = entry[2];
      patterns[i] = topOf[split.set[i]] < 0 ? 0 : (topOf[split.set[i]] % 12) + 1;
    }
    colour.needsUpdate = true;
    pattern.needsUpdate = true;
    for (const [i, mark] of this.marks) mark.visible = isShown(i);
  }

  /** Colours by a map; what has no value is grey. */
  paintMap(map: number, colourOf: (share: number) => [number, number, number]) {
    const values = this.mapValues(map);
    const colour = this.mesh.geometry.getAttribute("color") as THREE.BufferAttribute;
    const pattern = this.mesh.geometry.getAttribute("pattern") as THREE.BufferAttribute;
    const colours = colour.array as Float32Array;
    const table = Array.from({ length: 256 }, (_, i) => colourOf(i / 255).map((c) => linear[c]));
    const { source } = this.split;
    const { minimum, maximum, from, to } = this.about.maps[map];
    const none = [0.5, 0.5, 0.5];
    const scale = (255 * (maximum - minimum)) / 65534 / (to - from || 1);
    const offset = (255 * (minimum - from)) / (to - from || 1);
    for (let i = 0; i < source.length; ++i) {
      const value = values[source[i]];
      const entry = value === 65535 ? none : table[Math.min(255, Math.max(0, Math.round(offset + scale * value)))];
      colours[3 * i] = entry[0];
      colours[3 * i + 1] = entry[1];
      colours[3 * i + 2] = entry[2];
    }
    (pattern.array as Uint8Array).fill(0);
    colour.needsUpdate = true;
    pattern.needsUpdate = true;
  }

  mapValues(map: number): Uint16Array {
    const bytes = this.blobs.get(this.about.maps[map].blob);
    return new Uint16Array(bytes.slice().buffer);
  }

  /** What a map says at a vertex; undefined: nothing. */
  mapValue(map: number, vertex: number): number | undefined {
    const { minimum, maximum } = this.about.maps[map];
    const step = this.mapValues(map)[vertex];
    return step === 65535 ? undefined : minimum + (step / 65534) * (maximum - minimum);
  }

  /** All shown regions on a triangle, the smallest first. */
  annotationsOn(face: number): number[] {
    const found: number[] = [];
    this.regions.forEach((faces, i) => {
      if (!faces) return;
      let low = 0;
      let high = faces.length;
      while (low < high) {
        const middle = (low + high) >> 1;
        if (faces[middle] < face) low = middle + 1;
        else high = middle;
      }
      if (faces[low] === face) found.push(i);
    });
    return found.sort((a, b) => this.regions[a]!.length - this.regions[b]!.length || a - b);
  }
}
