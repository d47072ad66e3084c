// Measures how many pictures per second the page draws of a moving world. The engine is that of `fake.ts`, so that most
// of the cost is drawing. The time of scripts, which includes this engine, is what remains with a graphics card;
// without a card, the rest of the time is spent in the rasterizer.

import { findBrowser, launch, settle, until, visit, write } from "./support";

async function main(): Promise<void> {
  const path = findBrowser();
  if (!path) throw new Error("there is no browser");
  const browser = await launch(path);
  const address = write({ scene: { open: "samples", title: "Measurement" } });
  for (const sample of ["boxes2:1000", "boxes3:1000", "boxes2:10000", "boxes3:10000"]) {
    const { page } = await visit(browser, `${address}#sample=${sample}`, { fake: true });
    await until(page, /objects/);
    await page.keyboard.press(" ");
    await settle(page, 2000);
    const before = await page.metrics();
    const pictures = await page.evaluate(countPictures, 6000);
    const { ScriptDuration } = await page.metrics();
    const script = (1000 * ((ScriptDuration ?? 0) - (before.ScriptDuration ?? 0))) / pictures;
    console.log(
      `${sample}: ${(pictures / 6).toFixed(1)} pictures a second, ${script.toFixed(1)} ms of script for each`,
    );
    await page.close();
  }
  await browser.close();
}

/**
 * Runs in the page, and counts animation frames for `duration` milliseconds. The page draws the moving world in each.
 */
async function countPictures(duration: number): Promise<number> {
  const start = performance.now();
  let pictures = 0;
  while (performance.now() - start < duration) {
    await new Promise((next) => requestAnimationFrame(next));
    pictures += 1;
  }
  return pictures;
}

await main();
