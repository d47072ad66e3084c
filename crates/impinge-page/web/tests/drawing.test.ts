// Tests of the drawing and the operation of the page, with the engine of `fake.ts` instead of the real one.

import assert from "node:assert/strict";
import { createServer, type ServerResponse } from "node:http";
import type { AddressInfo } from "node:net";
import { after, before, test } from "node:test";
import type { Browser, Page } from "puppeteer-core";
import type { Vec3 } from "../src/protocol";
import { corners, projection2, projection3, silhouette } from "./project";
import { fill, findBrowser, golden, launch, settle, textOf, until, visit, write } from "./support";

const path = findBrowser();
if (!path) console.log("no browser: the tests of the page's drawing are skipped");
const options = { skip: path === null, timeout: 120_000 };
const recording = write({ scene: { open: "recording", title: "Boxes <b>&" }, recording: golden(3) });
const samples = write({ scene: { open: "samples", title: "Samples" } });
const BOUNDS2: [Vec3, Vec3] = [
  [-0.5, 0, 0],
  [11, 15, 0],
];
let browser: Browser;

/** Returns the texts that are visible in the picture. */
function labels(page: Page): Promise<(string | null)[]> {
  return page.$$eval("#labels span", (elements) =>
    elements.filter(({ style }) => style.visibility === "visible").map(({ textContent }) => textContent),
  );
}

before(async () => {
  if (path) browser = await launch(path);
});

after(async () => {
  await browser?.close();
});

test("a recording opens without an error, and its title is a text", options, async () => {
  const { page, errors } = await visit(browser, recording, { fake: true });
  await until(page, /^step 0 of 240: 60 objects, 1 pair, 2 contacts; contact of 0 and 1 started$/);
  assert.equal(await textOf(page, "h1"), "Boxes <b>&");
  assert.equal(await page.title(), "Boxes <b>&");
  assert.deepEqual(errors, []);
  await page.close();
});

test("boxes in 2D cover the pixels that the fitted bounds say", options, async () => {
  const { page } = await visit(browser, `${samples}#sample=boxes2:60`, { fake: true });
  await until(page, /60 objects/);
  for (const _ of Array.from({ length: 12 })) await page.keyboard.press("PageDown");
  await until(page, /step 120/);
  await settle(page);
  const project = await projection2(page, BOUNDS2);
  // Every fourth box is blue. In rows of eight these are columns 0 and 4, of rows 0 to 7, whose centres are 1 apart.
  const [low, high] = [project([-0.5, 8, 0]), project([6.5, 0, 0])];
  const seen = await silhouette(page, "blue");
  for (const [one, other] of [
    [seen.low, low],
    [seen.high, high],
  ] as const) {
    assert.ok(
      Math.hypot(one.x - other.x, one.y - other.y) < 4,
      `${JSON.stringify(one)} is not ${JSON.stringify(other)}`,
    );
  }
  // Fifteen boxes of area 1 are blue. A normal covers a part of one, and their edges are darker.
  const box = (high.x - low.x) / 7;
  const expected = 15 * box * box;
  assert.ok(seen.pixels > 0.8 * expected && seen.pixels < 1.05 * expected, `${seen.pixels} of ${expected} pixels`);
  await page.close();
});

/** The bounds of the recording at its first step. */
const BOUNDS3: [Vec3, Vec3] = [
  [-0.5, 0, -0.5],
  [5, 7, 5],
];

/** Returns the gaps between the projection of the fitted bounds and the solids: left, right, above, below. */
async function margins(page: Page): Promise<number[]> {
  const spots = corners(BOUNDS3).map(await projection3(page, BOUNDS3));
  const [xs, ys] = [spots.map(({ x }) => x), spots.map(({ y }) => y)];
  const { low, high } = await silhouette(page, "solid");
  return [low.x - Math.min(...xs), Math.max(...xs) - high.x, low.y - Math.min(...ys), Math.max(...ys) - high.y];
}

test("boxes in 3D nearly fill their bounds, which are fitted again until the view is moved", options, async () => {
  const { page } = await visit(browser, recording, { fake: true });
  await until(page, /step 0/);
  for (const width of [1180, 800, 600]) {
    await page.setViewport({ width, height: 760 });
    await settle(page);
    const found = await margins(page);
    assert.ok(
      found.every((margin) => margin > -4 && margin < 40),
      `margins ${found.join(", ")} at a width of ${width}`,
    );
  }
  await page.keyboard.press("-");
  await settle(page);
  const { low, high } = await silhouette(page, "solid");
  await page.setViewport({ width: 660, height: 760 });
  await settle(page);
  const moved = await silhouette(page, "solid");
  assert.ok(Math.abs(moved.high.x - moved.low.x - (high.x - low.x)) < 4, "the reader's distance stays");
  await page.close();
});

test("texts that would overlap give way, always the same ones", options, async () => {
  const shown: string[][] = [];
  for (const _ of [1, 2]) {
    const { page } = await visit(browser, `${samples}#sample=texts2:60`, { fake: true });
    await until(page, /60 objects/);
    await settle(page);
    const boxes = await page.$$eval("#labels span", (elements) =>
      elements
        .filter(({ style }) => style.visibility === "visible")
        .map((element) => ({ text: element.textContent ?? "", ...element.getBoundingClientRect().toJSON() })),
    );
    for (const [index, one] of boxes.entries()) {
      for (const other of boxes.slice(index + 1)) {
        const apart =
          one.right <= other.left || other.right <= one.left || one.bottom <= other.top || other.bottom <= one.top;
        assert.ok(apart, `${one.text} overlaps ${other.text}`);
      }
    }
    assert.ok(boxes.length >= 8 && boxes.length < 60, `${boxes.length} of 60 texts`);
    shown.push(boxes.map(({ text }) => text));
    // After zooming in, the points are farther apart than the texts are large.
    for (const key of "++++++++++++") await page.keyboard.press(key as "+");
    await settle(page);
    assert.ok((await labels(page)).length > 2, "some remain");
    await page.close();
  }
  assert.deepEqual(shown[0], shown[1]);
});

test("the gallery is searched by words and by dimension", options, async () => {
  const { page } = await visit(browser, samples, { fake: true });
  const titles = (): Promise<string[]> =>
    page.$$eval(".card:not([hidden]) h2", (elements) => elements.map(({ innerText }) => innerText));
  await page.waitForSelector(".card");
  assert.deepEqual(await titles(), ["Boxes in 2D", "Boxes in 3D"]);
  await page.type("input[type=search]", "drag BOXES 3d");
  assert.deepEqual(await titles(), ["Boxes in 3D"], "all words, in any order");
  await page.click("[data-wanted='2']");
  assert.deepEqual(await titles(), []);
  assert.match(await textOf(page, ".filter"), /0 of 2 samples/);
  await page.close();
});

test("two clicks give the distance of two boxes", options, async () => {
  const { page, errors } = await visit(browser, `${samples}#sample=boxes2:60`, { fake: true });
  await until(page, /60 objects/);
  const project = await projection2(page, BOUNDS2);
  const [one, other] = [project([0.2, 0.6, 0]), project([6.1, 0.6, 0])];
  await page.mouse.click(one.x, one.y);
  await page.waitForSelector(".selection:not([hidden])");
  assert.match(await textOf(page, ".selection"), /Object 0[\s\S]*box 0/);
  await page.keyboard.down("Shift");
  await page.mouse.click(other.x, other.y);
  await page.keyboard.up("Shift");
  await page.waitForFunction(() => document.querySelector(".selection h2")?.textContent?.startsWith("Pair"));
  assert.match(await textOf(page, ".selection"), /Pair of 0 and 4[\s\S]*distance\s+5\b/);
  assert.deepEqual(await labels(page), ["5", "normal"], "the length stands at the line");
  assert.equal((await page.$$(".tests .pass")).length, 3);
  assert.equal((await page.$$(".tests .fail")).length, 1);
  await page.keyboard.press("Escape");
  await page.waitForSelector(".selection[hidden]");
  assert.deepEqual(errors, []);
  await page.close();
});

/** Drags box 0 of a 2D stage to (-3.5, 4.5). */
async function dragFirst(page: Page): Promise<void> {
  const project = await projection2(page, BOUNDS2);
  const [from, to] = [project([0.2, 0.6, 0]), project([-3.3, 4.6, 0])];
  await page.keyboard.press("m");
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move((from.x + to.x) / 2, from.y, { steps: 3 });
  await page.mouse.move(to.x, to.y, { steps: 3 });
  await page.mouse.up();
  await settle(page);
}

/** Asserts that box 0 is selected, and is at the position to which `dragFirst` moves it. */
async function assertDragged(page: Page): Promise<void> {
  const text = await textOf(page, ".selection");
  const [x, y] = /position\s+(\S+), (\S+)/
    .exec(text)!
    .slice(1)
    .map((part) => Number(part.replace("\u2212", "-")));
  assert.ok(Math.abs(x! + 3.5) < 0.05 && Math.abs(y! - 4.5) < 0.05, text);
}

test("an object follows the pointer", options, async () => {
  const { page } = await visit(browser, `${samples}#sample=boxes2:60`, { fake: true });
  await until(page, /60 objects/);
  await dragFirst(page);
  await assertDragged(page);
  await page.close();
});

/** Serves the page of a live recording until `act` ends. `push` sends a piece of the recording to the page. */
async function live(act: (address: string, push: () => Promise<void>) => Promise<void>): Promise<void> {
  let connect: (log: ServerResponse) => void;
  const connection = new Promise<ServerResponse>((found) => (connect = found));
  const server = createServer(({ url }, response) => {
    if (url === "/log") return connect(response);
    response.setHeader("content-type", "text/html; charset=utf-8");
    response.end(fill({ scene: { open: "live", title: "Live" } }));
  });
  const push = async (): Promise<void> => {
    (await connection).write("piece");
  };
  await new Promise<void>((ready) => server.listen(0, "127.0.0.1", ready));
  const { port } = server.address() as AddressInfo;
  try {
    await act(`http://127.0.0.1:${port}/`, push);
  } finally {
    server.closeAllConnections();
    server.close();
  }
}

test("an object that is dragged in a live recording stays when the recording grows", options, async () => {
  await live(async (address, push) => {
    const { page, errors } = await visit(browser, address, { fake: true });
    await push();
    await until(page, /^step 0 of 10: 60 objects/);
    await push();
    await until(page, /^step 20 of 20: 60 objects/);
    await dragFirst(page);
    await push();
    await page.waitForFunction(() => document.querySelector(".counter")?.textContent?.endsWith("/ 30"));
    await settle(page);
    await assertDragged(page);
    assert.equal(await textOf(page, ".counter"), "20 / 30", "the page no longer follows");
    await page.click(".live");
    await until(page, /^step 30 of 30/);
    assert.deepEqual(errors, []);
    await page.close();
  });
});

test("a note that comes after the stage was opened is shown, and stays", options, async () => {
  const note = /^The pair filter teams lets all pairs through\.$/;
  const { page } = await visit(browser, recording, { fake: true });
  await until(page, /^step 0 /);
  assert.equal(await page.$(".about"), null);
  for (const [key, summary] of [
    ["PageDown", /^step 10 /],
    ["ArrowRight", /^step 11 /],
  ] as const) {
    await page.keyboard.press(key);
    await until(page, summary);
    assert.match(await textOf(page, ".about"), note);
  }
  await page.close();
  await live(async (address, push) => {
    const { page } = await visit(browser, address, { fake: true });
    await push();
    await until(page, /^step 0 of 10/);
    assert.equal(await page.$(".about"), null);
    await push();
    await until(page, /^step 20 of 20/);
    assert.match(await textOf(page, ".about"), note);
    await page.close();
  });
});

test("keys step, scrub, play and show the list of keys", options, async () => {
  const { page } = await visit(browser, recording, { fake: true });
  await until(page, /^step 0 /);
  await page.keyboard.press("ArrowRight");
  await until(page, /^step 1 /);
  await page.keyboard.press("End");
  await until(page, /^step 240 /);
  await page.keyboard.press("ArrowLeft");
  await until(page, /^step 239 /);
  await page.keyboard.press("Home");
  await until(page, /^step 0 /);
  await page.keyboard.press(" ");
  assert.equal(await page.$eval(".play", (element) => element.getAttribute("aria-label")), "Pause");
  await until(page, /^step (?!0 )\d+ /);
  await page.keyboard.press(" ");
  assert.equal(await page.$eval(".play", (element) => element.getAttribute("aria-label")), "Play");
  await page.keyboard.press("2");
  assert.equal(await page.$eval(".layers li:nth-child(2) input", (element) => element.checked), true);
  await page.keyboard.press("?");
  assert.match(await textOf(page, "dialog[open]"), /play or pause/);
  await page.keyboard.press("Escape");
  assert.equal(await page.$("dialog[open]"), null);
  await page.close();
});

test("the time line is a slider that is dragged", options, async () => {
  const { page } = await visit(browser, recording, { fake: true });
  await until(page, /^step 0 /);
  const box = (await (await page.$(".timeline"))!.boundingBox())!;
  const x = (step: number): number => box.x + 10 + (step / 240) * (box.width - 20);
  await page.mouse.move(x(60), box.y + 30);
  await page.mouse.down();
  await until(page, /^step 60 /);
  await page.mouse.move(x(180), box.y + 30, { steps: 4 });
  await until(page, /^step 180 /);
  await page.mouse.up();
  assert.equal(await page.$eval(".timeline input", (element) => element.value), "180");
  await page.keyboard.press("PageUp");
  await until(page, /^step 170 /);
  await page.close();
});

test("every control has a name, and what has the focus is marked", options, async () => {
  const { page } = await visit(browser, `${samples}#sample=boxes3:60`, { fake: true });
  await until(page, /60 objects/);
  const nameless = await page.$$eval(
    "#viewer :is(button, input, select, [tabindex])",
    (elements) =>
      elements.filter((element) => {
        const own = element.getAttribute("aria-label") ?? element.textContent?.trim();
        return !own && !element.closest("label")?.textContent?.trim();
      }).length,
  );
  assert.equal(nameless, 0);
  await page.keyboard.press("Tab");
  const outline = await page.evaluate(() => getComputedStyle(document.activeElement!).outlineStyle);
  assert.notEqual(outline, "none");
  await page.close();
});

test("a narrow page does not scroll sideways", options, async () => {
  for (const address of [recording, samples, `${samples}#sample=boxes2:60`]) {
    const { page } = await visit(browser, address, { fake: true, width: 380, height: 780, dark: true });
    await settle(page);
    const [scroll, client] = await page.evaluate(() => [
      document.documentElement.scrollWidth,
      document.documentElement.clientWidth,
    ]);
    assert.ok(scroll! <= client!, `${scroll} of ${client} at ${address}`);
    await page.close();
  }
});

test("a file that lacks its engine says so", options, async () => {
  const { page } = await visit(browser, recording);
  await page.waitForSelector("#notice:not([hidden])");
  assert.match(await textOf(page, "#notice"), /This page cannot be shown/);
  await page.close();
});

test("a sample runs at once, though the clock is ahead of the first picture", options, async () => {
  const { page, errors } = await visit(browser, "about:blank", { fake: true, motion: true });
  // In this browser the times of pictures are half a second behind its clock.
  await page.evaluateOnNewDocument(() => {
    const later = performance.now.bind(performance);
    performance.now = () => later() + 500;
  });
  await page.goto(`${samples}#sample=boxes2:60`);
  await until(page, /^step [1-9]/);
  assert.deepEqual(errors, []);
  await page.close();
});
