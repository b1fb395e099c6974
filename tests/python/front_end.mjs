// front_end.mjs URL MODEL: uses docs/front_end.py as somebody at a browser does, and prints what was seen as JSON.
import { readFile } from "node:fs/promises";
import { openBrowser } from "../../clients/viewer/test/browser.mjs";

const [url, model] = process.argv.slice(2);
const browser = await openBrowser();
const page = await browser.newPage();
const complaints = [];
page.on("pageerror", (e) => complaints.push(e.message));
await page.goto(url);
await page.setInputFiles("#model", model);
const textWith = async (part) => {
  await page.waitForFunction((p) => document.getElementById("text").textContent.includes(p), part, { timeout: 60000 });
  return page.locator("#text").innerText();
};

await page.click("#regions");
const regions = await textWith("regions:");
const frame = await (await page.locator("iframe").elementHandle()).contentFrame();
await frame.waitForFunction(() => window.patchmillView !== undefined);

await page.fill("#scallop", "9");
await page.click("#mill");
const error = await textWith("InvalidRequestError");

await page.fill("#scallop", "0.0002");
await page.click("#mill");
await page.waitForFunction(() => document.getElementById("bar").value > 0 && !document.getElementById("text").textContent.includes("Error"));
await page.click("#cancel");
const cancelled = await textWith("JobCancelledError");

await page.fill("#scallop", "1");
await page.click("#mill");
const result = await textWith("COMPLETE");
const download = page.waitForEvent("download");
await page.click("#program");
const program = await readFile(await (await download).path(), "utf8");
await browser.close();
console.log(JSON.stringify({ regions, error, cancelled, result, program, complaints }));
