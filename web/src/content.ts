// Contents of the page: displaying them, opening them from an index, and restoring them from the address.
import { effect } from "@preact/signals";
import * as THREE from "three";
import { readEntry, type Blobs, type Content, type PageObject, type Shown } from "./data";
import { DrawnObject, dotMaterial, flatMaterial, readShape, type Shape } from "./geometry";
import { drawn, setScene, view } from "./picture";
import * as state from "./state";
import { decodeImages, lookOf, refine } from "./texture";
import { View } from "./view";

/** Reads the part of the address after '#': entry of a collection, object, annotation, map, camera. */
export async function readAddress() {
  const given = new URLSearchParams(location.hash.slice(1));
  const whole = (key: string, count: number, otherwise: number) => {
    const value = Number(given.get(key) ?? NaN);
    return Number.isInteger(value) && value >= 0 && value < count ? value : otherwise;
  };
  if (state.index) {
    const entry = whole("entry", state.index.data.collection!.length, -1);
    if (entry !== state.entry.value) await (entry < 0 ? closeEntry() : openEntry(entry));
  }
  state.object.value = whole("object", state.page.objects.length, 0);
  const about = state.page.objects[state.object.value];
  state.chosen.value = whole("annotation", about?.annotations.length ?? 0, -1);
  const values = about?.colouring === "values" && about.maps.length > 0 ? 0 : -1;
  state.map.value = whole("map", about?.maps.length ?? 0, values);
  const colours = given.get("colours");
  if (colours && state.isColouring(colours)) state.colouring.value = colours;
  const camera = given.get("camera");
  if (camera && view) view.where = camera;
}

export function address(): string {
  const parts = new URLSearchParams();
  if (state.entry.value >= 0) parts.set("entry", String(state.entry.value));
  parts.set("object", String(state.object.value));
  if (state.chosen.value >= 0) parts.set("annotation", String(state.chosen.value));
  if (state.map.value >= 0) parts.set("map", String(state.map.value));
  else if (state.colouring.value !== "auto") parts.set("colours", state.colouring.value);
  if (view) parts.set("camera", view.where);
  return "#" + parts.toString();
}

/** Shapes already received, by key. */
const known = new Map<string, Shape>();
export const knownShapes = () => [...known.keys()];

/** Reads a shape: packed in the page, or exact from a server. */
async function shapeOf(of: Shown, blobs: Blobs): Promise<Shape> {
  const images = decodeImages(of, blobs);
  if (of.geometry !== undefined) {
    const { positions, triangles, textured } = await readShape(blobs.get(of.geometry));
    return { positions, triangles, look: lookOf(of, triangles, positions.length / 3, blobs, await images, textured) };
  }
  const { key, positions, triangles } = of.shape!;
  if (positions !== undefined && triangles !== undefined) {
    const [p, t] = [blobs.get(positions), blobs.get(triangles)];
    const corners = new Uint32Array(t.buffer, t.byteOffset, t.byteLength / 4);
    known.set(key, {
      positions: new Float32Array(p.buffer, p.byteOffset, p.byteLength / 4),
      triangles: corners,
      look: lookOf(of, corners, p.byteLength / 12, blobs, await images),
    });
  }
  return known.get(key)!;
}
/** Removes cached shapes that are no longer shown. */
function forget(objects: PageObject[]) {
  const used = new Set(objects.flatMap((one) => [one.shape?.key, one.cage?.shape?.key]));
  for (const key of known.keys()) if (!used.has(key)) known.delete(key);
}

async function cageOf(one: DrawnObject, content: Content): Promise<THREE.Object3D | undefined> {
  const { cage } = one.about;
  if (!cage) return undefined;
  const shape = await shapeOf(cage, content.blobs);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(shape.positions.slice(), 3)); // control points can be dragged
  geometry.setIndex(new THREE.BufferAttribute(shape.triangles, 1));
  const lines = new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 0), flatMaterial([58, 110, 165]));
  const colours = new Uint8Array(shape.positions.length);
  for (let i = 0; i < colours.length; i += 3) colours.set([29, 79, 145], i);
  geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3, true));
  const points = new THREE.Points(geometry, dotMaterial(7));
  const group = new THREE.Group().add(lines, points);
  group.position.fromArray(cage.origin);
  return group;
}

/** The objects of a content that is not displayed, for pictures of them. */
export const objectsOf = ({ data, blobs }: Content): Promise<DrawnObject[]> =>
  Promise.all(data.objects.map(async (about, i) => new DrawnObject(i, about, await shapeOf(about, blobs), blobs)));

/** How much of the picture an object fills at first. */
let fill = 0.97;
export const setFill = (share: number) => (fill = share);

/** Displays a content: that of the page, or of an object of a collection. */
export async function showContent(content: Content, keepsCamera = false) {
  const objects = await objectsOf(content);
  for (const one of objects) {
    one.cage = await cageOf(one, content);
    if (one.cage) one.group.add(one.cage);
  }
  let made = view;
  try {
    if (!made && objects.length > 0) {
      made = new View(matchMedia("(prefers-reduced-motion: reduce)").matches);
      made.fill = fill;
    }
  } catch {
    made = undefined; // without WebGL the tables are still shown
  }
  made?.setObjects(objects, keepsCamera);
  const shown = new Set(objects.map((one) => one.shape.look));
  for (const one of drawn) if (!shown.has(one.shape.look)) one.shape.look?.texture?.images.forEach((image) => image.dispose());
  setScene(made, objects);
  forget(content.data.objects);
  state.setContent(content);
  document.title = content.data.title;
  const refineLooks = async () => {
    for (const one of objects) if (await refine(one.shape.look)) view?.draw();
  };
  const stop = effect(() => {
    if (!state.ready.value) return; // after the first picture
    setTimeout(() => {
      stop();
      void refineLooks();
    });
  });
}

export async function openEntry(entry: number) {
  const one = state.index!.data.collection![entry];
  state.message.value = state.word("loading", one.name);
  try {
    const content = await readEntry(one.file);
    place = window.scrollY;
    state.entry.value = entry;
    state.message.value = "";
    await showContent(content);
    history.replaceState(null, "", address());
    window.scrollTo(0, 0);
  } catch {
    state.message.value = state.word("missing", decodeURIComponent(one.file));
  }
}

/** Scroll position of the index. */
let place = 0;

export async function closeEntry() {
  state.entry.value = -1;
  await showContent(state.index!);
  history.replaceState(null, "", location.pathname + location.search);
  requestAnimationFrame(() => window.scrollTo(0, place));
}
