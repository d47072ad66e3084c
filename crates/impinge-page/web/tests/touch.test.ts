// Tests of the page on a touch screen: taps, drags and pinches, with the engine of `fake.ts` instead of the real one.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import type { Browser, Page } from "puppeteer-core";
import type { Vec3 } from "../src/protocol";
import { type Projection, projection2, type Spot } from "./project";
import { findBrowser, launch, settle, textOf, until, visit, write } from "./support";

const path = findBrowser();
if (!path) console.log("no browser: the tests of touches are skipped");
const options = { skip: path === null, timeout: 120_000 };
const samples = write({ scene: { open: "samples", title: "Samples" } });
/** Points inside the boxes 0 and 2 at the first step. Boxes are in rows of eight. */
const [FIRST, THIRD]: [Vec3, Vec3] = [
  [0.2, 0.6, 0],
  [3.2, 0.6, 0],
];
const BOUNDS: [Vec3, Vec3] = [
  [-0.5, 0, 0],
  [11, 15, 0],
];
let browser: Browser;

before(async () => {
  if (path) browser = await launch(path);
});

after(async () => {
  await browser?.close();
});

async function open(): Promise<{ page: Page; project: Projection; errors: string[] }> {
  const look = { fake: true, touch: true, width: 600, height: 900 };
  const { page, errors } = await visit(browser, `${samples}#sample=boxes2:60`, look);
  await until(page, /60 objects/);
  await settle(page);
  return { page, project: await projection2(page, BOUNDS), errors };
}

async function tap(page: Page, { x, y }: Spot): Promise<string> {
  await page.touchscreen.tap(x, y);
  await settle(page);
  return textOf(page, ".selection");
}

/** Moves two fingers symmetrically around a point; their distance from it changes from `from` to `to`. */
async function pinch(page: Page, { x, y }: Spot, from: number, to: number): Promise<void> {
  const left = await page.touchscreen.touchStart(x - from, y);
  const right = await page.touchscreen.touchStart(x + from, y);
  const steps = 8;
  for (let step = 1; step <= steps; step += 1) {
    const half = from + ((to - from) * step) / steps;
    await left.move(x - half, y);
    await right.move(x + half, y);
  }
  await left.end();
  await right.end();
  await settle(page);
}

/** Returns the position of a spot after a magnification around a fixed spot. */
function magnified(spot: Spot, fixed: Spot, factor: number): Spot {
  return { x: fixed.x + factor * (spot.x - fixed.x), y: fixed.y + factor * (spot.y - fixed.y) };
}

test("a tap selects, two taps in the mode of pairs ask for a distance, a tap beside clears", options, async () => {
  const { page, project, errors } = await open();
  assert.match(await tap(page, project(FIRST)), /Object 0\b/);
  await page.tap(".modes button:nth-child(2)");
  assert.match(await tap(page, project(THIRD)), /Pair of 0 and 2[\s\S]*distance\s+2\b/);
  // This tap is farther from all boxes than the tolerance of a finger, so it clears the selection.
  assert.equal(await tap(page, project([4, 13.5, 0])), "");
  assert.deepEqual(errors, []);
  await page.close();
});

test("one finger pans the view, and is no tap", options, async () => {
  const { page, project } = await open();
  const start = project(FIRST);
  const finger = await page.touchscreen.touchStart(start.x, start.y);
  for (let step = 1; step <= 6; step += 1) await finger.move(start.x + 20 * step, start.y - 10 * step);
  await finger.end();
  await settle(page);
  assert.equal(await textOf(page, ".selection"), "", "nothing is selected");
  assert.match(await tap(page, { x: start.x + 120, y: start.y - 60 }), /Object 0\b/, "it moved with the finger");
  await page.close();
});

test("two fingers magnify what is between them in every mode, and select nothing", options, async () => {
  for (const mode of [1, 3, 4]) {
    const { page, project } = await open();
    await page.tap(`.modes button:nth-child(${mode})`);
    // Between two rows, so that no finger is on a box.
    const fixed = project([1.7, 1.5, 0]);
    await pinch(page, fixed, 60, 120);
    assert.equal(await textOf(page, ".selection"), "", `nothing is selected in mode ${mode}`);
    await page.tap(".modes button:nth-child(1)");
    assert.match(await tap(page, magnified(project(FIRST), fixed, 2)), /Object 0\b/, `mode ${mode}`);
    assert.match(await tap(page, magnified(project(THIRD), fixed, 2)), /Object 2\b/, `mode ${mode}`);
    await page.close();
  }
});

test("a finger moves an object", options, async () => {
  const { page, project } = await open();
  await page.tap(".modes button:nth-child(4)");
  const [from, to] = [project(FIRST), project([2.2, 4.6, 0])];
  const finger = await page.touchscreen.touchStart(from.x, from.y);
  for (let step = 1; step <= 8; step += 1) {
    await finger.move(from.x + ((to.x - from.x) * step) / 8, from.y + ((to.y - from.y) * step) / 8);
  }
  await finger.end();
  await settle(page);
  const [x, y] = /position\s+(\S+), (\S+)/
    .exec(await textOf(page, ".selection"))!
    .slice(1)
    .map(Number);
  assert.ok(Math.abs(x! - 2) < 0.05 && Math.abs(y! - 4.5) < 0.05, `${x}, ${y}`);
  await page.close();
});
