// Packs the page's modules into one with esbuild: `node pack.js FOLDER_OF_NODE_MODULES < modules`.
//
// Reads `{name: source}` as JSON, and writes `{code, map, exports}`. The pack exports `modules`, its
// modules by their names, for those that are not in it; `exports` are the names that each exports.

import path from "node:path";
import { pathToFileURL } from "node:url";

/** @import {BuildOptions, Plugin} from "esbuild" */

const [folder] = process.argv.slice(2);
/** @type {typeof import("esbuild")} */
const { build } = await import(pathToFileURL(`${folder}/esbuild/lib/main.js`).href);

/** Made by the server for each page. */
const CONSTANTS = "constants.js";
const ENTRY = "packed.js";

const chunks = [];
for await (const chunk of process.stdin) chunks.push(chunk);
const sources = JSON.parse(Buffer.concat(chunks).toString());
const names = Object.keys(sources).sort();

const entry = [
  ...names.map((name, i) => `import * as m${i} from "webviz/${name}";`),
  `export const modules = { ${names.map((name, i) => `"${name}": m${i}`).join(", ")} };`,
].join("\n");

/** @type {Plugin} */
const page = {
  name: "page",
  setup(build) {
    build.onResolve({ filter: /.*/ }, ({ path: wanted }) => {
      const name = wanted.replace(/^webviz\//, "");
      if (name === CONSTANTS) return { path: `webviz/${CONSTANTS}`, external: true };
      return { path: name, namespace: "page" };
    });
    build.onLoad({ filter: /.*/, namespace: "page" }, ({ path: name }) => ({
      contents: name === ENTRY ? entry : sources[name],
    }));
  },
};

/** @type {BuildOptions & {write: false}} */
const common = { plugins: [page], format: "esm", target: "es2024", charset: "utf8", write: false };
const packed = await build({
  ...common,
  entryPoints: [ENTRY],
  outfile: ENTRY,
  bundle: true,
  // Names stay as they are: they stand in stack traces.
  minifyWhitespace: true,
  minifySyntax: true,
  sourcemap: "external",
  sourcesContent: false,
});
const exported = await build({
  ...common,
  entryPoints: names,
  outdir: ".",
  bundle: true,
  packages: "external",
  metafile: true,
  plugins: [
    {
      name: "alone",
      setup(build) {
        build.onResolve({ filter: /.*/ }, ({ path: name, kind }) =>
          kind === "entry-point"
            ? { path: name, namespace: "page" }
            : { path: name, external: true },
        );
        build.onLoad({ filter: /.*/, namespace: "page" }, ({ path: name }) => ({
          contents: sources[name],
        }));
      },
    },
  ],
});

const [sourceMap, code] = ["packed.js.map", ENTRY].map(
  (name) => packed.outputFiles.find((file) => path.basename(file.path) === name)?.text ?? "",
);
const exports = Object.fromEntries(
  Object.values(exported.metafile?.outputs ?? {}).map(({ entryPoint = "", exports }) => [
    entryPoint.replace(/^page:/, ""),
    exports,
  ]),
);
const map = sourceMap.replaceAll('"page:', '"');
process.stdout.write(JSON.stringify({ code, map, exports }));
