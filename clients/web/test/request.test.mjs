// The requests of the page are those of the command line: both resolve to the same digest, whatever is set.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { promisify } from "node:util";
import { after, before, test } from "node:test";
import { createClient } from "@connectrpc/connect";
import { createConnectTransport } from "@connectrpc/connect-node";
import { build } from "esbuild";
import { ToolpathService } from "../gen/patchmill/v1/toolpath_service_pb.js";
import { bin, needBuild, patchmill, startBackend, startWeb, withFolder } from "./support.mjs";

// The sources of the page as modules of Node.js.
async function load(...files) {
  const contents = files.map((file) => `export * from "./page/${file}";`).join("\n");
  const bundle = await build({ stdin: { contents, resolveDir: new URL("..", import.meta.url).pathname, loader: "ts" }, bundle: true, write: false, format: "esm", platform: "node" });
  return import(`data:text/javascript;base64,${Buffer.from(bundle.outputFiles[0].text).toString("base64")}`);
}

const points = [0, 0, 0, 0, 20, 6, 0, 40, 6, 0, 60, 0, 20, 0, 6, 20, 20, 30, 20, 40, 30, 20, 60, 6, 40, 0, 6, 40, 20, 30, 40, 40, 30, 40, 60, 6, 60, 0, 0, 60, 20, 6, 60, 40, 6, 60, 60, 0];
const shifted = points.map((v, i) => (i % 3 === 0 ? v + 60 : v));
const patch = (id, p) => ({ id, bezier: { degree_u: 3, degree_v: 3, points: p } });
const modelOf = (...patches) => JSON.stringify({ length_unit: "LENGTH_UNIT_MILLIMETER", patches });
const model = modelOf(patch("one", points), patch("two", shifted));
// A wall that stands alone has two sides.
const wall = { id: "wall", bezier: { degree_u: 1, degree_v: 1, points: [80, 0, 0, 80, 0, 10, 80, 40, 0, 80, 40, 10] } };
const withWall = modelOf(patch("one", points), wall);

const coarse = { scallop: "0.8", tolerance: "0.3" };
const cases = {
  "defaults, but coarse": {},
  "tool and post": {
    "tool-diameter": "4", "flute-length": "12.5", "shank-diameter": "6", stickout: "40", holder: "20,30 25,30,45.5", "holder-clearance": "0.7", spindle: "9000", feed: "800", "plunge-feed": "200", coolant: "flood", "tool-number": "12",
    post: "haas", "program-number": "42", "no-arcs": "1", "restart-points": "1", "line-numbers": "5",
  },
  "some cutting data, a point as zero, lines": { "tool-diameter": "9.7", feed: "777", zero: "1,2.25,-3", "work-offset": "G57", strategy: "zigzag", "zigzag-angle": "-30.5", "one-way": "1", edges: "roll", detail: "0.9" },
  "a small tool, contours": { "tool-diameter": "3.3", leave: "0.1", direction: "either", spirals: "1", edges: "extend", "steep-angle": "30", clearance: "12" },
  "placement, outer walls": { up: "-z", scale: "0.5", zero: "top-center", translate: "1.5,-2,3e-1", outside: "1", "max-unreached": "80" },
  "round stock and clamps": { stock: "cylinder,180,60,30", allowance: "0.4", "stock-top": "40", "accept-depth": "30", obstacle: ["vice=10,2: -40,-20 -30,-20 -30,20", "9: 150,0 160,0 160,10 150,10"] },
  "a block, a region with its own passes": { stock: "block", allowance: "0.3", "accept-depth": "30", region: ["30,30,19.125:contour"] },
  "walls and floors": { "allowance-walls": "0.2", "allowance-floors": "0.6" },
  "selection": { only: ["one"], avoid: ["#1"], "avoid-margin": "0.5", floor: "-3", top: "60" },
  "leads, links, feeds": { "lead-radius": "0.8", "lead-sweep": "60", "lead-feed": "600", "link-feed": "900.5", "corner-feed": "450", "plunge-angle": "12", "keep-feed": "1", "approach-gap": "0.7", "high-rapids": "1", allowance: "0.2" },
  "stock by outline, straight lines": { stock: "outline: -10,-10 130.5,-10 130.5,70 -10,70", "stock-top": "35", "accept-depth": "40", bend: "5", "no-round-lines": "1", "no-border-passes": "1" },
  "a machine": { "machine-name": "bench mill, \u00fc", "machine-x": "-400,0,10000,5000,500", "machine-y": "-250.5,1e0,10000,5000,500", "machine-z": "-200,0,5000,3000,300.25", "machine-corner": "0", "machine-spindle": "100,24000", "machine-zero": "-300,-200,-150" },
  "a machine without more": { "machine-x": "-400,0,10000,5000,500", "machine-y": "-250,0,10000,5000,500", "machine-z": "-200,0,5000,3000,300" },
  "an own post file, inches": { post: "./shop.post", inch: "1", "control-deviation": "0.01" },
  "a wall with its side": { "wall-side": ["wall=100,20,5"] },
  "holes closed": { "cap-holes": "6.5" },
  "boundary": { boundary: ["5,5 100,5 100,50 5,50", "20,20 30,20 30,30"], "boundary-mode": "inside", "boundary-offset": "1.5" },
  "a region off": { region: ["30,30,19.125:off"] },
};

let backend;
let web;
before(async () => {
  needBuild();
  backend = await startBackend();
  web = await startWeb(backend.port);
});
after(async () => {
  await web?.stop();
  await backend?.stop();
});

test("page and command line ask for the same job", { timeout: 80_000 }, async () => {
  const { Choice, commandOf, machineFile, machineText, makeMachine, makeProgram, readMachine, settings } = await load("settings.ts", "request.ts", "machine.ts");
  const client = createClient(ToolpathService, createConnectTransport({ baseUrl: web.url.replace(/\/$/, ""), httpVersion: "1.1", useBinaryFormat: true }));
  const seen = new Set();
  const { posts } = await client.listPosts({});
  const post = { name: "shop.post", text: posts.find((p) => p.name === "mach3").postFile.replace(/^title = .*$/m, "title = Shop") };
  await withFolder(async (folder) => {
    await writeFile(join(folder, post.name), post.text);
    for (const [title, values] of Object.entries(cases)) {
      const content = values["wall-side"] === undefined ? model : withWall;
      const file = { name: "two.json", bytes: new TextEncoder().encode(content) };
      await writeFile(join(folder, file.name), content);
      const choice = new Choice();
      for (const [name, value] of Object.entries({ ...coarse, ...values })) {
        choice.set(name, ...[value].flat());
        seen.add(name);
      }
      // The address brings them back.
      const again = new Choice();
      assert.deepEqual(again.fromHash(choice.toHash()), []);
      assert.equal(again.toHash(), choice.toHash());
      const request = makeProgram(file, again, post);
      const machine = makeMachine(again);
      if (machine !== undefined) {
        const text = machineText(machine);
        await writeFile(join(folder, machineFile), text);
        const read = readMachine(machineFile, text);
        for (const { name, group } of settings) if (group === "machine" && read.has(name)) again.set(name, read.get(name));
        assert.deepEqual(makeMachine(again), machine, "the file brings the machine back");
      }
      const command = commandOf(again, file.name, "out.ngc");
      await promisify(execFile)("bash", ["-c", `${command} --quiet`], { cwd: folder, env: { ...process.env, PATH: `${bin}:${process.env.PATH}` } }).catch((error) => {
        throw new Error(`${title}: ${command}: ${error.stderr}`);
      });
      // Some controls break their comments into short lines.
      const theirs = /request sha256:\W*([0-9a-f]{16,})/i.exec(await readFile(join(folder, "out.ngc"), "utf8"))[1].toLowerCase();
      let ours = "";
      for await (const { event } of client.generateProgram({ ...request, validateOnly: true })) {
        if (event.case === "accepted") ours = Buffer.from(event.value.requestSha256).toString("hex");
      }
      assert.ok(ours.startsWith(theirs), `${title}: ${command}`);
    }
  });
  // Nothing of the table is left out, but what needs a CAD file or plans a job twenty times.
  const missing = settings.map((s) => s.name).filter((name) => !seen.has(name) && !["skip-face", "border-tolerance", "length-unit", "auto-angle"].includes(name));
  assert.deepEqual(missing, []);
});

test("the page has every option of the command line that is about the job", async () => {
  const { settings } = await load("settings.ts");
  const { stdout } = await patchmill("mill", "--help");
  const options = [...stdout.matchAll(/^ +(?:-\w,)?--([a-z-]+)/gm)].map(([, name]) => name);
  assert.ok(options.length > 60, `${options.length} options`);
  // Files of the user have a chooser each, pictures are looked at; the others are about the call, or without
  // effect.
  const others = ["help", "output", "tool", "machine", "regions", "report", "preview", "server", "ca", "cert", "key", "token-file", "threads", "timeout", "quiet", "low-rapids"];
  const names = new Set([...settings.map((s) => s.name), ...others]);
  assert.deepEqual(options.filter((name) => !names.has(name) && !name.startsWith("picture-")), []);
});
