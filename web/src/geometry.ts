// Drawable objects: triangles with one colour each, regions, and lines and points on the surface.
import * as THREE from "three";
import { MeshoptDecoder } from "three/examples/jsm/libs/meshopt_decoder.module.js";
import { MeshBVH } from "three-mesh-bvh";
import { readRuns, type Blobs, type Colouring, type PageObject, type Slice } from "./data";
import { angleSign } from "./sizes";
import { kindsOf, rangesByMaterial, texturedMaterials, type Kinds, type ShapeLook, type ShapeTexture } from "./texture";

/** Vertices and triangles in the order of the object's file. */
export interface Shape {
  positions: Float32Array;
  triangles: Uint32Array;
  look?: ShapeLook;
}

/** Reads GLB files written by the command: one mesh with one primitive, all streams compressed. Vertices with texture coordinates are
 * returned too. */
export async function readShape(bytes: Uint8Array): Promise<Shape & { textured?: Pick<ShapeTexture, "vertices" | "places" | "corners"> }> {
  await MeshoptDecoder.ready;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const jsonSize = view.getUint32(12, true);
  const file = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + jsonSize)));
  const binary = 20 + jsonSize + 8;
  const primitive = file.meshes[0].primitives[0];
  const unpacked = (accessor: number) => {
    const packed = file.bufferViews[file.accessors[accessor].bufferView].extensions.EXT_meshopt_compression;
    const made = new Uint8Array(packed.count * packed.byteStride);
    const begin = binary + (packed.byteOffset ?? 0);
    MeshoptDecoder.decodeGltfBuffer(
      made,
      packed.count,
      packed.byteStride,
      bytes.subarray(begin, begin + packed.byteLength),
      packed.mode,
      packed.filter,
    );
    return { made, stride: packed.byteStride as number, count: packed.count as number };
  };
  const points = unpacked(primitive.attributes.POSITION);
  const steps = new Uint16Array(points.made.buffer);
  const scale: number[] = file.nodes[0].scale ?? [1, 1, 1];
  const moved: number[] = file.nodes[0].translation ?? [0, 0, 0];
  const packed = unpacked(primitive.indices);
  const corners = packed.stride === 2 ? Uint32Array.from(new Uint16Array(packed.made.buffer)) : new Uint32Array(packed.made.buffer);
  const origins = primitive.attributes._VERTEX;
  const vertices = origins === undefined ? undefined : new Uint32Array(unpacked(origins).made.buffer);
  let count = vertices ? 0 : points.count;
  if (vertices) for (let i = 0; i < vertices.length; ++i) if (vertices[i] >= count) count = vertices[i] + 1;
  const positions = new Float32Array(3 * count);
  for (let i = 0; i < points.count; ++i) {
    const at = 3 * (vertices ? vertices[i] : i);
    for (let k = 0; k < 3; ++k) positions[at + k] = moved[k] + scale[k] * steps[(i * points.stride) / 2 + k];
  }
  if (!vertices) return { positions, triangles: corners };
  const texture = unpacked(primitive.attributes.TEXCOORD_0).made.buffer;
  const inSteps = file.accessors[primitive.attributes.TEXCOORD_0].normalized === true;
  // Plain loops: before the browser has compiled them, callbacks take several times as long.
  const triangles = new Uint32Array(corners.length);
  for (let i = 0; i < corners.length; ++i) triangles[i] = vertices[corners[i]];
  const places = inSteps ? new Float32Array(texture.byteLength / 2) : new Float32Array(texture);
  if (inSteps) {
    const steps = new Uint16Array(texture);
    for (let i = 0; i < steps.length; ++i) places[i] = steps[i] / 65535;
  }
  return { positions, triangles, textured: { vertices, corners, places } };
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
    const length = Math.sqrt(normals[i] ** 2 + normals[i + 1] ** 2 + normals[i + 2] ** 2) || 1;
    normals[i] /= length;
    normals[i + 1] /= length;
    normals[i + 2] /= length;
  }
  return normals;
}

/** The entries of `values` (three per vertex) for these vertices. */
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

/** Groups triangles by the set of regions that contain them: a set number per triangle, and the regions of each set. */
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

/** What is computed of a shape once, also when objects are made of it again: normals, and the hierarchy of boxes by which places are picked. */
class Rest {
  private hierarchy: MeshBVH | undefined;
  readonly normals: Float32Array;
  constructor(private readonly shape: Shape) {
    this.normals = normalsOf(shape.positions, shape.triangles);
  }
  get bvh(): MeshBVH {
    this.hierarchy ??= hierarchyOf(this.shape.positions, this.shape.triangles);
    return this.hierarchy;
  }
}
const rests = new WeakMap<Float32Array, Rest>();
function restOf(shape: Shape): Rest {
  const rest = rests.get(shape.positions) ?? new Rest(shape);
  rests.set(shape.positions, rest);
  return rest;
}

function hierarchyOf(positions: Float32Array, triangles: Uint32Array): MeshBVH {
  const indexed = new THREE.BufferGeometry();
  indexed.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  indexed.setIndex(new THREE.BufferAttribute(triangles, 1));
  return new MeshBVH(indexed, { indirect: true });
}

/** Duplicates vertices so that each one has one colour: one per vertex and kind of triangle that meets there. */
function splitVertices(
  vertices: number,
  triangles: Uint32Array,
  kinds: Uint32Array,
): { source: Uint32Array; kind: Uint32Array; index: Uint32Array } {
  const first = new Int32Array(vertices).fill(-1);
  const source: number[] = [];
  const kind: number[] = [];
  const next: number[] = [];
  const index = new Uint32Array(triangles.length);
  for (let i = 0; i < triangles.length; ++i) {
    const v = triangles[i];
    const wanted = kinds[(i / 3) | 0];
    let at = first[v];
    while (at >= 0 && kind[at] !== wanted) at = next[at];
    if (at < 0) {
      at = source.push(v) - 1;
      kind.push(wanted);
      next.push(first[v]);
      first[v] = at;
    }
    index[i] = at;
  }
  return { source: Uint32Array.from(source), kind: Uint32Array.from(kind), index };
}

/** Uniforms shared by all materials. */
export const shared = {
  blend: { value: 0 },
  explode: { value: 0 },
  patterns: { value: 0 },
  /** 1: colours without light and shade. */
  flatLight: { value: 0 },
  /** Unit vector towards the lamp, in the frame of the camera. */
  lamp: { value: new THREE.Vector3(0.263, 0.473, 0.841) },
  /** How much ridges are brightened and hollows darkened. */
  relief: { value: 0 },
  clip: { value: new THREE.Vector4(0, 0, 0, 1) },
  /** While handles follow one affine map x -> A x + t: A - I, and t. */
  bend: { value: new THREE.Matrix3().set(0, 0, 0, 0, 0, 0, 0, 0, 0) },
  shift: { value: new THREE.Vector3() },
};

const clipping = `
uniform vec4 clip;
in vec3 place;
`;

/** A custom shader, which compiles much faster than those of the library. Colours are sRGB; light is added to their squares, which
 * approximates linear light. */
const surface = new THREE.RawShaderMaterial({
  glslVersion: THREE.GLSL3,
  side: THREE.DoubleSide,
  uniforms: shared,
  vertexShader: `
    precision highp float;
    uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
    uniform float blend, explode;
    uniform mat3 bend;
    uniform vec3 shift;
    in vec3 position, normal, otherPosition, otherNormal, apart;
    in vec4 color;
    #ifdef IMAGE
    in vec2 uv;
    out vec2 at;
    #endif
    in vec4 drag; // where there is none it is 0, 0, 0, 1
    in float pattern;
    out vec3 place, facing;
    out vec4 tint;
    flat out float kind;
    void main() {
      #ifdef IMAGE
      at = vec2(uv.x, 1.0 - uv.y);
      #endif
      vec3 moved = mix(position, otherPosition, blend) + explode * apart + bend * drag.xyz + (drag.w - 1.0) * shift;
      vec4 world = modelMatrix * vec4(moved, 1.0);
      place = world.xyz;
      facing = mat3(viewMatrix) * mat3(modelMatrix) * mix(normal, otherNormal, blend);
      tint = color;
      kind = pattern;
      gl_Position = projectionMatrix * viewMatrix * world;
    }`,
  fragmentShader: `
    precision highp float;
    ${clipping}
    uniform float patterns, flatLight, relief;
    uniform vec3 lamp;
    in vec3 facing;
    in vec4 tint; // with a texture: the colour that multiplies it, or the colour that covers it in part
    flat in float kind;
    out vec4 pixel;
    #ifdef TEXTURED
    uniform vec4 factor;
    uniform float cutoff;
    #ifdef IMAGE
    uniform sampler2D image;
    in vec2 at;
    #endif
    // sRGB, IEC 61966-2-1
    vec3 coded(vec3 c) { return mix(12.92 * c, 1.055 * pow(max(c, 1e-6), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }
    vec3 linear(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c)); }
    #endif
    void main() {
      if (dot(vec4(place, 1.0), clip) < 0.0) discard;
      vec3 n = normalize(facing + 1e-12);
      if (!gl_FrontFacing) n = -n;
      vec3 shown = tint.rgb;
      #ifdef TEXTURED
      vec4 texel = factor;
      #ifdef IMAGE
      texel *= texture(image, at);
      #endif
      if (texel.a < cutoff) discard;
      shown = tint.a > 0.0 ? mix(coded(min(texel.rgb, 1.0)), tint.rgb, tint.a) : coded(min(texel.rgb * linear(tint.rgb), 1.0));
      #endif
      vec3 colour = shown * shown;
      if (patterns > 0.5 && kind > 0.5) {
        vec2 at = gl_FragCoord.xy;
        float form = mod(kind - 1.0, 6.0), period = 9.0 + 3.0 * floor((kind - 1.0) / 6.0);
        float along = form < 0.5 ? at.x + at.y : form < 1.5 ? at.x - at.y : form < 2.5 ? at.x : at.y;
        bool mark = form < 3.5 ? mod(along, period) < 1.5
                  : form < 4.5 ? min(mod(at.x, period), mod(at.y, period)) < 1.2
                  : length(mod(at, period) - 0.5 * period) < 1.8;
        if (mark) colour *= 0.45;
      }
      // A low lamp (raking light) leaves less light from around, so that its shades are deep.
      float low = clamp(1.0 - lamp.z / 0.841, 0.0, 1.0);
      float light = 0.36 - 0.28 * low + 0.1 * n.y + (0.72 + 0.4 * low) * max(0.0, dot(n, lamp));
      if (relief > 0.0) {
        // How fast the normal turns across the picture: positive on ridges, negative in hollows.
        float turn = dFdx(n.x) + dFdy(n.y);
        light *= clamp(1.0 + relief * 10.0 * turn, 1.0 - 0.75 * relief, 1.0 + 0.75 * relief);
      }
      light = mix(light, 1.0, flatLight);
      pixel = vec4(sqrt(min(vec3(1.0), colour * light)), 1.0);
    }`,
});

/** Material for lines, points and bands of one colour; an opacity below 1 lets the shaded surface below show through. */
export function flatMaterial(colour: [number, number, number], dot = 0, through = false, opacity = 1): THREE.RawShaderMaterial {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    side: THREE.DoubleSide,
    depthTest: !through,
    depthWrite: opacity === 1,
    transparent: opacity < 1,
    uniforms: {
      clip: shared.clip,
      colour: { value: new THREE.Vector3(...colour).divideScalar(255) },
      size: { value: dot },
      opacity: { value: opacity },
    },
    vertexShader: `
      precision highp float;
      uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
      uniform float size;
      in vec3 position;
      out vec3 place;
      void main() {
        vec4 at = modelMatrix * vec4(position, 1.0);
        place = at.xyz;
        gl_Position = projectionMatrix * viewMatrix * at;
        gl_PointSize = size;
      }`,
    fragmentShader: `
      precision highp float;
      ${clipping}
      uniform vec3 colour;
      uniform float size, opacity;
      out vec4 pixel;
      void main() {
        if (dot(vec4(place, 1.0), clip) < 0.0) discard;
        if (size > 0.0 && length(gl_PointCoord - 0.5) > 0.5) discard;
        pixel = vec4(colour, opacity);
      }`,
  });
}

/** Material for points with individual colours. */
export function dotMaterial(size: number): THREE.RawShaderMaterial {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    uniforms: { clip: shared.clip, size: { value: size } },
    vertexShader: `
      precision highp float;
      uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
      uniform float size;
      in vec3 position, color;
      out vec3 place, tint;
      void main() {
        vec4 at = modelMatrix * vec4(position, 1.0);
        place = at.xyz;
        tint = color;
        gl_Position = projectionMatrix * viewMatrix * at;
        gl_PointSize = size;
      }`,
    fragmentShader: `
      precision highp float;
      ${clipping}
      in vec3 tint;
      out vec4 pixel;
      void main() {
        if (dot(vec4(place, 1.0), clip) < 0.0 || length(gl_PointCoord - 0.5) > 0.5) discard;
        pixel = vec4(tint, 1.0);
      }`,
  });
}

const clay: [number, number, number] = [201, 184, 160];
/** How far the colour of the selected region covers a texture or own colours. */
const covering = 0.5;

/** Contours of a plane as bands, so that they are wide enough from every direction. */
function bandsOf(slice: Slice, points: Float32Array, begin: number, half: number): THREE.BufferGeometry {
  const [origin, u, v] = [slice.origin, slice.u, slice.v].map((x) => new THREE.Vector3(...x));
  const normal = u.clone().cross(v).normalize();
  const corners: number[] = [];
  const at = (i: number) =>
    origin
      .clone()
      .addScaledVector(u, points[2 * i])
      .addScaledVector(v, points[2 * i + 1]);
  const band = (a: THREE.Vector3, b: THREE.Vector3, across: THREE.Vector3) => {
    const [p, q, r, s] = [a.clone().sub(across), a.clone().add(across), b.clone().add(across), b.clone().sub(across)];
    for (const one of [p, q, r, p, r, s]) corners.push(one.x, one.y, one.z);
  };
  let first = begin;
  for (const contour of slice.contours) {
    const last = contour.closed ? contour.points : contour.points - 1;
    for (let i = 0; i < last; ++i) {
      const a = at(first + i);
      const b = at(first + ((i + 1) % contour.points));
      band(a, b, normal.clone().multiplyScalar(half));
      band(a, b, b.clone().sub(a).cross(normal).setLength(half));
    }
    first += contour.points;
  }
  return new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(Float32Array.from(corners), 3));
}

const cut = flatMaterial([194, 24, 91], 0, true);

export class DrawnObject {
  readonly group = new THREE.Group();
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.Material | THREE.Material[]>;
  readonly regions: (Uint32Array | undefined)[];
  /** Annotations of type line or point, by index. */
  readonly marks = new Map<number, THREE.Object3D>();
  readonly pins = new THREE.Group();
  readonly chosen = new THREE.Group();
  /** The smallest visible region of each triangle; -1: none. */
  readonly top: Int32Array;
  cage: THREE.Object3D | undefined;
  /** Current vertex positions, including blending and moving apart. */
  private readonly current: Float32Array;
  /** Displacement of each vertex when the parts are moved apart; undefined: there are no parts. */
  private readonly apart: Float32Array | undefined;
  private moved = { blend: 0, explode: 0 };
  private slice: THREE.Mesh | undefined;
  /** Of the moved vertices. */
  private bvhMade: MeshBVH | undefined;
  /** Whether vertices are no longer where the shape has them. */
  private isMoved = false;
  private readonly normals: Float32Array;
  private readonly sets: ReturnType<typeof setsOf>;
  private readonly kinds: Kinds;
  /** For each drawn vertex: the vertex of the object, and the combination of region set, material and colour around it. */
  private readonly split: { source: Uint32Array; kind: Uint32Array };
  /** Materials by which the surface shows its texture; the first is for triangles without a material. */
  private readonly textured: THREE.RawShaderMaterial[] | undefined;
  /** Vertex positions of the object that this one is blended into. */
  private other: Float32Array | undefined;
  private partner: DrawnObject | undefined;

  constructor(
    readonly index: number,
    readonly about: PageObject,
    readonly shape: Shape,
    private readonly blobs: Blobs,
  ) {
    const { positions, triangles } = shape;
    this.regions = about.annotations.map((one) => (one.faces ? readRuns(blobs.get(one.faces.blob)) : undefined));
    this.sets = setsOf(triangles.length / 3, this.regions);
    const texture = shape.look?.texture;
    this.kinds = kindsOf(this.sets.of, shape.look);
    const split = splitVertices(texture ? texture.vertices.length : positions.length / 3, texture?.corners ?? triangles, this.kinds.of);
    this.split = { source: split.source, kind: split.kind };
    if (texture) {
      this.split.source = new Uint32Array(split.source.length);
      for (let i = 0; i < split.source.length; ++i) this.split.source[i] = texture.vertices[split.source[i]];
    }
    this.normals = restOf(shape).normals;
    const geometry = new THREE.BufferGeometry();
    const count = this.split.source.length;
    if (texture) {
      const places = new Float32Array(2 * count);
      for (let i = 0; i < count; ++i) {
        places[2 * i] = texture.places[2 * split.source[i]];
        places[2 * i + 1] = texture.places[2 * split.source[i] + 1];
      }
      geometry.setAttribute("uv", new THREE.BufferAttribute(places, 2));
      const { index, ranges } = rangesByMaterial(split.index, texture);
      geometry.setIndex(new THREE.BufferAttribute(index, 1));
      for (const one of ranges) geometry.addGroup(one.start, one.count, one.material);
      this.textured = [surface, ...texturedMaterials(texture, surface)];
    } else geometry.setIndex(new THREE.BufferAttribute(split.index, 1));
    geometry.setAttribute("position", new THREE.BufferAttribute(gathered(positions, this.split.source), 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(gathered(this.normals, this.split.source), 3));
    geometry.setAttribute("otherPosition", geometry.getAttribute("position"));
    geometry.setAttribute("otherNormal", geometry.getAttribute("normal"));
    this.current = positions.slice();
    this.apart = this.partMoves();
    if (this.apart) geometry.setAttribute("apart", new THREE.BufferAttribute(gathered(this.apart, this.split.source), 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Uint8Array(4 * count), 4, true));
    geometry.setAttribute("pattern", new THREE.BufferAttribute(new Uint8Array(count), 1));
    this.mesh = new THREE.Mesh(geometry, surface);
    this.mesh.frustumCulled = false;
    this.top = new Int32Array(triangles.length / 3);
    this.group.add(this.mesh, this.pins, this.chosen);
    about.annotations.forEach((one, i) => {
      const mark = one.curves
        ? this.curves(one.curves, one.colour, one.type)
        : one.lines
          ? this.line(one.lines, one.colour)
          : one.points
            ? this.dots(one.points, one.colour)
            : undefined;
      if (!mark) return;
      this.marks.set(i, mark);
      this.group.add(mark);
    });
  }

  /** Built on first use; triangles keep their numbers. */
  get bvh(): MeshBVH {
    if (!this.isMoved) return restOf(this.shape).bvh;
    this.bvhMade ??= hierarchyOf(this.current, this.shape.triangles);
    return this.bvhMade;
  }

  /** Current position of a vertex. */
  vertex(index: number): THREE.Vector3 {
    return new THREE.Vector3().fromArray(this.current, 3 * index);
  }

  /** Displacements from the common centre to the centre of each part. */
  private partMoves(): Float32Array | undefined {
    const { parts } = this.about;
    if (!parts) return undefined;
    const { positions, triangles } = this.shape;
    const moves = new Float32Array(positions.length);
    const middle = new THREE.Vector3(...this.about.size).multiplyScalar(0.5);
    for (const part of parts) {
      const sum = new THREE.Vector3();
      const corners = [...this.regions[part]!].flatMap((f) => [triangles[3 * f], triangles[3 * f + 1], triangles[3 * f + 2]]);
      for (const v of corners) sum.add(new THREE.Vector3().fromArray(positions, 3 * v));
      sum.divideScalar(corners.length || 1).sub(middle);
      for (const v of corners) sum.toArray(moves, 3 * v);
    }
    return moves;
  }

  /** Sets blending and separation; later position queries refer to the shape displayed then. */
  moveTo(blend: number, explode: number) {
    const wanted = { blend: this.other ? blend : 0, explode: this.apart ? explode : 0 };
    if (wanted.blend === this.moved.blend && wanted.explode === this.moved.explode) return false;
    this.moved = wanted;
    const { positions } = this.shape;
    for (let i = 0; i < positions.length; ++i) {
      let x = positions[i];
      if (wanted.blend > 0) x += wanted.blend * (this.other![i] - x);
      if (wanted.explode > 0) x += wanted.explode * this.apart![i];
      this.current[i] = x;
    }
    this.isMoved = true;
    this.bvhMade?.refit();
    return true;
  }

  /** Shows the contours of a level of the slices; undefined: none. */
  showSlice(level: number | undefined) {
    if (this.slice) {
      this.slice.geometry.dispose();
      this.group.remove(this.slice);
      this.slice = undefined;
    }
    const { slices } = this.about;
    if (!slices || level === undefined || !slices.levels[level]) return;
    this.slice = new THREE.Mesh(
      bandsOf(slices.levels[level], this.slicePoints(), this.firstPoint(level), 0.0025 * Math.hypot(...this.about.size)),
      cut,
    );
    this.slice.frustumCulled = false;
    this.slice.renderOrder = 1;
    this.group.add(this.slice);
  }

  /** Coordinates along u and v of all contours of all levels. */
  slicePoints(): Float32Array {
    return new Float32Array(this.blobs.get(this.about.slices!.blob).slice().buffer);
  }

  firstPoint(level: number): number {
    return this.about.slices!.levels.slice(0, level).reduce((sum, one) => sum + one.contours.reduce((n, c) => n + c.points, 0), 0);
  }

  dispose() {
    this.group.traverse((one) => (one as THREE.Mesh).geometry?.dispose());
  }

  private line(lines: number[][], colour: [number, number, number]): THREE.Object3D {
    const group = new THREE.Group();
    const material = flatMaterial(colour);
    const lift = this.lift();
    for (const one of lines) {
      const geometry = new THREE.BufferGeometry().setFromPoints(one.map((v) => this.vertex(v).addScaledVector(lift(v), 1)));
      group.add(new THREE.Line(geometry, material));
    }
    return group;
  }

  /** Draws curves inside triangles, darker than their region so that they are visible on it. */
  private curves(curves: [number, number, number][][], colour: [number, number, number], type: string): THREE.Object3D {
    if (type === "point") {
      const geometry = new THREE.BufferGeometry().setFromPoints(curves.map(([p]) => new THREE.Vector3(...p)));
      return new THREE.Points(geometry, flatMaterial(colour, 11));
    }
    const group = new THREE.Group();
    const material = flatMaterial(type === "region" ? (colour.map((x) => Math.round(0.5 * x)) as [number, number, number]) : colour);
    for (const one of curves)
      group.add(new THREE.Line(new THREE.BufferGeometry().setFromPoints(one.map((p) => new THREE.Vector3(...p))), material));
    return group;
  }

  private dots(points: number[], colour: [number, number, number]): THREE.Object3D {
    const lift = this.lift();
    const geometry = new THREE.BufferGeometry().setFromPoints(points.map((v) => this.vertex(v).add(lift(v))));
    const material = flatMaterial(colour, 11);
    return new THREE.Points(geometry, material);
  }

  /** Offsets points slightly from the surface, so that lines and points are not half hidden. */
  private lift(): (v: number) => THREE.Vector3 {
    const step = 0.002 * Math.hypot(...this.about.size);
    return (v) => new THREE.Vector3().fromArray(this.normals, 3 * v).multiplyScalar(step);
  }

  /** Sets the shape to blend into, which has the same triangles. */
  blendTo(other: DrawnObject | undefined) {
    if (this.partner === other) return;
    this.partner = other;
    // Positions are relative to the box of their own object.
    const apart = other ? other.about.origin.map((x, k) => x - this.about.origin[k]) : [0, 0, 0];
    this.other = other?.shape.positions.map((x, i) => x + apart[i % 3]);
    const geometry = this.mesh.geometry;
    const of = (values: Float32Array) => new THREE.BufferAttribute(gathered(values, this.split.source), 3);
    geometry.setAttribute("otherPosition", this.other ? of(this.other) : geometry.getAttribute("position"));
    geometry.setAttribute("otherNormal", other ? of(other.normals) : geometry.getAttribute("normal"));
  }

  /** Sets how much each vertex follows the dragged handles: four numbers per vertex, or none. */
  follows(weights: Float32Array | undefined) {
    const { geometry } = this.mesh;
    if (!weights) {
      geometry.deleteAttribute("drag");
      return;
    }
    const made = new Float32Array(4 * this.split.source.length);
    this.split.source.forEach((v, i) => {
      for (let k = 0; k < 4; ++k) made[4 * i + k] = weights[4 * v + k] + (k === 3 ? 1 : 0);
    });
    geometry.setAttribute("drag", new THREE.BufferAttribute(made, 4));
  }

  /** Sets temporary vertex positions, until the object is displayed again. */
  moveVertices(positions: Float32Array) {
    const attribute = this.mesh.geometry.getAttribute("position") as THREE.BufferAttribute;
    const places = attribute.array as Float32Array;
    this.split.source.forEach((v, i) => {
      places[3 * i] = positions[3 * v];
      places[3 * i + 1] = positions[3 * v + 1];
      places[3 * i + 2] = positions[3 * v + 2];
    });
    attribute.needsUpdate = true;
    this.current.set(positions);
    this.isMoved = true;
    this.bvhMade?.refit();
  }

  private cloud: THREE.Points | undefined;
  /** Sets the style: surface, edges or vertices. */
  style(kind: "surface" | "edges" | "points") {
    for (const one of [surface, ...(this.textured ?? [])]) one.wireframe = kind === "edges";
    this.mesh.visible = kind !== "points";
    if (kind === "points" && !this.cloud) {
      const places = new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(this.current, 3));
      this.cloud = new THREE.Points(places, flatMaterial([90, 80, 70], 2));
      this.cloud.frustumCulled = false;
      this.group.add(this.cloud);
    }
    if (this.cloud) this.cloud.visible = kind === "points";
  }

  /** Colourings that the object has, in the order of preference; annotations without regions look like clay. */
  get colourings(): Colouring[] {
    const { look } = this.shape;
    const list: Colouring[] = [];
    if (look?.texture) list.push("texture");
    if (look?.vertexColours ?? look?.faceColours) list.push("own");
    if (this.about.annotations.length > 0) list.push("annotations");
    return [...list, "clay"];
  }

  /** Whether there are annotations of parts, not only of the whole object. */
  private get hasParts(): boolean {
    const all = this.shape.triangles.length / 3;
    return this.about.annotations.some((one) => (one.faces ? one.faces.count < all : !one.tag.startsWith(angleSign)));
  }

  /** Whether a region only holds the measures of the whole object: grey all over, it would hide the object's own colours. */
  private isBare(annotation: number): boolean {
    const { faces, colour } = this.about.annotations[annotation];
    return faces !== undefined && faces.count === this.top.length && colour.every((c) => c === 190);
  }

  /** The colouring shown for a wanted one; "auto": annotations of parts if there are any, otherwise texture or own colours. */
  colouring(wanted: Colouring | "auto"): Colouring {
    const { colourings } = this;
    const first = wanted === "auto" && this.about.colouring !== "values" ? this.about.colouring : wanted;
    if (first && first !== "auto" && colourings.includes(first)) return first;
    return this.hasParts && colourings.includes("annotations") ? "annotations" : colourings[0];
  }

  /** Writes the colour of each drawn vertex, and shows the texture or not. `colour` writes red, green, blue and, with a texture, how far
   * they cover it, all 0 to 255, to `to` for the drawn vertex i. */
  private recolour(withTexture: boolean, colour: (i: number, to: Uint8Array) => void, pattern?: (i: number) => number) {
    const { geometry } = this.mesh;
    const [colours, patterns] = ["color", "pattern"].map((name) => geometry.getAttribute(name) as THREE.BufferAttribute);
    const to = new Uint8Array(4);
    for (let i = 0; i < this.split.source.length; ++i) {
      to[3] = 255;
      colour(i, to);
      (colours.array as Uint8Array).set(to, 4 * i);
      (patterns.array as Uint8Array)[i] = pattern ? pattern(i) : 0;
    }
    colours.needsUpdate = true;
    patterns.needsUpdate = true;
    this.mesh.material = withTexture && this.textured ? this.textured : surface;
  }

  /** Colours by one number per vertex, from 0 (clay colour) to 1 (red). */
  paintValues(values: Float32Array) {
    this.recolour(false, (i, to) => {
      const share = Math.min(1, Math.max(0, values[this.split.source[i]]));
      [214, 40, 40].forEach((c, k) => (to[k] = clay[k] + share * (c - clay[k])));
    });
  }

  /** Colours by the visible annotations, smaller ones over larger ones, or by texture or own colours, on which only the selected region is
   * marked. `chosen`: the others are paler. */
  paint(isShown: (annotation: number) => boolean, chosen = -1, colouring: Colouring = "annotations") {
    const { about, sets, kinds, split } = this;
    // For each set the smallest visible region.
    const topOf = sets.members.map((regions) => {
      let best = -1;
      for (const i of regions) if (isShown(i) && (best < 0 || this.regions[i]!.length < this.regions[best]!.length)) best = i;
      return best;
    });
    for (let face = 0; face < this.top.length; ++face) this.top[face] = topOf[sets.of[face]];
    const selects = chosen >= 0 && this.regions[chosen] !== undefined;
    if (colouring === "annotations") {
      const table = sets.members.map((regions, set) => {
        const [own, pale] = selects && !regions.includes(chosen) ? [0.35, 160] : [1, 0];
        const bare = topOf[set] < 0 || (this.isBare(topOf[set]) && topOf[set] !== chosen);
        return (bare ? clay : about.annotations[topOf[set]].colour).map((c) => own * c + pale);
      });
      this.recolour(
        false,
        (i, to) => to.set(table[kinds.set[split.kind[i]]]),
        (i) => {
          const top = topOf[kinds.set[split.kind[i]]];
          return top < 0 ? 0 : (top % 12) + 1;
        },
      );
    } else {
      const marked = sets.members.map((regions) => selects && isShown(chosen) && regions.includes(chosen));
      this.paintLook(colouring, marked, selects ? about.annotations[chosen].colour : clay);
    }
    for (const [i, mark] of this.marks) mark.visible = isShown(i);
  }

  /** Colours by texture, own colours or clay, covered in part by `cover` on the marked sets of regions. */
  private paintLook(colouring: Colouring, marked: boolean[], cover: [number, number, number]) {
    const { kinds, split } = this;
    const { vertexColours, faceColours, texture } = this.shape.look ?? {};
    this.recolour(colouring === "texture", (i, to) => {
      const kind = split.kind[i];
      const isTextured = colouring === "texture" && texture !== undefined && kinds.material[kind] >= 0;
      if (isTextured && marked[kinds.set[kind]]) {
        to.set(cover);
        to[3] = 255 * covering;
        return;
      }
      if (isTextured) {
        to.fill(255);
        to[3] = 0; // multiplies
      } else to.set(clay);
      if (colouring !== "clay") {
        if (faceColours) to.set(faceColours.subarray(3 * kinds.triangle[kind], 3 * kinds.triangle[kind] + 3));
        else if (vertexColours) to.set(vertexColours.subarray(3 * split.source[i], 3 * split.source[i] + 3));
      }
      if (marked[kinds.set[kind]]) for (let k = 0; k < 3; ++k) to[k] += covering * (cover[k] - to[k]);
    });
  }

  /** Colours by a map; grey without a value. */
  paintMap(map: number, colourOf: (share: number) => [number, number, number]) {
    const values = this.mapValues(map);
    const { source } = this.split;
    const { minimum, maximum, from, to, categories } = this.about.maps[map];
    const none = [128, 128, 128];
    // For categories a step is an index into the list.
    const table = categories ? categories.map((c) => c.colour) : Array.from({ length: 256 }, (_, i) => colourOf(i / 255));
    const scale = categories ? 1 : (255 * (maximum - minimum)) / 65534 / (to - from || 1);
    const offset = categories ? 0 : (255 * (minimum - from)) / (to - from || 1);
    this.recolour(false, (i, colour) => {
      const value = values[source[i]];
      colour.set(value === 65535 ? none : table[Math.min(table.length - 1, Math.max(0, Math.round(offset + scale * value)))]);
    });
  }

  mapValues(map: number): Uint16Array {
    const bytes = this.blobs.get(this.about.maps[map].blob);
    return new Uint16Array(bytes.slice().buffer);
  }

  /** Value of a map at a vertex: a number or the name of a category; undefined: no value. */
  mapValue(map: number, vertex: number): number | string | undefined {
    const { minimum, maximum, categories } = this.about.maps[map];
    const step = this.mapValues(map)[vertex];
    if (step === 65535) return undefined;
    return categories ? categories[step].text : minimum + (step / 65534) * (maximum - minimum);
  }

  /** All visible regions on a triangle, the smallest first. */
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
