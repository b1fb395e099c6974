// notebook.mjs FILE.html: opens a document with the page in a frame, as a notebook has it, in Chromium without a screen, and
// prints what the page shows.
import { pathToFileURL } from "node:url";
import { hearComplaints, openBrowser } from "../../clients/viewer/test/browser.mjs";

const url = pathToFileURL(process.argv[2]).href;
const browser = await openBrowser();
const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
const complaints = [];
hearComplaints(page, (text) => complaints.push(text));
page.on("request", (r) => {
  if (r.url() !== url && !/^(data|about):/.test(r.url())) complaints.push(`request: ${r.url()}`);
});
await page.goto(url);
const frame = await (await page.locator("iframe").elementHandle()).contentFrame();
await frame.waitForFunction(() => window.patchmillView !== undefined);
await frame.evaluate(() => window.patchmillView.ready);
const { total } = await frame.evaluate(() => window.patchmillView.state());
const text = await frame.locator("body").innerText();
if (process.argv[3] !== undefined) await page.screenshot({ path: process.argv[3] });
await browser.close();
console.log(JSON.stringify({ total, text, complaints }));
