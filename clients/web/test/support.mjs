// Starts what the tests need: patchmilld, the server, a browser. PATCHMILL_BIN names the folder of patchmilld and patchmill.
import { execFile, spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { mkdtemp, rm } from "node:fs/promises";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { promisify } from "node:util";
import { chromium } from "playwright-core";

export const root = fileURLToPath(new URL("../../../", import.meta.url));
export const bin = process.env.PATCHMILL_BIN ?? join(root, "build/release/bin");
const serverFile = fileURLToPath(new URL("../dist/server.mjs", import.meta.url));
export const example = (name) => join(root, "examples", name);
export const cadPart = (name) => join(root, "tests/models/cad", name);

export function needBuild() {
  for (const file of [serverFile, join(bin, "patchmilld"), join(bin, "patchmill")]) {
    if (!existsSync(file)) throw new Error(`${file} is missing. Build it, or set PATCHMILL_BIN.`);
  }
}

export function freePort() {
  return new Promise((resolve, reject) => {
    const server = createServer().on("error", reject);
    server.listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

// A test that fails stops nothing itself.
const children = new Set();
process.on("exit", () => children.forEach((child) => child.kill()));

// Runs a program until it is told to stop. Its lines come to `onLine`.
function run(command, args, onLine = () => {}) {
  const child = spawn(command, args, { stdio: ["ignore", "pipe", "pipe"] });
  children.add(child);
  for (const stream of [child.stdout, child.stderr]) {
    let rest = "";
    stream.setEncoding("utf8").on("data", (text) => {
      const lines = (rest + text).split("\n");
      rest = lines.pop();
      lines.forEach(onLine);
    });
  }
  const ended = new Promise((resolve) => child.on("exit", resolve));
  return {
    child,
    ended,
    stop: async (signal = "SIGTERM") => {
      child.kill(signal);
      await ended;
    },
  };
}

export async function startBackend(port) {
  const lines = [];
  let ready = null;
  const isReady = new Promise((resolve) => (ready = resolve));
  const own = port ?? (await freePort());
  const running = run(join(bin, "patchmilld"), ["--listen", `127.0.0.1:${own}`], (line) => {
    lines.push(line);
    if (line.includes("listens on")) ready();
  });
  await isReady;
  return { port: own, lines, ...running };
}

export async function startWeb(backendPort, ...args) {
  let say = null;
  const url = new Promise((resolve) => (say = resolve));
  const lines = [];
  const running = run(process.execPath, [serverFile, "--listen", "127.0.0.1:0", "--backend", `127.0.0.1:${backendPort}`, ...args], (line) => {
    lines.push(line);
    if (line.startsWith("http://")) say(line);
  });
  running.ended.then(() => say(null));
  return { url: await url, lines, ...running };
}

export const startBrowser = () =>
  chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });

// A page that notes everything that should not happen: errors, and requests to other hosts.
export async function openPage(browser, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(20_000);
  const faults = [];
  page.on("pageerror", (error) => faults.push(`error: ${error.message}`));
  page.on("console", (message) => {
    // A refused call is a line of the console, and is shown on the page.
    if (message.type() === "error" && !message.text().startsWith("Failed to load resource")) faults.push(`console: ${message.text()}`);
  });
  page.on("request", (request) => {
    const { protocol, host } = new URL(request.url());
    if (protocol.startsWith("http") && host !== new URL(url).host) faults.push(`request: ${request.url()}`);
  });
  page.on("dialog", (dialog) => {
    faults.push(`dialog: ${dialog.message()}`);
    void dialog.dismiss();
  });
  await page.goto(url);
  return { page, faults, close: () => context.close() };
}

export const shown = (page) => page.waitForSelector("#frames iframe:not(.next)", { state: "visible", timeout: 30_000 });
export const regionsShown = (page) => page.waitForFunction(() => /\d+ regions?, computed/.test(document.getElementById("split-state").textContent), null, { timeout: 30_000 });

export async function choosePart(page, file) {
  await page.setInputFiles("#file", file);
  await regionsShown(page);
  await shown(page);
}

// Calls the interface of the frame that is shown.
export const inFrame = (page, name, ...args) =>
  page.evaluate(([n, a]) => document.querySelector("#frames iframe:not(.next)").contentWindow.patchmillFrame[n](...a), [name, args]);

export async function clickPoint(page, point) {
  const { x, y } = await inFrame(page, "project", point);
  const box = await (await page.$("#frames iframe:not(.next)")).boundingBox();
  const stage = await page.evaluate(() => {
    const r = document.querySelector("#frames iframe:not(.next)").contentDocument.getElementById("canvas").getBoundingClientRect();
    return { x: r.x, y: r.y };
  });
  await page.mouse.click(box.x + stage.x + x, box.y + stage.y + y);
}

export async function downloaded(page, button) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(button)]);
  const { readFile } = await import("node:fs/promises");
  return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
}

export async function withFolder(use) {
  const folder = await mkdtemp(join(tmpdir(), "patchmill-web-"));
  try {
    return await use(folder);
  } finally {
    await rm(folder, { recursive: true, force: true });
  }
}

export const patchmill = (...args) => promisify(execFile)(join(bin, "patchmill"), args, { env: { ...process.env, PATH: `${bin}:${process.env.PATH}` } });
