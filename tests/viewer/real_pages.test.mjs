// Pages that patchmill writes, in Chromium: what the pointer shows is what report and program say.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { hearComplaints, openBrowser } from "../../clients/viewer/test/browser.mjs";

const patchmill = join(process.env.PATCHMILL_BIN, "patchmill");
const folder = mkdtempSync(join(tmpdir(), "patchmill-pages-"));
let browser;

before(async () => {
  browser = await openBrowser();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

// Runs patchmill; a job that cannot be done ends with status 1.
function run(args, status = 0) {
  try {
    execFileSync(patchmill, [...args, "--quiet"], { stdio: ["ignore", "ignore", "pipe"] });
  } catch (error) {
    assert.equal(error.status, status, String(error.stderr));
    return;
  }
  assert.equal(0, status);
}

// Opens a page; it must want nothing from elsewhere and complain about nothing.
async function open(file, complaints) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
  hearComplaints(page, (text) => complaints.push(text));
  page.on("request", (r) => {
    // Large scenes are unpacked in a worker, which is a text of the page itself.
    if (r.url() !== pathToFileURL(file).href && !/^(data:|blob:null\/)/.test(r.url())) complaints.push(`request: ${r.url()}`);
  });
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => window.patchmillView !== undefined);
  await page.evaluate(() => window.patchmillView.ready);
  return page;
}

test("a mould with stock, clamp and holder", async () => {
  const [program, report, page] = ["part.ngc", "part.json", "part.html"].map((name) => join(folder, name));
  run(["mill", "examples/two_hills.bv", "-o", program, "--report", report, "--preview", page, "--tool-diameter", "6",
    "--scallop", "0.05", "--allowance", "0.5", "--stock", "block,0", "--accept-depth", "30", "--stickout", "60", "--holder", "20,28 25,40,50",
    "--obstacle", "vice=5: -20,-20 -10,-20 -10,120 -20,120"]);
  const said = JSON.parse(readFileSync(report, "utf8"));
  const complaints = [];
  const view = await open(page, complaints);
  const state = () => view.evaluate(() => window.patchmillView.state());

  const { total } = await state();
  assert.ok(Math.abs(total - said.estimated_time_s) < 0.01 * total, `${total} s, ${said.estimated_time_s} s`);
  await view.evaluate((t) => window.patchmillView.setTime(t), total);
  const end = (await state()).tip;
  assert.ok(Math.abs(end[2] - said.setup_sheet.clearance_z_mm) < 1e-3, `the tool ends at Z ${end[2]}`);

  // From above, the pointer tells the region and the place that the report gives.
  await view.getByRole("button", { name: "Top", exact: true }).click();
  await view.evaluate(() => window.patchmillView.setTime(0));
  let compared = 0;
  for (const region of said.regions) {
    if (region.unreachable_reason !== "UNREACHABLE_REASON_UNSPECIFIED") continue;
    const at = [region.inside_point.x_mm, region.inside_point.y_mm, region.inside_point.z_mm];
    const picked = await view.evaluate((p) => {
      const { x, y } = window.patchmillView.project(p);
      return window.patchmillView.pick(x, y);
    }, at);
    const surface = picked?.kind === "move" ? picked.behind : picked;
    if (!surface?.region) continue;
    const where = surface.point;
    if (Math.hypot(where[0] - at[0], where[1] - at[1], where[2] - at[2]) > 1) continue; // something lies over it
    assert.ok(surface.region.startsWith(`${region.id} `), `${surface.region} at a point of region ${region.id}`);
    assert.ok(surface.gouge <= said.max_gouge_mm + 1e-4, `gouge ${surface.gouge}`);
    assert.ok(surface.leftover <= said.max_leftover_mm + 1e-3, `leftover ${surface.leftover}`);
    ++compared;
  }
  assert.ok(compared >= 2, `${compared} regions compared`);
  assert.deepEqual(complaints, []);
  await view.close();
});

test("a job that failed, and regions alone", async () => {
  const failed = join(folder, "failed.html");
  run(["mill", "examples/two_hills.bv", "-o", join(folder, "no.ngc"), "--preview", failed, "--tool-diameter", "6",
    "--scallop", "0.05", "--stock", "block,4"], 1);
  const regions = join(folder, "regions.html");
  run(["regions", "examples/two_hills.bv", "-o", regions, "--tool-diameter", "6"]);
  for (const [file, text] of [[failed, "NEEDS_ROUGHING"], [regions, "two_hills.bv"]]) {
    const complaints = [];
    const view = await open(file, complaints);
    assert.ok((await view.locator("body").innerText()).includes(text), text);
    assert.deepEqual(complaints, []);
    await view.close();
  }
});
