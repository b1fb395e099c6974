// Builds page and server: node build.mjs makes gen/ (types of the contract) and dist/ (what runs). It is run by the Node.js
// of package.json; programs that it starts run under the same one.
import { execFileSync } from "node:child_process";
import { mkdir, readFile, rm, writeFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";
import { buildPage } from "../viewer/build.mjs";

const here = (name) => fileURLToPath(new URL(name, import.meta.url));

function generate() {
  const plugin = { local: [process.execPath, here("node_modules/@bufbuild/protoc-gen-es/bin/protoc-gen-es")] };
  const options = { out: here("gen"), opt: ["target=js+dts", "import_extension=js"], include_imports: false };
  const template = JSON.stringify({ version: "v2", clean: true, plugins: [{ ...plugin, ...options }] });
  const buf = here("node_modules/@bufbuild/buf/bin/buf");
  execFileSync(process.execPath, [buf, "generate", here("../../proto"), "--template", template], { stdio: "inherit" });
}

// The viewer's page without scene, style and script in it: the front end puts a scene into it by a call.
async function frameHtml() {
  const cut = (html, pattern, by) => {
    if (!pattern.test(html)) throw new Error(`clients/viewer/page.html has no ${pattern}; adapt clients/web/build.mjs.`);
    return html.replace(pattern, by);
  };
  let html = await readFile(here("../viewer/page.html"), "utf8");
  html = cut(html, /<meta http-equiv="Content-Security-Policy"[^>]*>\n/, "");
  html = cut(html, /<link rel="icon"[^>]*>\n/, "");
  html = cut(html, /<style>@STYLE@<\/style>/, '<link rel="stylesheet" href="viewer.css">\n<link rel="stylesheet" href="frame.css">');
  html = cut(html, /<script type="application\/json"[^]*?<\/script>\n/, "");
  html = cut(html, /<script type="application\/octet-stream"[^]*?<\/script>\n/, "");
  return cut(html, /<script>@SCRIPT@<\/script>/, '<script src="frame.js"></script>');
}

const common = { bundle: true, minify: true, charset: "ascii", legalComments: "none", absWorkingDir: here("."), logLevel: "warning" };

export async function buildAll() {
  await rm(here("dist"), { recursive: true, force: true });
  await mkdir(here("dist/public"), { recursive: true });
  generate();
  await build({
    ...common,
    entryPoints: { page: "page/main.ts", frame: "page/frame/main.ts" },
    outdir: "dist/public",
    format: "iife",
    target: ["es2022"],
  });
  await build({
    ...common,
    entryPoints: { server: "server/main.ts" },
    outdir: "dist",
    outExtension: { ".js": ".mjs" },
    format: "esm",
    platform: "node",
    target: ["node22"],
    minify: false,
    banner: { js: 'import { createRequire } from "node:module"; const require = createRequire(import.meta.url);' },
  });
  const copies = { "page/page.html": "index.html", "page/page.css": "page.css", "page/frame/frame.css": "frame.css", "../viewer/page.css": "viewer.css" };
  for (const [from, to] of Object.entries(copies)) await writeFile(here(`dist/public/${to}`), await readFile(here(from)));
  await writeFile(here("dist/public/frame.html"), await frameHtml());
  await writeFile(here("dist/public/template.html"), await buildPage());
}

await buildAll();
