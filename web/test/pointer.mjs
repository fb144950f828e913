// What people do to a picture with their hands: events of a real pointer, wheel and touch screen, and what is seen afterwards.
import assert from "node:assert/strict";

const canvas = "canvas";

/** Waits until nothing is drawn any more: the camera has come to rest. */
const rest = (page) =>
  page.evaluate(
    () =>
      new Promise((done) => {
        let drawn = 0;
        const before = ostraka.view.onDrawn;
        ostraka.view.onDrawn = () => {
          drawn += 1;
          before();
        };
        let seen = -1;
        const look = () => {
          if (drawn === seen) {
            ostraka.view.onDrawn = before;
            done();
          } else {
            seen = drawn;
            setTimeout(look, 150);
          }
        };
        setTimeout(look, 150);
      }),
  );

/** The camera (direction, target, zoom) and the pixels of the picture. */
async function look(page) {
  await rest(page);
  const [ex, ey, ez, tx, ty, tz, zoom] = await page.evaluate(() => ostraka.view.where.split(",").map(Number));
  const away = Math.hypot(ex - tx, ey - ty, ez - tz);
  const pixels = (await page.locator(canvas).first().screenshot()).toString("base64");
  return { direction: [(ex - tx) / away, (ey - ty) / away, (ez - tz) / away], target: [tx, ty, tz], zoom, pixels };
}

const distance = (a, b) => Math.hypot(...a.map((x, k) => x - b[k]));

/** What each gesture must do, and what it must leave alone. `act` is given the canvas's box. */
async function gesture(page, name, act, { turns = false, moves = false, zooms = false }) {
  const before = await look(page);
  await act(await page.locator(canvas).first().boundingBox());
  const after = await look(page);
  assert.equal(
    distance(before.direction, after.direction) > 0.1,
    turns,
    `${name}: turned by ${distance(before.direction, after.direction)}`,
  );
  if (!zooms)
    assert.equal(distance(before.target, after.target) > 0.02, moves, `${name}: moved by ${distance(before.target, after.target)}`);
  assert.equal(Math.abs(Math.log(after.zoom / before.zoom)) > 0.05, zooms, `${name}: zoom ${before.zoom} became ${after.zoom}`);
  assert.notEqual(before.pixels, after.pixels, `${name}: the picture is the same`);
  return { before, after };
}

async function dragBy(page, box, button, modifiers = []) {
  for (const key of modifiers) await page.keyboard.down(key);
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  await page.mouse.down({ button });
  for (let i = 1; i <= 6; ++i) await page.mouse.move(box.x + (0.5 + 0.03 * i) * box.width, box.y + (0.5 + 0.01 * i) * box.height);
  await page.mouse.up({ button });
  for (const key of modifiers) await page.keyboard.up(key);
}

/** Turns, moves and zooms the picture by mouse, wheel and fingers. The page's context needs `hasTouch`. */
export async function turnsByHand(page) {
  const chosen = () => page.evaluate(() => (ostraka.state ?? ostraka.page).chosen.value);
  const first = await chosen();
  await gesture(page, "dragging", (box) => dragBy(page, box, "left"), { turns: true });
  assert.equal(await chosen(), first, "the end of a drag is not a click");
  await gesture(page, "dragging by the right button", (box) => dragBy(page, box, "right"), { moves: true });
  const wheel = (step) => async (box) => {
    await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
    await page.mouse.wheel(0, step);
  };
  const near = await gesture(page, "the wheel, away from oneself", wheel(-240), { zooms: true });
  assert.ok(near.after.zoom > near.before.zoom);
  const far = await gesture(page, "the wheel, toward oneself", wheel(240), { zooms: true });
  assert.ok(far.after.zoom < far.before.zoom);
  // Fingers: as the browser gets them from a touch screen.
  const screen = await page.context().newCDPSession(page);
  const touch = async (ways) => {
    const at = (t) => ways.map(([from, to], id) => ({ id, x: from[0] + t * (to[0] - from[0]), y: from[1] + t * (to[1] - from[1]) }));
    await screen.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: at(0) });
    for (let i = 1; i <= 6; ++i) await screen.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: at(i / 6) });
    await screen.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  };
  const inside = (box, x, y) => [box.x + x * box.width, box.y + y * box.height];
  const scrolled = () => page.evaluate(() => [scrollX, scrollY]);
  const still = await scrolled();
  await gesture(page, "one finger", (box) => touch([[inside(box, 0.4, 0.5), inside(box, 0.65, 0.55)]]), { turns: true });
  const pinched = await gesture(
    page,
    "two fingers apart",
    (box) =>
      touch([
        [inside(box, 0.45, 0.5), inside(box, 0.3, 0.5)],
        [inside(box, 0.55, 0.5), inside(box, 0.7, 0.5)],
      ]),
    { zooms: true },
  );
  assert.ok(pinched.after.zoom > pinched.before.zoom);
  assert.deepEqual(await scrolled(), still, "fingers on the picture do not scroll the page");
}
