// What the command writes into the page (doc/report.md, "The page's data").

export type Language = "en" | "de" | "it";

export interface Measure {
  name: string;
  tool: string;
  value: number | null;
  unit: string;
  uncertainty?: number;
  stale?: boolean;
  /** Pins, in the object's coordinates minus `origin`. */
  pins: [number, number, number][];
  /** For a tape along edges: its path. */
  way?: [number, number, number][];
}

export interface Attribute {
  name: string;
  text: string;
}

export interface Annotation {
  id: number;
  tag: string;
  type: "region" | "line" | "point";
  colour: [number, number, number];
  note?: string;
  /** Index in `annotations` of the smallest annotation that contains it; -1: none. */
  parent: number;
  attributes: Attribute[];
  measures: Measure[];
  /** For regions: number of triangles, and the blob that lists them. */
  faces?: { count: number; blob: number };
  /** For lines and points: vertices of the displayed mesh. */
  lines?: number[][];
  points?: number[];
  /** For curves inside triangles: points slightly above the surface, relative to the object's box. */
  curves?: [number, number, number][][];
}

/** One number per vertex, in 16-bit steps between `minimum` and `maximum`; 65535: no value. */
export interface ValueMap {
  name: string;
  label: string;
  blob: number;
  minimum: number;
  maximum: number;
  /** Range of the colours and the histogram; values outside it get the colour of the nearest end. */
  from: number;
  to: number;
  /** At equal steps from `from` to `to`; the same colours as in the command's pictures. */
  colours: [number, number, number][];
  histogram: number[];
  /** If present, the steps are indices into this list of names. `histogram` has one entry per category. */
  categories?: { text: string; colour: [number, number, number] }[];
}

/** A planar section of an object. */
export interface Slice {
  height: number;
  /** The plane's frame, in the object's coordinates minus `origin`. */
  origin: [number, number, number];
  u: [number, number, number];
  v: [number, number, number];
  /** In the order of `Slices.columns`. */
  values: (number | null)[];
  /** Their points are stored consecutively in `Slices.blob`. */
  contours: { points: number; closed: boolean; hole: boolean }[];
}

export interface Slices {
  unit: string;
  columns: { name: string; title: string; unit: string }[];
  /** By ascending height. */
  levels: Slice[];
  /** Coordinates along u and v: two 32-bit floats per point of all contours of all levels. */
  blob: number;
  /** Range of heights in which the object is tubular. */
  tube?: [number, number];
}

/** Result of a constraint in a deformation. */
export interface Constraint {
  type: string;
  /** Indices in `annotations`. */
  members: number[];
  weight: number;
  hard: boolean;
  /** Verdicts before and after as text, and whether the constraint is satisfied after; undefined: unknown. */
  before: string;
  verdict: string;
  holds?: boolean;
  text: string;
  deviations: { quantity: string; before: number | null; value: number | null; tolerance: number | null; unit: string }[];
  /** From the solver: distance of the points from their projections onto the constraint. */
  residual?: { mean: number; largest: number };
}

/** A material: linear red, green, blue and opacity, multiplied by an image. */
export interface SurfaceMaterial {
  colour: [number, number, number, number];
  /** Index in `Look.images`. */
  image?: number;
  wrap?: ["repeat" | "clamp" | "mirror", "repeat" | "clamp" | "mirror"];
  nearest?: boolean;
  /** Opacity below which nothing is drawn. */
  cutoff?: number;
  /** Shown without light and shade. */
  unlit?: boolean;
  /** Blob that lists the triangles; undefined: all. */
  faces?: number;
}

/** An image file; `preview`: a small one for the first picture. */
export interface PageImage {
  blob: number;
  type: string;
  width: number;
  height: number;
  preview?: { blob: number; type: string };
}

/** The texture of a shape. Texture coordinates are in the packed geometry, or for exact shapes in blobs: textured vertices (index of the
 * vertex; u and v), and the textured vertex of each corner. */
export interface Look {
  materials: SurfaceMaterial[];
  images: PageImage[];
  vertices?: number;
  places?: number;
  corners?: number;
}

/** Blob with red, green, blue of each vertex, or of each triangle. */
export interface OwnColours {
  vertices?: number;
  faces?: number;
}

/** What colours the surface, where no map does. */
export type Colouring = "texture" | "own" | "annotations" | "clay";

/** A shape: packed in a blob, or exact (32-bit floats relative to the box, triangles); it may have been sent before. */
export interface Shown {
  geometry?: number;
  shape?: { key: string; positions?: number; triangles?: number; colours?: OwnColours; texture?: Look };
  /** Of packed shapes. */
  colours?: OwnColours;
  texture?: Look;
}

export interface PageObject extends Shown {
  name: string;
  unit: string;
  /** Numbers of vertices and triangles of the object, and of the displayed mesh if that is simplified. */
  vertices: number;
  faces: number;
  simplified?: { vertices: number; deviation: number };
  origin: [number, number, number];
  size: [number, number, number];
  up: [number, number, number];
  annotations: Annotation[];
  /** Colours shown first; undefined: annotations of parts if there are any, otherwise texture or own colours. */
  colouring?: Colouring | "values";
  maps: ValueMap[];
  cage?: Shown & { vertices: number; origin: [number, number, number] };
  /** Rows of the drawing of relationships: each annotation below the one that contains it. */
  tree: { annotation: number; depth: number }[];
  relations: Relation[];
  constraints?: Constraint[];
  /** Results of 'relation check': rules of the class, relations, constraints, canons (proportions). */
  conformance?: { kind: "rule" | "relation" | "constraint" | "canon"; name: string; members: number[]; holds?: boolean; text: string }[];
  /** Sets of constraints that cannot be satisfied together, as text. */
  conflicts?: string[];
  slices?: Slices;
  /** Indices in `annotations` of the parts that a slider moves apart (fragments of an assembly). */
  parts?: number[];
  /** Objects with the same number have the same triangles and can be blended into each other. */
  blend?: number;
}

export interface Relation {
  id: number;
  type: string;
  /** Indices in `annotations`. */
  members: number[];
  directed: boolean;
  constraint: boolean;
  weight: number;
  holds?: boolean;
  text: string;
  /** Column beside the tree, from inside; undefined: expressed by the tree itself. */
  lane?: number;
}

export interface Column {
  title: string;
  numeric: boolean;
}

export interface Table {
  name: string;
  title: string;
  note: string;
  columns: Column[];
  rows: (string | number | null)[][];
  /** For each row the index of its object and of its annotation (-1: none). */
  objects?: number[];
  annotations?: number[];
}

/** A drawing made by the command: an SVG shown as an image, so that its scripts cannot run. */
export interface Drawing {
  title: string;
  blob: number;
}

/** An object of a collection, read on demand. */
export interface Entry {
  name: string;
  /** Beside the page: a script that calls `ostrakaObject(file, data, bytes)` with the page of this object. */
  file: string;
  /** Beside the page: a PNG. */
  thumbnail: string;
  vertices: number;
  faces: number;
  tags: string[];
}

export interface PageData {
  version: number;
  /** For a collection: `objects` is empty, and table rows refer to indices of this list. */
  collection?: Entry[];
  title: string;
  notes: string[];
  provenance: string;
  objects: PageObject[];
  tables: Table[];
  drawings: Drawing[];
  blobs: [number, number][];
}

/** Binary data of the page: deflated and base64-encoded. */
export class Blobs {
  constructor(
    private readonly bytes: Uint8Array,
    private readonly places: [number, number][],
  ) {}

  get(index: number): Uint8Array {
    const [begin, size] = this.places[index];
    return this.bytes.subarray(begin, begin + size);
  }
}

function decodeBase64(text: string): Uint8Array {
  const native = Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array };
  if (native.fromBase64) return native.fromBase64(text);
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

export interface Content {
  data: PageData;
  blobs: Blobs;
}

async function unpack(data: PageData, text: string): Promise<Content> {
  const packed = decodeBase64(text.trim());
  const stream = new Blob([packed as BlobPart]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  return { data, blobs: new Blobs(bytes, data.blobs) };
}

export function readPage(): Promise<Content> {
  const text = (id: string) => document.getElementById(id)?.textContent ?? "";
  return unpack(JSON.parse(text("ostraka-data")) as PageData, text("ostraka-bytes"));
}

/** Reads an object of a collection. Its file is a script that calls `ostrakaObject`. */
export function readEntry(file: string): Promise<Content> {
  return new Promise((done, failed) => {
    const script = document.createElement("script");
    (window as unknown as Record<string, unknown>).ostrakaObject = (of: string, data: PageData, bytes: string) => {
      if (of === file) done(unpack(data, bytes));
    };
    const ended = () => {
      script.remove();
      failed(new Error(file)); // unless the script has called
    };
    script.onload = ended;
    script.onerror = ended;
    script.src = file;
    document.head.append(script);
  });
}

/** Decodes the triangles of a region: pairs of a gap and a run length, as integers with seven bits per byte. */
export function readRuns(bytes: Uint8Array): Uint32Array {
  const list: number[] = [];
  let place = 0;
  const next = () => {
    let value = 0;
    for (let shift = 1; ; shift *= 128) {
      const byte = bytes[place++];
      value += (byte & 127) * shift;
      if (byte < 128) return value;
    }
  };
  for (let face = 0; place < bytes.length;) {
    face += next();
    for (let run = next(); run > 0; --run) list.push(face++);
  }
  return Uint32Array.from(list);
}
