// Makes a scene of a hilly plate, for tests and for looking at the page. It fills every field that a scene can have.
//   node make_scene.mjs OUT.html [--segments 20000] [--grid 160] [--gzip] [--template FILE]
import { readFile, writeFile } from "node:fs/promises";
import { pathToFileURL } from "node:url";
import { gzipSync } from "node:zlib";
import { buildPage } from "./build.mjs";

export const plate = { x: 100, y: 70 };
export const hill = { x: 64, y: 36, height: 17, width: 8 };
const radius = 3; // of the ball
const steepAngle = 45;
const scallop = 0.02;
const tolerance = 0.01;
const stepSmooth = (t) => (t <= 0 ? 0 : t >= 1 ? 1 : t * t * t * (10 - 15 * t + 6 * t * t));

// The height of the plate. Within 13 mm of its middle the hill is a solid of revolution.
export function height(x, y) {
  const r = Math.hypot(x - hill.x, y - hill.y);
  const waves = 3 * Math.sin((2 * Math.PI * x) / 48) * Math.cos((2 * Math.PI * y) / 40);
  return hill.height * Math.exp((-r * r) / (2 * hill.width ** 2)) + waves * stepSmooth((r - 13) / 14);
}

// First and second derivatives of the height.
function derivatives(x, y) {
  const e = 1e-3;
  const [c, l, r, d, u] = [height(x, y), height(x - e, y), height(x + e, y), height(x, y - e), height(x, y + e)];
  const xy = (height(x + e, y + e) - height(x + e, y - e) - height(x - e, y + e) + height(x - e, y - e)) / (4 * e * e);
  return { x: (r - l) / (2 * e), y: (u - d) / (2 * e), xx: (r - 2 * c + l) / (e * e), yy: (u - 2 * c + d) / (e * e), xy };
}

function normalAt(x, y) {
  const d = derivatives(x, y);
  const size = Math.hypot(d.x, d.y, 1);
  return [-d.x / size, -d.y / size, 1 / size];
}

const degrees = (v) => (v * 180) / Math.PI;
export const slopeAt = (x, y) => degrees(Math.acos(normalAt(x, y)[2]));

// Positive where the level line bends outward; NaN where the surface is level.
function contourCurvature(x, y) {
  const d = derivatives(x, y);
  const g = Math.hypot(d.x, d.y);
  return g < 1e-2 ? NaN : -(d.xx * d.y ** 2 - 2 * d.xy * d.x * d.y + d.yy * d.x ** 2) / g ** 3;
}

export const leftoverAt = (x, y) =>
  scallop * (0.5 + 0.45 * Math.sin(x / 3) * Math.sin(y / 2)) + 0.09 * Math.exp(-((x - 6) ** 2 + (y - 6) ** 2) / 20);
export const gougeAt = (x, y) => 0.008 * Math.exp(-((x - 30) ** 2 + (y - 50) ** 2) / 60);

const isPocket = (x, y) => x < 12 && y < 12;
const regionAt = (x, y) => (isPocket(x, y) ? 2 : slopeAt(x, y) > steepAngle ? 1 : 0);

function makeMesh(grid) {
  const [nx, ny] = [grid, Math.max(2, Math.round((grid * plate.y) / plate.x))];
  const count = (nx + 1) * (ny + 1);
  const mesh = {
    "mesh.position": new Float32Array(3 * count),
    "mesh.normal": new Float32Array(3 * count),
    "mesh.slope": new Float32Array(count),
    "mesh.curvature": new Float32Array(count),
    "mesh.leftover": new Float32Array(count),
    "mesh.gouge": new Float32Array(count),
    "mesh.index": new Uint32Array(6 * nx * ny),
    "mesh.region": new Int32Array(2 * nx * ny),
    "mesh.surface": new Uint32Array(2 * nx * ny),
  };
  for (let j = 0, v = 0; j <= ny; j++) {
    for (let i = 0; i <= nx; i++, v++) {
      const [x, y] = [(plate.x * i) / nx, (plate.y * j) / ny];
      mesh["mesh.position"].set([x, y, height(x, y)], 3 * v);
      mesh["mesh.normal"].set(normalAt(x, y), 3 * v);
      mesh["mesh.slope"][v] = slopeAt(x, y);
      mesh["mesh.curvature"][v] = contourCurvature(x, y);
      mesh["mesh.leftover"][v] = leftoverAt(x, y);
      mesh["mesh.gouge"][v] = gougeAt(x, y);
    }
  }
  for (let j = 0, t = 0; j < ny; j++) {
    for (let i = 0; i < nx; i++, t += 2) {
      const v = j * (nx + 1) + i;
      mesh["mesh.index"].set([v, v + 1, v + nx + 2, v, v + nx + 2, v + nx + 1], 3 * t);
      const [x, y] = [(plate.x * (i + 0.5)) / nx, (plate.y * (j + 0.5)) / ny];
      const region = regionAt(x, y);
      const surface = (x > plate.x / 2 ? 1 : 0) + (y > plate.y / 2 ? 2 : 0);
      mesh["mesh.region"].set([region, region], t);
      mesh["mesh.surface"].set([surface, surface], t);
    }
  }
  return mesh;
}

// The rings where the hill turns steep, found by halving, and the edge of the pocket.
function makeBorders() {
  const points = [];
  const borders = [];
  const add = (name, color, line) => {
    borders.push({ name, color, first: points.length / 3, count: line.length });
    for (const [x, y] of line) points.push(x, y, height(x, y));
  };
  for (const [low, high] of [[0.5, hill.width], [13, hill.width]]) {
    let [a, b] = [low, high];
    for (let k = 0; k < 50; k++) {
      const middle = (a + b) / 2;
      if (slopeAt(hill.x + middle, hill.y) > steepAngle) b = middle;
      else a = middle;
    }
    const ring = Array.from({ length: 97 }, (_, i) => [hill.x + a * Math.cos((i * Math.PI) / 48), hill.y + a * Math.sin((i * Math.PI) / 48)]);
    add(`slope: ${(2 * Math.PI * a).toFixed(1)} mm`, "#c2410c", ring);
  }
  const edge = [...Array.from({ length: 25 }, (_, i) => [12, i / 2]), ...Array.from({ length: 25 }, (_, i) => [12 - i / 2, 12])];
  add("reach: 24.0 mm", "#5b21b6", edge);
  return { borders, points: new Float32Array(points) };
}

// Collects moves; the program's text grows with them.
class Moves {
  tip = [];
  kind = [];
  passKind = [];
  region = [];
  pass = [];
  feed = [];
  seconds = [];
  line = [];
  arcs = { move: [], plane: [], center: [], turns: [] };
  text = [];
  sections = [];
  lines = 0;

  write(text) {
    this.text.push(text, "\n");
    return ++this.lines;
  }

  get last() {
    return this.tip.slice(-3);
  }

  add(point, kind, { pass = -1, passKind = 255, region = -1, feed = 800, arc = null } = {}) {
    const from = this.tip.length === 0 ? point : this.last;
    let length = Math.hypot(point[0] - from[0], point[1] - from[1], point[2] - from[2]);
    const [x, y, z] = point.map((v) => v.toFixed(3));
    if (arc !== null) {
      const [u, v] = { 1: [0, 1], 2: [2, 0], 3: [1, 2] }[arc.plane];
      const third = 3 - u - v;
      const turn = 2 * Math.PI * Math.abs(arc.turns) * Math.hypot(from[u] - arc.center[u], from[v] - arc.center[v]);
      length = Math.hypot(turn, point[third] - from[third]);
      this.arcs.move.push(this.kind.length);
      this.arcs.plane.push(arc.plane);
      this.arcs.center.push(...arc.center);
      this.arcs.turns.push(arc.turns);
      this.line.push(this.write(`${["", "G17", "G18", "G19"][arc.plane]} ${arc.turns > 0 ? "G3" : "G2"} X${x} Y${y} Z${z}`));
    } else {
      this.line.push(this.write(`${kind === 1 ? "G0" : "G1"} X${x} Y${y} Z${z}`));
    }
    this.tip.push(...point);
    this.kind.push(kind);
    this.pass.push(pass);
    this.passKind.push(passKind);
    this.region.push(region);
    const rate = kind === 1 ? 10000 : feed;
    this.feed.push(kind === 1 ? 0 : feed);
    this.seconds.push((length / rate) * 60);
  }
}

const clearance = 26;

function tipAt(x, y) {
  const n = normalAt(x, y);
  return [x + radius * n[0], y + radius * n[1], height(x, y) + radius * n[2] - radius];
}

// Contours around the hill are whole circles, with leads and links that are arcs.
function addContours(moves, firstPass) {
  let pass = firstPass;
  moves.sections.push({ name: "region 1: contour passes", first_move: moves.kind.length });
  for (let r = 4; r <= 12; r += 0.8, pass++) {
    const [x, y, z] = tipAt(hill.x + r, hill.y);
    const options = { pass, passKind: 1, region: 1 };
    if (r === 4) {
      moves.add([x + 2, y, clearance], 1);
      moves.add([x + 2, y, z + 4], 2, { feed: 2000 });
      moves.add([x + 2, y, z + 2], 3, { feed: 300 });
    } else {
      // A link outward and down: a quarter turn in XZ about the place above its end.
      const [fx, , fz] = moves.last;
      moves.add([fx + 2, y, fz + 2], 6, { arc: { plane: 2, center: [fx + 2, y, fz], turns: 0.25 } });
      moves.add([x + 2, y, z + 2], 6, { feed: 1500 });
    }
    moves.add([x, y, z], 4, { ...options, feed: 500, arc: { plane: 2, center: [x + 2, y, z], turns: -0.25 } });
    moves.add([x, y, z], 5, { ...options, arc: { plane: 1, center: [hill.x, hill.y, z], turns: 1 } });
  }
  moves.add([...moves.last.slice(0, 2), clearance], 7, { feed: 3000 });
  return pass;
}

// Zig-zag lines over the whole plate, with about `segments` moves.
function addZigzag(moves, segments, firstPass) {
  moves.sections.push({ name: "region 0: zig-zag passes", first_move: moves.kind.length });
  const rows = Math.max(2, Math.round(Math.sqrt((segments * plate.y) / plate.x)));
  const steps = Math.max(2, Math.round(segments / rows));
  for (let j = 0; j < rows; j++) {
    const y = (plate.y * j) / (rows - 1);
    const at = (i) => tipAt((plate.x * (j % 2 === 0 ? i : steps - i)) / steps, y);
    const options = { pass: firstPass + j, passKind: 0, region: 0 };
    if (j === 0) {
      const [x, , z] = at(0);
      moves.add([x, y, clearance], 1);
      moves.add([x, y, z + 3], 2, { feed: 2000 });
      moves.add(at(0), 3, { feed: 300 });
    } else {
      moves.add(at(0), 6, { feed: 1200 });
    }
    for (let i = 1; i <= steps; i++) moves.add(at(i), 5, { ...options, feed: i < steps / 2 ? 800 : 1000 });
  }
  moves.add([...moves.last.slice(0, 2), clearance], 7, { feed: 3000 });
  return firstPass + rows;
}

// Returns the header (without buffers' places) and the buffers of a scene.
export function makeScene({ segments = 20000, grid = 160 } = {}) {
  const mesh = makeMesh(grid);
  const { borders, points } = makeBorders();
  const moves = new Moves();
  moves.write("%");
  moves.write("(hilly plate, ball 6 mm)");
  moves.write("G21 G90 G94 S12000 M3");
  moves.add([0, 0, 40], 1);
  moves.sections.push({ name: "start", first_move: 0 });
  const pass = addContours(moves, 0);
  addZigzag(moves, segments, pass);
  moves.add([0, 0, 40], 1);
  moves.write("M30");
  moves.write("%");
  const z = mesh["mesh.position"].filter((_, i) => i % 3 === 2);
  const [low, high] = [z.reduce((a, b) => Math.min(a, b)), z.reduce((a, b) => Math.max(a, b))];
  const header = {
    version: 1,
    title: "hilly_plate.json",
    made_by: "patchmill make_scene",
    outcome: "COMPLETE",
    figures: [
      ["largest gouge", "0.0080 mm"],
      ["largest leftover", "0.1007 mm"],
      ["moves", String(moves.kind.length)],
    ],
    findings: [
      { severity: "WARNING", code: "UNREACHABLE_AREA", message: "144.0 mm2 are CONCAVE: the ball is too large.", point: [6, 6, height(6, 6)] },
      { severity: "WARNING", code: "STEEP_LEAD", message: "The lead of pass 0 is steep.", point: [hill.x + 6, hill.y, height(hill.x + 6, hill.y)] },
      { severity: "INFO", code: "UNUSED_SETTING", message: "The setting min_area is not used.", point: null },
    ],
    box: { min: [0, 0, low], max: [plate.x, plate.y, high] },
    tolerance,
    scallop,
    steep_angle: steepAngle,
    tool: {
      ball_diameter: 2 * radius,
      flute_length: 12,
      shank_diameter: 6,
      holder: { stickout: 30, profile: [[0, 9], [4, 12], [22, 12], [22, 16], [34, 16]] },
    },
    stock: { outline: [[-4, -4], [plate.x + 4, -4], [plate.x + 4, plate.y + 4], [-4, plate.y + 4]], bottom: -14, top: 18 },
    clamps: [
      { name: "left jaw", outline: [[-22, 14], [-4, 14], [-4, 56], [-22, 56]], top: 1 },
      { name: "right jaw", outline: [[plate.x + 4, 14], [plate.x + 22, 14], [plate.x + 22, 56], [plate.x + 4, 56]], top: 1 },
    ],
    regions: [
      { id: 0, name: "0 plain, gentle: 6412.0 mm2", color: "#7fb2d9", unreachable: "" },
      { id: 1, name: "1 mountain, steep: 412.3 mm2", color: "#e6785f", unreachable: "" },
      { id: 2, name: "2 corner: 144.0 mm2", color: "#b7a4d6", unreachable: "CONCAVE" },
    ],
    surfaces: ["f1", "f2", "lid", "patch 3"],
    borders,
    passes: ["zigzag", "contour", "border", "pencil", "rest"],
    sections: moves.sections,
    time_basis: "at the given feeds; no accelerations",
  };
  const buffers = {
    ...mesh,
    "border.position": points,
    "path.tip": Float32Array.from(moves.tip),
    "path.kind": Uint8Array.from(moves.kind),
    "path.pass_kind": Uint8Array.from(moves.passKind),
    "path.region": Int32Array.from(moves.region),
    "path.pass": Int32Array.from(moves.pass),
    "path.feed": Float32Array.from(moves.feed),
    "path.seconds": Float32Array.from(moves.seconds),
    "path.line": Uint32Array.from(moves.line),
    "arc.move": Uint32Array.from(moves.arcs.move),
    "arc.plane": Uint8Array.from(moves.arcs.plane),
    "arc.center": Float32Array.from(moves.arcs.center),
    "arc.turns": Float32Array.from(moves.arcs.turns),
    "program.text": Buffer.from(moves.text.join("")),
  };
  return { header, buffers };
}

const typeNames = { Float32Array: "f32", Uint32Array: "u32", Int32Array: "i32", Uint8Array: "u8", Buffer: "u8" };

// Puts the buffers into one block, each at a multiple of 4 bytes, and their places into the header.
export function pack({ header, buffers }) {
  const places = {};
  let size = 0;
  for (const [name, array] of Object.entries(buffers)) {
    places[name] = { type: typeNames[array.constructor.name], offset: size, count: array.length };
    size += Math.ceil(array.byteLength / 4) * 4;
  }
  const block = Buffer.alloc(size);
  for (const [name, array] of Object.entries(buffers)) {
    Buffer.from(array.buffer, array.byteOffset, array.byteLength).copy(block, places[name].offset);
  }
  return { header: { ...header, buffers: places }, block };
}

// The template with a scene in it, as a list of pieces: one text may become too long.
export function fillPage(template, header, data) {
  const [before, rest] = template.split("@PATCHMILL_SCENE@");
  const [between, after] = rest.split("@PATCHMILL_DATA@");
  return [before, JSON.stringify(header).replaceAll("<", "\\u003c"), between, data, after];
}

export function makePage(template, scene, { gzip = false } = {}) {
  const { header, block } = pack(scene);
  if (!gzip) return fillPage(template, header, block.toString("base64"));
  return fillPage(template, { ...header, data_encoding: "gzip" }, gzipSync(block, { level: 6 }).toString("base64"));
}

if (process.argv[1] !== undefined && import.meta.url === pathToFileURL(process.argv[1]).href) {
  const words = process.argv.slice(2);
  const value = (name, usual) => (words.includes(name) ? words[words.indexOf(name) + 1] : usual);
  if (words.length === 0 || words[0].startsWith("--")) {
    console.error("usage: node make_scene.mjs OUT.html [--segments N] [--grid N] [--gzip] [--template FILE]");
    process.exit(2);
  }
  const file = value("--template", null);
  const template = file === null ? await buildPage() : await readFile(file, "utf8");
  const scene = makeScene({ segments: Number(value("--segments", 20000)), grid: Number(value("--grid", 160)) });
  await writeFile(words[0], makePage(template, scene, { gzip: words.includes("--gzip") }));
}
