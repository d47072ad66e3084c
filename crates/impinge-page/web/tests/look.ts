// Takes screenshots of the page for visual inspection: light and dark, wide and narrow.

import { mkdirSync } from "node:fs";
import type { Page } from "puppeteer-core";
import { findBrowser, findModule, golden, launch, type Look, settle, visit, write } from "./support";

const FOLDER = "tests/shots";

async function take(page: Page, name: string): Promise<void> {
  await settle(page, 700);
  await page.screenshot({ path: `${FOLDER}/${name}.png` });
}

async function clickMiddle(page: Page): Promise<void> {
  const box = await (await page.$("#canvas"))?.boundingBox();
  if (box) await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
}

async function main(): Promise<void> {
  const path = findBrowser();
  if (!path) throw new Error("there is no browser");
  mkdirSync(FOLDER, { recursive: true });
  const browser = await launch(path);
  const wasm = findModule();
  const only = process.argv[2] ?? "";
  const parts = wasm ? { wasm } : {};
  const looks: [string, string, Look][] = [];
  for (const dimension of [2, 3] as const) {
    const address = write({
      scene: { open: "recording", title: `A world in ${dimension}D` },
      recording: golden(dimension),
      ...parts,
    });
    looks.push(
      [`recording${dimension}-light`, address, {}],
      [`recording${dimension}-dark-narrow`, address, { dark: true, width: 400, height: 800 }],
    );
  }
  const samples = write({ scene: { open: "samples", title: "impinge samples" }, ...parts });
  looks.push(["gallery-light", samples, {}], ["gallery-dark-narrow", samples, { dark: true, width: 400, height: 800 }]);
  const named = process.argv.slice(3);
  for (const name of named.length > 0 ? named : wasm ? [] : ["boxes2:60", "boxes3:60"]) {
    looks.push(
      [`sample-${name}-dark`, `${samples}#sample=${name}`, { dark: true }],
      [`sample-${name}-light`, `${samples}#sample=${name}`, {}],
    );
  }
  for (const [name, address, look] of looks.filter(([name]) => name.includes(only))) {
    const { page, errors } = await visit(browser, address, { ...look, fake: wasm === null });
    await settle(page, 600);
    for (let step = 0; name.startsWith("sample") && step < 4; step += 1) await page.keyboard.press("PageDown");
    await settle(page, 900);
    if (!name.startsWith("gallery")) await clickMiddle(page);
    await take(page, name);
    console.log(name, errors);
    await page.close();
  }
  await browser.close();
}

await main();
