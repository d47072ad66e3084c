// Tests of the whole page: template, bundle, the module of the engine, and recordings with known numbers.
//
// The recordings are written by `examples/falling_ball.rs`: a ball of radius 0.5 falls from a height of 3, by 0.1 in
// each step, onto a floor from -4 to 4 whose top is at 0. A second ball rests at x = 2.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createServer, type Server } from "node:http";
import type { AddressInfo } from "node:net";
import { after, before, test } from "node:test";
import type { Browser, Page } from "puppeteer-core";
import type { Vec3 } from "../src/protocol";
import { css } from "../src/color";
import { type EngineError, loadEngine } from "../src/engine";
import { LAYER_NAMES } from "../src/layers";
import { sentence } from "../src/messages";
import { type Projection, projection2, projection3, silhouette } from "./project";
import { fill, findBrowser, findModule, golden, launch, settle, textOf, until, visit, write } from "./support";

const path = findBrowser();
const wasm = findModule();
if (!path) console.log("no browser: the tests of the whole page are skipped");
if (!wasm) console.log("IMPINGE_PAGE_WASM names no module: the tests of the whole page are skipped");
const options = { skip: !path || !wasm, timeout: 240_000 };
const module = wasm ? { wasm } : {};
/** The bounds of the recordings at the first step. */
const BOUNDS2: [Vec3, Vec3] = [
  [-4, -1, 0],
  [4, 4, 0],
];
const BOUNDS3: [Vec3, Vec3] = [
  [-4, -1, -4],
  [4, 4, 4],
];
let browser: Browser;

const falling = (dimension: 2 | 3): Uint8Array => readFileSync(`tests/falling${dimension}.rec`);

function recorded(dimension: 2 | 3): string {
  return write({
    scene: { open: "recording", title: `Falling in ${dimension}D` },
    recording: falling(dimension),
    ...module,
  });
}

/** Returns the number that the panel lists for a term. */
async function listed(page: Page, term: string): Promise<number> {
  const text = await page.$$eval(
    ".selection dt",
    (terms, wanted) => terms.find((other) => other.textContent === wanted)?.nextElementSibling?.textContent ?? "",
    term,
  );
  return Number(text.replace("\u2212", "-"));
}

/** Waits until the text of the selection's panel matches a pattern. */
async function selected(page: Page, pattern: RegExp): Promise<void> {
  await page.waitForFunction(
    (source) => new RegExp(source).test(document.querySelector(".selection")?.textContent ?? ""),
    { polling: 200 },
    pattern.source,
  );
}

async function clickAt(page: Page, project: Projection, at: Vec3, shift = false): Promise<void> {
  const { x, y } = project(at);
  if (shift) await page.keyboard.down("Shift");
  await page.mouse.click(x, y);
  if (shift) await page.keyboard.up("Shift");
  await settle(page);
}

async function dragFrom(page: Page, project: Projection, from: Vec3, to: Vec3): Promise<void> {
  const [start, end] = [project(from), project(to)];
  await page.mouse.move(start.x, start.y);
  await page.mouse.down();
  await page.mouse.move((start.x + end.x) / 2, (start.y + end.y) / 2, { steps: 3 });
  await page.mouse.move(end.x, end.y, { steps: 3 });
  await page.mouse.up();
  await settle(page);
}

before(async () => {
  if (path && wasm) browser = await launch(path);
});

after(async () => {
  await browser?.close();
});

test("recordings of every shape open and run to their end without an error", options, async () => {
  for (const dimension of [2, 3] as const) {
    const address = write({ scene: { open: "recording", title: "Golden" }, recording: golden(dimension), ...module });
    const { page, errors } = await visit(browser, address);
    await until(page, /^step 1 of 10: \d+ objects/);
    await page.keyboard.press(" ");
    await until(page, /^step 10 of 10/);
    // Stand-ins replace the shapes and pair filters of the recorded program. So the replay differs and reports it.
    const others = errors.filter((error) => !error.startsWith("banner: The replay differs from its recording (step "));
    assert.deepEqual(others, []);
    await page.close();
  }
});

test("the legend has the colours in which the engine draws", { skip: !wasm }, async () => {
  const engine = await loadEngine(Uint8Array.from(wasm!));
  const style = readFileSync("page.css", "utf8");
  const found = new Set<string>();
  for (const dimension of [2, 3] as const) {
    const { steps } = engine.open({ kind: "recording", bytes: golden(dimension) });
    for (let step = 1; step <= steps!; step += 1) {
      engine.seek(step);
      const { layers, lines, points, triangles, payload } = engine.frame(LAYER_NAMES, [], 0);
      for (const { count, color, layer } of [lines, points, triangles]) {
        const [colors, indices] = [payload.words(color), payload.words(layer)];
        for (let at = 0; at < count; at += 1) found.add(`${layers[indices[at]!]}: ${css(colors[at]!)}`);
      }
    }
  }
  const swatch = (layer: string): string =>
    new RegExp(`\\.swatch\\.${layer.replace(" ", "-")} \\{ background: (.*?); \\}`).exec(style)?.[1] ?? "";
  for (const one of found) {
    const [layer, color] = one.split(": ") as [string, string];
    assert.equal(swatch(layer), color, layer);
  }
  assert.ok(found.size >= 7, [...found].join(", "));
});

test("balls have the distance that their centres say, at each step, forwards and backwards", options, async () => {
  const { page, errors } = await visit(browser, recorded(2));
  await until(page, /^step 1 of 40: 4 objects/);
  const project = await projection2(page, BOUNDS2);
  await clickAt(page, project, [0, 3.5, 0]);
  await selected(page, /falling ball/);
  await clickAt(page, project, [2, 0.5, 0], true);
  await selected(page, /^Pair of 1 and 2/);
  const apart = (height: number): number => Math.hypot(2, height) - 1;
  assert.ok(Math.abs((await listed(page, "distance")) - apart(3)) < 1e-3, "at the first step");
  await page.keyboard.press("End");
  await until(page, /^step 40 of 40/);
  await settle(page);
  assert.ok(Math.abs((await listed(page, "distance")) - 1) < 1e-3, "at rest");
  for (const _ of [1, 2]) await page.keyboard.press("PageUp");
  await until(page, /^step 20 of 40/);
  await settle(page);
  assert.ok(Math.abs((await listed(page, "distance")) - apart(1.1)) < 1e-3, "backwards");
  assert.equal((await page.$$(".tests li")).length, 4, "groups, filter, boxes and distance");
  assert.ok((await page.$$(".tests .fail")).length > 0, "they do not touch");
  assert.deepEqual(errors, []);
  await page.close();
});

test("a ray that is drawn lists the balls that it hits, in order", options, async () => {
  const { page } = await visit(browser, recorded(2));
  await until(page, /^step 1 of 40/);
  await page.keyboard.press("End");
  await until(page, /^step 40 of 40/);
  const project = await projection2(page, BOUNDS2);
  await page.keyboard.press("r");
  await dragFrom(page, project, [-3, 0.5, 0], [3.5, 0.5, 0]);
  const rows = await page.$$eval(".selection .rows li", (items) => items.map((item) => item.textContent ?? ""));
  const times = rows.map((row) => Number(/at (\S+)/.exec(row)?.[1]));
  assert.equal(rows.length, 2, rows.join("; "));
  assert.ok(Math.abs(times[0]! - 2.5) < 0.02 && Math.abs(times[1]! - 4.5) < 0.02, rows.join("; "));
  await page.close();
});

test("a ball that is dragged away loses its contact, and a step brings it back", options, async () => {
  const { page } = await visit(browser, recorded(2));
  await until(page, /^step 1 of 40: 4 objects, \d+ pairs?, 1 contact\b/);
  await page.keyboard.press("End");
  await until(page, /^step 40 of 40: 4 objects, \d+ pairs?, 2 contacts/);
  const project = await projection2(page, BOUNDS2);
  await page.keyboard.press("m");
  await dragFrom(page, project, [0, 0.5, 0], [-2, 2.5, 0]);
  await until(page, /^step 40 of 40: 4 objects, \d+ pairs?, 1 contact\b/);
  await page.keyboard.press("ArrowLeft");
  await until(page, /^step 39 of 40: 4 objects, \d+ pairs?, 2 contacts/);
  await page.close();
});

test("a ball in 3D is picked where the camera has it, and the picture covers the bounds", options, async () => {
  const { page, errors } = await visit(browser, recorded(3));
  await until(page, /^step 1 of 40: 4 objects/);
  const project = await projection3(page, BOUNDS3);
  await settle(page);
  const seen = await silhouette(page, "solid");
  const floor = [
    [-4, -4],
    [-4, 4],
    [4, -4],
    [4, 4],
  ].flatMap(([x, z]) => [project([x!, 0, z!]), project([x!, -1, z!])]);
  const xs = floor.map(({ x }) => x);
  assert.ok(
    Math.abs(seen.low.x - Math.min(...xs)) < 5 && Math.abs(seen.high.x - Math.max(...xs)) < 5,
    `${JSON.stringify(seen)} is not from ${Math.min(...xs)} to ${Math.max(...xs)}`,
  );
  await clickAt(page, project, [2, 0.5, 0]);
  await selected(page, /resting ball/);
  await clickAt(page, project, [0, 3.5, 0], true);
  await selected(page, /^Pair of 2 and 1/);
  assert.ok(Math.abs((await listed(page, "distance")) - (Math.sqrt(13) - 1)) < 1e-3, "balls");
  await page.keyboard.press("r");
  await clickAt(page, project, [2, 0.5, 0]);
  await selected(page, /2 hits/);
  assert.deepEqual(errors, []);
  await page.close();
});

/** Returns a server of the page and of a recording, which it sends in four pieces. */
function serve(recording: Uint8Array): Server {
  const scene = { open: "live", title: "Live", log: "/log" } as const;
  return createServer((request, response) => {
    if (request.url !== "/log") {
      response.setHeader("content-type", "text/html; charset=utf-8");
      response.end(fill({ scene, ...module }));
      return;
    }
    response.setHeader("content-type", "application/octet-stream");
    const pieces = [0, 1, 2, 3].map((part) =>
      recording.subarray((part * recording.length) / 4, ((part + 1) * recording.length) / 4),
    );
    pieces.forEach((piece, index) => setTimeout(() => response.write(piece), 300 * index));
    setTimeout(() => response.end(), 1500);
  });
}

test("a live recording is followed, and its end is said", options, async () => {
  const server = serve(falling(2));
  await new Promise<void>((ready) => server.listen(0, "127.0.0.1", ready));
  const { port } = server.address() as AddressInfo;
  const { page, errors } = await visit(browser, `http://127.0.0.1:${port}/`);
  await until(page, /^step 40 of 40: 4 objects/);
  await page.waitForFunction(() => document.querySelector(".live")?.textContent === "Ended");
  assert.deepEqual(errors, []);
  await page.close();
  server.close();
});

test("a recording whose program died is played, and its loss is said", options, async () => {
  const recording = falling(2).slice(0, -20);
  const { page, errors } = await visit(
    browser,
    write({ scene: { open: "recording", title: "Died" }, recording, ...module }),
  );
  await until(page, /^step 1 of 39: 4 objects/);
  assert.match(await textOf(page, ".about"), /^The recording has no end: its last \d+ bytes cannot be read/);
  assert.deepEqual(errors, []);
  await page.close();
});

test("a file whose recording has no header says so", options, async () => {
  const recording = falling(2).slice(0, 30);
  const { page } = await visit(
    browser,
    write({ scene: { open: "recording", title: "Damaged" }, recording, ...module }),
  );
  await page.waitForSelector("#notice:not([hidden])");
  assert.match(
    await textOf(page, "#notice"),
    /^This page cannot be shown\. The recording is damaged and cannot be read\./,
  );
  await page.close();
});

test(
  "the gallery lists the samples, and they open and run without an error",
  { ...options, timeout: 900_000 },
  async () => {
    const address = write({ scene: { open: "samples", title: "Samples" }, ...module });
    const { page, errors } = await visit(browser, address, { width: 480, height: 400 });
    await page.waitForSelector(".card");
    const names = await page.$$eval(".card a", (links) => links.map((link) => link.getAttribute("href") ?? ""));
    assert.ok(names.length > 0 && new Set(names).size === names.length, `${names.length} samples`);
    const dimensions = await page.$$eval(".badge", (badges) => badges.map((badge) => badge.textContent));
    await page.evaluate(() => document.querySelector<HTMLButtonElement>("[data-wanted='2']")?.click());
    const shown = await page.$$eval(".card:not([hidden])", (cards) => cards.length);
    assert.equal(shown, dimensions.filter((text) => text === "2D").length);
    // Only every eighth sample runs: a browser without a GPU draws slowly, and the tests of the engine run all samples.
    for (const name of names.filter((_, index) => index % 8 === 0)) {
      await page.evaluate((hash) => (location.hash = hash), name);
      // The test does not wait for a picture: rendering ten thousand objects in software is slow.
      const summary = await until(page, /^step 0: /).catch(() => assert.fail(`${name} does not open`));
      // A picture of a thousand or more objects takes minutes in software, so such a sample need only open.
      if (/^step 0: \d+\s\d{3} objects/.test(summary)) continue;
      await page.keyboard.press("ArrowRight");
      await until(page, /^step 1: \d/).catch(() => assert.fail(`${name} does not run`));
      assert.deepEqual(errors, [], name);
      assert.equal(await page.$("#notice:not([hidden])"), null, name);
    }
    await page.close();
  },
);

test(
  "each sample opens by its link and by a reload, runs at once, and shows no banner",
  { ...options, timeout: 1_800_000 },
  async () => {
    const samples = (await loadEngine(Uint8Array.from(wasm!))).samples();
    const address = write({ scene: { open: "samples", title: "Samples" }, ...module });
    const { page, errors } = await visit(browser, "about:blank", { motion: true, undrawn: true });
    for (const { name } of samples) {
      for (const way of ["link", "reload"]) {
        // Without this, only the hash of the address would change, and the browser would not load the page again.
        if (way === "link") await page.goto("about:blank");
        await (way === "link" ? page.goto(`${address}#sample=${name}`) : page.reload());
        await until(page, /^step [1-9]/).catch(() => assert.fail(`${name} does not run by ${way}`));
        assert.deepEqual(errors, [], `${name} by ${way}`);
      }
    }
    await page.close();
  },
);

test("a name that no sample has is told in words for readers", options, async () => {
  const address = write({ scene: { open: "samples", title: "Samples" }, ...module });
  const { page, errors } = await visit(browser, `${address}#sample=nothing`);
  await page.waitForSelector("#notice:not([hidden])");
  assert.match(await textOf(page, "#notice"), /^There is no sample of this name\./);
  assert.deepEqual(new Set(errors), new Set(["banner: There is no sample of this name."]));
  await page.close();
});

test("no refusal of the engine is what a reader sees", { skip: !wasm }, async () => {
  const engine = await loadEngine(Uint8Array.from(wasm!));
  engine.open({ kind: "sample", name: "stack3" });
  const refused = (act: () => unknown): unknown => {
    try {
      act();
    } catch (error) {
      return error;
    }
    return assert.fail("it is answered");
  };
  const errors = [
    refused(() => engine.advance(-14)),
    refused(() => engine.advance(1e6)),
    refused(() => engine.seek(1)),
    refused(() => engine.object(99_999)),
    refused(() => engine.control("no such control", 1)),
    refused(() => engine.open({ kind: "sample", name: "nothing" })),
    refused(() => engine.open({ kind: "recording", bytes: new Uint8Array(9) })),
    refused(() => engine.open({ kind: "recording", bytes: falling(2).slice(0, 30) })),
    new TypeError("undefined is not a function"),
  ];
  for (const error of errors) {
    const text = sentence(error);
    assert.match(text, /^[A-Z].*\.$/);
    assert.ok(!text.includes((error as Error).message), text);
  }
  assert.equal(new Set(errors.slice(0, 8).map((error) => (error as EngineError).code)).size, 6);
});
