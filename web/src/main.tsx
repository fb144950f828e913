import { effect } from "@preact/signals";
import { render } from "preact";
import { App } from "./app";
import { readPage } from "./data";
import { DrawnObject, patternShare, readShape } from "./geometry";
import { setScene, view } from "./picture";
import * as state from "./state";
import { View } from "./view";
import * as THREE from "three";
import "./style.css";

/** What the address says after '#': object, annotation, map, camera. */
function readAddress() {
  const given = new URLSearchParams(location.hash.slice(1));
  const whole = (key: string, count: number, otherwise: number) => {
    const value = Number(given.get(key) ?? NaN);
    return Number.isInteger(value) && value >= 0 && value < count ? value : otherwise;
  };
  state.object.value = whole("object", state.page.objects.length, 0);
  const about = state.page.objects[state.object.value];
  state.chosen.value = whole("annotation", about?.annotations.length ?? 0, -1);
  state.map.value = whole("map", about?.maps.length ?? 0, -1);
  const camera = given.get("camera");
  if (camera && view) view.where = camera;
}

export function address(): string {
  const parts = new URLSearchParams();
  parts.set("object", String(state.object.value));
  if (state.chosen.value >= 0) parts.set("annotation", String(state.chosen.value));
  if (state.map.value >= 0) parts.set("map", String(state.map.value));
  if (view) parts.set("camera", view.where);
  return "#" + parts.toString();
}

async function start() {
  const { data, blobs } = await readPage();
  state.setPage(data);
  document.title = data.title;
  const canvas = document.createElement("canvas");
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "application");
  const objects = await Promise.all(
    data.objects.map(async (about, i) => new DrawnObject(i, about, await readShape(blobs.get(about.geometry)), blobs)),
  );
  for (const one of objects) {
    if (!one.about.cage) continue;
    const shape = await readShape(blobs.get(one.about.cage.geometry));
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(shape.positions, 3));
    geometry.setIndex(new THREE.BufferAttribute(shape.triangles, 1));
    const lines = new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 0), new THREE.LineBasicMaterial({ color: 0x3a6ea5 }));
    const points = new THREE.Points(geometry, new THREE.PointsMaterial({ color: 0x1d4f91, size: 5, sizeAttenuation: false }));
    one.cage = new THREE.Group().add(lines, points);
    one.cage.position.fromArray(one.about.cage.origin);
    one.group.add(one.cage);
  }
  try {
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    if (objects.length > 0) setScene(new View(canvas, objects, calm), objects);
  } catch {
    setScene(undefined, objects); // no WebGL: the tables are there all the same
  }
  readAddress();
  const dark = matchMedia("(prefers-color-scheme: dark)");
  effect(() => {
    const isDark = state.theme.value === "dark" || (state.theme.value === "system" && dark.matches);
    document.documentElement.dataset.theme = isDark ? "dark" : "light";
    document.documentElement.lang = state.language.value;
    canvas.setAttribute("aria-label", state.word("canvas", data.title));
    patternShare.value = state.patterns.value ? 1 : 0;
    if (view) {
      view.background = isDark ? 0x1b1d20 : 0xffffff;
      view.draw();
    }
  });
  dark.addEventListener("change", () => (state.theme.value = String(state.theme.value)));
  window.addEventListener("hashchange", readAddress);
  render(<App blobs={blobs} />, document.getElementById("app")!);
  // For tests of this page, which ask where things are drawn.
  (window as unknown as Record<string, unknown>).ostraka = { state, view, objects };
}

void start();
