// The 3D view with labels and measures, and the actions of pointer and keys on it.
import { effect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import * as THREE from "three";
import { colourOf } from "./colours";
import { shared, type DrawnObject } from "./geometry";
import { angleOf, angleSign } from "./sizes";
import * as state from "./state";
import { numberText, page, withUnit, word } from "./state";
import { isUnlit } from "./texture";
import type { View } from "./view";

export let view: View | undefined;
export let drawn: DrawnObject[] = [];
export function setScene(made: View | undefined, objects: DrawnObject[]) {
  view = made;
  drawn = objects;
  anchors.clear();
}

const anchors = new Map<string, THREE.Vector3[]>();

/** Anchor points of an annotation, the one nearest to its centre first; for a region where no smaller one covers it. */
function anchorsOf(of: DrawnObject, annotation: number): THREE.Vector3[] {
  const one = of.about.annotations[annotation];
  const faces = of.regions[annotation];
  let vertices: ArrayLike<number> = one.points ?? one.lines?.flat() ?? [];
  if (faces) {
    const own = faces.filter((f) => of.top[f] === annotation);
    vertices = (own.length > 0 ? own : faces).map((f) => of.shape.triangles[3 * f]);
  }
  if (vertices.length === 0) return [];
  const most = one.points ? vertices.length : 48;
  const some = Array.from({ length: Math.min(most, vertices.length) }, (_, i) =>
    of.vertex(vertices[Math.floor((i * vertices.length) / Math.min(most, vertices.length))]),
  );
  const middle = some.reduce((sum, p) => sum.add(p), new THREE.Vector3()).divideScalar(some.length);
  return some.sort((a, b) => a.distanceToSquared(middle) - b.distanceToSquared(middle));
}

interface Label {
  text: string;
  x: number;
  y: number;
  atX: number;
  atY: number;
  strong: boolean;
}

/** Positions of labels on both sides of the object, sorted so that leader lines do not cross. */
function labelPlaces(width: number, height: number): Label[] {
  if (!view || !state.labels.value) return [];
  const list: Label[] = [];
  const share = 1 / state.panes.value.length;
  state.panes.value.forEach((o, pane) => {
    const of = drawn[o];
    if (!of) return;
    const mine: Label[] = [];
    of.about.annotations.forEach((one, i) => {
      if (!state.isShown(o, i) || !one.tag) return;
      const chosen = state.chosen.value === i && o === state.object.value;
      const whole = one.faces && one.faces.count >= 0.95 * of.top.length;
      if ((whole && !chosen) || one.tag.startsWith(angleSign)) return; // an angle has its name beside its value
      const key = state.keyOf(o, i);
      if (!anchors.has(key)) anchors.set(key, anchorsOf(of, i));
      const at = anchors.get(key)!.find((one) => view!.sees(of, one));
      const place = at && view!.place(of, at);
      if (!place) return;
      mine.push({ text: one.tag, x: 0, y: place.y, atX: place.x, atY: place.y, strong: chosen });
    });
    const middle = (pane + 0.5) * share * width;
    for (const side of [0, 1]) {
      const row = 17;
      const column = mine.filter((one) => (one.atX < middle ? 0 : 1) === side).sort((a, b) => a.atY - b.atY);
      const room = Math.max(1, Math.floor((height - 16) / row));
      const kept = column.filter((one, i) => one.strong || i < room).slice(0, room);
      kept.forEach((one, i) => (one.y = Math.max(one.atY, i === 0 ? 12 : kept[i - 1].y + row)));
      for (let i = kept.length - 1; i >= 0; --i) kept[i].y = Math.min(kept[i].y, i === kept.length - 1 ? height - 8 : kept[i + 1].y - row);
      for (const one of kept) one.x = side === 0 ? pane * share * width + 8 : (pane + 1) * share * width - 8;
      list.push(...kept.map((one) => ({ ...one, side })));
    }
  });
  return list;
}

/** Lines of measures: those of the selected annotation or of all shown ones, and interactive ones. */
function rulers(): { from: { x: number; y: number }; to: { x: number; y: number }; text: string; ends: [boolean, boolean] }[] {
  if (!view) return [];
  const list: ReturnType<typeof rulers> = [];
  const add = (o: number, pins: THREE.Vector3[], text: string) => {
    for (let i = 1; i < pins.length; ++i) {
      const from = view!.place(drawn[o], pins[i - 1]);
      const to = view!.place(drawn[o], pins[i]);
      if (from && to)
        list.push({ from, to, text: i === Math.ceil((pins.length - 1) / 2) ? text : "", ends: [i === 1, i === pins.length - 1] });
    }
  };
  page.objects[state.object.value]?.annotations.forEach((one, i) => {
    if (i !== state.chosen.value && !(state.allMeasures.value && state.isShown(state.object.value, i))) return;
    for (const m of one.measures ?? [])
      add(
        state.object.value,
        (m.way ?? m.pins).map((p) => new THREE.Vector3(...p)),
        m.value === null ? m.name : `${m.name} ${withUnit(m.value, m.unit)}`,
      );
    const of = drawn[state.object.value];
    const angle = of && angleOf(of, i);
    if (angle === undefined) return;
    const legs = one.points!.map((v) => of.vertex(v));
    add(state.object.value, legs, "");
    const apex = view!.place(of, legs[1]);
    const text = `${one.tag} ${numberText(Number(angle.toFixed(1)))}°`;
    if (apex) list.push({ from: apex, to: apex, text, ends: [false, false] });
  });
  const { object, places } = state.measured.value;
  if (object >= 0 && places.length > 0) {
    const pins = places.map((p) => new THREE.Vector3(p.x, p.y, p.z));
    if (pins.length === 1) pins.push(pins[0]);
    const text = places.length < 2 ? "" : withUnit(pins[0].distanceTo(pins[1]), page.objects[object].unit);
    add(object, pins, text);
  }
  return list;
}

const namespace = "http://www.w3.org/2000/svg";
function element(name: string, attributes: Record<string, string | number>, text?: string): SVGElement {
  const made = document.createElementNS(namespace, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  if (text !== undefined) made.textContent = text;
  return made;
}

/** A length of 1, 2 or 5 times a power of ten that is 60 to 150 pixels long in the picture, and its pixels. */
export function scaleBar(pixelsPerUnit: number): { length: number; pixels: number } | undefined {
  const most = 150 / pixelsPerUnit;
  if (!Number.isFinite(most) || most <= 0) return undefined;
  const decade = 10 ** Math.floor(Math.log10(most));
  const length = [5, 2, 1].map((one) => one * decade).find((one) => one <= most) ?? decade;
  return { length, pixels: length * pixelsPerUnit };
}

/** The scale bar of the object in a pane: the view is orthographic, so that one length holds for all of the picture. */
function scaleBarOf(pane: number, width: number, height: number): SVGElement[] {
  const of = drawn[state.panes.value[pane]];
  const bar = of && view && scaleBar(view.pixelsPerUnit(of));
  if (!of || !bar) return [];
  const x = ((pane + 1) * width) / state.panes.value.length - 14 - bar.pixels;
  const y = height - 14;
  return [
    element("path", { class: "scale-bar", d: `M${x} ${y - 5}V${y}H${x + bar.pixels}V${y - 5}` }),
    element("text", { class: "scale-bar", x: x + bar.pixels / 2, y: y - 7, "text-anchor": "middle" }, withUnit(bar.length, of.about.unit)),
  ];
}

function drawOverlay(svg: SVGSVGElement) {
  const { clientWidth: width, clientHeight: height } = svg;
  const made: SVGElement[] = [];
  for (const one of labelPlaces(width, height) as (Label & { side: number })[]) {
    const css = one.strong ? "label strong" : "label";
    const end = one.side === 0 ? one.x + 4 + one.text.length * 6.4 : one.x - 4 - one.text.length * 6.4;
    made.push(element("line", { class: css, x1: end, y1: one.y, x2: one.atX, y2: one.atY }));
    made.push(element("circle", { class: css, cx: one.atX, cy: one.atY, r: 2.2 }));
    made.push(element("text", { class: css, x: one.x, y: one.y + 4, "text-anchor": one.side === 0 ? "start" : "end" }, one.text));
  }
  for (const { from, to, text, ends } of rulers()) {
    made.push(element("line", { class: "ruler", x1: from.x, y1: from.y, x2: to.x, y2: to.y }));
    for (const pin of [from, to].filter((_, i) => ends[i])) made.push(element("circle", { class: "ruler", cx: pin.x, cy: pin.y, r: 3.5 }));
    if (text) made.push(element("text", { class: "ruler", x: (from.x + to.x) / 2 + 6, y: (from.y + to.y) / 2 - 6 }, text));
  }
  const count = state.panes.value.length;
  for (let pane = 0; pane < count; ++pane) made.push(...scaleBarOf(pane, width, height));
  if (count > 1)
    state.panes.value.forEach((o, i) => {
      const x = ((i + 0.5) * width) / count;
      made.push(element("text", { class: "title", x, y: height - 10, "text-anchor": "middle" }, page.objects[o].name));
      if (i > 0) made.push(element("line", { class: "border", x1: (i * width) / count, y1: 0, x2: (i * width) / count, y2: height }));
    });
  svg.replaceChildren(...made);
}

function step(by: number) {
  const { annotations } = page.objects[state.object.value];
  const list = annotations.map((_, i) => i).filter((i) => state.isShown(state.object.value, i));
  if (list.length === 0) return;
  const at = list.indexOf(state.chosen.value);
  state.choose(list[(at + by + list.length) % list.length]);
}

function onKey(event: KeyboardEvent) {
  if (!view || event.ctrlKey || event.metaKey || event.altKey) return;
  const turn = Math.PI / 18;
  const actions: Record<string, () => void> = {
    ArrowLeft: () => void view!.controls.rotate(-turn, 0, true),
    ArrowRight: () => void view!.controls.rotate(turn, 0, true),
    ArrowUp: () => void view!.controls.rotate(0, -turn, true),
    ArrowDown: () => void view!.controls.rotate(0, turn, true),
    "+": () => void view!.controls.zoom(view!.camera.zoom * 0.25, true),
    "=": () => void view!.controls.zoom(view!.camera.zoom * 0.25, true),
    "-": () => void view!.controls.zoom(-view!.camera.zoom * 0.2, true),
    "0": () => view!.home(),
    "[": () => state.choose(-1, (state.object.value + page.objects.length - 1) % page.objects.length),
    "]": () => state.choose(-1, (state.object.value + 1) % page.objects.length),
    n: () => step(1),
    p: () => step(-1),
    Escape: () => {
      state.choose(-1);
      state.measured.value = { object: -1, places: [] };
    },
  };
  const action = actions[event.key] ?? actions[event.key.toLowerCase()];
  if (!action) return;
  event.preventDefault();
  action();
  view.draw();
}

/** Whether the shown object is drawn under light and shade: a texture that asks for flat light is not, unless the reader wants it. */
export function isShaded(): boolean {
  const of = drawn[state.object.value];
  const isTexture = state.map.value < 0 && of?.colouring(state.colouring.value) === "texture";
  return state.shade.value ?? !(isTexture && isUnlit(of?.shape.look));
}

export function repaint() {
  if (!view) return;
  const chosen = state.chosen.value;
  for (const o of state.panes.value) {
    const of = drawn[o];
    if (!of) return; // another content is being loaded
    const map = state.map.value;
    if (map >= 0 && map < of.about.maps.length) of.paintMap(map, (share) => colourOf(share, of.about.maps[map].colours));
    else of.paint((i) => state.isShown(o, i), o === state.object.value ? chosen : -1, of.colouring(state.colouring.value));
    if (of.cage) of.cage.visible = state.cage.value;
  }
  shared.flatLight.value = isShaded() ? 0 : 1;
  const [x, y] = state.lamp.value;
  shared.lamp.value.set(x, y, Math.sqrt(Math.max(0, 1 - x * x - y * y)));
  shared.relief.value = state.relief.value;
  const partner = state.blendPartner.value;
  for (const of of drawn) of.blendTo(of.index === state.object.value && partner >= 0 ? drawn[partner] : undefined);
  view.show(state.panes.value.map((o) => drawn[o]));
}

export function Picture() {
  const overlay = useRef<SVGSVGElement>(null);
  const holder = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (!view || !holder.current || !overlay.current) return;
    const canvas = view.canvas;
    holder.current.prepend(canvas);
    const svg = overlay.current;
    // The BVH for visibility is built after the first frame.
    let soon = true;
    view.onMove = () => {
      state.moves.value += 1;
      if (!soon) return drawOverlay(svg);
      soon = false;
      setTimeout(() => drawOverlay(svg), 30);
    };
    const stops = [
      effect(() => {
        repaint();
      }),
      effect(() => {
        view!.clip = state.clip.value;
        view!.clipAxis = state.clipAxis.value;
        view!.move(state.blend.value, state.explode.value);
        const moved = drawn.map((one) => one.moveTo(state.blend.value, state.explode.value));
        if (moved.some(Boolean)) anchors.clear();
      }),
      effect(() => {
        for (const one of drawn) one.showSlice(one.index === state.object.value && state.level.value >= 0 ? state.level.value : undefined);
        view!.draw();
      }),
      effect(() => {
        void [state.labels.value, state.measured.value, state.chosen.value, state.language.value];
        view!.draw();
      }),
    ];
    const sized = new ResizeObserver(() => view!.draw());
    sized.observe(canvas);
    let down = { x: 0, y: 0 };
    const at = (event: PointerEvent | MouseEvent) => {
      const box = canvas.getBoundingClientRect();
      return { x: event.clientX - box.left, y: event.clientY - box.top };
    };
    let waiting = false;
    // The canvas outlives the components around it.
    const listens = new AbortController();
    const { signal } = listens;
    canvas.addEventListener(
      "pointermove",
      (event) => {
        if (event.buttons !== 0 || waiting) return;
        waiting = true;
        const place = at(event);
        requestAnimationFrame(() => {
          waiting = false;
          hover(place.x, place.y);
        });
      },
      { signal },
    );
    canvas.addEventListener("pointerleave", () => (state.hovered.value = undefined), { signal });
    canvas.addEventListener("pointerdown", (event) => (down = at(event)), { signal });
    canvas.addEventListener(
      "click",
      (event) => {
        const place = at(event);
        if (Math.hypot(place.x - down.x, place.y - down.y) > 4) return;
        click(place.x, place.y);
      },
      { signal },
    );
    canvas.addEventListener("keydown", onKey, { signal });
    return () => {
      stops.forEach((stop) => stop());
      listens.abort();
      sized.disconnect();
    };
  }, []);
  if (!view) return <p class="nothing">{word("noWebgl")}</p>;
  return (
    <div class="picture" ref={holder}>
      <svg ref={overlay} aria-hidden="true" />
      <Tip />
    </div>
  );
}

/** The smallest visible annotation at a position of the canvas, and those that contain it. */
export function hover(x: number, y: number) {
  const hit = view?.pick(x, y);
  if (!hit) {
    state.hovered.value = undefined;
    return;
  }
  const list = drawn[hit.object].annotationsOn(hit.face).filter((i) => state.isShown(hit.object, i));
  state.hovered.value = { object: hit.object, annotations: list, vertex: hit.vertex, x, y };
}

export function click(x: number, y: number) {
  if (!state.clicks.value) return;
  const hit = view?.pick(x, y);
  if (state.measuring.value) {
    if (!hit) return;
    const { object, places } = state.measured.value;
    const fresh = object !== hit.object || places.length >= 2;
    const place = { x: hit.point.x, y: hit.point.y, z: hit.point.z };
    state.measured.value = { object: hit.object, places: fresh ? [place] : [...places, place] };
    return;
  }
  if (!hit) {
    state.choose(-1);
    return;
  }
  const list = drawn[hit.object].annotationsOn(hit.face).filter((i) => state.isShown(hit.object, i));
  // A second click selects the containing annotation.
  const at = hit.object === state.object.value ? list.indexOf(state.chosen.value) : -1;
  state.choose(list[at + 1] ?? (at >= 0 ? list[0] : -1), hit.object);
}

function Tip() {
  const at = state.hovered.value;
  if (!at) return null;
  const about = page.objects[at.object];
  const map = about.maps[state.map.value];
  const value = map ? drawn[at.object].mapValue(state.map.value, at.vertex) : undefined;
  if (at.annotations.length === 0 && !map) return null;
  return (
    <div class="tip" style={{ left: `${at.x + 14}px`, top: `${at.y + 14}px` }} data-annotation={at.annotations[0] ?? -1}>
      {at.annotations.map((i, k) => (
        <div key={i} class={k === 0 ? "first" : "quiet"}>
          {about.annotations[i].tag || `#${about.annotations[i].id}`}
        </div>
      ))}
      {map && (
        <div>
          {map.name}: {value === undefined ? word("noValue") : typeof value === "string" ? value : numberText(value)}
        </div>
      )}
    </div>
  );
}
