// Times of the workbench: opening a million triangles by phase, picking, pictures, drags. usage: node workbench.figures.mjs COMMAND PROJECT
// (doc/workbench.md, "Measured"). It measures and checks nothing.
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const [command, project] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "ostraka-figures-"));
const at = (name) => join(folder, name);
const ostraka = (...words) => execFileSync(command, words, { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
const median = (list) => [...list].sort((a, b) => a - b)[list.length >> 1];
const high = (list) => [...list].sort((a, b) => a - b)[Math.floor(0.95 * (list.length - 1))];
const text = (x) => x.toFixed(x < 10 ? 2 : 0);

async function serve(file) {
  const began = performance.now();
  const child = spawn(command, ["workbench", file, "--no-browser"], { stdio: ["ignore", "pipe", "ignore"] });
  const address = await new Promise((done) => {
    let out = "";
    child.stdout.on("data", (data) => {
      out += data;
      if (out.includes("\n")) done(out.trim());
    });
  });
  return { child, address, seconds: (performance.now() - began) / 1000 };
}

const browser = await chromium.launch({
  executablePath: process.env.OSTRAKA_CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--disable-background-networking", "--no-first-run"],
});
async function open(address) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 860 } });
  await page.goto(address);
  await page.waitForFunction(
    () => performance.getEntriesByName("scene shown").length > 0 && performance.getEntriesByName("first picture").length > 0,
    undefined,
    { timeout: 120000 },
  );
  return page;
}

try {
  // A scan of a million triangles.
  ostraka("mesh", "make", "statuette", at("scan.ply"), "--vertices", "500000");
  const opened = [];
  let page;
  let child;
  for (let lap = 0; lap < 3; ++lap) {
    rmSync(at("scan-session"), { recursive: true, force: true });
    if (page) await page.close();
    if (child) child.kill();
    const began = performance.now();
    const server = await serve(at("scan.ply"));
    child = server.child;
    page = await open(server.address);
    const inPage = await page.evaluate(() => ({
      first: performance.getEntriesByName("first picture")[0].startTime,
      asked: performance.getEntriesByName("scene asked")[0].startTime,
      there: performance.getEntriesByName("scene there")[0].startTime,
      shown: performance.getEntriesByName("scene shown")[0].startTime,
      origin: performance.timeOrigin,
    }));
    const started = performance.timeOrigin + began;
    const since = (mark) => (inPage.origin + mark - started) / 1000;
    opened.push({
      server: server.seconds,
      asked: since(inPage.asked),
      there: since(inPage.there),
      shown: since(inPage.shown),
      picture: since(inPage.first),
    });
  }
  const faces = await page.evaluate(() => ostraka.page.page.objects[0].faces);
  console.log(
    `${faces} triangles: after the command was started: ${["server", "asked", "there", "shown", "picture"].map((k) => `${k} ${text(median(opened.map((o) => o[k])))} s`).join(", ")}`,
  );
  const picking = await page.evaluate(() => {
    const { view } = ostraka;
    view.pick(300, 300);
    const list = [];
    for (let i = 0; i < 200; ++i) {
      const began = performance.now();
      view.pick(200 + 2 * i, 250 + (i % 50));
      list.push(performance.now() - began);
    }
    return list;
  });
  console.log(`picking: ${median(picking).toFixed(3)} ms (95 %: ${high(picking).toFixed(3)})`);
  const pictures = await page.evaluate(async () => {
    const { view } = ostraka;
    const list = [];
    for (let i = 0; i < 12; ++i) {
      const began = performance.now();
      view.controls.rotate(0.05, 0, false);
      view.controls.update(0.1);
      view.paint();
      const gl = view.renderer.getContext();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
      list.push(performance.now() - began);
    }
    return list;
  });
  console.log(`a picture, drawn by the processor: ${text(median(pictures))} ms`);
  const selecting = await page.evaluate(async () => {
    ostraka.tools.choose("rectangle");
    const began = performance.now();
    const camera = { view: "front" };
    await ostraka.selection.setSelection({ rectangle: { camera, from: [400, 200], to: [800, 500], visible: true } });
    return { ms: performance.now() - began, count: ostraka.selection.selected.value?.count };
  });
  console.log(`a visible-only rectangle, found by the command and drawn: ${text(selecting.ms / 1000)} s, ${selecting.count} triangles`);
  await page.close();
  child.kill();

  // Drags.
  ostraka("mesh", "make", "teapot", at("pot.ply"), "--vertices", "60000");
  ostraka("annotation", "apply", at("pot.ply"), join(project, "data/teapot.recipe.json"), at("pot.ant.json"));
  ostraka("cage", "make", at("pot.ply"), at("pot.cage.ply"), "--vertices", "200");
  ostraka("cage", "weights", at("pot.ply"), at("pot.cage.ply"), at("pot.npy"));
  ostraka(
    "relation",
    "add",
    at("pot.ply"),
    at("pot.ant.json"),
    at("pot.graph.json"),
    "--constraint",
    "--relation",
    "same level: flower 1, flower 2, flower 3, flower 4, flower 5",
    "--relation",
    "keep shape: lid",
    "--relation",
    "keep shape: spout",
    "--relation",
    "co-axiality: lid, base",
  );
  const pot = await serve(at("pot.ply"));
  page = await open(pot.address);
  const drags = async (constraints) =>
    page.evaluate(async (constraints) => {
      const id = (tag) => ostraka.page.page.objects[ostraka.page.object.value].annotations.find((one) => one.tag === tag).id;
      ostraka.deform.set([]);
      await ostraka.deform.ofAnnotation(id("handle"));
      const began = performance.now();
      const answer = await ostraka.model.link.ask("grab", { handles: [...ostraka.deform.handles.value], constraints });
      const grabbed = performance.now() - began;
      const of = ostraka.objects[ostraka.page.object.value];
      const rest = answer.result.handles.map((i) =>
        ostraka.deform
          .control(of, i)
          .toArray()
          .map((x, k) => x + of.about.origin[k]),
      );
      const [alone, server, shown] = [[], [], []];
      const wait = () => {
        const gl = ostraka.view.renderer.getContext();
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
      };
      wait();
      for (let frame = 0; frame < 60; ++frame)
        alone.push(
          1000 * (await ostraka.model.link.ask("drag", { places: rest.map((p) => [p[0], p[1] + 0.2 * frame, p[2]]) })).result.seconds,
        );
      for (let frame = 0; frame < 60; ++frame) {
        const sent = performance.now();
        const { result, bytes } = await ostraka.model.link.ask("drag", { places: rest.map((p) => [p[0], p[1] + 0.2 * frame, p[2]]) });
        of.moveVertices(new Float32Array(bytes.buffer, bytes.byteOffset + result.positions[0], result.positions[1] / 4));
        ostraka.view.paint();
        wait();
        server.push(1000 * result.seconds);
        shown.push(performance.now() - sent);
      }
      return { grabbed, alone, server, shown, handles: rest.length, constrained: answer.result.constrained };
    }, constraints);
  for (const constraints of [false, true]) {
    const found = await drags(constraints);
    console.log(
      `60,000 vertices, 200 control points, ${found.handles} dragged, ${found.constrained ? "with" : "without"} constraints: grab ${text(found.grabbed)} ms; the command ${text(median(found.alone))} ms a frame (95 %: ${text(high(found.alone))}), ${text(median(found.server))} while the processor draws; message to picture ${text(median(found.shown))} ms (95 %: ${text(high(found.shown))})`,
    );
  }
  await page.close();
  pot.child.kill();
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
