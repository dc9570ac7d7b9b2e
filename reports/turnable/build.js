// Builds viewer.js: the sources, and of three.js what they use, in one script without imports. `make viewer` runs it, with the
// folder in which npm has installed the packages.
// The head of that file carries the digest of the sources, the version of three.js and its licence.

import { createHash } from "node:crypto";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

const packages = resolve(process.argv[2], "node_modules");
const { build } = createRequire(join(packages, "any.js"))("esbuild");
const here = (name) => new URL(name, import.meta.url);
const text = (name) => readFileSync(here(name), "utf8");

// As reports/turnable/script.py has it: names and contents, in the order of the names.
const digest = createHash("sha256");
const inputs = ["build.js", "package.json", "package-lock.json", ...readdirSync(here("source")).map((name) => `source/${name}`)];
for (const name of inputs.sort()) digest.update(`${name}\n${text(name)}\n`);

const { version } = JSON.parse(readFileSync(join(packages, "three/package.json"), "utf8"));
const licence = readFileSync(join(packages, "three/LICENSE"), "utf8").trim();
writeFileSync(here("LICENSE.three.txt"), `${licence}\n`);
const bundle = await build({
  entryPoints: [here("source/main.js").pathname],
  nodePaths: [packages],
  bundle: true,
  minify: true,
  write: false,
  format: "iife",
  target: "es2020",
  charset: "ascii",
  legalComments: "none",
});
const head = [`Built by "make viewer" from reports/turnable/source; sources sha256 ${digest.digest("hex")}.`,
  `It contains three.js ${version}, under this licence:`, "", ...licence.split("\n")];
writeFileSync(here("viewer.js"), `/*!\n${head.map((line) => ` * ${line}`.trimEnd()).join("\n")}\n */\n${bundle.outputFiles[0].text}`);
