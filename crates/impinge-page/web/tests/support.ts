// Creates pages from the template, opens them in a browser, and reads values for tests.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { gzipSync } from "node:zlib";
import puppeteer, { type Browser, type Page } from "puppeteer-core";
import type { Scene } from "../src/embedded";

/** The folder of the page's sources; `run.mjs` starts the tests there. */
const WEB = process.cwd();
/**
 * The timeout in milliseconds. It is long, since software rendering of ten thousand objects is slow on a busy machine.
 */
const PATIENCE = 180_000;
const FLAGS = [
  "--headless=new",
  "--no-sandbox",
  "--use-gl=angle",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
];

/** The parts with which the template is filled. */
export interface Parts {
  scene: Scene;
  recording?: Uint8Array;
  wasm?: Uint8Array;
}

/** Returns the path of a browser, or null if there is none. */
export function findBrowser(): string | null {
  for (const name of ["chromium", "chromium-browser", "google-chrome"]) {
    try {
      return execFileSync("/bin/sh", ["-c", `command -v ${name}`], { encoding: "utf8" }).trim();
    } catch {
      continue;
    }
  }
  return null;
}

export function launch(path: string): Promise<Browser> {
  return puppeteer.launch({ executablePath: path, args: FLAGS });
}

/** Returns the module of the engine, whose path is in `IMPINGE_PAGE_WASM`; null if the variable is not set. */
export function findModule(): Uint8Array | null {
  const path = process.env.IMPINGE_PAGE_WASM;
  return path ? readFileSync(path) : null;
}

/** Returns the golden recording of the crate `impinge-record` in 2D or 3D. */
export function golden(dimension: 2 | 3): Uint8Array {
  return readFileSync(join(WEB, `../../impinge-record/tests/golden/scene${dimension}.rec`));
}

/** Fills the template in one pass, so that inserted text is not filled again. */
export function fill({ scene, recording, wasm }: Parts): string {
  const base64 = (bytes: Uint8Array): string => Buffer.from(bytes).toString("base64");
  const escape = (text: string): string => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
  const values: Record<string, string> = {
    TITLE: escape(scene.title),
    STYLE: readFileSync(join(WEB, "page.css"), "utf8"),
    SCENE: JSON.stringify(scene).replaceAll("<", "\\u003c"),
    RECORDING: base64(recording ?? new Uint8Array([0])),
    WASM: base64(gzipSync(wasm ?? new Uint8Array([0]))),
    SCRIPT: readFileSync(join(WEB, "dist/page.js"), "utf8"),
  };
  const template = readFileSync(join(WEB, "page.html"), "utf8");
  return template.replace(/\{\{([A-Z]+)\}\}/g, (whole, name: string) => values[name] ?? whole);
}

/** Writes a page with these parts into a temporary folder, and returns its address. */
export function write(parts: Parts): string {
  const path = join(mkdtempSync(join(tmpdir(), "page-")), "page.html");
  writeFileSync(path, fill(parts));
  return pathToFileURL(path).href;
}

/** A page of a browser, and the errors that it reported. */
export interface Visit {
  page: Page;
  errors: string[];
}

export interface Look {
  width?: number;
  height?: number;
  dark?: boolean;
  /** Whether the screen is a touch screen. */
  touch?: boolean;
  /** Whether the engine of boxes replaces the module. */
  fake?: boolean;
  /** Whether samples run at once, as without a preference for reduced motion. */
  motion?: boolean;
  /** Whether drawing is disabled, for tests that need no pictures: rendering in software is slow. */
  undrawn?: boolean;
}

export async function visit(browser: Browser, address: string, look: Look = {}): Promise<Visit> {
  const page = await browser.newPage();
  page.setDefaultTimeout(PATIENCE);
  const errors: string[] = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => {
    // Cards request thumbnails, which a single file does not have.
    const isThumbnail = message.location().url?.includes("/thumbnails/") ?? false;
    if (message.type() === "error" && !isThumbnail) errors.push(message.text());
  });
  await page.setViewport({
    width: look.width ?? 1180,
    height: look.height ?? 760,
    hasTouch: look.touch ?? false,
  });
  await page.emulateMediaFeatures([
    { name: "prefers-color-scheme", value: look.dark ? "dark" : "light" },
    { name: "prefers-reduced-motion", value: look.motion ? "no-preference" : "reduce" },
  ]);
  // A banner is an error too, even if it is hidden again at once.
  await page.exposeFunction("banner", (text: string) => errors.push(`banner: ${text}`));
  await page.evaluateOnNewDocument(watchBanner);
  if (look.undrawn) await page.evaluateOnNewDocument(drawNothing);
  if (look.fake)
    await page.evaluateOnNewDocument(readFileSync(join(process.env.IMPINGE_PAGE_TESTS ?? "", "fake.js"), "utf8"));
  await page.goto(address);
  return { page, errors };
}

/** Runs in the page: disables the draw calls of the graphics context; all else is unchanged. */
function drawNothing(): void {
  const context = WebGL2RenderingContext.prototype;
  context.drawArrays = context.drawElements = context.drawArraysInstanced = context.drawElementsInstanced = () => {};
}

/** Runs in the page: reports each text of the notice while it is shown. */
function watchBanner(): void {
  const report = (window as unknown as { banner: (text: string) => void }).banner;
  addEventListener("DOMContentLoaded", () => {
    const notice = document.getElementById("notice");
    if (!notice) return;
    const look = (): void => {
      if (!notice.hidden) report(notice.querySelector("p")?.textContent ?? "");
    };
    new MutationObserver(look).observe(notice, { attributes: true, childList: true, subtree: true });
  });
}

/** Waits until the summary for assistive technology matches a pattern, and returns the summary. */
export async function until(page: Page, pattern: RegExp): Promise<string> {
  await page.waitForFunction(
    (source) => new RegExp(source).test(document.getElementById("summary")?.textContent ?? ""),
    { timeout: PATIENCE, polling: 200 },
    pattern.source,
  );
  return page.$eval("#summary", (element) => element.textContent ?? "");
}

/** Waits for some time, in which the page usually draws. */
export async function settle(page: Page, milliseconds = 400): Promise<void> {
  await page.evaluate((pause) => new Promise((done) => setTimeout(done, pause)), milliseconds);
}

export function textOf(page: Page, selector: string): Promise<string> {
  return page.$eval(selector, (element) => (element as HTMLElement).innerText);
}
