// Starts Debian's Chromium without a screen, with its software renderer.
import { chromium } from "playwright-core";

export function openBrowser() {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
}

// Tells `heard` what a page writes to the console and each error it throws. The software renderer's remarks on its own
// speed ("GPU stall due to ReadPixels") are left out: they depend on how busy the machine is, and a test's own look at a
// pixel causes them.
export function hearComplaints(page, heard) {
  page.on("console", (message) => {
    const text = message.text();
    if (!/^\[\.WebGL-\w+\]\s*GL Driver Message \(OpenGL, Performance, /.test(text)) heard(`${message.type()}: ${text}`);
  });
  page.on("pageerror", (error) => heard(`error: ${error.message}`));
}
