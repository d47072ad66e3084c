// Compares the hashes that a WebAssembly module computes with those in files.
//
//     node compare.mjs MODULE.wasm FILE...
//
// Each line of a file is a name and 16 hexadecimal digits. Each name of the module must occur in at
// least one file, and every file that has the name must have the same hash.

import { readFileSync } from "node:fs";

const [path, ...files] = process.argv.slice(2);
const { instance } = await WebAssembly.instantiate(readFileSync(path), {});
const { count, name, hash } = instance.exports;

function nameOf(check) {
  let text = "";
  for (let at = 0, code; (code = name(check, at)) !== 0; at += 1) {
    text += String.fromCharCode(code);
  }
  return text;
}

const known = files.map((file) => {
  const lines = readFileSync(file, "utf8").split("\n");
  const entries = lines.filter((line) => line !== "" && !line.startsWith("#"));
  return new Map(entries.map((line) => [line.slice(0, -17), line.slice(-16)]));
});

let wrong = 0;
for (let check = 0; check < count(); check += 1) {
  const text = nameOf(check);
  const began = performance.now();
  const digits = BigInt.asUintN(64, hash(check)).toString(16).padStart(16, "0");
  const expected = known.map((entries) => entries.get(text)).filter((other) => other !== undefined);
  const isRight = expected.length > 0 && expected.every((other) => other === digits);
  wrong += isRight ? 0 : 1;
  const verdict = isRight ? "" : ` is wrong: ${expected.join(", ") || "unknown"}`;
  console.log(`${text} ${digits} ${Math.round(performance.now() - began)} ms${verdict}`);
}
console.log(`${count() - wrong} of ${count()} hashes are those expected`);
process.exit(wrong === 0 && count() > 0 ? 0 : 1);
