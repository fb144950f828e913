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
}

export interface PageObject {
  name: string;
  unit: string;
  /** Vertices and triangles of the object; of what is shown, if that is less. */
  vertices: number;
  faces: number;
  simplified?: { vertices: number; deviation: number };
  origin: [number, number, number];
  size: [number, number, number];
  up: [number, number, number];
  geometry: number;
  annotations: Annotation[];
  maps: ValueMap[];
  cage?: { geometry: number; vertices: number; origin: [number, number, number] };
  relations: Relation[];
  /** Objects of one number have the same triangles: one turns into the other. */
  blend?: number;
}

export interface Relation {
  type: string;
  /** Indices in `annotations`. */
  members: number[];
  directed: boolean;
  constraint: boolean;
  weight: number;
  holds?: boolean;
  text: string;
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

export interface PageData {
  version: number;
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

export async function readPage(): Promise<{ data: PageData; blobs: Blobs }> {
  const text = (id: string) => document.getElementById(id)?.textContent?.trim() ?? "";
  const data = JSON.parse(text("ostraka-data")) as PageData;
  const packed = decodeBase64(text("ostraka-bytes"));
  const stream = new Blob([packed as BlobPart]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  return { data, blobs: new Blobs(bytes, data.blobs) };
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
