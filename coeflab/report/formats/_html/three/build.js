// Makes three.min.js again: `npm install --no-package-lock && npm run build` in a copy of this folder.
import {build} from "esbuild";
import {readFileSync} from "node:fs";

const from = name => readFileSync(`node_modules/three/${name}`, "utf8");
const licence = from("LICENSE").trim(), {version} = JSON.parse(from("package.json"));
await build({
  entryPoints: ["used.js"], outfile: "three.min.js", bundle: true, minify: true, format: "iife", target: "es2022", charset: "utf8",
  legalComments: "none", banner: {js: `/*! three.js ${version}, only what a report uses of it.\n\n${licence}\n*/`},
});
