// Builds the page: node build.mjs OUT.html makes one file with script and style inside and the markers of the scene left.
// The same sources and lock file give the same bytes.
import { createHash } from "node:crypto";
import { readFile, writeFile } from "node:fs/promises";
import { fileURLToPath, pathToFileURL } from "node:url";
import { build, transform } from "esbuild";

const here = (name) => fileURLToPath(new URL(name, import.meta.url));
const hash = (text) => `'sha256-${createHash("sha256").update(text, "utf8").digest("base64")}'`;

const common = { bundle: true, write: false, minify: true, format: "iife", target: ["es2022"], charset: "ascii", legalComments: "none", absWorkingDir: here(".") };

// import source from "./name?worker" gives the bundled source of a worker as a text.
export const workerPlugin = {
  name: "worker",
  setup(bundle) {
    bundle.onResolve({ filter: /\?worker$/ }, ({ path }) => ({ path: here(`src/${path.replace(/^\.\/|\?worker$/g, "")}.ts`), namespace: "worker" }));
    bundle.onLoad({ filter: /./, namespace: "worker" }, async ({ path }) => {
      const { outputFiles } = await build({ ...common, entryPoints: [path] });
      return { contents: outputFiles[0].text, loader: "text" };
    });
  },
};

export async function buildPage() {
  const bundle = await build({
    ...common,
    entryPoints: [here("src/main.ts")],
    plugins: [workerPlugin],
    banner: { js: `/* Patchmill viewer: Apache-2.0. three.js, which it contains:\n\n${await readFile(here("node_modules/three/LICENSE"), "utf8")}*/` },
  });
  // A script element ends at its end tag, wherever that stands.
  const script = bundle.outputFiles[0].text.replace(/<\/(script)/gi, "<\\/$1").replace(/<!--/g, "<\\!--");
  const style = (await transform(await readFile(here("page.css"), "utf8"), { loader: "css", minify: true })).code;
  const policy = [
    "default-src 'none'",
    `script-src ${hash(script)}`,
    `style-src ${hash(style)}`,
    "img-src data:",
    "worker-src blob:",
    "base-uri 'none'",
    "form-action 'none'",
  ].join("; ");
  const parts = { "@CSP@": policy, "@STYLE@": style, "@SCRIPT@": script };
  return (await readFile(here("page.html"), "utf8")).replace(/@CSP@|@STYLE@|@SCRIPT@/g, (marker) => parts[marker]);
}

if (process.argv[1] !== undefined && import.meta.url === pathToFileURL(process.argv[1]).href) {
  const [out] = process.argv.slice(2);
  if (out === undefined) {
    console.error("usage: node build.mjs OUT.html");
    process.exit(2);
  }
  await writeFile(out, await buildPage());
}
