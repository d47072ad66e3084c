// Tests the schema of scene files with an independent validator of JSON Schema: it accepts the examples, and rejects
// the scenes that the loader rejects (crates/impinge-files/tests/it/scenes.rs reads the same list).

import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { Ajv2020 } from "ajv/dist/2020.js";

const files = join(process.cwd(), "../../impinge-files");
const read = (path: string) => JSON.parse(readFileSync(join(files, path), "utf8")) as unknown;
// Formats such as `uint32` are annotations: the schema itself bounds the numbers.
const accepts = new Ajv2020({ validateFormats: false }).compile(read("scene.schema.json") as object);

test("the schema accepts the example scenes", () => {
  const scenes = readdirSync(join(files, "scenes")).filter((name) => name.endsWith(".json"));
  assert.equal(scenes.length, 6);
  for (const name of scenes) assert.ok(accepts(read(`scenes/${name}`)), `${name}: ${JSON.stringify(accepts.errors)}`);
});

test("the schema refuses what the loader refuses", () => {
  for (const scene of read("tests/data/refused.json") as unknown[]) assert.ok(!accepts(scene), JSON.stringify(scene));
});
