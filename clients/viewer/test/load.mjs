// Bundles a module of src/ for Node and imports it.
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { build } from "esbuild";
import { workerPlugin } from "../build.mjs";

export async function load(...names) {
  const folder = await mkdtemp(join(tmpdir(), "viewer-test-"));
  try {
    const bundle = await build({
      stdin: {
        contents: names.map((n) => `export * from "./src/${n}";`).join("\n"),
        resolveDir: fileURLToPath(new URL("..", import.meta.url)),
      },
      bundle: true,
      plugins: [workerPlugin],
      write: false,
      format: "esm",
      target: ["es2022"],
    });
    const file = join(folder, "bundle.mjs");
    await writeFile(file, bundle.outputFiles[0].contents);
    return await import(pathToFileURL(file).href);
  } finally {
    await rm(folder, { recursive: true });
  }
}

// Random numbers from 0 to 1 that a seed repeats.
export function randomFrom(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}
