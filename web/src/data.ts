// What the command writes into the page (doc/report.md, "The page's data").

export type Language = "en" | "de" | "it";

export interface Measure {
  name: string;
  tool: string;
  value: number | null;
  unit: string;
  uncertainty?: number;
  stale?: boolean;
  /** Pins, in the object's coordinates less `origin`. */
  pins: [number, number, number][];
  /** What it runs along, of a tape along edges. */
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
  /** Index in `annotations` of the smallest one that contains it; -1: none. */
  parent: number;
  attributes: Attribute[];
  measures: Measure[];
  /** Of a region: how many triangles, and which blob lists them. */
  faces?: { count: number; blob: number };
  /** Of lines and points: vertices of the mesh that is shown. */
  lines?: number[][];
  points?: number[];
  /** Of what runs through the triangles: places a little off the surface, relative to the object's box. */
  curves?: [number, number, number][][];
}

/** A number for each vertex, as 16 bit steps between `minimum` and `maximum`; 65535: no value. */
export interface ValueMap {
  name: string;
  label: string;
  blob: number;
  minimum: number;
  maximum: number;
  /** What the colours and the histogram go over; what lies beyond has the colour of the end. */
  from: number;
  to: number;
  /** At even steps from `from` to `to`: those of the command's own pictures. */
  colours: [number, number, number][];
  histogram: number[];
  /** The steps are indices in this list, if it is there: names instead of numbers. `histogram` has an entry for each. */
  categories?: { text: string; colour: [number, number, number] }[];
}

/** What a plane cuts out of an object. */
export interface Slice {
  height: number;
  /** The plane's frame, in the object's coordinates less `origin`. */
  origin: [number, number, number];
  u: [number, number, number];
  v: [number, number, number];
  /** In the order of `Slices.columns`. */
  values: (number | null)[];
  /** Their points lie one after the other in `Slices.blob`. */
  contours: { points: number; closed: boolean; hole: boolean }[];
}

export interface Slices {
  unit: string;
  columns: { name: string; title: string; unit: string }[];
  /** By ascending height. */
  levels: Slice[];
  /** Along u and v, two 32 bit floats for each point of all contours of all levels. */
  blob: number;
  /** The heights between which the object is tubular. */
  tube?: [number, number];
}

/** What became of a constraint in a deformation. */
export interface Constraint {
  type: string;
  /** Indices in `annotations`. */
  members: number[];
  weight: number;
  hard: boolean;
  /** Verdicts before and after, in words, and whether it holds after; undefined: it cannot be told. */
  before: string;
  verdict: string;
  holds?: boolean;
  text: string;
  deviations: { quantity: string; before: number | null; value: number | null; tolerance: number | null; unit: string }[];
  /** Of the solver: how far the points are from where the constraint puts them. */
  residual?: { mean: number; largest: number };
}

/** A shape: packed in a blob, or exact (32 bit floats relative to the box, triangles), which may have been sent before. */
export interface Shown {
  geometry?: number;
  shape?: { key: string; positions?: number; triangles?: number };
}

export interface PageObject extends Shown {
  name: string;
  unit: string;
  /** Vertices and triangles of the object; of what is shown, if that is less. */
  vertices: number;
  faces: number;
  simplified?: { vertices: number; deviation: number };
  origin: [number, number, number];
  size: [number, number, number];
  up: [number, number, number];
  annotations: Annotation[];
  maps: ValueMap[];
  cage?: Shown & { vertices: number; origin: [number, number, number] };
  /** The rows of a drawing of the relationships: annotations under what contains them. */
  tree: { annotation: number; depth: number }[];
  relations: Relation[];
  constraints?: Constraint[];
  /** What 'relation check' says: rules of the class, relations, constraints, canons (proportions). */
  conformance?: { kind: "rule" | "relation" | "constraint" | "canon"; name: string; members: number[]; holds?: boolean; text: string }[];
  /** Constraints that cannot hold together, in words. */
  conflicts?: string[];
  slices?: Slices;
  /** Indices in `annotations` of the parts that a slider moves apart (the fragments of an assembly). */
  parts?: number[];
  /** Objects of one number have the same triangles: one turns into the other. */
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
  /** Beside the tree, from inside; undefined: the tree says it. */
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
  /** For each row the object that it is of (-1: none), and the annotation of it (-1: none). */
  objects?: number[];
  annotations?: number[];
}

/** A drawing made by the command: SVG, drawn as a picture, so that nothing in it can run. */
export interface Drawing {
  title: string;
  blob: number;
}

/** An object of a collection, read when it is asked for. */
export interface Entry {
  name: string;
  /** Beside the page: a script that calls `ostrakaObject(file, data, bytes)` with a page of this one object. */
  file: string;
  /** Beside the page: a PNG. */
  thumbnail: string;
  vertices: number;
  faces: number;
  tags: string[];
}

export interface PageData {
  version: number;
  /** Of a collection: then `objects` is empty, and the objects that rows of tables name are indices here. */
  collection?: Entry[];
  title: string;
  notes: string[];
  provenance: string;
  objects: PageObject[];
  tables: Table[];
  drawings: Drawing[];
  blobs: [number, number][];
}

/** Bytes of the page: one deflated, base64 text. */
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

/** An object of a collection. Its file is a script that calls `ostrakaObject`. */
export function readEntry(file: string): Promise<Content> {
  return new Promise((done, failed) => {
    const script = document.createElement("script");
    (window as unknown as Record<string, unknown>).ostrakaObject = (of: string, data: PageData, bytes: string) => {
      if (of === file) done(unpack(data, bytes));
    };
    const ended = () => {
      script.remove();
      failed(new Error(file)); // unless it has called
    };
    script.onload = ended;
    script.onerror = ended;
    script.src = file;
    document.head.append(script);
  });
}

/** The triangles of a region: pairs of a gap and a run, as numbers of seven bits a byte. */
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
  for (let face = 0; place < bytes.length; ) {
    face += next();
    for (let run = next(); run > 0; --run) list.push(face++);
  }
  return Uint32Array.from(list);
}
