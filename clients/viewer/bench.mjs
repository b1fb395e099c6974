// Measures a page with a long path: seconds to load, and frames in a second while the view turns.
//   node bench.mjs [--segments 2000000] [--page FILE.html] [--frames 60] [--gzip]
// It runs Chromium's software renderer at 1280 x 720.
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { buildPage } from "./build.mjs";
import { makePage, makeScene } from "./make_scene.mjs";
import { openBrowser } from "./test/browser.mjs";

const words = process.argv.slice(2);
const value = (name, usual) => (words.includes(name) ? words[words.indexOf(name) + 1] : usual);
const folder = await mkdtemp(join(tmpdir(), "viewer-bench-"));
let file = value("--page", null);
if (file === null) {
  file = join(folder, "page.html");
  const scene = makeScene({ segments: Number(value("--segments", 2000000)), grid: 300 });
  await writeFile(file, makePage(await buildPage(), scene, { gzip: words.includes("--gzip") }));
}
const browser = await openBrowser();
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
  await page.goto(pathToFileURL(file).href, { waitUntil: "commit", timeout: 120000 });
  await page.waitForFunction(() => window.patchmillView !== undefined, null, { timeout: 120000 });
  // performance.now() counts from the start of the navigation.
  const load = await page.evaluate(() => window.patchmillView.ready.then(() => performance.now() / 1000));
  const frames = Number(value("--frames", 60));
  const turn = (count) =>
    page.evaluate(async (n) => {
      const view = window.patchmillView;
      const times = [];
      let last = performance.now();
      for (let i = 0; i < n; i++) {
        view.orbit(3, 0); // the picture is drawn in the next animation frame
        await new Promise(requestAnimationFrame);
        view.wait();
        const now = performance.now();
        times.push(now - last);
        last = now;
      }
      return times;
    }, count);
  await turn(5);
  const { frames: before } = await page.evaluate(() => window.patchmillView.state());
  const times = (await turn(frames)).sort((a, b) => a - b);
  const state = await page.evaluate(() => window.patchmillView.state());
  console.log(`pictures drawn      ${state.frames - before} in ${frames} steps`);
  console.log(`segments            ${state.levelSizes[0]}`);
  console.log(`drawn while turning ${state.drawnSegments}`);
  console.log(`loaded in           ${load.toFixed(2)} s`);
  const middle = times[Math.floor(times.length / 2)];
  console.log(`median frame        ${middle.toFixed(0)} ms, ${(1000 / middle).toFixed(1)} frames in a second`);
  console.log(`slowest frame       ${times[times.length - 1].toFixed(0)} ms`);
} finally {
  await browser.close();
  await rm(folder, { recursive: true });
}
