// Bundles the page's sources into dist/page.js. With --verify fails if the committed bundle differs from the result.

import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";

const OUTPUT = new URL("dist/page.js", import.meta.url);

const { outputFiles } = await build({
  entryPoints: ["src/main.ts"],
  absWorkingDir: import.meta.dirname,
  bundle: true,
  minify: true,
  write: false,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "inline",
});
// The bundle is the content of a script element, which `</script` would end.
const bundle = outputFiles[0].text.replaceAll("</script", "<\\/script");

if (process.argv.includes("--verify")) {
  const committed = await readFile(OUTPUT, "utf8").catch(() => "");
  if (committed !== bundle) {
    console.error("dist/page.js is not what the sources give: run `npm run build`");
    process.exit(1);
  }
  console.log("dist/page.js is up to date");
} else {
  await writeFile(OUTPUT, bundle);
  console.log(`dist/page.js: ${bundle.length} bytes`);
}
