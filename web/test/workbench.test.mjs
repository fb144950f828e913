// The workbench's page on the real server in a real browser. usage: node workbench.test.mjs COMMAND PROJECT [PICTURES]
// Needs the distribution's Chromium, and playwright-core, iwer and axe-core (npm ci in web/).
import { execFileSync, spawn } from "node:child_process";
import { createHash } from "node:crypto";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, relative } from "node:path";
import assert from "node:assert/strict";
import { chromium } from "playwright-core";

const [command, project, pictures] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "ostraka-workbench-"));
const at = (name) => join(folder, name);
const ostraka = (...words) => execFileSync(command, words, { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
const require = createRequire(import.meta.url);
const patience = 60000;

const browser = await chromium.launch({
  executablePath: process.env.OSTRAKA_CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run"],
});

const failures = [];
let count = 0;
async function test(name, work) {
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

/** The command as a person starts it: its address once it is there. */
function serve(...words) {
  const child = spawn(command, ["workbench", ...words, "--no-browser"], { stdio: ["ignore", "pipe", "pipe"] });
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
  await page.goto(address);
  await settled(page);
  return { page, told, context, close: () => context.close() };
}

/** Nothing is under way, and the picture is drawn. */
const settled = (page) =>
  page.waitForFunction(() => globalThis.ostraka?.model.connected.value && globalThis.ostraka.model.operations.value.length > 0 && globalThis.ostraka.model.busy.value === "", undefined, { timeout: patience });
/** Waits for what is asked of the page; what it says is wrong ends the wait. */
async function until(page, what, condition, argument) {
  const wrong = () => page.evaluate(() => globalThis.ostraka?.model.problem.value?.problem);
  const end = Date.now() + patience;
  for (;;) {
    if (await page.evaluate(`(${condition})(${JSON.stringify(argument)}) && ostraka.model.busy.value === ""`)) return;
    const problem = await wrong();
    if (problem) throw new Error(`${what}: ${problem}`);
    if (Date.now() > end) throw new Error(`${what}: nothing happened; at step ${await page.evaluate(() => ostraka.model.place.value)}, ${await page.evaluate(() => ostraka.model.busy.value)}`);
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
  for (let i = 1; i <= between; ++i) await page.mouse.move(box.x + from[0] + ((to[0] - from[0]) * i) / between, box.y + from[1] + ((to[1] - from[1]) * i) / between);
  await page.mouse.up();
}
const useTool = (page, name) => page.locator(`[data-tool="${name}"]`).click();
const tab = (page, name) => page.locator(`#tab-${name}`).click();
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
    await drag(page, [0.35 * w, 0.05 * h], [0.65 * w, 0.35 * h]);
    await selected(page);
    await page.locator(".annotate input").first().fill("lid");
    await page.locator(".annotate button[type=submit]").first().click();
    await steps(page, 2);
    await useTool(page, "brush");
    await drag(page, [0.45 * w, 0.6 * h], [0.55 * w, 0.6 * h], 8);
    await selected(page);
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
    await page.locator("#panel select[multiple]").selectOption({ label: "lid" });
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
    await page.locator("header select").first().evaluate((select) => select.options.length);
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
    assert.deepEqual(await second.page.evaluate(() => ostraka.page.page.objects[ostraka.page.object.value].annotations.map((a) => a.tag)), before.tags);
    await second.close();
    await again.stop();
    assert.deepEqual(told, []);
    session = at("pot-session");
  });

  await test("the session's study makes the same files to the bit", async () => {
    assert.ok(session);
    ostraka("run", join(session, "session.study.json"), "--output", at("replayed"));
    const [mine, theirs] = [tree(join(session, "steps")), tree(join(at("replayed"), "steps"))];
    const made = [...mine.keys()].filter((name) => !name.endsWith("report.json"));
    assert.ok(made.length >= 9, `${made}`);
    for (const name of made) assert.equal(theirs.get(name), mine.get(name), name);
    // The annotations alone are a recipe.
    const recipe = JSON.parse(readFileSync(join(session, "session.json"))).steps[2].state.objects[0].parts.recipe;
    ostraka("annotation", "apply", at("pot.ply"), join(session, recipe), at("again.ant.json"));
    assert.equal(sha(at("again.ant.json")), sha(join(session, JSON.parse(readFileSync(join(session, "session.json"))).steps[2].state.objects[0].parts.annotations)));
  });
} finally {
  await browser.close();
  if (!process.env.KEEP) rmSync(folder, { recursive: true, force: true });
  else console.log(folder);
}
console.log(`${count - failures.length} of ${count} passed`);
process.exitCode = failures.length > 0 ? 1 : 0;
