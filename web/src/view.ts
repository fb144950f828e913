// The 3D view: one canvas, one camera, one pane per displayed object.
import CameraControls from "camera-controls";
import * as THREE from "three";
import { shared, type DrawnObject } from "./geometry";

CameraControls.install({ THREE });

/** Azimuth and elevation in degrees. */
export const sixViews = [
  ["front", 0, 0],
  ["right", 90, 0],
  ["back", 180, 0],
  ["left", 270, 0],
  ["top", 0, 89.9],
  ["bottom", 0, -89.9],
] as const;

/** The object and face under the pointer. */
export interface Hit {
  object: number;
  face: number;
  /** The corner of the face nearest to the point. */
  vertex: number;
  point: THREE.Vector3;
}

/** Without a graphics card, antialiasing takes most of the rendering time. */
function drawsInSoftware(gl: WebGL2RenderingContext): boolean {
  const about = gl.getExtension("WEBGL_debug_renderer_info");
  return /swiftshader|llvmpipe|software|basic render/i.test(about ? String(gl.getParameter(about.UNMASKED_RENDERER_WEBGL)) : "");
}

/** A canvas with its context; antialiased only with a graphics card. */
function makeCanvas(): { canvas: HTMLCanvasElement; context: WebGL2RenderingContext } {
  for (const antialias of [false, true]) {
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("webgl2", { antialias, alpha: true, stencil: false, powerPreference: "high-performance" });
    if (!context) break;
    if (antialias || drawsInSoftware(context)) return { canvas, context };
    context.getExtension("WEBGL_lose_context")?.loseContext();
  }
  throw new Error("no WebGL 2");
}

/** Half width and height of a pane at zoom 1: an object of size 1 fits. */
function halfSizes(aspect: number): [number, number] {
  return aspect > 1 ? [aspect, 1] : [1, 1 / aspect];
}

export class View {
  readonly canvas: HTMLCanvasElement;
  private objects: DrawnObject[] = [];
  readonly renderer: THREE.WebGLRenderer;
  readonly controls: CameraControls;
  readonly camera: THREE.OrthographicCamera;
  private readonly scene = new THREE.Scene();
  private last = performance.now();
  private readonly plane = new THREE.Plane();
  private panes: DrawnObject[] = [];
  /** Drawn with the object of each pane. */
  private layers: DrawnObject[] = [];
  private frames: { centre: THREE.Vector3; scale: number; turn: THREE.Quaternion }[] = [];
  /** Whether the first view has been fitted to the canvas. */
  private placed = false;
  /** Whether the first frame has been drawn. */
  private seen = false;
  private wanted = true;
  private running = false;
  /** Compares two objects: left of the share of the width the first, right of it the second. */
  wipe: { left: DrawnObject; right: DrawnObject; share: number } | undefined;
  /** How much of a pane the displayed objects fill; less where bars lie over the picture. */
  fill = 0.97;
  clip = 1;
  clipAxis = 2;
  background = 0xffffff;
  onMove: () => void = () => {};
  onDrawn: () => void = () => {};

  constructor(reducedMotion: boolean) {
    const { canvas, context } = makeCanvas();
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, context });
    this.renderer.autoClear = false;
    this.renderer.debug.checkShaderErrors = false; // the check would wait for compilation
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -20, 20);
    this.camera.up.set(0, 0, 1);
    this.controls = new CameraControls(this.camera, canvas);
    this.controls.minZoom = 0.2;
    this.controls.maxZoom = 200;
    this.controls.smoothTime = reducedMotion ? 0.001 : 0.12;
    this.controls.draggingSmoothTime = reducedMotion ? 0.001 : 0.06;
    this.controls.dollyToCursor = true;
    // Frames are drawn on demand, so pointer, wheel, touch and command events must trigger drawing: "update" is only sent while drawing.
    for (const event of ["controlstart", "control", "transitionstart"] as const) this.controls.addEventListener(event, () => this.draw());
  }

  /** Replaces the displayed objects. */
  setObjects(objects: DrawnObject[], keepsCamera = false) {
    for (const one of this.objects) {
      this.scene.remove(one.group);
      one.dispose();
    }
    this.objects = objects;
    this.panes = [];
    this.frames = [];
    this.placed = keepsCamera && this.placed;
    this.frame();
    this.layers = [];
    for (const one of objects) {
      this.stand(one);
      this.scene.add(one.group);
    }
    if (!this.placed) this.home(false);
  }

  /** Places an object by itself. */
  private stand(one: DrawnObject) {
    const { centre, scale, turn } = this.frames[one.index];
    one.group.quaternion.copy(turn);
    one.group.scale.setScalar(scale);
    one.group.position.copy(centre).applyQuaternion(turn).multiplyScalar(-scale);
    one.group.updateMatrixWorld(true);
  }

  /** Draws other objects together with this one, positioned by their coordinates. */
  showWith(of: DrawnObject, layers: DrawnObject[]) {
    for (const one of this.layers) this.stand(one);
    this.layers = layers;
    for (const one of layers) {
      const apart = new THREE.Vector3(...one.about.origin).sub(new THREE.Vector3(...of.about.origin));
      one.group.quaternion.copy(of.group.quaternion);
      one.group.scale.copy(of.group.scale);
      one.group.position.copy(of.group.position).add(apart.applyQuaternion(of.group.quaternion).multiply(of.group.scale));
      one.group.updateMatrixWorld(true);
    }
    this.draw();
  }

  /** Takes the objects back from another display. */
  adopt() {
    for (const one of this.objects) this.scene.add(one.group);
    this.scene.updateMatrixWorld(true);
    this.draw();
  }

  /** Objects with the same position share one frame, so that differences are visible; others are centred. */
  private frame() {
    const boxes = this.objects.map((one) => {
      const { origin, size } = one.about;
      return { low: new THREE.Vector3(...origin), size: new THREE.Vector3(...size) };
    });
    boxes.forEach((box, i) => {
      let like = i;
      for (let k = 0; k < i && like === i; ++k) {
        const apart = box.low.clone().addScaledVector(box.size, 0.5).distanceTo(boxes[k].low.clone().addScaledVector(boxes[k].size, 0.5));
        const ratio = box.size.length() / boxes[k].size.length();
        if (apart < 0.25 * boxes[k].size.length() && ratio > 0.5 && ratio < 2) like = k;
      }
      const of = boxes[like];
      const up = new THREE.Vector3(...this.objects[like].about.up).normalize();
      this.frames.push({
        // Positions are relative to their own origin.
        centre: of.low.clone().addScaledVector(of.size, 0.5).sub(box.low),
        scale: 2 / (of.size.length() || 1),
        turn: new THREE.Quaternion().setFromUnitVectors(up, new THREE.Vector3(0, 0, 1)),
      });
    });
  }

  show(panes: DrawnObject[]) {
    this.panes = panes;
    this.draw();
  }

  home(moves = true) {
    void this.controls.setLookAt(1.5, -2.6, 1.1, 0, 0, 0, moves);
    void this.controls.zoomTo(this.homeZoom(), moves);
    this.draw();
  }

  /** Zoom at which the boxes of the displayed objects fill the panes. */
  private homeZoom(): number {
    const camera = this.camera.clone();
    camera.position.set(1.5, -2.6, 1.1);
    camera.lookAt(0, 0, 0);
    const [width, height] = this.paneSize();
    const [x, y] = halfSizes(width > 0 && height > 0 ? width / height : 1.6);
    const most = this.mostOf(this.panes.length > 0 ? this.panes : this.objects.slice(0, 1), camera, x, y);
    return most > 0 ? this.fill / most : 1;
  }

  /** How far the boxes of objects reach from the centre of the picture, as a share of its half width and half height. */
  private mostOf(objects: DrawnObject[], camera: THREE.Camera, x: number, y: number): number {
    const right = new THREE.Vector3(1, 0, 0).applyQuaternion(camera.quaternion);
    const up = new THREE.Vector3(0, 1, 0).applyQuaternion(camera.quaternion);
    let most = 0;
    for (const one of objects)
      for (let corner = 0; corner < 8; ++corner) {
        const at = new THREE.Vector3(...one.about.size.map((x, k) => ((corner >> k) % 2) * x));
        one.group.localToWorld(at);
        most = Math.max(most, Math.abs(at.dot(right)) / x, Math.abs(at.dot(up)) / y);
      }
    return most;
  }

  /** A small picture of one object; neither the object nor the view is changed by it. */
  thumbnail(of: DrawnObject, width: number, height: number): HTMLCanvasElement {
    const { group } = of;
    const before = { parent: group.parent, turn: group.quaternion.clone(), scale: group.scale.clone(), place: group.position.clone() };
    const size = new THREE.Vector3(...of.about.size);
    const scene = new THREE.Scene().add(group);
    const hidden = group.children.filter((one) => one !== of.mesh && one.visible);
    for (const one of hidden) one.visible = false;
    group.visible = true;
    group.quaternion.setFromUnitVectors(new THREE.Vector3(...of.about.up).normalize(), new THREE.Vector3(0, 0, 1));
    group.scale.setScalar(2 / (size.length() || 1));
    group.position.copy(size).multiplyScalar(-0.5).applyQuaternion(group.quaternion).multiply(group.scale);
    group.updateMatrixWorld(true);
    const camera = this.camera.clone();
    const [x, y] = halfSizes(width / height);
    Object.assign(camera, { left: -x, right: x, top: y, bottom: -y, zoom: 1 });
    camera.position.set(1.5, -2.6, 1.1);
    camera.lookAt(0, 0, 0);
    camera.updateMatrixWorld();
    camera.zoom = 0.95 / this.mostOf([of], camera, x, y);
    camera.updateProjectionMatrix();
    shared.clip.value.set(0, 0, 0, 1);
    const { renderer } = this;
    renderer.setPixelRatio(1);
    renderer.setSize(2 * width, 2 * height, false);
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, 2 * width, 2 * height);
    renderer.setClearColor(this.background, 0);
    renderer.clear();
    renderer.render(scene, camera);
    const picture = document.createElement("canvas");
    Object.assign(picture, { width: 2 * width, height: 2 * height });
    picture.getContext("2d")!.drawImage(this.canvas, 0, 0);
    for (const one of hidden) one.visible = true;
    scene.remove(group);
    before.parent?.add(group);
    group.quaternion.copy(before.turn);
    group.scale.copy(before.scale);
    group.position.copy(before.place);
    group.updateMatrixWorld(true);
    this.paint();
    return picture;
  }

  /** Frees what the view holds of the graphics card. */
  close() {
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  look(azimuth: number, elevation: number) {
    const a = (azimuth * Math.PI) / 180;
    const e = (elevation * Math.PI) / 180;
    const away = 3.2;
    void this.controls.setLookAt(away * Math.sin(a) * Math.cos(e), -away * Math.cos(a) * Math.cos(e), away * Math.sin(e), 0, 0, 0, true);
    this.draw();
  }

  /** Requests a frame; several requests give one frame. */
  draw() {
    this.wanted = true;
    if (this.running) return;
    this.running = true;
    this.last = performance.now();
    requestAnimationFrame(this.step);
  }

  private readonly step = () => {
    const now = performance.now();
    const moving = this.controls.update(Math.min(0.1, (now - this.last) / 1000));
    this.last = now;
    if (this.wanted || moving) {
      this.wanted = false;
      this.paint();
      this.onMove();
    }
    if (moving || this.wanted) requestAnimationFrame(this.step);
    else this.running = false;
  };

  /** Width and height of a pane in CSS pixels. */
  private paneSize(): [number, number] {
    const { clientWidth, clientHeight } = this.canvas;
    return [clientWidth / Math.max(1, this.panes.length), clientHeight];
  }

  /** Length in the picture of a unit of an object, in CSS pixels. */
  pixelsPerUnit(object: DrawnObject): number {
    const [, height] = this.paneSize();
    return (object.group.scale.x * this.camera.zoom * height) / (this.camera.top - this.camera.bottom);
  }

  paint() {
    const { clientWidth, clientHeight } = this.canvas;
    if (this.renderer.xr.isPresenting) return; // the headset renders
    if (clientWidth === 0 || clientHeight === 0) return;
    const { renderer } = this;
    const ratio = Math.min(2, window.devicePixelRatio);
    const size = renderer.getSize(new THREE.Vector2());
    if (size.x !== clientWidth || size.y !== clientHeight || renderer.getPixelRatio() !== ratio) {
      renderer.setPixelRatio(ratio);
      renderer.setSize(clientWidth, clientHeight, false);
    }
    const [width, height] = this.paneSize();
    const [x, y] = halfSizes(width / height);
    if (!this.placed) {
      this.placed = true;
      void this.controls.zoomTo(this.homeZoom(), false);
      this.controls.update(0);
    }
    if (this.camera.right !== x || this.camera.top !== y) {
      Object.assign(this.camera, { left: -x, right: x, top: y, bottom: -y });
      this.camera.updateProjectionMatrix();
    }
    this.camera.updateMatrixWorld();
    renderer.setClearColor(this.background);
    renderer.setScissorTest(false);
    renderer.clear();
    renderer.setScissorTest(true);
    const normal = new THREE.Vector3().setComponent(this.clipAxis, -1);
    this.plane.set(normal, this.clip);
    if (this.clip < 1) shared.clip.value.set(normal.x, normal.y, normal.z, this.clip);
    else shared.clip.value.set(0, 0, 0, 1);
    const { wipe } = this;
    const halves = wipe && this.panes.length === 1 ? [wipe.left, wipe.right] : [];
    halves.forEach((half, i) => {
      for (const one of this.objects) one.group.visible = one === half;
      const edge = Math.round(wipe!.share * width);
      renderer.setViewport(0, 0, width, height);
      renderer.setScissor(i * edge, 0, i === 0 ? edge : width - edge, height);
      renderer.render(this.scene, this.camera);
    });
    if (halves.length === 0)
      this.panes.forEach((pane, i) => {
        for (const one of this.objects) one.group.visible = one === pane || this.layers.includes(one);
        renderer.setViewport(i * width, 0, width, height);
        renderer.setScissor(i * width, 0, width, height);
        renderer.render(this.scene, this.camera);
      });
    if (!this.seen) {
      this.seen = true;
      renderer.getContext().finish();
      performance.mark("first picture");
    }
    this.onDrawn();
  }

  /** Position of a point of an object relative to the canvas; undefined: in no pane. */
  place(object: DrawnObject, point: THREE.Vector3): { x: number; y: number; depth: number } | undefined {
    const pane = this.panes.indexOf(object);
    if (pane < 0) return undefined;
    const [width, height] = this.paneSize();
    const at = object.group.localToWorld(point.clone()).project(this.camera);
    return { x: (pane + 0.5 + at.x / 2) * width, y: (0.5 - at.y / 2) * height, depth: at.z };
  }

  /** Whether a point of the object's surface is not occluded by the object. */
  sees(object: DrawnObject, point: THREE.Vector3): boolean {
    const inverse = object.group.matrixWorld.clone().invert();
    const toward = new THREE.Vector3(0, 0, 1).transformDirection(this.camera.matrixWorld).transformDirection(inverse);
    const step = 1e-3 * Math.hypot(...object.about.size);
    const ray = new THREE.Ray(point.clone().addScaledVector(toward, step), toward);
    return object.bvh.raycastFirst(ray, THREE.DoubleSide) === null;
  }

  pick(x: number, y: number): Hit | undefined {
    const [width, height] = this.paneSize();
    const pane = this.panes[Math.floor(x / width)];
    if (!pane) return undefined;
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * (x % width)) / width - 1, 1 - (2 * y) / height), this.camera);
    ray.ray.applyMatrix4(pane.group.matrixWorld.clone().invert());
    // Orthographic views show the full depth: start the ray in front of everything.
    ray.ray.origin.addScaledVector(ray.ray.direction, -4 * Math.hypot(...pane.about.size));
    const toWorld = pane.group.matrixWorld;
    const hits = pane.bvh.raycast(ray.ray, THREE.DoubleSide).sort((a, b) => a.distance - b.distance);
    const hit = hits.find((one) => this.clip >= 1 || this.plane.distanceToPoint(one.point.clone().applyMatrix4(toWorld)) >= 0);
    if (!hit || hit.faceIndex == null) return undefined;
    const corners = [0, 1, 2].map((k) => pane.shape.triangles[3 * hit.faceIndex! + k]);
    corners.sort((a, b) => pane.vertex(a).distanceToSquared(hit.point) - pane.vertex(b).distanceToSquared(hit.point));
    return { object: pane.index, face: hit.faceIndex, vertex: corners[0], point: hit.point };
  }

  /** Sets how far objects are blended into others, and how far their parts are moved apart. */
  move(blend: number, explode: number) {
    shared.blend.value = blend;
    shared.explode.value = explode;
    this.draw();
  }

  /** The camera as a short text, for addresses. */
  get where(): string {
    const eye = this.controls.getPosition(new THREE.Vector3());
    const target = this.controls.getTarget(new THREE.Vector3());
    return [...eye.toArray(), ...target.toArray(), this.camera.zoom].map((x) => +x.toFixed(3)).join(",");
  }

  set where(text: string) {
    const numbers = text.split(",").map(Number);
    if (numbers.length !== 7 || !numbers.every(Number.isFinite) || numbers[6] <= 0) return;
    const [ex, ey, ez, tx, ty, tz, zoom] = numbers;
    this.placed = true;
    void this.controls.setLookAt(ex, ey, ez, tx, ty, tz, false);
    void this.controls.zoomTo(zoom, false);
    this.draw();
  }
}
