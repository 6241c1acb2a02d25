// Bundles what the page uses of other people's work into the folder above, with their licences and a manifest.
// `npm install --no-package-lock && node build.mjs`, in this folder.

import { createHash } from "node:crypto";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const out = new URL("..", import.meta.url).pathname;
const bundles = ["preact", "codemirror", "mediabunny"];
const { metafile } = await build({
  entryPoints: bundles.map((name) => `${name}.js`),
  outdir: out,
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  charset: "utf8",
  legalComments: "none",
  metafile: true,
});

const packageOf = (path) => path.match(/node_modules\/((?:@[^/]+\/)?[^/]+)/)?.[1];
const facts = (name) => JSON.parse(readFileSync(`node_modules/${name}/package.json`));
const used = new Set(Object.values(metafile.outputs).flatMap(({ inputs }) => Object.keys(inputs).map(packageOf)).filter(Boolean));
const packages = [...used].sort().map((name) => ({ name, version: facts(name).version, license: facts(name).license }));
const licences = packages.map(({ name, version, license }) => {
  const file = readdirSync(`node_modules/${name}`).find((one) => /^licen[cs]e/i.test(one));
  // The MPL demands a note on where to get the source code.
  const source = license.startsWith("MPL") ? `Source code: ${facts(name).repository.url.replace("git+", "")}, or the package ${name} ${version} on npm\n\n` : "";
  return `${name} ${version}\n\n${source}${readFileSync(`node_modules/${name}/${file}`, "utf8").trim()}\n`;
});
writeFileSync(`${out}/LICENSES.txt`, licences.join(`\n${"-".repeat(78)}\n\n`));

const hash = (file) => createHash("sha256").update(readFileSync(`${out}/${file}`)).digest("hex");
const files = [...bundles.map((name) => `${name}.js`), "LICENSES.txt"].map((name) => ({ name, sha256: hash(name) }));
writeFileSync(`${out}/manifest.json`, `${JSON.stringify({ files, packages }, null, 2)}\n`);
