// Bundles the tests, which are TypeScript like the page, and runs them with Node's test runner. `node tests/run.mjs
// look` takes pictures instead, `fps` measures the drawing.

import { build } from "esbuild";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, symlinkSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const web = join(import.meta.dirname, "..");
const output = mkdtempSync(join(tmpdir(), "page-tests-"));
symlinkSync(join(web, "node_modules"), join(output, "node_modules"));

const sources = readdirSync(join(web, "tests")).filter((name) => name.endsWith(".ts") && name !== "fake.ts");
const shared = { absWorkingDir: web, bundle: true, outdir: output, logLevel: "warning" };
await build({
  ...shared,
  entryPoints: sources.map((name) => `tests/${name}`),
  platform: "node",
  format: "esm",
  packages: "external",
  outExtension: { ".js": ".mjs" },
});
await build({ ...shared, entryPoints: ["tests/fake.ts"], format: "iife" });

const [tool, ...rest] = process.argv.slice(2);
const tests = sources
  .filter((name) => name.endsWith(".test.ts"))
  .map((name) => join(output, name.replace(/\.ts$/, ".mjs")));
const command = tool ? [join(output, `${tool}.mjs`), ...rest] : ["--test", "--test-concurrency=1", ...tests];
const { status } = spawnSync(process.execPath, command, {
  cwd: web,
  stdio: "inherit",
  env: { ...process.env, IMPINGE_PAGE_TESTS: output },
});
process.exit(status ?? 1);
