// The page in a browser: from a part to a verified program, as a user goes.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { createServer as createHttp } from "node:http";
import { createServer } from "node:http2";
import { copyFile, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { promisify } from "node:util";
import { execFile } from "node:child_process";
import { after, before, test } from "node:test";
import { connectNodeAdapter } from "@connectrpc/connect-node";
import { Outcome } from "../gen/patchmill/v1/report_pb.js";
import { ToolpathService } from "../gen/patchmill/v1/toolpath_service_pb.js";
import {
  bin, cadPart, choosePart, clickPoint, downloaded, example, freePort, inFrame, needBuild, openPage, regionsShown, root, startBackend, startBrowser, startWeb, withFolder,
} from "./support.mjs";

let backend;
let web;
let browser;
before(async () => {
  needBuild();
  backend = await startBackend();
  web = await startWeb(backend.port);
  browser = await startBrowser();
});
after(async () => {
  await browser?.close();
  await web?.stop();
  await backend?.stop();
});

const text = (page, id) => page.textContent(`#${id}`);
// As the page has it now: the browser tells of a new address a little later.
const hashOf = async (page) => new URLSearchParams(await page.evaluate(() => location.hash.slice(1)));
const done = (page) => page.waitForSelector("#result:not([hidden]), #problem:not([hidden])", { timeout: 60_000 });
const openGroups = (page) => page.evaluate(() => document.querySelectorAll("#groups details").forEach((d) => (d.open = true)));
const problem = (page) => page.waitForSelector("#problem:not([hidden])", { timeout: 20_000 });
// Presses Tab until an element has the focus.
async function tabTo(page, selector) {
  for (let k = 0; k < 25; k++) {
    await page.keyboard.press("Tab");
    if (await page.evaluate((s) => document.activeElement.matches(s), selector)) return;
  }
  assert.fail(`Tab does not lead to ${selector}`);
}
// Small and quick: a flat dome of one patch.
const dome = (id = "dome") =>
  JSON.stringify({
    length_unit: "LENGTH_UNIT_MILLIMETER",
    patches: [{ id, bezier: { degree_u: 3, degree_v: 3, points: [0, 0, 0, 0, 20, 6, 0, 40, 6, 0, 60, 0, 20, 0, 6, 20, 20, 30, 20, 40, 30, 20, 60, 6, 40, 0, 6, 40, 20, 30, 40, 40, 30, 40, 60, 6, 60, 0, 0, 60, 20, 6, 60, 40, 6, 60, 60, 0] } }],
  });
const asFile = (name, content) => ({ name, mimeType: "application/octet-stream", buffer: Buffer.from(content) });

// Runs the command that the page shows, beside a copy of the part.
async function runCommand(page, part, folder, extra) {
  await copyFile(part, join(folder, part.split("/").pop()));
  const command = await text(page, "command");
  await promisify(execFile)("bash", ["-c", `${command} ${extra}`], { cwd: folder, env: { ...process.env, PATH: `${bin}:${process.env.PATH}` } });
}

test("a CAD part: findings and size, a click on a face, regions anew, a job, and files equal to the command line's", { timeout: 60_000 }, async () => {
  const { page, faults, close } = await openPage(browser, `${web.url}#scallop=0.1&tolerance=0.05&allowance=0.3&post=fanuc&work-offset=G55`);
  const part = cadPart("dome.step");
  await choosePart(page, part);
  await page.waitForFunction(() => document.querySelectorAll("#surfaces li").length === 7);
  assert.equal(await text(page, "sum-part"), "30 \u00d7 24 \u00d7 15 mm");
  assert.match(await text(page, "findings-title"), /^Findings: 0 errors, \d+ warnings?, \d+ notes?$/);
  const whole = await inFrame(page, "state");
  assert.ok(whole.regions > 1);

  // A click on the top face mills it alone; the next one in its list takes it back.
  await page.click('[data-click="mill"]');
  await clickPoint(page, [3, 3, 8]);
  await page.waitForFunction(() => location.hash.includes("only="));
  const [face] = (await hashOf(page)).getAll("only");
  assert.match(await text(page, "command"), new RegExp(`--only=${face}( |$)`));
  const button = page.locator(`#surfaces button[data-is="only"][aria-label="mill ${face}"]`);
  assert.equal(await button.getAttribute("aria-pressed"), "true");
  assert.equal((await inFrame(page, "state")).shading, "marks");
  await button.focus();
  await page.keyboard.press("Space");
  assert.equal((await hashOf(page)).get("only"), null);
  await page.keyboard.press("Space"); // the focus stayed
  assert.equal((await hashOf(page)).get("only"), face);

  // The map was made anew: other regions are not selected.
  await page.waitForFunction(() => document.getElementById("split-state").textContent.includes("computed in") === false);
  await regionsShown(page);

  await page.click("#start");
  await page.waitForSelector("#progress-box:not([hidden])");
  assert.equal(await page.isVisible("#cancel"), true);
  await done(page);
  assert.equal(await text(page, "problem"), "");
  assert.match(await text(page, "outcome"), /erified/);
  const program = await downloaded(page, "#get-program");
  const report = await downloaded(page, "#get-report");
  const picture = await downloaded(page, "#get-picture");
  const view = await downloaded(page, "#get-page");
  assert.equal(program.name, "dome.nc");
  await withFolder(async (folder) => {
    await runCommand(page, part, folder, "--report r.json --preview p.svg");
    assert.ok(program.bytes.equals(await readFile(join(folder, "dome.nc"))), "the program has other bytes than the command line's");
    assert.ok(picture.bytes.equals(await readFile(join(folder, "p.svg"))));
    const [ours, theirs] = [JSON.parse(report.bytes), JSON.parse(await readFile(join(folder, "r.json")))];
    for (const r of [ours, theirs]) for (const s of r.stages) delete s.seconds;
    assert.deepEqual(ours, theirs);
    // The 3-D page opens by itself.
    const file = join(folder, "page.html");
    await writeFile(file, view.bytes);
    const context = await browser.newContext({ offline: true });
    const alone = await context.newPage();
    await alone.goto(`file://${file}`);
    await alone.evaluate(() => window.patchmillView.ready);
    assert.ok((await alone.evaluate(() => window.patchmillView.state())).total > 0);
    await context.close();
  });

  // The slider runs the tool.
  await page.waitForFunction(() => document.querySelector("#frames iframe:not(.next)").title.includes("program"));
  const frame = page.frameLocator("#frames iframe:not(.next)");
  assert.equal((await inFrame(page, "state")).time, 0);
  await frame.locator("#time").focus();
  await page.keyboard.press("End");
  const end = await inFrame(page, "state");
  assert.ok(Math.abs(end.time - end.total) < 1e-6 && end.total > 1);
  assert.match(await frame.locator("#lines").textContent(), /M30|%/);
  // What lies under the pointer has the values of the report.
  const { max_leftover_mm: most, max_gouge_mm: deepest } = JSON.parse(report.bytes);
  const picked = [];
  for (let x = 60; x < 660; x += 40) for (let y = 60; y < 480; y += 40) picked.push(await inFrame(page, "pick", x, y));
  const surfaces = picked.filter((p) => p?.kind === "surface");
  assert.ok(surfaces.length > 5);
  for (const { surface, gouge, leftover, unreachable } of surfaces) {
    assert.match(surface, /^f\d$/);
    assert.ok(gouge <= deepest + 1e-4);
    if (surface === face && unreachable === "") assert.ok(leftover <= most + 1e-4, `${leftover} at a place that the ball reaches`);
  }
  // Clicks on the part come back when they are wanted.
  await page.click("#show-program");
  await page.waitForFunction(() => document.querySelector("#frames iframe:not(.next)").title.includes("part"));
  await openGroups(page);
  await page.fill("#set-scallop", "0.2");
  assert.equal(await page.isVisible("#stale"), true);
  assert.deepEqual(faults, []);
  await close();
});

test("regions are switched off by a click and in the list; a plane face is turned up", { timeout: 60_000 }, async () => {
  const { page, faults, close } = await openPage(browser, `${web.url}#scallop=0.1&tolerance=0.05`);
  await choosePart(page, cadPart("dome.step"));
  await page.click('[data-click="region"]');
  await clickPoint(page, [3, 3, 8]);
  await page.waitForFunction(() => location.hash.includes("region="));
  const change = (await hashOf(page)).get("region");
  assert.match(change, /^-?[\d.]+,-?[\d.]+,-?[\d.]+:off$/);
  await page.waitForFunction(() => [...document.querySelectorAll("#regions select")].some((s) => s.value === "off"));
  await page.waitForTimeout(500);
  await regionsShown(page);
  const row = page.locator("#regions li", { has: page.locator("select") }).filter({ hasText: "neutral, gentle" }).first();
  assert.equal(await row.locator("select").inputValue(), "off", "the region is still the one that was clicked");
  await row.locator("select").selectOption("");
  assert.equal((await hashOf(page)).get("region"), null);

  // Faces by a text, and the part dropped anew on the picture: the settings stay.
  await page.fill("#by-text", "kind=sphere, f1+");
  await page.click("#text-avoid");
  assert.deepEqual((await hashOf(page)).getAll("avoid"), ["kind=sphere", "f1+"]);
  assert.match(await text(page, "surfaces"), /kind=sphere/);
  await page.click('#surfaces button[aria-label="avoid f1+"]');
  await page.click('#surfaces button[aria-label="avoid kind=sphere"]');
  assert.equal((await hashOf(page)).get("avoid"), null);
  const bytes = [...(await readFile(cadPart("dome.step")))];
  await page.evaluate((content) => {
    const { contentWindow, contentDocument } = document.querySelector("#frames iframe:not(.next)");
    const data = new contentWindow.DataTransfer();
    data.items.add(new contentWindow.File([new Uint8Array(content)], "dropped.step"));
    contentDocument.dispatchEvent(new contentWindow.DragEvent("drop", { dataTransfer: data, cancelable: true }));
  }, bytes);
  await page.waitForFunction(() => document.getElementById("file-name").textContent === "dropped.step");
  await regionsShown(page);
  await page.waitForSelector("#frames iframe:not(.next)");

  // The front face lies at y = 0; after the turn it is the highest.
  await page.click('[data-click="up"]');
  await clickPoint(page, [15, 0, 4]);
  await page.waitForFunction(() => location.hash.includes("up="));
  assert.match((await hashOf(page)).get("up"), /^f\d+$/);
  await page.waitForFunction(() => document.getElementById("sum-part").textContent.startsWith("30 \u00d7 15 \u00d7 24"), null, { timeout: 20_000 });
  assert.deepEqual(faults, []);
  await close();
});

test("without a mouse: from a part to a program, what it assumes, and the setting that states it", { timeout: 60_000 }, async () => {
  const { page, faults, close } = await openPage(browser, `${web.url}#scallop=0.2&tolerance=0.1&tool-number=3&zero=origin&tool-diameter=0.5`);
  const chooser = page.waitForEvent("filechooser");
  // Tab leads to the chooser of the part, and the focus can be seen there.
  await tabTo(page, "#file");
  assert.notEqual(await page.evaluate(() => getComputedStyle(document.querySelector(".file")).outlineStyle), "none");
  await page.keyboard.press("Enter");
  await (await chooser).setFiles(asFile("dome.json", dome()));
  await regionsShown(page);
  // A part that is large for the ball is noted before a job runs for long.
  await page.waitForFunction(() => /60 mm long, and the ball has 0.5 mm/.test(document.getElementById("check-state").textContent));
  await tabTo(page, "details:has(#sum-tool) > summary");
  await page.keyboard.press("Enter");
  await tabTo(page, "#set-tool-diameter");
  await page.keyboard.press("Control+a");
  await page.keyboard.type("6");
  await page.waitForFunction(() => document.getElementById("check-state").textContent === "");
  await page.keyboard.press("Control+Enter");
  await done(page);
  assert.match(await text(page, "outcome"), /erified/, await text(page, "problem"));
  // What nobody stated is listed, and only that.
  assert.match(await text(page, "assumed-title"), /3 assumptions/);
  const rows = await page.$$eval("#assumed li", (items) => items.map((i) => i.textContent));
  for (const [k, wanted] of [/holder/, /material/, /material/].entries()) assert.ok(rows.some((r) => wanted.test(r)), `${k}: ${rows.join(" ")}`);
  await page.locator("#assumed-box summary").focus();
  await page.keyboard.press("Enter");
  await page.locator('#assumed [data-setting="holder"]').focus();
  await page.keyboard.press("Enter");
  assert.equal(await page.evaluate(() => document.activeElement.id), "set-holder");
  assert.equal(await page.isVisible("#help-holder"), true);
  assert.deepEqual(faults, []);
  await close();
});

test("a click is not lost when the help above it goes away", async () => {
  const { page, faults, close } = await openPage(browser, web.url);
  await openGroups(page);
  await page.focus("#set-plunge-angle");
  assert.equal(await page.isVisible("#help-plunge-angle"), true);
  // The help of the field takes lines above the check box, which moves when the field loses the focus.
  const { x, y } = await page.locator("#set-high-rapids").boundingBox();
  await page.mouse.move(x + 5, y + 5);
  await page.mouse.down();
  await page.waitForTimeout(60);
  await page.mouse.up();
  assert.equal(await page.isChecked("#set-high-rapids"), true);
  await page.waitForSelector("#help-plunge-angle", { state: "hidden" });
  assert.equal(await page.isVisible("#help-high-rapids"), true);
  assert.deepEqual(faults, []);
  await close();
});

test("a job is cancelled, and nothing of it is kept", { timeout: 60_000 }, async () => {
  const { page, faults, close } = await openPage(browser, `${web.url}#scallop=0.001&tolerance=0.001&tool-diameter=1`);
  await choosePart(page, example("two_hills.bv"));
  await page.click("#start");
  await page.waitForFunction(() => /%/.test(document.getElementById("percent").textContent));
  assert.ok(Number(await page.getAttribute("#progress", "value")) <= 1);
  const before = backend.lines.length;
  const start = performance.now();
  await page.click("#cancel");
  await page.waitForSelector("#progress-box", { state: "hidden" });
  while (!backend.lines.slice(before).some((line) => /GenerateProgram.*CANCELLED/.test(line))) {
    assert.ok(performance.now() - start < 5000, `the backend goes on: ${backend.lines.slice(before).join("\n")}`);
    await page.waitForTimeout(20);
  }
  assert.equal(await page.isVisible("#result"), false);
  assert.equal(await page.isEnabled("#start"), true);
  assert.match(await text(page, "job-state"), /cancelled/);
  assert.deepEqual(faults, []);
  await close();
});

test("tools of files fill the settings", async () => {
  const { page, faults, close } = await openPage(browser, web.url);
  await openGroups(page);
  const library = {
    data: [
      { type: "holder", description: "a holder" },
      { type: "flat end mill", description: "flat", geometry: { DC: 10 } },
      {
        type: "ball end mill",
        unit: "inches",
        description: "<b>quarter</b>",
        geometry: { DC: 0.25, LCF: 0.75, SFDM: 0.25, LB: 1.5 },
        holder: { segments: [{ height: 1, "lower-diameter": 1, "upper-diameter": 1 }, { height: 0.5, "lower-diameter": 1, "upper-diameter": 2 }] },
        "post-process": { number: 7 },
        "start-values": { presets: [{ n: 9000, v_f: 40, v_f_plunge: 10 }] },
      },
    ],
  };
  await page.setInputFiles("#tool-file", asFile("shop.json", JSON.stringify(library)));
  await page.waitForFunction(() => location.hash.includes("tool-diameter"));
  const wanted = { "tool-diameter": "6.35", "flute-length": "19.05", "shank-diameter": "6.35", stickout: "38.1", holder: "25.4,25.4 12.7,25.4,50.8", "tool-number": "7", spindle: "9000", feed: "1016", "plunge-feed": "254" };
  for (const [name, value] of Object.entries(wanted)) assert.equal((await hashOf(page)).get(name), value, name);
  assert.equal(await page.inputValue("#set-holder"), wanted.holder);
  await page.setInputFiles("#tool-file", asFile("shop.tbl", "T1 P1 D4.0 Z+40 ;ball 4\nT2 P2 D8 ;ball 8\n"));
  await page.waitForFunction(() => document.getElementById("tool-list").options.length === 2);
  await page.selectOption("#tool-list", "1");
  assert.equal((await hashOf(page)).get("tool-diameter"), "8");
  assert.equal((await hashOf(page)).get("holder"), null);
  await page.setInputFiles("#tool-file", asFile("shop.json", '{"data": [{"type": "drill"}]}'));
  await problem(page);
  assert.match(await text(page, "problem"), /no ball end mill/);
  assert.deepEqual(faults, []);
  await close();
});

test("the stock is drawn in plan, with the pointer and with keys", async () => {
  const { page, faults, close } = await openPage(browser, `${web.url}#scallop=0.3&tolerance=0.1&allowance=0.3&accept-depth=40`);
  await page.setInputFiles("#file", asFile("dome.json", dome()));
  await regionsShown(page);
  await openGroups(page);
  await page.selectOption("#set-stock", "outline");
  assert.equal((await hashOf(page)).get("stock"), "outline: -5,-5 65,-5 65,65 -5,65", "around the part");
  await page.fill("#stock-points", "0,0\n70, 0\n70,70");
  assert.equal((await hashOf(page)).get("stock"), "outline: 0,0 70,0 70,70");
  await page.click("#stock-draw");
  assert.equal(await page.locator("#plan-ring circle").count(), 3);
  // The last point goes two steps left and ten down; a new one between it and the first goes up.
  await page.locator("#plan-ring circle").nth(2).focus();
  for (const key of ["ArrowLeft", "ArrowLeft", "Shift+ArrowDown"]) await page.keyboard.press(key);
  await page.click("#plan-add");
  for (let k = 0; k < 3; k++) await page.keyboard.press("ArrowUp");
  await page.click("#plan-use");
  assert.equal((await hashOf(page)).get("stock"), "outline: 0,0 70,0 68,60 34,33");
  await page.click("#stock-draw");
  // A click in the middle of a side adds a point to this side, and it can be dragged on.
  const [a, b] = await Promise.all([0, 1].map((k) => page.locator("#plan-ring circle").nth(k).boundingBox()));
  const [x, y] = [(a.x + b.x) / 2 + 7, (a.y + b.y) / 2 + 7];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y + 40);
  await page.mouse.up();
  await page.click("#plan-use");
  const points = (await hashOf(page)).get("stock").replace("outline: ", "").split(" ").map((p) => p.split(",").map(Number));
  assert.equal(points.length, 5);
  assert.equal(points[1][0], 35);
  assert.ok(points[1][1] < -2, `${points[1]}`);
  assert.ok(points.flat().every(Number.isInteger), "points lie on the steps");
  // Cancel leaves it as it was; the rectangle around the part has the margin that is asked for.
  const before = (await hashOf(page)).get("stock");
  await page.click("#stock-draw");
  await page.click("#plan-clear");
  assert.equal(await page.isDisabled("#plan-use"), true);
  await page.keyboard.press("Escape");
  assert.equal((await hashOf(page)).get("stock"), before);
  await page.click("#stock-draw");
  await page.fill("#plan-margin", "7.5");
  await page.click("#plan-around");
  await page.click("#plan-use");
  assert.equal((await hashOf(page)).get("stock"), "outline: -7.5,-7.5 67.5,-7.5 67.5,67.5 -7.5,67.5");
  await page.waitForTimeout(500);
  await regionsShown(page);
  await page.waitForFunction(() => document.querySelector("#frames iframe:not(.next)")?.contentWindow.patchmillFrame.state().layers.some((l) => l.id === "stock"));
  // A clamp is drawn in the same way.
  const clamps = page.locator("#set-obstacle").locator("..").locator("..").locator("button");
  await clamps.click();
  await page.click("#plan-around");
  await page.click("#plan-use");
  assert.match((await hashOf(page)).get("obstacle"), /^clamp 1=[\d.]+,2: -7.5,-7.5 67.5,/);
  assert.deepEqual(faults, []);
  await close();
});

test("machine and post file come from files, go into the program, and are named when they are wrong", { timeout: 60_000 }, async () => {
  const { page, faults, close } = await openPage(browser, `${web.url}#scallop=0.3&tolerance=0.1&allowance=0.3&lead-radius=0.8&lead-feed=333`);
  await page.setInputFiles("#file", asFile("dome.json", dome()));
  await regionsShown(page);
  await openGroups(page);
  await page.setInputFiles("#machine-file", join(root, "docs/machine.json"));
  await page.waitForFunction(() => location.hash.includes("machine-x"));
  assert.equal((await hashOf(page)).get("machine-x"), "-400,0,10000,5000,500");
  assert.equal(await page.inputValue("#set-machine-z-4"), "300");
  assert.equal(await text(page, "sum-machine"), "bench mill");
  // A wrong value of an axis is shown at its cell, with the server's path of it.
  await page.fill("#set-machine-y-3", "0");
  await problem(page);
  assert.match(await text(page, "wrong-machine-y"), /= 0; must .*job\.setup\.machine\.axes\[1\]\.feed_mm_per_min/);
  assert.equal(await page.getAttribute("#set-machine-y-3", "aria-invalid"), "true");
  assert.equal(await page.getAttribute("#set-machine-y-2", "aria-invalid"), null);
  await page.fill("#set-machine-y-3", "");
  await page.waitForFunction(() => /Fill in fastest feed/.test(document.getElementById("wrong-machine-y").textContent));
  await page.fill("#set-machine-y-3", "4000");
  await page.waitForSelector("#problem", { state: "hidden" });
  // So are those of feeds and leads, which no picture depends on.
  await page.fill("#set-lead-sweep", "5");
  await problem(page);
  assert.match(await text(page, "wrong-lead-sweep"), /= 5; must .*job\.operations\[0\]\.leads\.sweep_deg/);
  await page.fill("#set-lead-sweep", "45");
  await page.waitForSelector("#problem", { state: "hidden" });

  // The post file: what is wrong in it, then a whole one with a title of its own.
  await page.setInputFiles("#post-file", asFile("shop.post", "[control]\nname = shop\n"));
  await problem(page);
  assert.match(await text(page, "wrong-post"), /missing.*post\.post_file/);
  await page.selectOption("#set-post", "grbl");
  const { bytes } = await downloaded(page, "#post-save");
  const own = bytes.toString().replace(/^name = .*$/m, "name = shop").replace(/^title = .*$/m, "title = Shop 7");
  await page.setInputFiles("#post-file", asFile("shop.post", own));
  await page.waitForFunction(() => document.getElementById("set-post").value === "./shop.post");
  await page.waitForFunction(() => document.getElementById("problem").hidden);
  assert.equal((await hashOf(page)).get("post"), "./shop.post");
  assert.equal(await page.inputValue("#set-post"), "./shop.post");
  await page.click("#start");
  await done(page);
  assert.match(await text(page, "outcome"), /erified/, await text(page, "problem"));
  const program = await downloaded(page, "#get-program");
  assert.equal(program.name, "dome.nc");
  const report = JSON.parse((await downloaded(page, "#get-report")).bytes);
  assert.match(report.time_basis, /acceleration/i);
  assert.ok(program.bytes.includes("F333"), "leads have their feed");
  const machine = await downloaded(page, "#machine-save");
  await withFolder(async (folder) => {
    await writeFile(join(folder, "dome.json"), dome());
    await writeFile(join(folder, machine.name), machine.bytes);
    await writeFile(join(folder, "shop.post"), own);
    await promisify(execFile)("bash", ["-c", await text(page, "command")], { cwd: folder, env: { ...process.env, PATH: `${bin}:${process.env.PATH}` } });
    assert.ok(program.bytes.equals(await readFile(join(folder, "dome.nc"))), "the program has other bytes than the command line's");
  });
  // A file is no part of the address: the page says so when it is gone.
  await page.reload();
  await page.setInputFiles("#file", asFile("dome.json", dome()));
  await problem(page);
  assert.match(await text(page, "problem"), /does not have the post file "shop.post".*Choose the file again/);
  await openGroups(page);
  await page.setInputFiles("#machine-file", asFile("m.json", '{"axes": [], "<b>": 1}'));
  await page.waitForFunction(() => /no machine in JSON.*<b>/.test(document.getElementById("problem").textContent));
  await page.setInputFiles("#machine-file", asFile("m.json", '{"axes": [{}]}'));
  await page.waitForFunction(() => /has 1 axes; it must have 3/.test(document.getElementById("problem").textContent));
  await page.setInputFiles("#post-file", asFile("big.post", Buffer.alloc(100_001, 65)));
  await page.waitForFunction(() => /100001 bytes; a post file has at most 100,000/.test(document.getElementById("problem").textContent));
  assert.deepEqual(faults, []);
  await close();
});

test("wrong settings are shown with value, field and a way to them", async () => {
  const { page, faults, close } = await openPage(browser, web.url);
  await page.setInputFiles("#file", asFile("dome.json", dome()));
  await regionsShown(page);
  await openGroups(page);
  await page.fill("#set-scallop", "-1");
  await problem(page);
  assert.match(await text(page, "problem"), /\u201cScallop\u201d = -1; must/);
  assert.match(await text(page, "problem"), /job\.operations\[0\]\.scallop_mm/);
  assert.match(await text(page, "wrong-scallop"), /-1/);
  assert.equal(await page.getAttribute("#set-scallop", "aria-invalid"), "true");
  await page.click('#problem [data-setting="scallop"]');
  assert.equal(await page.evaluate(() => document.activeElement.id), "set-scallop");
  // A text that is no number does not leave the page.
  await page.fill("#set-scallop", "0,02");
  await problem(page);
  assert.match(await text(page, "problem"), /decimal point/);
  await page.fill("#set-scallop", "0.02");
  await page.waitForSelector("#problem", { state: "hidden" });
  assert.deepEqual(faults, []);
  await close();
});

test("names with markup are text, wherever they stand", async () => {
  const evil = '<img src=x onerror=alert(1)><script>alert(2)</script>';
  const { page, faults, close } = await openPage(browser, `${web.url}#${new URLSearchParams({ up: evil, only: evil, "x<b>": "1", scallop: "0.1", tolerance: "0.05" })}`);
  assert.match(await text(page, "problem"), /x<b>/);
  await page.setInputFiles("#file", asFile(`${evil.replaceAll("/", "_")}.json`, dome(evil)));
  await problem(page);
  await page.evaluate(() => (location.hash = "scallop=0.1&tolerance=0.05"));
  await regionsShown(page);
  assert.ok((await text(page, "surfaces")).includes(evil));
  await page.click('[data-click="mill"]');
  await page.click('#surfaces button[data-is="only"]');
  await page.waitForTimeout(500);
  await regionsShown(page);
  await page.click("#start");
  await done(page);
  assert.match(await text(page, "outcome"), /erified/, await text(page, "problem"));
  const view = await downloaded(page, "#get-page");
  assert.ok(!view.bytes.includes(evil), "the markup is escaped in the page");
  assert.equal(await page.evaluate(() => document.querySelectorAll("img:not(#faces-picture)").length), 0);
  assert.equal(await page.frameLocator("#frames iframe:not(.next)").locator("img").count(), 0);
  assert.deepEqual(faults, []);
  await close();
});

test("damaged and unknown files are errors that say what to do", async () => {
  const { page, faults, close } = await openPage(browser, web.url);
  const cases = [
    ["part.txt", "hello", /has no ending that Patchmill reads/],
    ["part.json", "{", /JSON|cannot|line/],
    ["part.step", "ISO-10303-21; rubbish", /./],
    ["part.bpt", "1 2 3 \u0000", /line|patch/i],
    ["part.pb", "", /./],
  ];
  for (const [name, content, wanted] of cases) {
    await page.setInputFiles("#file", asFile(name, content));
    await problem(page);
    assert.match(await text(page, "problem"), wanted, name);
    assert.notEqual(await page.textContent("#problem .advice"), "", name);
  }
  await withFolder(async (folder) => {
    const big = join(folder, "big.step");
    await writeFile(big, Buffer.alloc(65 * 2 ** 20));
    await page.setInputFiles("#file", big);
    await page.waitForFunction(() => /65\.0 MiB; a request has at most 64 MiB/.test(document.getElementById("problem").textContent));
  });
  assert.deepEqual(faults, []);
  await close();
});

// Serves the page in front of a backend of the test. `run` starts a job, which it answers with these events.
async function withFake(use) {
  let events = [];
  const router = (routes) =>
    routes.service(ToolpathService, {
      async *generateProgram({ validateOnly }) {
        yield { event: { case: "accepted", value: {} } };
        if (!validateOnly) for (const [name, value] of events) yield { event: { case: name, value } };
      },
    });
  const fake = createServer(connectNodeAdapter({ routes: router }));
  const port = await freePort();
  await new Promise((resolve) => fake.listen(port, "127.0.0.1", resolve));
  const own = await startWeb(port);
  const { page, faults, close } = await openPage(browser, own.url);
  await page.setInputFiles("#file", asFile("dome.json", dome()));
  await problem(page); // there is nothing else behind this backend
  const run = async (next) => {
    events = next;
    await page.click("#start");
    await page.waitForSelector("#start:enabled");
  };
  await use(page, run);
  assert.deepEqual(faults, []);
  await close();
  await own.stop();
  fake.close();
}
const programBytes = new TextEncoder().encode("G1 X0\nM30\n");
const sha = createHash("sha256").update(programBytes).digest();
const verified = { outcome: Outcome.COMPLETE, programSizeBytes: programBytes.length, programSha256: sha, totalAreaMm2: 1 };

test("a stream that ends early is void, and so is a program that is not the verified one", { timeout: 60_000 }, async () => {
  const program = ["program", { data: programBytes }];
  const other = ["program", { data: new TextEncoder().encode("G1 X9\nM30\n") }];
  const cases = [
    [[program], /ended before its report/],
    [[other, ["report", verified]], /did not arrive whole/],
    [[program, program, ["report", verified]], /did not arrive whole/],
    [[["report", verified]], /did not arrive whole/],
  ];
  await withFake(async (page, run) => {
    for (const [events, wanted] of cases) {
      await run(events);
      assert.match(await text(page, "problem"), wanted);
      assert.equal(await page.isVisible("#result"), false);
    }
    // What a verification refused is not handed out, although it came.
    await run([program, ["report", { ...verified, outcome: Outcome.VERIFICATION_FAILED }]]);
    assert.match(await text(page, "outcome"), /verification failed: no program/);
    assert.equal(await page.isVisible("#get-program"), false);
    await run([program, ["report", verified]]);
    assert.ok((await downloaded(page, "#get-program")).bytes.equals(Buffer.from(programBytes)));
  });
});

test("answers with markup and with damaged triangles leave page and program whole", { timeout: 60_000 }, async () => {
  const evil = "<img src=x onerror=alert(1)><script>alert(2)</script>";
  const finding = { severity: 2, code: evil, message: evil, where: { faceId: evil } };
  const report = { ...verified, diagnostics: [finding], checkBeforeStartCodes: [evil], timeBasis: evil, estimatedTimeS: 9, unreachable: [{ reason: 99, areaMm2: 1 }] };
  // A corner that is not there, and names that are markup.
  const mesh = { positionMm: [0, 0, 0, 1, 0, 0, 0, 1, 0], normal: [0, 0, 1, 0, 0, 1, 0, 0, 1], slopeDeg: [0, 0, 0], contourCurvaturePerMm: [0, 0, 0], corners: [0, 1, 7], regionId: [0], patchIndex: [0], patchNames: [evil] };
  const regions = { regions: [{ id: 0, kind: 1, slope: 1, areaMm2: 1 }] };
  await withFake(async (page, run) => {
    await run([["regions", regions], ["mesh", mesh], ["program", { data: programBytes }], ["report", report]]);
    assert.match(await text(page, "problem"), /3-D view/);
    assert.match(await text(page, "problem"), /mesh\.index holds 7 at 2/);
    const saved = await downloaded(page, "#get-program");
    assert.ok(saved.bytes.equals(Buffer.from(programBytes)));
    assert.ok((await text(page, "assumed")).includes(evil));
    assert.equal(await page.evaluate(() => document.querySelectorAll("img:not(#faces-picture), #settings script").length), 0);
  });
});

test("an address with anything in it does no harm", async () => {
  const { page, faults, close } = await openPage(browser, `${web.url}#scallop=0.3&tolerance=0.1`);
  await page.setInputFiles("#file", asFile("dome.json", dome()));
  await regionsShown(page);
  const cases = [
    ["up=constructor", /up_face.*constructor|constructor/],
    ["zero=toString", /toString.* must be origin/],
    ["strategy=__proto__", /__proto__.* must be one of auto, contour, zigzag/],
    ["coolant=valueOf", /valueOf.* must be one of off, flood/],
    ["region=1,2,3:constructor", /must be X,Y,Z and then/],
    ["post=constructor", /post\.dialect/],
    ["post=..%2F..%2Fetc%2Fpasswd", /does not have the post file/],
    ["stock=outline:@%2Fetc%2Fpasswd", /must be points X,Y/],
    ["machine-x=1,2,3", /Fill in fastest feed, acceleration/],
    [`obstacle=${"a".repeat(300_000)}`, /must be NAME=TOP,MARGIN/],
    ["__proto__=1&constructor=2&scallop[]=3", /do not exist: __proto__, constructor, scallop\[\]/],
    ["scallop=%ff%00&tolerance=NaN", /is no number/],
  ];
  for (const [hash, wanted] of cases) {
    await page.evaluate((h) => (location.hash = h), hash.includes("scallop") ? hash : `scallop=0.3&tolerance=0.1&${hash}`);
    await page.waitForFunction((w) => new RegExp(w).test(document.getElementById("problem").textContent), wanted.source).catch(async () => {
      assert.match(await text(page, "problem"), wanted, hash.slice(0, 60));
    });
  }
  // Flags that are off are off.
  await page.evaluate(() => (location.hash = "scallop=0.3&tolerance=0.1&spirals=0&one-way=false&inch=1"));
  await page.waitForFunction(() => document.getElementById("set-inch").checked);
  assert.equal(await page.isChecked("#set-spirals"), false);
  assert.doesNotMatch(await text(page, "command"), /spirals|one-way/);
  assert.deepEqual(faults, []);
  await close();
});

test("a backend or a server that is not there is said on the page", async () => {
  const own = await startWeb(await freePort());
  const { page, close } = await openPage(browser, own.url);
  await problem(page);
  assert.match(await text(page, "problem"), /patchmilld does not answer at 127\.0\.0\.1:\d+/);
  await own.stop();
  await page.setInputFiles("#file", asFile("dome.json", dome()));
  await page.waitForFunction(() => /server of this page does not answer/.test(document.getElementById("problem").textContent));
  await close();
});

test("another site can neither call nor embed the page", async () => {
  const other = createHttp((_request, response) => response.writeHead(200, { "Content-Type": "text/html" }).end("<p>other</p>"));
  const port = await freePort();
  await new Promise((resolve) => other.listen(port, "127.0.0.1", resolve));
  const page = await browser.newPage();
  await page.goto(`http://localhost:${port}/`);
  const before = backend.lines.length;
  const outcome = await page.evaluate(async (url) => {
    const call = (mode, headers) => fetch(`${url}patchmill.v1.ToolpathService/ListPosts`, { method: "POST", mode, headers, body: "" }).then((r) => r.type, () => "refused");
    const frame = document.createElement("iframe");
    frame.src = url;
    document.body.append(frame);
    await new Promise((resolve) => (frame.onload = resolve));
    let isReadable = true;
    try {
      isReadable = frame.contentDocument !== null;
    } catch {
      isReadable = false;
    }
    return [await call("cors", { "Content-Type": "application/proto", "Connect-Protocol-Version": "1" }), await call("no-cors", {}), isReadable];
  }, web.url);
  assert.equal(outcome[0], "refused");
  assert.equal(outcome[2], false);
  assert.ok(!backend.lines.slice(before).some((line) => line.includes("ListPosts")), "no call came through");
  await page.close();
  other.close();
});

test("the address holds the settings, the page is dark and narrow when it should be", async () => {
  const { page, faults, close } = await openPage(browser, `${web.url}#tool-diameter=4&strategy=zigzag&spirals=1&obstacle=${encodeURIComponent("vice=12,2: -40,-20 -30,-20 -30,20")}`, { colorScheme: "dark", viewport: { width: 390, height: 800 } });
  assert.equal(await page.inputValue("#set-tool-diameter"), "4");
  assert.equal(await page.inputValue("#set-strategy"), "zigzag");
  assert.equal(await page.isChecked("#set-spirals"), true);
  assert.match(await page.inputValue("#set-obstacle"), /^vice=12,2:/);
  await page.setInputFiles("#file", asFile("dome.json", dome()));
  await regionsShown(page);
  await page.waitForSelector("#frames iframe:not(.next)");
  assert.equal((await inFrame(page, "state")).theme, "dark");
  assert.deepEqual((await inFrame(page, "state")).layers.filter((l) => l.id === "clamps").length, 1);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "nothing is cut off at the side");
  await openGroups(page);
  // A new body begins with one that the part fits into: its diagonal is 84.9 mm.
  await page.selectOption("#set-stock", "cylinder");
  assert.equal((await hashOf(page)).get("stock"), "cylinder,85");
  await page.fill("#stock-diameter", "90");
  await page.fill("#stock-center", "1,2.5");
  assert.equal((await hashOf(page)).get("stock"), "cylinder,90,1,2.5");
  await page.selectOption("#set-stock", "block");
  assert.equal((await hashOf(page)).get("stock"), "block");
  await page.fill("#stock-margin", "2");
  assert.equal((await hashOf(page)).get("stock"), "block,2");
  await page.waitForTimeout(500);
  await regionsShown(page);
  await page.waitForFunction(() => document.querySelector("#frames iframe:not(.next)").contentWindow.patchmillFrame.state().layers.some((l) => l.id === "stock"));
  await page.click("#dark");
  assert.equal((await inFrame(page, "state")).theme, "light");
  await page.click("#reset");
  assert.equal(new URL(page.url()).hash.replace("#", ""), "");
  assert.deepEqual(faults, []);
  await close();
});
