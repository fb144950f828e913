// The workbench's page on the real server in a real browser. usage: node workbench.test.mjs COMMAND PROJECT [PICTURES]
// Needs the distribution's Chromium, and playwright-core, iwer and axe-core (npm ci in web/).
import { execFileSync, spawn } from "node:child_process";
import { createHash } from "node:crypto";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, relative } from "node:path";
import assert from "node:assert/strict";
import { chromium } from "playwright-core";
import { turnsByHand } from "./pointer.mjs";

const [command, project, pictures, only] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "ostraka-workbench-"));
const at = (name) => join(folder, name);
const ostraka = (...words) => execFileSync(command, words, { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
const require = createRequire(import.meta.url);
const patience = Number(process.env.PATIENCE ?? 60000);

const browser = await chromium.launch({
  executablePath: process.env.OSTRAKA_CHROMIUM ?? "/usr/bin/chromium",
  args: [
    "--no-sandbox",
    "--disable-gpu",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    ...(process.env.PAGE ? ["--disable-features=LocalNetworkAccessChecks"] : []),
  ],
});

const failures = [];
let count = 0;
async function test(name, work) {
  if (only && !name.includes(only)) return;
  ++count;
  const began = Date.now();
  try {
    await work();
    console.log(`ok ${count} - ${name} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failures.push(name);
    console.log(`not ok ${count} - ${name}\n${error.stack}`);
  }
}

const servers = new Set();
/** The command as a person starts it: its address once it is there. */
function serve(...words) {
  const child = spawn(command, ["workbench", ...words, "--no-browser"], { stdio: ["ignore", "pipe", "pipe"] });
  servers.add(child);
  child.on("exit", () => servers.delete(child));
  let said = "";
  child.stderr.on("data", (data) => (said += data));
  const address = new Promise((done, failed) => {
    let out = "";
    child.stdout.on("data", (data) => {
      out += data;
      if (out.includes("\n")) done(out.trim());
    });
    child.on("exit", (code) => failed(new Error(`the command ended with ${code}: ${said}`)));
  });
  const stop = (signal = "SIGTERM") =>
    new Promise((done) => {
      child.on("exit", done);
      child.kill(signal);
    });
  return { address, stop, child };
}

async function open(address, options = {}, script) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 860 }, reducedMotion: "reduce", ...options });
  const page = await context.newPage();
  const told = [];
  page.on("console", (message) => {
    if (!message.text().includes("GL Driver Message")) told.push(message.text());
  });
  page.on("pageerror", (error) => told.push(String(error)));
  if (script) await page.addInitScript(script);
  // A page that was built since the command was.
  if (process.env.PAGE)
    await page.route(
      (url) => url.pathname === "/",
      async (route) => {
        const response = await route.fetch();
        const headers = response.headers();
        delete headers["content-security-policy"];
        await route.fulfill({ response, headers, body: readFileSync(process.env.PAGE, "utf8") });
      },
    );
  await page.goto(address);
  await settled(page).catch((error) => {
    throw new Error(`${error.message}\n${told.join("\n")}`);
  });
  return { page, told, context, close: () => context.close() };
}

/** Nothing is under way, and the picture is drawn. */
const settled = (page) =>
  page.waitForFunction(
    () =>
      globalThis.ostraka?.model.connected.value &&
      globalThis.ostraka.model.operations.value.length > 0 &&
      globalThis.ostraka.model.busy.value === "",
    undefined,
    { timeout: patience },
  );
/** Waits for what is asked of the page; what it says is wrong ends the wait. */
async function until(page, what, condition, argument) {
  const wrong = () => page.evaluate(() => globalThis.ostraka?.model.problem.value?.problem);
  const end = Date.now() + patience;
  for (;;) {
    if (await page.evaluate(`(${condition})(${JSON.stringify(argument)}) && ostraka.model.busy.value === ""`)) return;
    const problem = await wrong();
    if (problem) throw new Error(`${what}: ${problem}`);
    if (Date.now() > end)
      throw new Error(
        `${what}: nothing happened; at step ${await page.evaluate(() => ostraka.model.place.value)}, ${await page.evaluate(() => ostraka.model.busy.value)}`,
      );
    await page.waitForTimeout(50);
  }
}
const selected = (page) => until(page, "selecting", "() => ostraka.selection.selected.value !== undefined");
async function steps(page, n) {
  return until(page, `step ${n}`, "(n) => ostraka.model.place.value === n", n);
}
const look = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
async function drag(page, from, to, between = 4) {
  const box = await page.locator(".canvas canvas").boundingBox();
  await page.mouse.move(box.x + from[0], box.y + from[1]);
  await page.mouse.down();
  for (let i = 1; i <= between; ++i)
    await page.mouse.move(box.x + from[0] + ((to[0] - from[0]) * i) / between, box.y + from[1] + ((to[1] - from[1]) * i) / between);
  await page.mouse.up();
}
const useTool = (page, name) => page.locator(`[data-tool="${name}"]`).click();
const tab = (page, name) => page.locator(`#tab-${name}`).click();
/** Ticks the members of a relationship, and no others. */
async function members(page, ...names) {
  for (const box of await page.locator("#panel .members input:checked").all()) await box.uncheck();
  for (const name of names) await page.locator("#panel .members").getByRole("checkbox", { name, exact: true }).check();
}
const sha = (file) => createHash("sha256").update(readFileSync(file)).digest("hex");
function tree(root) {
  const found = new Map();
  const walk = (folder) => {
    for (const entry of readdirSync(folder, { withFileTypes: true })) {
      const path = join(folder, entry.name);
      if (entry.isDirectory()) walk(path);
      else found.set(relative(root, path), sha(path));
    }
  };
  if (existsSync(root)) walk(root);
  return found;
}
async function picture(page, name) {
  if (!pictures) return;
  mkdirSync(pictures, { recursive: true });
  await look(page);
  await page.screenshot({ path: join(pictures, name) });
}

try {
  ostraka("mesh", "make", "teapot", at("pot.ply"), "--vertices", "6000");

  let session;
  await test("the whole workflow: scan, annotate, relate, cage, constrain, drag, save, reopen", async () => {
    const server = serve(at("pot.ply"));
    const { page, told, close } = await open(await server.address);
    await steps(page, 1);
    // Annotate: a rectangle through the lid, a lasso around the spout.
    await useTool(page, "rectangle");
    const size = await page.evaluate(() => [ostraka.view.canvas.clientWidth, ostraka.view.canvas.clientHeight]);
    const [w, h] = size;
    await drag(page, [0.35 * w, 0.09 * h], [0.65 * w, 0.35 * h]);
    await selected(page);
    await page.locator(".annotate input").first().fill("lid");
    await page.locator(".annotate button[type=submit]").first().click();
    await steps(page, 2);
    await useTool(page, "brush");
    await drag(page, [0.45 * w, 0.6 * h], [0.55 * w, 0.6 * h], 8);
    await selected(page);
    // As drawn: through the triangles, and a line is drawn there.
    assert.ok(
      await page.evaluate(() => {
        const at = ostraka.page.page.objects[0].annotations.findIndex((one) => one.tag === "lid");
        return ostraka.page.page.objects[0].annotations[at].curves?.[0].length > 10 && ostraka.objects[0].marks.has(at);
      }),
    );
    await page.locator(".annotate input").first().fill("belly");
    await page.locator(".annotate button[type=submit]").first().click();
    await steps(page, 3);
    // Measure.
    await useTool(page, "ruler");
    const box = await page.locator(".canvas canvas").boundingBox();
    await page.mouse.click(box.x + 0.45 * w, box.y + 0.55 * h);
    await page.mouse.click(box.x + 0.55 * w, box.y + 0.65 * h);
    await steps(page, 4);
    await picture(page, "workbench-annotations.png");
    // Relate.
    await tab(page, "relating");
    await page.getByRole("button", { name: "Extract relationships" }).click();
    await steps(page, 5);
    await members(page, "lid");
    await page.locator("#panel form select").first().selectOption("keep shape");
    await page.locator("#panel form button[type=submit]").click();
    await steps(page, 6);
    await picture(page, "workbench-relationships.png");
    // Cage.
    await tab(page, "deforming");
    await page.locator("#panel input[type=number]").first().fill("60");
    await page.getByRole("button", { name: "Make cage" }).click();
    await steps(page, 7);
    await page.getByRole("button", { name: "Link cage and mesh" }).click();
    await steps(page, 8);
    await page.evaluate(() => ostraka.deform.ofAnnotation(ostraka.page.page.objects[0].annotations.find((one) => one.tag === "lid").id));
    await settled(page);
    assert.ok((await page.evaluate(() => ostraka.deform.handles.value.size)) > 0);
    await page.getByLabel("Constraints hold").check();
    await useTool(page, "move");
    await drag(page, [0.5 * w, 0.3 * h], [0.5 * w, 0.2 * h], 6);
    await steps(page, 9);
    await page.getByLabel("Constraints hold").uncheck();
    await useTool(page, "rotate");
    await drag(page, [0.5 * w, 0.3 * h], [0.55 * w, 0.3 * h], 4);
    await steps(page, 10);
    await picture(page, "workbench-deformation.png");
    await page.getByRole("button", { name: "Accept" }).click();
    await steps(page, 11);
    // Save, and reopen what was saved.
    await page.locator("header .save input").fill("saved");
    await page.locator("header .save button").click();
    await settled(page);
    assert.equal(await page.evaluate(() => ostraka.model.problem.value), undefined);
    const before = await page.evaluate(() => {
      const one = ostraka.page.page.objects[ostraka.page.object.value];
      return { vertices: one.vertices, tags: one.annotations.map((a) => a.tag), relations: one.relations.length };
    });
    await page
      .locator("header select")
      .first()
      .evaluate((select) => select.options.length);
    await page.evaluate(() => ostraka.model.refresh());
    await page.locator("header select").first().selectOption("saved/saved.template.json");
    await steps(page, 12);
    const after = await page.evaluate(() => {
      const one = ostraka.page.page.objects[ostraka.page.object.value];
      return { vertices: one.vertices, tags: one.annotations.map((a) => a.tag), relations: one.relations.length };
    });
    assert.deepEqual(after, before);
    // A reload shows the same; and so does the server after it was killed.
    await page.reload();
    await steps(page, 12);
    await server.stop("SIGKILL");
    await close();
    const again = serve(at("pot.ply"));
    const second = await open(await again.address);
    await steps(second.page, 12);
    assert.deepEqual(
      await second.page.evaluate(() => ostraka.page.page.objects[ostraka.page.object.value].annotations.map((a) => a.tag)),
      before.tags,
    );
    await second.close();
    await again.stop();
    assert.deepEqual(told, []);
    session = at("pot-session");
  });

  await test("pointer, wheel and fingers turn, move and zoom, with and without motion", async () => {
    copyFileSync(at("pot.ply"), at("turned.ply"));
    const server = serve(at("turned.ply"));
    for (const reducedMotion of ["reduce", "no-preference"]) {
      const { page, told, close } = await open(await server.address, { hasTouch: true, reducedMotion });
      await steps(page, 1);
      await turnsByHand(page);
      assert.deepEqual(told, []);
      await close();
    }
    await server.stop();
  });

  await test("figure 5.3 by hand: a teapot is stretched, its flowers keep their level and their shape", async () => {
    ostraka("mesh", "make", "teapot", at("flowers.ply"), "--vertices", process.env.VERTICES ?? "8000", "--labels", at("flowers.txt"));
    ostraka("annotation", "apply", at("flowers.ply"), join(project, "data/teapot.recipe.json"), at("flowers.ant.json"));
    ostraka("cage", "make", at("flowers.ply"), at("flowers.cage.ply"), "--vertices", process.env.CAGE ?? "150");
    const labels = readFileSync(at("flowers.txt"), "utf8").trim().split(/\s+/).map(Number);
    const server = serve(at("flowers.ply"));
    const { page, told, close } = await open(await server.address);
    await steps(page, 1);
    await tab(page, "relating");
    await members(page, ...[1, 2, 3, 4, 5].map((i) => `flower ${i}`));
    await page.locator("#panel form select").first().selectOption("same level");
    await page.locator("#panel form button[type=submit]").click();
    await steps(page, 2);
    await tab(page, "deforming");
    await page.getByRole("button", { name: "Link cage and mesh" }).click();
    await steps(page, 3);
    // Before the edit: what the cage can hold.
    await until(page, "the reach", "() => ostraka.deform.reach.value !== undefined");
    const reach = await page.evaluate(() => ostraka.deform.reach.value);
    assert.equal(reach.constraints, 1);
    assert.match(reach.texts[0], /same level.*control points are missing there/);
    assert.ok(await page.getByText(reach.texts[0]).isVisible());
    const [w, h] = await page.evaluate(() => [ostraka.view.canvas.clientWidth, ostraka.view.canvas.clientHeight]);
    await page.evaluate(() => (ostraka.selection.visible.value = false));
    await useTool(page, "handles");
    await drag(page, [2, 2], [w - 2, h - 2]);
    assert.equal(
      await page.evaluate(() => ostraka.deform.handles.value.size),
      await page.evaluate(() => ostraka.page.page.objects[0].cage.vertices),
    );
    await useTool(page, "stretch");
    await drag(page, [0.5 * w, 0.7 * h], [0.5 * w, 0.62 * h], 6);
    await steps(page, 4);
    const said = await page.evaluate(() => ostraka.model.outcome.value);
    assert.ok(said.holds, said.text);
    assert.match(said.notes.join(" "), /over the mesh; the parts of 0 \(same level\) are seated/);
    // The file that was written, measured here.
    const shape = (name) => {
      ostraka("mesh", "convert", name, at("measured.obj"));
      const lines = readFileSync(at("measured.obj"), "utf8").split("\n");
      const points = lines.filter((one) => one.startsWith("v ")).map((one) => one.slice(2).trim().split(/\s+/).map(Number));
      const faces = lines
        .filter((one) => one.startsWith("f "))
        .map((one) =>
          one
            .slice(2)
            .trim()
            .split(/\s+/)
            .map((i) => parseInt(i) - 1),
        );
      return { points, faces };
    };
    const deformed = await page.evaluate(() => ostraka.model.object.value.parts.deformed);
    const before = shape(at("flowers.ply"));
    const after = shape(join(at("flowers-session"), deformed));
    const heights = [6, 7, 8, 9, 10].map((label) => {
      let sum = 0;
      let area = 0;
      after.faces.forEach((face, f) => {
        if (labels[f] !== label) return;
        const [p, q, r] = face.map((v) => after.points[v]);
        const [u, v] = [q.map((x, k) => x - p[k]), r.map((x, k) => x - p[k])];
        const size = Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
        sum += (size * (p[2] + q[2] + r[2])) / 3;
        area += size;
      });
      return sum / area;
    });
    assert.ok(Math.max(...heights) - Math.min(...heights) < 1e-3, heights.join(", "));
    // Edges of the flowers are as long as they were; those of the body are longer.
    const length = (points, a, b) => Math.hypot(...points[a].map((x, k) => x - points[b][k]));
    const strain = (label) =>
      Math.max(
        ...before.faces
          .filter((_, f) => labels[f] === label)
          .map(([a, b]) => Math.abs(length(after.points, a, b) / length(before.points, a, b) - 1)),
      );
    assert.ok(strain(6) < 0.05, `${strain(6)}`);
    assert.ok(strain(0) > 0.1, `${strain(0)}`);
    await picture(page, "workbench-flowers.png");
    await close();
    await server.stop();
    assert.deepEqual(told, []);
  });

  await test("the secret is in the page's address alone", async () => {
    mkdirSync(at("alone"));
    copyFileSync(at("pot.ply"), join(at("alone"), "pot.ply"));
    const server = serve(at("alone"));
    const address = await server.address;
    const { page, told, context, close } = await open(address);
    assert.deepEqual(await context.cookies(), []);
    assert.deepEqual(await page.evaluate(() => [localStorage.length, sessionStorage.length, document.cookie]), [0, 0, ""]);
    // A reload works, and so does a second window of that address; one without the token does not.
    await page.reload();
    await settled(page);
    assert.equal(page.url(), address);
    const second = await context.newPage();
    await second.goto(address);
    await settled(second);
    await second.close();
    const third = await context.newPage();
    assert.equal((await third.goto(address.split("?")[0])).status(), 403);
    await third.close();
    // A page of this machine, of another port or a file, leads here (as the desktop's browser is led), and cannot talk itself.
    writeFileSync(at("leads.html"), `<!doctype html><meta http-equiv="refresh" content="0; url=${address}">`);
    const led = await context.newPage();
    await led.goto("file://" + at("leads.html"));
    await settled(led);
    assert.equal(led.url(), address);
    await led.close();
    writeFileSync(at("talks.html"), "<!doctype html><title>another page</title>");
    const other = await context.newPage();
    await other.goto("file://" + at("talks.html"));
    const heard = await other.evaluate(
      (url) =>
        new Promise((done) => {
          const socket = new WebSocket(url);
          socket.onopen = () => done("open");
          socket.onerror = () => done("refused");
        }),
      address.replace("http:", "ws:").replace("/?", "/messages?"),
    );
    assert.equal(heard, "refused");
    await other.close();
    // Nothing that comes into the page later runs.
    assert.deepEqual(told, []);
    await page.evaluate(() => {
      document.body.insertAdjacentHTML(
        "beforeend",
        `<img src=x onerror="globalThis.broken = 1"><svg onload="globalThis.broken = 2"></svg>`,
      );
      const script = document.createElement("script");
      script.textContent = "globalThis.broken = 3";
      document.body.append(script);
    });
    await page.waitForTimeout(300);
    assert.equal(await page.evaluate(() => globalThis.broken), undefined);
    await close();
    await server.stop();
  });

  await test("the session's study makes the same files to the bit", async () => {
    assert.ok(session);
    ostraka("run", join(session, "session.study.json"), "--reads", folder, "--output", at("replayed"));
    const [mine, theirs] = [tree(join(session, "steps")), tree(join(at("replayed"), "steps"))];
    const made = [...mine.keys()].filter((name) => !name.endsWith("report.json"));
    assert.ok(made.length >= 9, `${made}`);
    for (const name of made) assert.equal(theirs.get(name), mine.get(name), name);
    // The annotations alone are a recipe.
    const recipe = JSON.parse(readFileSync(join(session, "session.json"))).steps[2].state.objects[0].parts.recipe;
    ostraka("annotation", "apply", at("pot.ply"), join(session, recipe), at("again.ant.json"));
    assert.equal(
      sha(at("again.ant.json")),
      sha(join(session, JSON.parse(readFileSync(join(session, "session.json"))).steps[2].state.objects[0].parts.annotations)),
    );
  });
  await test("fragments: opened, fitted by a template, completed, one taken out", async () => {
    mkdirSync(at("find"));
    const find = (name) => join(at("find"), name);
    ostraka("mesh", "make", "statuette", find("whole.ply"), "--vertices", "4000");
    ostraka("annotation", "apply", find("whole.ply"), join(project, "data/statuette.recipe.json"), find("whole.ant.json"));
    ostraka("template", "pack", find("whole.template.json"), "--mesh", find("whole.ply"), "--annotations", find("whole.ant.json"));
    for (const [name, part] of [
      ["upper", "head"],
      ["lower", "base"],
    ])
      ostraka(
        "mesh",
        "break",
        find("whole.ply"),
        find(`${name}.ply`),
        "--annotations",
        find("whole.ant.json"),
        "--annotations-out",
        find(`${name}.ant.json`),
        "--share",
        "0.25",
        "--at",
        part,
      );
    const server = serve(at("find"));
    const { page, told, close } = await open(await server.address);
    let n = 0;
    for (const name of ["whole.template.json", "upper.ply", "lower.ply"]) {
      await page.locator("header select").first().selectOption(name);
      await steps(page, ++n);
    }
    // A landmark that is picked by hand on a fragment goes with it.
    await useTool(page, "points");
    const [w, h] = await page.evaluate(() => [ostraka.view.canvas.clientWidth, ostraka.view.canvas.clientHeight]);
    const box = await page.locator(".canvas canvas").boundingBox();
    await page.mouse.click(box.x + 0.5 * w, box.y + 0.5 * h);
    await page.locator(".canvas canvas").press("Enter");
    await selected(page);
    await page.locator(".annotate input").first().fill("seen here");
    await page.locator(".annotate button[type=submit]").first().click();
    await steps(page, ++n);
    // The whole is in the list as a template's file: it is packed once more, as the session has it.
    await page.locator(".layer input").first().check();
    await steps(page, ++n);
    await page.evaluate(() =>
      ostraka.model.run({
        operation: "template pack",
        title: "pack",
        with: { mesh: { part: "mesh", object: 0 }, annotations: { part: "annotations", object: 0 }, copy: true },
      }),
    );
    await steps(page, ++n);
    await tab(page, "fragments");
    await page.locator("#panel details").first().locator("summary").click();
    await page.locator("#input-fragments").selectOption([{ label: "upper: mesh" }, { label: "lower: mesh" }]);
    await page.locator("#input-template").selectOption({ index: 1 });
    await page.getByRole("button", { name: "Run fit" }).click();
    await steps(page, ++n);
    const done = await page.evaluate(() => ({
      objects: ostraka.model.objects.value.map((one) => one.name),
      text: ostraka.model.outcome.value.text,
      maps: ostraka.page.page.objects[ostraka.page.object.value].maps.map((one) => one.name),
    }));
    assert.ok(done.objects.includes("completed"), JSON.stringify(done.objects));
    assert.ok(done.maps.length > 0, "what is observed and what is hypothesis is a map");
    await page.evaluate(() => (ostraka.page.map.value = 0));
    await tab(page, "results");
    await picture(page, "workbench-fragments.png");
    // One fragment is taken out: the step is undone, and the other fitted alone; what was done before stays.
    await page.getByRole("button", { name: "Undo" }).click();
    await steps(page, n - 1);
    assert.ok(!(await page.evaluate(() => ostraka.model.objects.value.map((one) => one.name))).includes("completed"));
    assert.deepEqual(told, []);
    await close();
    await server.stop();
    ostraka("run", join(at("find"), "session", "session.study.json"), "--reads", at("find"), "--output", at("find-again"));
    const [mine, theirs] = [tree(join(at("find"), "session", "steps")), tree(join(at("find-again"), "steps"))];
    for (const name of theirs.keys()) if (!/(report|record).json$/.test(name)) assert.equal(theirs.get(name), mine.get(name), name);
  });

  await test("a pick of the page is that of the command, also far from the origin and turned", async () => {
    ostraka("mesh", "convert", at("pot.ply"), at("near.obj"));
    const far = readFileSync(at("near.obj"), "utf8").replace(
      /^v (\S+) (\S+) (\S+)/gm,
      (_, x, y, z) => `v ${+z + 20000} ${+x - 30000} ${+y + 10000}`,
    );
    writeFileSync(at("far.obj"), far);
    const server = serve(at("far.obj"));
    const { page, told, close } = await open(await server.address);
    await steps(page, 1);
    const found = await page.evaluate(async () => {
      const { view, objects, camera, model } = ostraka;
      const of = objects[0];
      await view.controls.rotate(0.7, -0.3, false);
      await view.controls.truck(0.1, 0.05, false);
      await view.controls.zoomTo(1.7 * view.camera.zoom, false);
      view.controls.update(1);
      view.paint();
      let seed = 5;
      const random = () => (seed = (seed * 1103515245 + 12345) % 2147483648) / 2147483648;
      const result = { tried: 0, same: 0, worst: 0 };
      for (let k = 0; k < 3000 && result.tried < 40; ++k) {
        const [x, y] = [random() * view.canvas.clientWidth, random() * view.canvas.clientHeight];
        const hit = view.pick(x, y);
        if (!hit) continue;
        ++result.tried;
        const expression = { vertices: [{ camera: camera.recipeCamera(of), pixel: camera.paneOf(of, x, y) }] };
        const answer = await model.link.ask("select", { type: "point", expression });
        const off = of.vertex(answer.result.points[0]).distanceTo(of.vertex(hit.vertex));
        result.same += off === 0 ? 1 : 0;
        result.worst = Math.max(result.worst, off / Math.hypot(...of.about.size));
      }
      return result;
    });
    // Where a place is as near to two corners the rounding of the picture decides.
    assert.ok(found.tried === 40 && found.same >= 39 && found.worst < 0.02, JSON.stringify(found));
    assert.deepEqual(told, []);
    await close();
    await server.stop();
  });

  await test("slices: a series with its slider, one where the picture is cut, files to take away", async () => {
    copyFileSync(at("pot.ply"), at("cut.ply"));
    ostraka("annotation", "apply", at("cut.ply"), join(project, "data/teapot.recipe.json"), at("cut.ant.json"));
    const server = serve(at("cut.ply"));
    const { page, told, close } = await open(await server.address);
    await steps(page, 1);
    await tab(page, "slicing");
    await page.locator("#panel input[type=number]").first().fill("20");
    await page.getByRole("button", { name: "Slice", exact: true }).click();
    await steps(page, 2);
    assert.equal(await page.evaluate(() => ostraka.page.page.objects[0].slices.levels.length), 20);
    assert.ok(await page.evaluate(() => ostraka.model.files.value.some((one) => one.name.endsWith(".profile.svg"))));
    // The plane of the picture, in the object's own coordinates: the slice lies on it.
    await page.evaluate(() => (ostraka.page.clip.value = 0.25));
    await page.getByRole("button", { name: "Slice at the cut" }).click();
    await steps(page, 3);
    const found = await page.evaluate(() => {
      const about = ostraka.page.page.objects[0];
      const level = about.slices.levels[0];
      const of = ostraka.objects[0];
      const world = of.group.localToWorld(of.vertex(0).set(...level.origin));
      return { levels: about.slices.levels.length, z: world.z, contours: level.contours.length };
    });
    assert.ok(found.levels === 1 && found.contours > 0 && Math.abs(found.z - 0.25) < 1e-6, JSON.stringify(found));
    await tab(page, "results");
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "cut.slices.json" }).click()]);
    assert.equal(JSON.parse(readFileSync(await download.path(), "utf8")).format, "ostraka-slices");
    // Where several annotations are under the pointer, a list says which.
    await useTool(page, "look");
    const place = await page.evaluate(() => {
      ostraka.page.clip.value = 1;
      const { view } = ostraka;
      for (let y = 20; y < view.canvas.clientHeight; y += 7)
        for (let x = 20; x < view.canvas.clientWidth; x += 7) {
          const hit = view.pick(x, y);
          if (hit && ostraka.objects[0].annotationsOn(hit.face).length > 1)
            return { x, y, list: ostraka.objects[0].annotationsOn(hit.face) };
        }
    });
    const box = await page.locator(".canvas canvas").boundingBox();
    await page.mouse.click(box.x + place.x, box.y + place.y);
    assert.equal(await page.locator(".chooser button").count(), place.list.length);
    await page.locator(".chooser button").last().click();
    assert.equal(await page.evaluate(() => ostraka.page.chosen.value), place.list.at(-1));
    assert.deepEqual(told, []);
    await close();
    await server.stop();
  });

  await test("the picture fills the window; an object stands up by a click on its base; the lamp, the relief, and a measure that stays", async () => {
    // A cone that lies on its side: its base is at x = 0, its tip at x = 2.
    const ring = Array.from({ length: 24 }, (_, i) => `0 ${Math.cos((i * Math.PI) / 12)} ${Math.sin((i * Math.PI) / 12)}`);
    const faces = ring.flatMap((_, i) => [`3 24 ${i} ${(i + 1) % 24}`, `3 25 ${(i + 1) % 24} ${i}`]);
    writeFileSync(at("cone.off"), `OFF\n26 48 0\n${[...ring, "2 0 0", "0 0 0"].join("\n")}\n${faces.join("\n")}\n`);
    const server = serve(at("cone.off"));
    const { page, told, close } = await open(await server.address);
    await steps(page, 1);
    for (const [width, height, share] of [
      [1366, 768, 0.7],
      [1920, 1080, 0.8],
    ]) {
      await page.setViewportSize({ width, height });
      const box = await page.locator(".canvas canvas").boundingBox();
      assert.ok(
        box.width * box.height >= share * width * height,
        `${box.width} x ${box.height} of ${width} x ${height}: ${(box.width * box.height) / width / height}`,
      );
    }
    await page.setViewportSize({ width: 1280, height: 860 });
    await page.locator(".gizmo button.left").click();
    await page.waitForTimeout(300);
    const middle = await page.locator(".canvas canvas").boundingBox();
    const [x, y] = [middle.x + middle.width / 2, middle.y + middle.height / 2];
    await useTool(page, "base");
    await page.mouse.click(x, y);
    await steps(page, 2);
    const along = await page.evaluate(() => {
      const of = ostraka.objects[ostraka.page.object.value];
      const [tip, base] = [24, 25].map((v) => of.group.localToWorld(of.vertex(v)));
      return tip.sub(base).normalize().z;
    });
    assert.ok(along > 0.9999, `the tip points up: ${along}`);
    // Each change of light changes the picture, and a double click takes it back.
    const pixels = async () => {
      await page.waitForTimeout(400);
      return (await page.locator(".canvas canvas").screenshot()).toString("base64");
    };
    const first = await pixels();
    const lamp = await page.locator(".lamp").boundingBox();
    await page.mouse.move(lamp.x + 22, lamp.y + 14);
    await page.mouse.down();
    await page.mouse.move(lamp.x + 4, lamp.y + 22, { steps: 4 });
    await page.mouse.up();
    const [lampX] = await page.evaluate(() => ostraka.page.lamp.value);
    assert.ok(lampX < -0.8, String(lampX));
    const raking = await pixels();
    assert.notEqual(first, raking);
    await page.locator(".light input[type=range]").fill("1");
    assert.notEqual(raking, await pixels());
    await page.locator(".light input[type=range]").fill("0");
    await page.locator(".lamp").dblclick();
    assert.deepEqual(await page.evaluate(() => ostraka.page.lamp.value), [0.263, 0.473]);
    // The scale bar has the length that it states.
    const bar = await page.evaluate(() => {
      const path = document
        .querySelector(".picture path.scale-bar")
        .getAttribute("d")
        .match(/[\d.]+/g)
        .map(Number);
      const of = ostraka.objects[ostraka.page.object.value];
      return {
        pixels: path[3] - path[0],
        text: document.querySelector(".picture text.scale-bar").textContent,
        unit: ostraka.view.pixelsPerUnit(of),
      };
    });
    assert.ok(Math.abs(bar.pixels - Number.parseFloat(bar.text) * bar.unit) < 1e-3, JSON.stringify(bar));
    // A measure without a chosen annotation is drawn, and stays when the tool is put away.
    await useTool(page, "ruler");
    await page.mouse.click(x - 20, y + 10);
    await page.mouse.click(x + 20, y + 10);
    await steps(page, 3);
    await useTool(page, "look");
    await page.waitForTimeout(300);
    assert.match(await page.locator(".picture text.ruler").first().textContent(), /^ruler [\d.]+/);
    assert.deepEqual(told, []);
    await close();
    await server.stop();
  });

  await test("notes and errors have buttons that do the remedy; a part is renamed, recoloured and deleted with its relationships", async () => {
    ostraka("mesh", "make", "box", at("remedy.ply"));
    ostraka("mesh", "convert", at("remedy.ply"), at("remedy.obj"));
    // Two boxes that share one vertex: the surface is cut there, and a note says so.
    const lines = readFileSync(at("remedy.obj"), "utf8").split("\n");
    const points = lines.filter((one) => one.startsWith("v ")).map((one) => one.slice(2).split(" ").map(Number));
    const faces = lines
      .filter((one) => one.startsWith("f "))
      .map((one) =>
        one
          .slice(2)
          .split(" ")
          .map((i) => parseInt(i)),
      );
    const far = points.reduce((best, p, i) => (p[0] + p[1] + p[2] > points[best].reduce((a, b) => a + b) ? i : best), 0);
    const mirrored = points.map((p) => p.map((x, k) => 2 * points[far][k] - x));
    const again = faces.map((f) => [...f].reverse().map((i) => (i - 1 === far ? i : i + points.length)));
    mkdirSync(at("remedies"));
    writeFileSync(
      at("remedies/touching.obj"),
      [...[...points, ...mirrored].map((p) => `v ${p.join(" ")}`), ...[...faces, ...again].map((f) => `f ${f.join(" ")}`), ""].join("\n"),
    );
    copyFileSync(at("pot.ply"), at("remedies/pot.ply"));
    const server = serve(at("remedies"));
    const { page, told, close } = await open(await server.address);
    await page.locator(".start button", { hasText: "touching" }).click();
    await steps(page, 1);
    await page.locator(".notes summary").click();
    assert.ok(!(await page.locator(".notes").innerText()).includes("ostraka"), "no note names a command");
    await page.getByRole("button", { name: "Repair a copy" }).click();
    await steps(page, 2);
    assert.deepEqual(await page.evaluate(() => ostraka.model.objects.value.map((one) => one.name)), ["touching", "touching-repair"]);
    assert.equal(await page.locator(".notes").count(), 0, "the notes are those of the other object");
    // An error whose remedy is a button: the cage that is missing is made.
    await page.locator("header select").first().selectOption("pot.ply");
    await steps(page, 3);
    await page.keyboard.press("Control+k");
    await page.keyboard.type("Link cage");
    await page.keyboard.press("Enter");
    await page.locator("[role=alert] button.remedy").click();
    await page.waitForFunction(() => ostraka.model.place.value === 4 && ostraka.model.busy.value === "", undefined, { timeout: patience });
    assert.equal(await page.evaluate(() => ostraka.model.problem.value), undefined);
    // Two parts and a relationship between them.
    const [w, h] = await page.evaluate(() => [ostraka.view.canvas.clientWidth, ostraka.view.canvas.clientHeight]);
    for (const [name, from, to, step] of [
      ["upper", [0.2, 0.15], [0.8, 0.45], 5],
      ["lower", [0.2, 0.55], [0.8, 0.9], 6],
    ]) {
      await useTool(page, "rectangle");
      await drag(page, [from[0] * w, from[1] * h], [to[0] * w, to[1] * h]);
      await selected(page);
      await page.locator(".annotate input").first().fill(name);
      await page.locator(".annotate button[type=submit]").first().click();
      await steps(page, step);
    }
    await page.evaluate(() =>
      ostraka.model.run({
        operation: "relation add",
        title: "x",
        with: {
          mesh: { part: "mesh" },
          annotations: { part: "annotations" },
          type: "parallel axes",
          annotation: ["upper", "lower"],
        },
        keep: ["output"],
      }),
    );
    await steps(page, 7);
    await page.locator("aside .tree .tag", { hasText: "upper" }).click();
    const name = page.locator(".part-editor input:not([type])");
    await name.fill("shoulder");
    await name.press("Enter");
    await steps(page, 8);
    await page.locator(".part-editor input[type=color]").fill("#00aa00");
    await steps(page, 9);
    const part = await page.evaluate(() => ostraka.page.page.objects[ostraka.page.object.value].annotations[0]);
    assert.deepEqual([part.tag, part.colour], ["shoulder", [0, 170, 0]]);
    // Deleting asks, since a relationship names the part.
    await page.getByRole("button", { name: "Delete", exact: true }).click();
    assert.match(await page.getByRole("alertdialog").innerText(), /“shoulder” is a member of relationships .1./);
    await picture(page, "workbench-delete.png");
    await page.getByRole("button", { name: "Delete all" }).click();
    await steps(page, 11);
    const left = await page.evaluate(() => {
      const about = ostraka.page.page.objects[ostraka.page.object.value];
      return { tags: about.annotations.map((one) => one.tag), relations: about.relations.length };
    });
    assert.deepEqual(left, { tags: ["lower"], relations: 0 });
    assert.deepEqual(told, []);
    await close();
    await server.stop();
  });

  await test("the start page and the list of objects show small pictures", async () => {
    mkdirSync(at("gallery"));
    for (const [file, name] of [
      ["pot.ply", "pot.ply"],
      ["flowers.ply", "flowers.ply"],
    ])
      if (existsSync(at(file))) copyFileSync(at(file), join(at("gallery"), name));
    ostraka("mesh", "make", "box", join(at("gallery"), "box.ply"));
    writeFileSync(join(at("gallery"), "cut.ply"), "ply\nformat ascii 1.0\nelement vertex 3\n");
    const server = serve(at("gallery"));
    const { page, told, close } = await open(await server.address);
    await page.waitForFunction(() => document.querySelectorAll(".start canvas.thumbnail").length >= 2, undefined, { timeout: patience });
    /** How many different colours a picture has. */
    const colours = (which) =>
      page
        .locator(which)
        .first()
        .evaluate((canvas) => {
          const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          return new Set(new Uint32Array(data.buffer)).size;
        });
    assert.ok((await colours(".start canvas.thumbnail")) > 3);
    await picture(page, "workbench-start.png");
    await page.locator(".start button", { hasText: "pot.ply" }).click();
    await steps(page, 1);
    await page.locator("header select").first().selectOption("box.ply");
    await steps(page, 2);
    await page.waitForFunction(() => document.querySelectorAll(".layer canvas.thumbnail").length === 2, undefined, { timeout: patience });
    assert.ok((await colours(".layer canvas.thumbnail")) > 3);
    // What was done before is a click away when everything is undone.
    await page.keyboard.press("Control+z");
    await steps(page, 1);
    await page.keyboard.press("Control+z");
    await steps(page, 0);
    await page.getByRole("button", { name: /Go on with the last session/ }).click();
    await steps(page, 2);
    assert.deepEqual(told, []);
    await close();
    await server.stop();
  });

  await test("the unit and the upward axis are asked once; angle, list of measures, and deleting one", async () => {
    // A table whose legs point along -y, as its file has it.
    const boxes = [[0, 0.7, 0, 1, 0.75, 0.6], ...[0, 0.92].flatMap((x) => [0, 0.52].map((z) => [x, 0, z, x + 0.08, 0.7, z + 0.08]))];
    const sides = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"];
    const text = boxes.flatMap(([x0, y0, z0, x1, y1, z1], b) => [
      ...[0, 1, 2, 3, 4, 5, 6, 7].map((k) => `v ${k & 1 ? x1 : x0} ${k & 2 ? y1 : y0} ${k & 4 ? z1 : z0}`),
      ...sides.map(
        (one) =>
          `f ${one
            .split(" ")
            .map((v) => +v + 8 * b)
            .join(" ")}`,
      ),
    ]);
    writeFileSync(at("table.obj"), text.join("\n") + "\n");
    const server = serve(at("table.obj"));
    const { page, told, close } = await open(await server.address);
    await steps(page, 1);
    assert.match(await page.locator(".first").innerText(), /y is probably up[^]*longest side is 1 long. In m/);
    await picture(page, "workbench-questions.png");
    await page.getByRole("button", { name: "Stand it up" }).click();
    await steps(page, 2);
    const up = () => page.evaluate(() => ostraka.page.page.objects[ostraka.page.object.value].up);
    assert.deepEqual(await up(), [0, 1, 0]);
    await page.locator(".first").getByRole("button", { name: "m", exact: true }).click();
    await steps(page, 3);
    assert.equal(await page.evaluate(() => ostraka.page.page.objects[0].unit), "m");
    assert.equal(await page.locator(".first").count(), 0, "nothing is asked twice");
    // Taken back, a click on the end of one leg stands it on all four.
    await page.keyboard.press("Control+z");
    await steps(page, 2);
    await page.keyboard.press("Control+z");
    await steps(page, 1);
    await useTool(page, "base");
    const onPage = async (v) => {
      const place = await page.evaluate((v) => ostraka.view.place(ostraka.objects[0], ostraka.objects[0].vertex(v).clone()), v);
      const box = await page.locator(".canvas canvas").boundingBox();
      return [box.x + place.x, box.y + place.y];
    };
    const leg = await page.evaluate(() => {
      // A place in the picture where the end of a leg is seen.
      const { view } = ostraka;
      for (let y = 10; y < view.canvas.clientHeight; y += 3)
        for (let x = 10; x < view.canvas.clientWidth; x += 3) {
          const hit = view.pick(x, y);
          if (hit && Math.abs(hit.point.y) < 1e-6) return [x, y];
        }
    });
    assert.ok(leg, "the end of a leg is seen");
    const box = await page.locator(".canvas canvas").boundingBox();
    await page.mouse.click(box.x + leg[0], box.y + leg[1]);
    await steps(page, 2);
    assert.ok(
      (await up()).every((x, k) => Math.abs(x - [0, 1, 0][k]) < 1e-6),
      `${await up()}`,
    );
    await page.locator(".first").getByRole("button", { name: "cm", exact: true }).click();
    await steps(page, 3);
    // A right angle at a corner of the table's top, from above.
    await page.locator(".gizmo button.top").click();
    await page.waitForTimeout(400);
    await useTool(page, "angle");
    for (const v of [2, 3, 7]) {
      const [x, y] = await onPage(v);
      const middle = [box.x + box.width / 2, box.y + box.height / 2];
      // A little towards the middle, where the surface is.
      await page.mouse.click(x + Math.sign(middle[0] - x) * 3, y + Math.sign(middle[1] - y) * 3);
    }
    await steps(page, 4);
    assert.match(await page.locator("#panel .measures").first().innerText(), /∠ angle[^]*90°/);
    await useTool(page, "ruler");
    for (const v of [2, 3]) {
      const [x, y] = await onPage(v);
      const middle = [box.x + box.width / 2, box.y + box.height / 2];
      await page.mouse.click(x + Math.sign(middle[0] - x) * 3, y + Math.sign(middle[1] - y) * 3);
    }
    await steps(page, 5);
    assert.match(await page.locator("#panel .measures").first().innerText(), /ruler \(object\)\s+1 cm/);
    const drawn = await page.locator(".picture text.ruler").allTextContents();
    assert.ok(drawn.some((one) => /∠ angle 90°/.test(one)) && drawn.some((one) => /ruler 1 cm/.test(one)), drawn.join());
    await picture(page, "workbench-measures.png");
    await page.getByRole("button", { name: /Remove: ∠ angle/ }).click();
    await steps(page, 6);
    assert.ok(!(await page.locator("#panel .measures").first().innerText()).includes("∠"));
    assert.deepEqual(told, []);
    await close();
    await server.stop();
  });

  await test("by numbers: the back 20 % higher with its legs level; compared by a line; picture, plate and page; numbers beside the hand", async () => {
    mkdirSync(at("chairs"));
    for (const name of ["chair.ply", "chair.ant.json"]) copyFileSync(join(project, "data", name), join(at("chairs"), name));
    const server = serve(at("chairs"));
    const { page, told, close } = await open(await server.address);
    await page.locator(".start button", { hasText: "chair.ply" }).click();
    await steps(page, 1);
    const height = () =>
      page.evaluate(() => {
        const i = ostraka.page.object.value;
        const of = ostraka.objects[i];
        const back = ostraka.page.page.objects[i].annotations.findIndex((one) => one.tag === "back");
        const z = [...of.regions[back]].flatMap((f) => [0, 1, 2].map((k) => of.vertex(of.shape.triangles[3 * f + k]).z));
        return Math.max(...z) - Math.min(...z);
      });
    const before = await height();
    await tab(page, "deforming");
    await page.locator(".numbers select").first().selectOption({ label: "back" });
    assert.equal(await page.locator(".numbers .kept input:checked").count(), 4, "the legs keep their level unless one says otherwise");
    await page.getByRole("button", { name: "Do it" }).click();
    await steps(page, 2);
    assert.ok(await page.evaluate(() => ostraka.model.outcome.value.holds));
    const ratio = (await height()) / before;
    assert.ok(Math.abs(ratio - 1.2) < 0.01, String(ratio));
    assert.match(await page.locator("#panel .verdict").first().innerText(), /acceptable/);
    // The line between before and after follows the pointer, and the picture with it.
    await page.getByRole("checkbox", { name: /Compare with before/ }).check();
    await look(page);
    const pixels = async () => (await page.locator(".canvas canvas").first().screenshot()).toString("base64");
    const first = await pixels();
    const line = await page.locator(".wipe").boundingBox();
    await page.mouse.move(line.x + 7, line.y + 150);
    await page.mouse.down();
    await page.mouse.move(line.x - 150, line.y + 160, { steps: 5 });
    await page.mouse.up();
    await look(page);
    const moved = await page.locator(".wipe").boundingBox();
    assert.ok(Math.abs(moved.x + 157 - line.x) < 3, `${line.x} ${moved.x}`);
    assert.notEqual(first, await pixels());
    await picture(page, "workbench-compare.png");
    await page.getByRole("checkbox", { name: /Compare with before/ }).uncheck();
    // What one takes away.
    const take = async (name) => {
      const [download] = await Promise.all([
        page.waitForEvent("download", { timeout: patience }),
        page.getByRole("button", { name, exact: true }).click(),
      ]);
      await settled(page);
      return { name: download.suggestedFilename(), data: readFileSync(await download.path()) };
    };
    const png = await take("Picture");
    assert.ok(png.name === "chair.png" && png.data.subarray(1, 4).toString() === "PNG");
    const [width, heightOf] = await page.evaluate(() => [ostraka.view.canvas.width, ostraka.view.canvas.height]);
    assert.deepEqual([png.data.readUInt32BE(16), png.data.readUInt32BE(20)], [width, heightOf]);
    const plate = await take("Plate");
    assert.ok(plate.name === "chair-plate.pdf" && plate.data.subarray(0, 5).toString() === "%PDF-");
    const html = await take("Make a page");
    assert.ok(html.name === "chair.html" && html.data.toString().includes("front left leg"));
    // A drag of the whole: the number is beside the pointer.
    await page.getByRole("button", { name: "Withdraw" }).click();
    await settled(page);
    const [w, h] = await page.evaluate(() => [ostraka.view.canvas.clientWidth, ostraka.view.canvas.clientHeight]);
    await useTool(page, "stretch");
    const box = await page.locator(".canvas canvas").boundingBox();
    await page.mouse.move(box.x + 0.5 * w, box.y + 0.6 * h);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.5 * w, box.y + 0.6 * h - 30, { steps: 5 });
    await page.waitForFunction(() => document.querySelector(".drawing-now .reading")?.textContent.startsWith("20 % higher, from its base"));
    await picture(page, "workbench-reading.png");
    await page.mouse.up();
    await settled(page);
    assert.equal(await page.locator(".drawing-now .reading").count(), 0);
    const sizes = await page.evaluate(() => {
      const of = (deformed) => ostraka.page.page.objects[ostraka.model.shown.value.findIndex((one) => one.deformed === deformed)].size[2];
      return of(true) / of(false);
    });
    assert.ok(Math.abs(sizes - 1.2) < 0.01, String(sizes));
    assert.deepEqual(told, []);
    await close();
    await server.stop();
  });

  await test("on a phone of 390 x 844 nothing overlaps, fingers turn the object, and every command is reached", async () => {
    mkdirSync(at("phone"));
    copyFileSync(join(project, "data/chair.ply"), join(at("phone"), "chair.ply"));
    const server = serve(at("phone"));
    const { page, told, close } = await open(await server.address, {
      viewport: { width: 390, height: 844 },
      hasTouch: true,
      isMobile: true,
    });
    await page.waitForFunction(() => document.querySelector(".start button"), undefined, { timeout: patience });
    await page.locator(".start button", { hasText: "chair.ply" }).tap();
    await steps(page, 1);
    const boxes = await page.evaluate(() =>
      ["header", ".tools", ".canvas", "aside"].map((one) => {
        const { left, top, right, bottom } = document.querySelector(one).getBoundingClientRect();
        return { one, left, top, right, bottom };
      }),
    );
    boxes.forEach((box, i) => {
      assert.ok(box.left >= 0 && box.right <= 391 && box.bottom <= 845, JSON.stringify(box));
      if (i > 0) assert.ok(box.top >= boxes[i - 1].bottom - 1, JSON.stringify(boxes));
    });
    assert.ok(boxes[0].bottom < 60, "the header is one row");
    assert.ok(boxes[2].bottom - boxes[2].top > 0.42 * 844, "the picture has its room");
    // What stands in one row does not cover its neighbour.
    for (const row of ["header", ".tools", ".tabs"]) {
      const covers = await page.evaluate((row) => {
        const list = [...document.querySelector(row).querySelectorAll("button, select, h1, form > input:not([type=file])")]
          .filter((one) => one.offsetParent)
          .map((one) => one.getBoundingClientRect());
        return list.some((a, i) =>
          list.some((b, k) => k > i && a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1),
        );
      }, row);
      assert.ok(!covers, row);
    }
    await picture(page, "workbench-phone.png");
    await turnsByHand(page);
    await page.getByRole("button", { name: "Hide the panel" }).tap();
    assert.equal(await page.locator("aside").count(), 0);
    assert.deepEqual(told, []);
    await close();
    await server.stop();
  });

  await test("relationships: types in groups of the field, forms from each type's declaration, what is refused is said at once", async () => {
    mkdirSync(at("relate"));
    for (const name of ["chair.ply", "chair.ant.json"]) copyFileSync(join(project, "data", name), join(at("relate"), name));
    // As most scans come: no direction is up.
    const set = JSON.parse(readFileSync(join(at("relate"), "chair.ant.json"), "utf8"));
    delete set.up;
    writeFileSync(join(at("relate"), "chair.ant.json"), JSON.stringify(set));
    const server = serve(at("relate"));
    const { page, told, close } = await open(await server.address);
    await page.locator(".start button", { hasText: "chair.ply" }).click();
    await steps(page, 1);
    await tab(page, "relating");
    const type = page.locator("#panel form.operation select").first();
    const groups = await type
      .locator("optgroup")
      .evaluateAll((list) => list.map((one) => [one.label, one.querySelectorAll("option").length]));
    assert.equal(groups.length, 5);
    const offered = await page.evaluate(
      () =>
        ostraka.model.operations.value.find((one) => one.name === "relation add").options.find((one) => one.name === "type").words.length,
    );
    assert.equal(
      groups.reduce((sum, [, count]) => sum + count, 0),
      offered,
      "every type is offered once",
    );
    await type.selectOption("keep measure");
    await members(page, "back");
    await page.locator("#parameter-measure").selectOption("height");
    await page.getByLabel("At least").fill("300");
    await page.getByLabel("At most").fill("600");
    await page.getByLabel("Strength").selectOption("exact");
    await page.locator("#panel form.operation button[type=submit]").click();
    await steps(page, 2);
    const graph = await page.evaluate(async () => {
      const answer = await ostraka.model.link.ask("file", { file: ostraka.model.object.value.parts.graph });
      return JSON.parse(new TextDecoder().decode(answer.bytes));
    });
    assert.deepEqual(graph.relationships.at(-1).constraint, { hard: true, measure: "height", minValue: 300, maxValue: 600 });
    // "Same level" needs a direction that is up: said when it is added, with the button that mends it.
    await type.selectOption("same level");
    await members(page, "front left leg", "front right leg");
    await page.locator("#panel form.operation button[type=submit]").click();
    await page.locator("[role=alert] button.remedy").waitFor();
    await picture(page, "workbench-relate.png");
    await page.locator("[role=alert] button.remedy").click();
    assert.equal(await page.evaluate(() => ostraka.tools.tool.value), "base");
    assert.deepEqual(told, []);
    await close();
    await server.stop();
  });

  await test("strokes of the brush are undone one by one, and the hint says what the next click does", async () => {
    copyFileSync(at("pot.ply"), at("strokes.ply"));
    const server = serve(at("strokes.ply"));
    const { page, told, close } = await open(await server.address);
    await steps(page, 1);
    const [w, h] = await page.evaluate(() => [ostraka.view.canvas.clientWidth, ostraka.view.canvas.clientHeight]);
    const hint = () => page.locator(".hint").last().innerText();
    const count = () => page.evaluate(() => ostraka.selection.selected.value?.count ?? 0);
    await useTool(page, "brush");
    assert.match(await hint(), /Paint on the surface/);
    const counts = [];
    for (const y of [0.45, 0.55, 0.65]) {
      const last = counts.at(-1) ?? 0;
      await drag(page, [0.45 * w, y * h], [0.55 * w, y * h], 8);
      await until(page, "the stroke", "(last) => (ostraka.selection.selected.value?.count ?? 0) > last", last);
      counts.push(await count());
    }
    assert.match(await hint(), /adds to the selection/);
    await page.locator(".canvas canvas").first().focus();
    for (const wanted of [counts[1], counts[0], 0]) {
      await page.keyboard.press("Control+z");
      await until(page, "undone", "(n) => (ostraka.selection.selected.value?.count ?? 0) === n", wanted);
    }
    assert.equal(await page.evaluate(() => ostraka.model.place.value), 1, "no step of the session was undone");
    await page.keyboard.press("Control+y");
    await until(page, "redone", "(n) => ostraka.selection.selected.value?.count === n", counts[0]);
    await page.locator(".annotate input").first().fill("belly");
    await page.locator(".annotate button[type=submit]").first().click();
    await steps(page, 2);
    // Now an undo takes back the annotation; five fast presses are five steps, as far as there are any.
    await page.locator(".canvas canvas").first().focus();
    for (let i = 0; i < 2; ++i) await page.keyboard.press("Control+z");
    await steps(page, 0);
    for (let i = 0; i < 2; ++i) await page.keyboard.press("Control+y");
    await steps(page, 2);
    await useTool(page, "angle");
    const box = await page.locator(".canvas canvas").boundingBox();
    await page.mouse.click(box.x + 0.45 * w, box.y + 0.5 * h);
    assert.match(await hint(), /apex/);
    await page.keyboard.press("Escape");
    assert.deepEqual(told, []);
    await close();
    await server.stop();
  });

  await test("for everybody: keys reach all, axe finds nothing, three languages, tags stay text, problems are told", async () => {
    const evil = "</script><img src=x onerror=alert(1)>";
    copyFileSync(at("pot.ply"), at("evil.ply"));
    ostraka("annotation", "select", at("evil.ply"), at("evil.ant.json"), "--all", "--tag", evil);
    const server = serve(at("evil.ply"));
    const { page, told, close } = await open(await server.address);
    await steps(page, 1);
    assert.equal(await page.locator("img").count(), 0);
    assert.ok((await page.locator("aside .tree .tag").first().textContent()).includes("<img"));
    for (const language of ["en", "de", "it"]) {
      await page.evaluate((language) => ostraka.page.setLanguage(language), language);
      await page.evaluate(readFileSync(require.resolve("axe-core/axe.min.js"), "utf8"));
      for (const name of ["annotating", "measuring", "relating", "deforming", "fragments", "slicing", "everything", "results", "history"]) {
        await tab(page, name);
        if (language !== "en" && name !== "annotating") continue;
        const found = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
        assert.deepEqual(
          found.violations.map((one) => `${name}: ${one.id}: ${one.nodes[0].html}`),
          [],
        );
      }
    }
    await page.evaluate(() => ostraka.page.setLanguage("en"));
    await tab(page, "annotating");
    // Every control is reached by Tab, and the focus is seen.
    await page.evaluate(() => document.activeElement.blur());
    const wanted = await page.evaluate(
      () =>
        [...document.querySelectorAll("button:not(:disabled), select, input:not(:disabled), summary, [tabindex='0']")].filter(
          (one) => one.offsetParent !== null && !(one.type === "radio" && !one.checked),
        ).length,
    );
    const reached = new Set();
    for (let i = 0; i < 2 * wanted && reached.size < wanted; ++i) {
      await page.keyboard.press("Tab");
      const at = await page.evaluate(() => {
        const one = document.activeElement;
        return one === document.body ? undefined : [...document.querySelectorAll("*")].indexOf(one);
      });
      if (at !== undefined) reached.add(at);
    }
    assert.ok(reached.size >= wanted, `${reached.size} of ${wanted} are reached`);
    // The palette, by keys only.
    await page.keyboard.press("Control+k");
    await page.keyboard.type("brush");
    await page.keyboard.press("Enter");
    assert.equal(await page.evaluate(() => ostraka.tools.tool.value), "brush");
    // What goes wrong is told, with what to do about it.
    await page.evaluate(() => ostraka.commands.linkCage());
    await page.waitForFunction(() => document.querySelector("[role=alert]")?.textContent.includes("make a cage first"));
    await page.evaluate(() =>
      ostraka.model.run({ operation: "mesh simplify", title: "x", with: { input: { part: "mesh" }, vertices: -1 } }),
    );
    await page.waitForFunction(() => document.querySelector("[role=alert]")?.textContent.includes("vertices"));
    assert.deepEqual(told, []);
    await close();
    await server.stop();
  });

  await test("virtual reality: gaze, pinch, two hands, voice's words", async () => {
    ostraka("annotation", "apply", at("pot.ply"), join(project, "data/teapot.recipe.json"), at("vr.ant.json"));
    copyFileSync(at("pot.ply"), at("vr.ply"));
    ostraka("annotation", "apply", at("vr.ply"), join(project, "data/teapot.recipe.json"), at("vr.ant.json"));
    ostraka("cage", "make", at("vr.ply"), at("vr.cage.ply"), "--vertices", "80");
    ostraka("cage", "weights", at("vr.ply"), at("vr.cage.ply"), at("vr.npy"));
    const server = serve(at("vr.ply"));
    const headset =
      readFileSync(require.resolve("iwer/build/iwer.min.js"), "utf8") +
      ";globalThis.headset = new IWER.XRDevice(IWER.metaQuest3); headset.installRuntime({ forceInstall: true });";
    const { page, told, close } = await open(await server.address, {}, headset);
    await steps(page, 1);
    await page.getByRole("button", { name: "Enter VR" }).click();
    const frames = (n) =>
      page.evaluate(
        (n) =>
          new Promise((done) => {
            const end = ostraka.xr.frames.value + n;
            const wait = () => (ostraka.xr.frames.value >= end ? done() : requestAnimationFrame(wait));
            wait();
          }),
        n,
      );
    await until(page, "entering", "() => ostraka.xr.isInside() && ostraka.xr.frames.value > 3");
    // The head turns to a control point that is not behind others.
    const gaze = await page.evaluate(() => {
      const of = ostraka.objects[0];
      headset.position.set(0, 1.6, 0);
      const from = { x: 0, y: 1.6, z: 0 };
      let best;
      for (let i = 0; i < ostraka.deform.controls(of); ++i) {
        const p = of.group.localToWorld(ostraka.deform.control(of, i));
        if (!best || p.z > best.p.z) best = { i, p: { x: p.x, y: p.y, z: p.z } };
      }
      const d = [best.p.x - from.x, best.p.y - from.y, best.p.z - from.z];
      const n = Math.hypot(...d);
      // From straight ahead to there.
      const [x, y, z] = d.map((v) => v / n);
      const q = [y, -x, 0, 1 - z];
      const l = Math.hypot(...q);
      headset.quaternion.set(q[0] / l, q[1] / l, q[2] / l, q[3] / l);
      return best;
    });
    await frames(4);
    assert.equal(await page.evaluate(() => ostraka.commands.gazedPoint.value), gaze.i);
    assert.ok(await page.evaluate(() => ostraka.commands.say("select")));
    assert.deepEqual(await page.evaluate(() => [...ostraka.deform.handles.value]), [gaze.i]);
    assert.ok(await page.evaluate(() => ostraka.commands.say("Discard.")));
    assert.equal(await page.evaluate(() => ostraka.deform.handles.value.size), 0);
    // A hand takes it and moves it.
    const before = await page.evaluate(async (i) => {
      const answer = await ostraka.model.link.ask("influence", { handles: [i] });
      const weights = [
        ...new Float32Array(answer.bytes.buffer, answer.bytes.byteOffset + answer.result.values[0], answer.result.values[1] / 4),
      ];
      const about = ostraka.page.page.objects[0];
      return {
        weights,
        rest: [...ostraka.objects[0].shape.positions],
        origin: about.origin,
        diagonal: Math.hypot(...about.size),
        scale: ostraka.objects[0].group.matrixWorld.elements,
      };
    }, gaze.i);
    await page.evaluate(({ x, y, z }) => headset.controllers.right.position.set(x, y, z), gaze.p);
    await frames(4);
    await page.evaluate(() => headset.controllers.right.updateButtonValue("trigger", 1));
    await until(page, "grabbing", "() => ostraka.deform.held() !== undefined");
    for (let k = 1; k <= 4; ++k) {
      await page.evaluate(({ p, k }) => headset.controllers.right.position.set(p.x + 0.03 * k, p.y + 0.02 * k, p.z), { p: gaze.p, k });
      await frames(2);
    }
    await page.evaluate(() => headset.controllers.right.updateButtonValue("trigger", 0));
    await steps(page, 2);
    const after = await page.evaluate(() => {
      const i = ostraka.model.shown.value.findIndex((one) => one.deformed);
      return { positions: [...ostraka.objects[i].shape.positions], origin: ostraka.page.page.objects[i].origin };
    });
    // Of the room 12 cm to the right and 8 up, in the object's own lengths.
    const m = before.scale;
    const column = (k) => [m[4 * k], m[4 * k + 1], m[4 * k + 2]];
    const square = column(0).reduce((sum, x) => sum + x * x, 0);
    const way = [0, 1, 2].map((k) => (column(k)[0] * 0.12 + column(k)[1] * 0.08) / square);
    let worst = 0;
    let most = 0;
    before.weights.forEach((w, v) => {
      const off = [0, 1, 2].map(
        (k) => after.positions[3 * v + k] + after.origin[k] - before.rest[3 * v + k] - before.origin[k] - w * way[k],
      );
      worst = Math.max(worst, Math.hypot(...off));
      most = Math.max(most, w);
    });
    console.log(`# moved vertices are off by ${(worst / before.diagonal).toExponential(2)} of the diagonal at most`);
    assert.ok(worst < 1e-3 * before.diagonal && most > 0.05, `${worst} of ${before.diagonal}, ${most}`);
    // An annotation's control points, scaled by two hands.
    await page.evaluate(() => {
      ostraka.deform.set([]);
      const i = ostraka.page.page.objects[ostraka.page.object.value].annotations.findIndex((one) => one.tag === "handle");
      ostraka.page.choose(i);
      return ostraka.deform.ofAnnotation(ostraka.page.page.objects[ostraka.page.object.value].annotations[i].id);
    });
    assert.ok((await page.evaluate(() => ostraka.deform.handles.value.size)) > 1);
    if (pictures) await picture(page, "workbench-vr.png");
    await page.evaluate(() => {
      headset.controllers.left.position.set(-0.6, 1.0, 0.2);
      headset.controllers.right.position.set(0.6, 1.0, 0.2);
    });
    await frames(3);
    await page.evaluate(() => headset.controllers.left.updateButtonValue("trigger", 1));
    await frames(2);
    await page.evaluate(() => headset.controllers.right.updateButtonValue("trigger", 1));
    await until(page, "holding", "() => ostraka.deform.held()?.motion === 'scale'");
    await page.evaluate(() => headset.controllers.right.position.set(0.84, 1.0, 0.2));
    await frames(3);
    await page.evaluate(() => headset.controllers.left.updateButtonValue("trigger", 0));
    await steps(page, 3);
    await page.evaluate(() => headset.controllers.right.updateButtonValue("trigger", 0));
    await frames(2);
    const scaled = await page.evaluate(async () => {
      const answer = await ostraka.model.link.ask("file", { file: ostraka.model.object.value.parts.edit });
      return JSON.parse(new TextDecoder().decode(answer.bytes)).steps.at(-1);
    });
    assert.ok(Math.abs(scaled.scale.factor - 1.2) < 0.01, JSON.stringify(scaled));
    // Said words.
    assert.ok(await page.evaluate(() => ostraka.commands.say("undo")));
    await steps(page, 2);
    assert.ok(await page.evaluate(() => ostraka.commands.say("level two")));
    const shownNow = await page.evaluate(() => {
      const about = ostraka.page.page.objects[ostraka.page.object.value];
      return about.annotations
        .map((one, i) => [i, ostraka.page.isShown(ostraka.page.object.value, i)])
        .filter(([, is]) => is)
        .map(([i]) => ostraka.commands.depthOf(i));
    });
    assert.ok(shownNow.length > 0 && shownNow.every((depth) => depth === 2), JSON.stringify(shownNow));
    for (const said of ["hide cage", "hide CPs", "show cage", "show CPs"])
      assert.ok(await page.evaluate((said) => ostraka.commands.say(said), said), said);
    assert.ok(!(await page.evaluate(() => ostraka.commands.say("make coffee"))));
    await page.evaluate(() => ostraka.page.setLanguage("de"));
    assert.ok(await page.evaluate(() => ostraka.commands.say("Ebene eins")));
    await page.evaluate(() => ostraka.page.setLanguage("it"));
    assert.ok(await page.evaluate(() => ostraka.commands.say("nascondi gabbia")));
    await page.evaluate(() => ostraka.page.setLanguage("en"));
    await page.evaluate(() => ostraka.commands.say("leave VR"));
    await until(page, "leaving", "() => !ostraka.xr.isInside()");
    assert.deepEqual(told, []);
    await close();
    await server.stop();
  });

  await test("scans dropped onto the page are sent, imported and opened; what cannot be read is said there", async () => {
    mkdirSync(at("empty"));
    mkdirSync(at("scan with parts"));
    // A textured box whose faces have corners of their own on the image, a mesh of points, and one whose edge has three faces.
    const corner = (k) => [k & 1, (k >> 1) & 1, (k >> 2) & 1].join(" ");
    const sides = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"];
    const faces = sides.map(
      (side) =>
        `f ${side
          .split(" ")
          .map((v, k) => `${v}/${k + 1}`)
          .join(" ")}`,
    );
    const points = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => `v ${corner(k)}`);
    writeFileSync(
      at("scan with parts/Box.obj"),
      ["mtllib box.MTL", ...points, "vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1", "usemtl m", ...faces, ""].join("\n"),
    );
    writeFileSync(at("scan with parts/box.mtl"), "newmtl m\nmap_Kd my image.png\n");
    copyFileSync(join(project, "doc/images/vase-profile.png"), at("scan with parts/my image.png"));
    writeFileSync(at("scan with parts/notes.doc"), "of the dig");
    writeFileSync(at("fan.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
    writeFileSync(at("broken.ply"), "ply\nformat ascii 1.0\nelement vertex 3\n");
    writeFileSync(at("old.dae"), "<COLLADA/>");
    ostraka("mesh", "convert", at("pot.ply"), at("pot.glb"));
    writeFileSync(
      at("cloud.xyz"),
      Array.from({ length: 2000 }, (_, i) => {
        const z = 1 - (2 * i + 1) / 2000;
        const turn = i * Math.PI * (3 - Math.sqrt(5));
        return [Math.sqrt(1 - z * z) * Math.cos(turn), Math.sqrt(1 - z * z) * Math.sin(turn), z].join(" ");
      }).join("\n"),
    );
    const server = serve(at("empty"));
    const { page, told, close } = await open(await server.address);
    const screen = await page.context().newCDPSession(page);
    const drop = async (...files) => {
      const data = { items: [], files: files.map(at), dragOperationsMask: 1 };
      await page.evaluate(() => (ostraka.drop.arrival.value = undefined));
      for (const type of ["dragEnter", "dragOver"]) await screen.send("Input.dispatchDragEvent", { type, x: 500, y: 400, data });
      await page.locator(".dropping").waitFor();
      await screen.send("Input.dispatchDragEvent", { type: "drop", x: 500, y: 400, data });
      await page.waitForFunction(() => /done|failed/.test(ostraka.drop.arrival.value?.phase), undefined, { timeout: patience });
      return page.evaluate(() => {
        const { phase, rows, problem } = ostraka.drop.arrival.value;
        return { phase, problem, rows: Object.fromEntries(rows.map((one) => [one.name, one.state])) };
      });
    };
    // A folder.
    const folderDrop = await drop("scan with parts");
    assert.deepEqual(folderDrop, {
      phase: "done",
      problem: undefined,
      rows: {
        "scan with parts/Box.obj": "sound",
        "scan with parts/box.mtl": "sent",
        "scan with parts/my image.png": "sent",
      },
    });
    await steps(page, 1);
    assert.ok(
      await page.evaluate(() => ostraka.page.page.objects[0].texture ?? ostraka.page.page.objects[0].shape?.texture),
      "it has its image",
    );
    assert.deepEqual(await page.evaluate(() => ostraka.model.objects.value.map((one) => one.name)), ["Box"]);
    // Several files: one that cannot be read stops no other.
    const several = await drop("pot.glb", "fan.obj", "cloud.xyz", "broken.ply");
    assert.equal(several.phase, "done", JSON.stringify(several));
    assert.equal(several.rows["broken.ply"], "refused");
    assert.equal(several.rows["cloud.xyz"], "sound");
    assert.match(several.rows["fan.obj"], /sound|open/);
    await steps(page, 2);
    assert.deepEqual((await page.evaluate(() => ostraka.model.objects.value.map((one) => one.name))).sort(), [
      "Box",
      "cloud",
      "fan",
      "pot",
    ]);
    assert.match(await page.locator(".arriving").innerText(), /broken\.ply.*(cut off|ends)/);
    await picture(page, "workbench-dropped.png");
    await page.locator(".arriving button").click();
    // Nothing that can be read: said in place, and nothing changes.
    const nothing = await drop("old.dae");
    assert.equal(nothing.phase, "failed");
    assert.match(await page.locator(".arriving [role=alert]").innerText(), /Blender|MeshLab/);
    const broken = await drop("broken.ply");
    assert.equal(broken.phase, "failed");
    assert.match(broken.problem.problem + broken.problem.where, /broken\.ply|cut off|ends/);
    await steps(page, 2);
    // Chosen by the button.
    await page.evaluate(() => (ostraka.drop.arrival.value = undefined));
    await page.locator("header input[type=file]").setInputFiles(at("pot.glb"));
    await page.waitForFunction(() => ostraka.drop.arrival.value?.phase === "done", undefined, { timeout: patience });
    await steps(page, 3);
    assert.ok(await page.evaluate(() => ostraka.model.objects.value.some((one) => one.name === "pot-2")));
    assert.deepEqual(told, []);
    await close();
    await server.stop();
    // The session repeats as a study, from the files that were sent.
    ostraka("run", at("empty/session/session.study.json"), "--reads", at("empty/session"), "--output", at("again"));
    const again = tree(at("again"));
    for (const [name, sum] of tree(at("empty/session/steps")))
      if (name.endsWith(".ply")) assert.ok([...again.values()].includes(sum), name);
  });
} finally {
  for (const child of servers) child.kill("SIGKILL");
  await browser.close();
  if (!process.env.KEEP) rmSync(folder, { recursive: true, force: true });
  else console.log(folder);
}
console.log(`${count - failures.length} of ${count} passed`);
process.exitCode = failures.length > 0 ? 1 : 0;
