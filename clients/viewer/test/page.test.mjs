// The page in Debian's Chromium: it opens without a request, and every control does what it says.
import assert from "node:assert/strict";
import { EventEmitter } from "node:events";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { gzipSync } from "node:zlib";
import { buildPage } from "../build.mjs";
import { fillPage, gougeAt, height, hill, leftoverAt, makePage, makeScene, pack, slopeAt } from "../make_scene.mjs";
import { hearComplaints, openBrowser } from "./browser.mjs";

const scene = makeScene({ segments: 3000, grid: 60 });
const { buffers } = scene;
let browser;
let folder;
let template;
let page; // the one that most tests share
let complaints = [];

// Opens a page of pieces and listens to all that it complains about or wants from elsewhere.
async function open(name, pieces, options = {}, context = browser) {
  const file = join(folder, `${name}.html`);
  await writeFile(file, pieces);
  const opened = await context.newPage({ viewport: { width: 1280, height: 720 }, ...options });
  complaints = [];
  hearComplaints(opened, (text) => complaints.push(text));
  opened.on("request", (r) => {
    if (r.url() !== pathToFileURL(file).href && !r.url().startsWith("data:")) complaints.push(`request: ${r.url()}`);
  });
  await opened.goto(pathToFileURL(file).href);
  await opened.waitForFunction(() => window.patchmillView !== undefined);
  return opened;
}
const state = (p = page) => p.evaluate(() => window.patchmillView.state());
const near = (a, b, tolerance) => assert.ok(Math.abs(a - b) <= tolerance, `${a} is not ${b}`);
const nearAll = (a, b, tolerance) => a.forEach((v, i) => near(v, b[i], tolerance));
const settle = (p = page) => p.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
// How many colours the canvas shows on a grid of pixels.
const colorsShown = (p) =>
  p.evaluate(() => {
    const canvas = document.getElementById("canvas");
    const found = new Set();
    for (let i = 1; i < 7; i++) {
      for (let j = 1; j < 7; j++) {
        found.add(window.patchmillView.pixel((canvas.clientWidth * i) / 7, (canvas.clientHeight * j) / 7).join());
      }
    }
    return found.size;
  });

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "viewer-page-"));
  template = await buildPage();
  browser = await openBrowser();
  page = await open("plate", makePage(template, scene));
  await page.evaluate(() => window.patchmillView.ready);
});
after(async () => {
  await browser?.close();
  await rm(folder, { recursive: true });
});

test("the page is one file that is built the same each time", async () => {
  assert.equal(await buildPage(), template);
  assert.ok(template.length < 1e6);
  for (const marker of ["@PATCHMILL_SCENE@", "@PATCHMILL_DATA@"]) assert.equal(template.split(marker).length, 2);
  assert.match(template, /default-src 'none'/);
});

test("an error, a warning and a line of the console are complaints, the renderer's remark on its speed is none", () => {
  const shown = new EventEmitter();
  const heard = [];
  hearComplaints(shown, (text) => heard.push(text));
  const say = (type, text) => shown.emit("console", { type: () => type, text: () => text });
  const driver = "[.WebGL-0x52c001d1400]GL Driver Message (OpenGL, ";
  say("warning", `${driver}Performance, GL_CLOSE_PATH_NV, High): GPU stall due to ReadPixels`);
  say("warning", `${driver}Error, GL_INVALID_OPERATION, High): no program`);
  say("log", "GPU stall");
  shown.emit("pageerror", new Error("no scene"));
  assert.deepEqual(heard, [`warning: ${driver}Error, GL_INVALID_OPERATION, High): no program`, "log: GPU stall", "error: no scene"]);
});

test("it opens without a request or a complaint, and draws", async () => {
  assert.deepEqual(complaints, []);
  assert.ok((await colorsShown(page)) > 6);
  assert.equal(await page.title(), "hilly_plate.json \u2013 Patchmill");
  assert.equal(await page.textContent("#outcome"), "COMPLETE");
  assert.equal(await page.isVisible("#loading"), false);
});

test("each shading has its legend", async () => {
  const wanted = {
    region: /0 plain, gentle: 6412\.0 mm2/, slope: /in degrees.*90.*steep from 45\u00b0/s, curvature: /in 1\/mm.*bends outward/s,
    leftover: /in mm.*0\.03.*scallop \+ tolerance/s, gouge: /in mm.*0\.01.*tolerance/s, unreachable: /CONCAVE.*reachable/s, plain: /surface/,
  };
  const seen = new Set();
  // Without the passes the pixel is one of the surface.
  for (const layer of ["path 5", "arrows", "borders"]) await page.uncheck(`[data-layer="${layer}"]`);
  for (const [id, legend] of Object.entries(wanted)) {
    await page.selectOption("#shading", id);
    assert.equal((await state()).shading, id);
    assert.match(await page.textContent("#legend-body"), legend);
    const { x, y } = await page.evaluate((p) => window.patchmillView.project(p), [6, 6, height(6, 6)]);
    seen.add((await page.evaluate(([a, b]) => window.patchmillView.pixel(a, b), [x, y])).join());
  }
  assert.ok(seen.size >= 4, `${seen.size} colours`);
  await page.selectOption("#shading", "region");
  for (const layer of ["path 5", "arrows", "borders"]) await page.check(`[data-layer="${layer}"]`);
});

test("layers are switched on and off", async () => {
  const ids = (await state()).layers.map((l) => l.id);
  for (const id of ["surface", "path 0", "path 1", "path 2", "path 3", "path 5", "path 6", "arrows", "tool", "holder", "stock", "clamps", "borders"]) {
    assert.ok(ids.includes(id), id);
    const box = page.locator(`[data-layer="${id}"]`);
    await box.uncheck();
    assert.equal((await state()).layers.find((l) => l.id === id).isShown, false);
    await box.check();
    assert.equal((await state()).layers.find((l) => l.id === id).isShown, true);
  }
});

test("holder, stock and clamps are drawn while they are on", async () => {
  await page.evaluate(() => window.patchmillView.setTime(0));
  const at = (point) => page.evaluate((p) => window.patchmillView.project(p), point);
  for (const [id, point] of [["holder", [0, 0, 40 + 30 + 15]], ["clamps", [113, 35, 1]], ["stock", [50, -4, 16]]]) {
    const { x, y } = await at(point);
    const pixel = () => page.evaluate(([a, b]) => window.patchmillView.pixel(a, b).join(), [x, y]);
    const shown = await pixel();
    await page.uncheck(`[data-layer="${id}"]`);
    assert.notEqual(await pixel(), shown, id);
    await page.check(`[data-layer="${id}"]`);
    assert.equal(await pixel(), shown, id);
  }
});

test("standard views, projection and fit", async () => {
  for (const [view, yaw, pitch] of [["top", -90, 90], ["front", -90, 0], ["right", 0, 0], ["iso", -60, 35.264]]) {
    await page.click(`[data-view="${view}"]`);
    const s = await state();
    near(s.yaw, yaw, 1e-9);
    near(s.pitch, pitch, 1e-9);
  }
  await page.click("#projection");
  assert.equal((await state()).isOrthographic, true);
  assert.equal(await page.getAttribute("#projection", "aria-pressed"), "true");
  await page.click("#projection");
  await page.mouse.move(600, 300);
  await page.mouse.wheel(0, -500);
  const { height: zoomed } = await state();
  await page.click("#fit");
  assert.ok((await state()).height > zoomed);
});

test("the slider puts the tool where the program is at that time", async () => {
  const ends = [];
  buffers["path.seconds"].reduce((sum, s, i) => (ends[i] = sum + s), 0);
  for (const move of [3, 900, 2000]) {
    // Half of a straight move: the tip is in the middle of its ends.
    const time = (ends[move - 1] + ends[move]) / 2;
    await page.$eval("#time", (slider, t) => {
      slider.value = String(t);
      slider.dispatchEvent(new Event("input"));
    }, time);
    const s = await state();
    assert.equal(s.move, move);
    const tip = buffers["path.tip"];
    nearAll(s.tip, [0, 1, 2].map((k) => (tip[3 * move + k] + tip[3 * move - 3 + k]) / 2), 1e-3);
  }
  // Half of the first whole circle is opposite to its start.
  const arc = buffers["arc.turns"].indexOf(1);
  const move = buffers["arc.move"][arc];
  await page.evaluate((t) => window.patchmillView.setTime(t), (ends[move - 1] + ends[move]) / 2);
  const end = buffers["path.tip"].subarray(3 * move, 3 * move + 3);
  nearAll((await state()).tip, [2 * hill.x - end[0], end[1], end[2]], 1e-3);
  await settle();
  assert.match(await page.textContent("#readout"), /cut, contour.*Line \d+.*G17 G3/);
});

test("run, stop, steps and speed", async () => {
  await page.click("#to-start");
  assert.equal((await state()).move, 0);
  await page.click("#step-forward");
  assert.equal((await state()).move, 1);
  await page.click("#step-back");
  assert.equal((await state()).move, 0);
  await page.selectOption("#speed", "100");
  await page.click("#play");
  await page.waitForFunction(() => window.patchmillView.state().time > 1);
  assert.equal((await state()).isRunning, true);
  await page.click("#play");
  assert.equal((await state()).isRunning, false);
  await page.click("#to-end");
  const s = await state();
  near(s.time, s.total, 1e-9);
});

test("the hover tells the values of the scene", async () => {
  for (const layer of ["path 0", "path 1", "path 2", "path 3", "path 5", "path 6"]) await page.uncheck(`[data-layer="${layer}"]`);
  await page.click('[data-view="top"]');
  for (const [i, j] of [[24, 30], [12, 20], [50, 10]]) {
    // A vertex of the mesh; its values are those of the scene.
    const [x, y] = [(100 * i) / 60, (70 * j) / 42];
    const at = await page.evaluate((p) => window.patchmillView.project(p), [x, y, height(x, y)]);
    const picked = await page.evaluate(([a, b]) => window.patchmillView.pick(a, b), [at.x, at.y]);
    nearAll(picked.point, [x, y, height(x, y)], 0.02);
    near(picked.leftover, leftoverAt(x, y), 1e-4);
    near(picked.gouge, gougeAt(x, y), 1e-5);
    near(picked.slope, slopeAt(x, y), 0.2);
    assert.equal(picked.surface, ["f1", "f2", "lid", "patch 3"][(picked.point[0] > 50 ? 1 : 0) + (picked.point[1] > 35 ? 2 : 0)]);
    const box = await page.locator("#canvas").boundingBox();
    await page.mouse.move(box.x + at.x, box.y + at.y);
    await page.waitForSelector("#hover:visible");
    await page.waitForFunction((t) => document.getElementById("hover").textContent.includes(t), picked.leftover.toFixed(4));
    const text = await page.textContent("#hover");
    for (const part of [picked.surface, picked.region, picked.gouge.toFixed(4), `${picked.slope.toFixed(1)}\u00b0`]) assert.ok(text.includes(part), `${text}: ${part}`);
  }
  for (const layer of ["path 0", "path 1", "path 2", "path 3", "path 5", "path 6"]) await page.check(`[data-layer="${layer}"]`);
});

test("a click on a path sets the time to it, and its hover tells the move", async () => {
  await page.click('[data-view="top"]');
  const move = 1500;
  const tip = buffers["path.tip"];
  const middle = [0, 1, 2].map((k) => (tip[3 * move + k] + tip[3 * move - 3 + k]) / 2);
  // A zoomed picture, in which the passes are pixels apart.
  for (let n = 0; n < 6; n++) {
    const { x, y } = await page.evaluate((p) => window.patchmillView.project(p), middle);
    const box = await page.locator("#canvas").boundingBox();
    await page.mouse.move(box.x + x, box.y + y);
    await page.mouse.wheel(0, -200);
    await settle();
  }
  const at = await page.evaluate((p) => window.patchmillView.project(p), middle);
  const picked = await page.evaluate(([a, b]) => window.patchmillView.pick(a, b), [at.x, at.y]);
  assert.equal(picked.move, move);
  assert.equal(picked.moveKind, "cut");
  assert.equal(picked.pass, "zig-zag");
  assert.equal(picked.behind.kind, "surface");
  assert.equal(picked.feed, buffers["path.feed"][move]);
  assert.equal(picked.line, buffers["path.line"][move]);
  assert.equal(picked.text, buffers["program.text"].toString().split("\n")[picked.line - 1]);
  const box = await page.locator("#canvas").boundingBox();
  await page.mouse.click(box.x + at.x, box.y + at.y);
  const hover = await page.textContent("#hover");
  for (const part of ["cut, zig-zag pass", picked.text, picked.behind.leftover.toFixed(4)]) assert.ok(hover.includes(part), `${hover}: ${part}`);
  const s = await state();
  assert.equal(s.move, move);
  near(s.share, 0.5, 0.05);
  await page.click('[data-view="iso"]');
});

test("the panel of the program follows, and a click on a line goes to its move", async () => {
  await page.evaluate(() => window.patchmillView.setTime(200));
  const line = buffers["path.line"][(await state()).move];
  assert.equal(await page.textContent("#current-line i"), String(line));
  assert.ok((await page.locator("#lines .line").count()) < 60);
  await page.click("#lines .line >> nth=3");
  const clicked = Number(await page.textContent("#current-line i"));
  assert.equal(buffers["path.line"][(await state()).move], clicked);
  await page.focus("#lines");
  await page.keyboard.press("ArrowDown");
  assert.equal(buffers["path.line"][(await state()).move], clicked + 1);
  await page.selectOption("#sections", { label: "region 1: contour passes" });
  assert.equal((await state()).move, scene.header.sections.find((s) => s.name.includes("contour")).first_move);
});

test("the section plane hides one side", async () => {
  await page.click('[data-view="top"]');
  const kept = await page.evaluate((p) => window.patchmillView.project(p), [20, 60, height(20, 60)]);
  const cut = await page.evaluate((p) => window.patchmillView.project(p), [80, 60, height(80, 60)]);
  const pick = (at) => page.evaluate(([a, b]) => window.patchmillView.pick(a, b), [at.x, at.y]);
  for (const axis of ["x", "y", "z"]) {
    await page.click(`[data-axis="${axis}"]`);
    assert.equal((await state()).section.axis, axis);
  }
  await page.click('[data-axis="x"]');
  assert.ok(await pick(kept));
  assert.equal(await pick(cut), null);
  await page.click("#section-flip");
  assert.equal(await pick(kept), null);
  assert.ok(await pick(cut));
  await page.click("#section-flip");
  await page.$eval("#section-position", (slider) => {
    slider.value = "90";
    slider.dispatchEvent(new Event("input"));
  });
  near((await state()).section.position, 90, 0.3);
  assert.ok(await pick(cut));
  await page.uncheck("#section-path");
  assert.equal((await state()).section.cutsPath, false);
  await page.check("#section-path");
  await page.click('[data-axis=""]');
  assert.equal((await state()).section.axis, null);
});

test("two points are measured", async () => {
  await page.click('[data-view="top"]');
  await page.click("#measure");
  const box = await page.locator("#canvas").boundingBox();
  for (const [x, y] of [[20, 20], [60, 50]]) {
    const at = await page.evaluate((p) => window.patchmillView.project(p), [x, y, height(x, y)]);
    await page.mouse.click(box.x + at.x, box.y + at.y);
  }
  const s = await state();
  const [a, b] = s.measured;
  near(s.distance.length, Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]), 1e-9);
  nearAll(s.distance.delta, [40, 30, height(60, 50) - height(20, 20)], 0.25); // a pixel is 0.2 mm
  assert.match(await page.textContent("#measure-values"), new RegExp(`Distance${s.distance.length.toFixed(3)} mm`));
  await page.click("#measure-clear");
  assert.deepEqual((await state()).measured, []);
  await page.click("#measure");
});

test("the path may be drawn in part, each pass of it, and at the contact points", async () => {
  for (const part of ["done", "coming", "whole"]) {
    await page.selectOption("#path-part", part);
    assert.equal((await state()).pathPart, part);
  }
  await page.check("#every-pass");
  await page.uncheck("#every-pass");
  await page.selectOption("#path-point", "contact");
  await page.waitForFunction(() => window.patchmillView.state().pathPoint === "contact");
  await page.selectOption("#path-point", "tip");
  await page.waitForFunction(() => window.patchmillView.state().pathPoint === "tip");
});

test("a click on a finding shows its place", async () => {
  await page.click("#tab-findings");
  assert.equal(await page.locator("#findings li").count(), scene.header.findings.length);
  await page.click("#findings button >> nth=0");
  nearAll((await state()).target, scene.header.findings[0].point, 1e-9);
  await settle();
  assert.match(await page.textContent("#overlay"), /UNREACHABLE_AREA/);
  await page.click("#tab-figures");
  assert.match(await page.textContent("#figures"), /largest gouge0\.0080 mm/);
  await page.click("#tab-program");
});

test("the scale bar is as long as it says", async () => {
  await page.click("#projection");
  await page.click('[data-view="top"]');
  await settle();
  const mm = Number((await page.textContent("#overlay")).match(/(\d+) mm/)[1]);
  const [a, b] = await page.evaluate((size) => [[0, 0, 0], [size, 0, 0]].map((p) => window.patchmillView.project(p).x), mm);
  const length = await page.$$eval("#overlay path", (paths) => paths.map((p) => p.getAttribute("d")).join(" "));
  near(Number(length.match(/v5h([\d.]+)v-5/)[1]), b - a, 0.1);
  await page.click("#projection");
});

test("everything has a key", async () => {
  await page.focus("#canvas");
  const press = async (key) => {
    await page.keyboard.press(key);
    return state();
  };
  assert.equal((await press("1")).pitch, 90);
  assert.equal((await press("2")).pitch, 0);
  assert.equal((await press("3")).yaw, 0);
  near((await press("4")).yaw, -60, 1e-9);
  near((await press("ArrowRight")).yaw, -55, 1e-9);
  assert.equal((await press("o")).isOrthographic, true);
  await press("o");
  const { height: before } = await state();
  assert.ok((await press("+")).height < before);
  await press("f");
  assert.equal((await press("Home")).move, 0);
  assert.equal((await press(".")).move, 1);
  assert.equal((await press(",")).move, 0);
  const { move } = await press("Shift+Period");
  assert.ok(buffers["path.pass"][move + 1] >= 0 && buffers["path.pass"][move] !== buffers["path.pass"][move + 1]);
  assert.equal((await press("End")).move, buffers["path.kind"].length - 1);
  assert.equal((await press(" ")).isRunning, true);
  assert.equal((await press(" ")).isRunning, false);
  const { speed } = await state();
  assert.ok((await press("]")).speed > speed);
  await press("[");
  const { shading } = await state();
  assert.notEqual((await press("s")).shading, shading);
  assert.equal((await press("Shift+S")).shading, shading);
  for (const [key, id] of Object.entries({ r: "path 0", l: "path 3", a: "path 5", n: "arrows", u: "surface", t: "tool", h: "holder", k: "stock", c: "clamps", b: "borders" })) {
    assert.equal((await press(key)).layers.find((l) => l.id === id).isShown, false, key);
    assert.equal((await press(key)).layers.find((l) => l.id === id).isShown, true, key);
  }
  for (const axis of ["x", "y", "z"]) assert.equal((await press(axis)).section.axis, axis);
  const { section } = await state();
  assert.equal((await press("\\")).section.isFlipped, true);
  await press("\\");
  assert.ok((await press("}")).section.position > section.position);
  assert.equal((await press("z")).section.axis, null);
  await press("1");
  await press("m");
  assert.equal((await press("Enter")).measured.length, 1);
  assert.equal((await press("Escape")).measured.length, 0);
  const { theme } = await state();
  assert.notEqual((await press("d")).theme, theme);
  await press("d");
  await press("v");
  assert.equal(await page.isVisible("#left"), false);
  await press("v");
  await press("p");
  assert.equal(await page.isVisible("#right"), false);
  await press("p");
  await press("?");
  assert.equal(await page.isVisible("#help"), true);
  assert.match(await page.textContent("#help-body"), /run, stop.*measure.*this help/s);
  await page.keyboard.press("Escape");
  assert.equal(await page.isVisible("#help"), false);
});

test("each control has a name, and the focus is visible", async () => {
  const nameless = await page.$$eval("button, select, input", (controls) =>
    controls
      .filter((c) => !(c.getAttribute("aria-label") || c.textContent.trim() || c.labels?.[0]?.textContent.trim()))
      .map((c) => c.outerHTML),
  );
  assert.deepEqual(nameless, []);
  await page.focus("#fit");
  await page.keyboard.press("Tab");
  assert.equal(await page.$eval("#projection", (b) => b === document.activeElement && getComputedStyle(b).outlineStyle), "solid");
});

test("the shared page made no request and no complaint in all this", () => assert.deepEqual(complaints, []));

test("dark mode follows the system, and the button changes it", async () => {
  const dark = await open("dark", makePage(template, scene, { gzip: true }), { colorScheme: "dark" });
  await dark.evaluate(() => window.patchmillView.ready);
  assert.equal((await state(dark)).theme, "dark");
  const corner = await dark.evaluate(() => window.patchmillView.pixel(3, 3));
  assert.ok(corner[0] < 60);
  await dark.click("#theme");
  assert.equal((await state(dark)).theme, "light");
  assert.ok((await dark.evaluate(() => window.patchmillView.pixel(3, 3)))[0] > 200);
  assert.deepEqual(complaints, []);
  await dark.close();
});

test("on a narrow screen nothing lies beside it, and a tap tells what is there", async () => {
  const phone = await open("phone", makePage(template, scene), { viewport: { width: 360, height: 640 }, hasTouch: true });
  await phone.evaluate(() => window.patchmillView.ready);
  assert.equal(await phone.isVisible("#right"), false);
  const beside = await phone.$$eval("#bar *, #player *, #legend", (all) =>
    all.filter((e) => e.getClientRects().length > 0 && (e.getBoundingClientRect().right > 361 || e.getBoundingClientRect().left < -1)).map((e) => e.id || e.tagName),
  );
  assert.deepEqual(beside, []);
  await phone.tap("#show-right");
  assert.equal(await phone.isVisible("#lines"), true);
  await phone.tap("#show-left");
  assert.equal(await phone.isVisible("#lines"), false);
  assert.equal(await phone.isVisible("#layers"), true);
  await phone.tap("#show-left");
  const at = await phone.evaluate((p) => window.patchmillView.project(p), [50, 10, height(50, 10)]);
  const box = await phone.locator("#canvas").boundingBox();
  await phone.touchscreen.tap(box.x + at.x, box.y + at.y);
  assert.equal(await phone.isVisible("#hover"), true);
  assert.deepEqual(complaints, []);
  await phone.close();
});

test("names with markup are shown as text, and nothing of them runs", async () => {
  const evil = '</script><img src=x onerror="window.evil=1"><b>&amp;</b>';
  const text = JSON.stringify(scene.header)
    .replaceAll("hilly_plate.json", "T")
    .replaceAll(/"(name|message|code|severity)":"[^"]*"/g, (_, key) => `"${key}":${JSON.stringify(evil)}`);
  const header = { ...JSON.parse(text), title: evil, outcome: evil, made_by: evil, time_basis: evil };
  header.figures = [[evil, evil]];
  header.surfaces = header.surfaces.map(() => evil);
  header.passes = header.passes.map(() => evil);
  header.regions.forEach((r) => (r.unreachable = evil));
  const hostile = { header, buffers: { ...buffers, "program.text": Buffer.from(`${evil}\n`.repeat(9000)) } };
  const opened = await open("hostile", makePage(template, hostile));
  await opened.evaluate(() => window.patchmillView.ready);
  for (const id of ["unreachable", "region"]) await opened.selectOption("#shading", id);
  await opened.click("#tab-findings");
  const { x, y } = await opened.evaluate((p) => window.patchmillView.project(p), [50, 10, height(50, 10)]);
  const box = await opened.locator("#canvas").boundingBox();
  await opened.mouse.move(box.x + x, box.y + y);
  await opened.waitForSelector("#hover:visible");
  assert.equal(await opened.locator("img, b b, #findings b").count(), 0);
  assert.equal(await opened.evaluate(() => window.evil), undefined);
  assert.equal(await opened.textContent("#title"), evil);
  assert.ok((await opened.textContent("#findings")).includes(evil));
  assert.deepEqual(complaints, []);
  await opened.close();
});

test("damaged scenes give a message, not an empty page", async () => {
  const { header, block } = pack(scene);
  const data = block.toString("base64");
  const cases = {
    "ends early": [header, data.slice(0, 4000), /end early/],
    "is no base64": [header, data.replace("AAAA", "<!--"), /no base64/],
    "is of another version": [{ ...header, version: 7 }, data, /version 7/],
    "lacks a buffer": [{ ...header, buffers: { ...header.buffers, "mesh.position": undefined } }, data, /mesh\.position is missing/],
    "is not compressed": [{ ...header, data_encoding: "gzip" }, data, /decompressed/],
  };
  for (const [name, [h, d, message]] of Object.entries(cases)) {
    const opened = await open("damaged", fillPage(template, h, d));
    await opened.waitForSelector("#error:visible");
    assert.match(await opened.textContent("#error"), message, name);
    assert.deepEqual(complaints, [], name);
    await opened.close();
  }
  const empty = await open("template", [template]);
  await empty.waitForSelector("#error:visible");
  assert.match(await empty.textContent("#error"), /template/);
  await empty.close();
});

test("a large scene is unpacked beside the page while the browser reads it", { timeout: 60_000 }, async () => {
  const large = makeScene({ segments: 260_000, grid: 30 });
  const pieces = makePage(template, large, { gzip: true });
  const moves = large.buffers["path.kind"].length;
  const noWorker = { addInitScript: () => void (window.Worker = undefined) };
  for (const { addInitScript } of [{ addInitScript: () => {} }, noWorker]) {
    const context = await browser.newContext();
    await context.addInitScript(addInitScript);
    const opened = await open("large", pieces, {}, context);
    await opened.evaluate(() => window.patchmillView.ready);
    assert.ok((await colorsShown(opened)) > 4);
    const { levelSizes } = await state(opened);
    assert.equal(levelSizes.length, 10);
    assert.ok(levelSizes[0] >= moves - 1 && levelSizes.every((size, k) => k === 0 || size <= levelSizes[k - 1]), levelSizes.join());
    assert.ok(levelSizes[9] < levelSizes[0] / 10);
    // The worker is a text of the page itself; nothing else is asked for.
    assert.deepEqual(complaints.filter((c) => !c.startsWith("request: blob:null/")), []);
    assert.equal(complaints.length, addInitScript === noWorker.addInitScript ? 0 : 1);
    await context.close();
  }
  // Damage is found there, too: a file that was cut, a bit that fell over, and data that grow without end.
  const { header, block } = pack(large);
  const packed = gzipSync(block);
  const flipped = Buffer.from(packed);
  flipped[packed.length >> 1] ^= 4;
  const withGzip = { ...header, data_encoding: "gzip" };
  const cut = fillPage(template, withGzip, packed.toString("base64").slice(0, packed.length >> 1)).slice(0, 4);
  const cases = [
    [cut, /end early/],
    [fillPage(template, withGzip, flipped.toString("base64")), /damaged/],
    [fillPage(template, withGzip, gzipSync(Buffer.alloc(256 * 2 ** 20), { level: 1 }).toString("base64")), /longer than the header states/],
  ];
  for (const [damaged, message] of cases) {
    const opened = await open("damaged", damaged);
    await opened.waitForSelector("#error:visible");
    assert.match(await opened.textContent("#error"), message);
    await opened.close();
  }
});

test("a browser without WebGL gets a message", async () => {
  const opened = await browser.newPage();
  await opened.addInitScript(() => {
    HTMLCanvasElement.prototype.getContext = () => null;
  });
  await opened.goto(pathToFileURL(join(folder, "plate.html")).href);
  await opened.waitForSelector("#error:visible");
  assert.match(await opened.textContent("#error"), /WebGL 2/);
  await opened.close();
});

test("a scene without a path, and one without a surface, are shown", async () => {
  const without = (prefix) => ({
    header: { ...scene.header, sections: [], borders: [] },
    buffers: Object.fromEntries(Object.entries(buffers).filter(([name]) => !prefix.test(name))),
  });
  for (const prefix of [/^(path|arc|program|border)\./, /^(mesh|border)\./]) {
    const opened = await open("part", makePage(template, without(prefix)));
    await opened.evaluate(() => window.patchmillView.ready);
    assert.ok((await colorsShown(opened)) > 4);
    for (const key of ["s", " ", ".", "Enter", "m", "x", "a", "Shift+Period"]) await opened.keyboard.press(key);
    assert.deepEqual(complaints, []);
    await opened.close();
  }
});

test("a screenshot of the page shows it", async () => {
  const file = join(folder, "shot.png");
  await page.screenshot({ path: file });
  assert.ok((await readFile(file)).length > 40000); // an empty page of this size takes some 5 kB
});
