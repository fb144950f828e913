import { effect } from "@preact/signals";
import { render } from "preact";
import * as THREE from "three";
import { App } from "./app";
import { readEntry, readPage, type Content } from "./data";
import { DrawnObject, flatMaterial, readShape, shared } from "./geometry";
import { drawn, setScene, view } from "./picture";
import * as state from "./state";
import { View } from "./view";
import "./style.css";

/** What the address says after '#': entry of a collection, object, annotation, map, camera. */
async function readAddress() {
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
  state.map.value = whole("map", about?.maps.length ?? 0, -1);
  const camera = given.get("camera");
  if (camera && view) view.where = camera;
}

export function address(): string {
  const parts = new URLSearchParams();
  if (state.entry.value >= 0) parts.set("entry", String(state.entry.value));
  parts.set("object", String(state.object.value));
  if (state.chosen.value >= 0) parts.set("annotation", String(state.chosen.value));
  if (state.map.value >= 0) parts.set("map", String(state.map.value));
  if (view) parts.set("camera", view.where);
  return "#" + parts.toString();
}

async function cageOf(one: DrawnObject, content: Content): Promise<THREE.Object3D | undefined> {
  const { cage } = one.about;
  if (!cage) return undefined;
  const shape = await readShape(content.blobs.get(cage.geometry));
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(shape.positions, 3));
  geometry.setIndex(new THREE.BufferAttribute(shape.triangles, 1));
  const lines = new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 0), flatMaterial([58, 110, 165]));
  const points = new THREE.Points(geometry, flatMaterial([29, 79, 145], 6));
  const group = new THREE.Group().add(lines, points);
  group.position.fromArray(cage.origin);
  return group;
}

/** Shows a content: that of the page, or of an object of a collection. */
async function showContent(content: Content) {
  const objects = await Promise.all(
    content.data.objects.map(async (about, i) => new DrawnObject(i, about, await readShape(content.blobs.get(about.geometry)), content.blobs)),
  );
  for (const one of objects) {
    one.cage = await cageOf(one, content);
    if (one.cage) one.group.add(one.cage);
  }
  let made = view;
  try {
    if (!made && objects.length > 0) made = new View(matchMedia("(prefers-reduced-motion: reduce)").matches);
  } catch {
    made = undefined; // no WebGL: the tables are there all the same
  }
  made?.setObjects(objects);
  setScene(made, objects);
  state.setContent(content);
  document.title = content.data.title;
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

/** Where in the index the reader was. */
let place = 0;

export async function closeEntry() {
  state.entry.value = -1;
  await showContent(state.index!);
  history.replaceState(null, "", location.pathname + location.search);
  requestAnimationFrame(() => window.scrollTo(0, place));
}

async function start() {
  const content = await readPage();
  if (content.data.collection) state.setIndex(content);
  await showContent(content);
  await readAddress();
  const dark = matchMedia("(prefers-color-scheme: dark)");
  effect(() => {
    const isDark = state.theme.value === "dark" || (state.theme.value === "system" && dark.matches);
    document.documentElement.dataset.theme = isDark ? "dark" : "light";
    document.documentElement.lang = state.language.value;
    shared.patterns.value = state.patterns.value ? 1 : 0;
    void state.turn.value;
    if (!view) return;
    view.canvas.tabIndex = 0;
    view.canvas.setAttribute("role", "application");
    view.canvas.setAttribute("aria-label", state.word("canvas", state.page.title));
    view.onDrawn = () => {
      if (!state.ready.value) setTimeout(() => (state.ready.value = true));
    };
    view.background = isDark ? 0x1b1d20 : 0xffffff;
    view.draw();
  });
  dark.addEventListener("change", () => (state.theme.value = String(state.theme.value)));
  window.addEventListener("hashchange", () => void readAddress());
  render(<App />, document.getElementById("app")!);
  // For tests of this page, which ask where things are drawn.
  Object.defineProperty(window, "ostraka", { value: { state, get view() { return view; }, get objects() { return drawn; } } });
}

void start();
