// Arcs, times, thinning and picking, against closed forms.
import assert from "node:assert/strict";
import { test } from "node:test";
import { load, randomFrom } from "./load.mjs";

const {
  arcPoint, arcChords, Timeline, makePathVertices, thin, PathPicker, MeshPicker, valueAt, nearestOnTriangle, NearestPoint,
  contactVertices, passRanks, currentSpan, leastRanks, chunkStarts, distanceOf, clockText, usualSpeed, toolProfiles, roundUp, formatNumber,
  Camera, splitByRegion, meshNormals, PathClass,
} = await load(
  "arc", "timeline", "path_vertices", "thin", "path_pick", "mesh_pick", "contact", "density", "path_view", "measure", "player",
  "playback", "tool_view", "shading", "camera", "mesh_view",
);

const near = (a, b, tolerance = 1e-9) => assert.ok(Math.abs(a - b) <= tolerance, `${a} is not ${b}`);
const nearAll = (a, b, tolerance) => a.forEach((v, i) => near(v, b[i], tolerance));

function pathOf(tips, more = {}) {
  return {
    tip: Float32Array.from(tips.flat()),
    kind: Uint8Array.from(tips, () => 5),
    passKind: null, region: null, pass: null, feed: null, seconds: null, line: null, arcs: null,
    ...more,
  };
}
const arcsOf = (move, plane, center, turns) => ({
  move: Uint32Array.of(move), plane: Uint8Array.of(plane), center: Float32Array.from(center), turns: Float32Array.of(turns),
});

test("points of arcs lie on helices of their planes", () => {
  // A quarter turn, counter-clockwise seen from the positive end of the third axis, takes the first axis to the second one.
  const axes = { 1: [0, 1, 2], 2: [2, 0, 1], 3: [1, 2, 0] };
  for (const [plane, [first, second, third]] of Object.entries(axes)) {
    for (const turns of [0.25, -0.25, 1, -1, 0.6]) {
      const center = [4, 5, 6];
      const whole = 2 * Math.PI * turns;
      const at = (share) => {
        const p = [...center];
        p[first] += 2 * Math.cos(whole * share);
        p[second] += 2 * Math.sin(whole * share);
        p[third] += 3 * share;
        return p;
      };
      const out = [0, 0, 0];
      for (const share of [0, 0.2, 0.5, 1]) {
        arcPoint(arcsOf(1, Number(plane), center, turns), 0, at(0), at(1), share, out);
        nearAll(out, at(share), 1e-6);
      }
    }
  }
});

test("an arc ends in its end, even if its centre is rounded", () => {
  const out = [0, 0, 0];
  arcPoint(arcsOf(1, 1, [0.001, 0, 0], 0.5), 0, [1, 0, 0], [-1, 0, 0], 1, out);
  nearAll(out, [-1, 0, 0], 1e-6);
});

test("chords of arcs stay within their tolerance", () => {
  for (const [radius, chord] of [[3, 0.01], [100, 0.001], [0.02, 0.01]]) {
    const n = arcChords(radius, 1, chord);
    assert.ok(radius * (1 - Math.cos(Math.PI / n)) <= chord * (1 + 1e-9), `${n} chords`);
  }
});

test("the place at a time is the move that runs then", () => {
  const path = pathOf([[0, 0, 0], [10, 0, 0], [10, 0, 0], [10, 20, 0]], { seconds: Float32Array.of(0, 2, 0, 4) });
  const timeline = new Timeline(path);
  assert.equal(timeline.total, 6);
  assert.deepEqual(timeline.placeAt(0), { move: 0, share: 1 });
  assert.deepEqual(timeline.placeAt(0.5), { move: 1, share: 0.25 });
  assert.deepEqual(timeline.placeAt(2), { move: 1, share: 1 });
  assert.deepEqual(timeline.placeAt(3), { move: 3, share: 0.25 });
  assert.deepEqual(timeline.placeAt(99), { move: 3, share: 1 });
  const tip = [0, 0, 0];
  timeline.tipAt(timeline.placeAt(5), tip);
  nearAll(tip, [10, 15, 0]);
  const random = randomFrom(7);
  for (let i = 0; i < 100; i++) {
    const time = random() * 6;
    near(timeline.timeOf(timeline.placeAt(time)), time);
  }
});

test("the tool follows an arc", () => {
  const path = pathOf([[1, 0, 0], [-1, 0, 1]], { seconds: Float32Array.of(0, 10), arcs: arcsOf(1, 1, [0, 0, 0], 0.5) });
  const tip = [0, 0, 0];
  new Timeline(path).tipAt({ move: 1, share: 0.5 }, tip);
  nearAll(tip, [0, 1, 0.5], 1e-6);
});

test("vertices of arcs lie on them, and other vertices are the tips", () => {
  const path = pathOf([[5, 0, 0], [5, 1, 0], [-5, 1, 4], [-6, 1, 4]], {
    seconds: Float32Array.of(0, 1, 8, 1),
    arcs: arcsOf(2, 1, [0, 1, 0], 0.5),
  });
  const timeline = new Timeline(path);
  const v = makePathVertices(timeline, 0.01);
  for (let i = 0; i < v.class.length; i++) {
    const [x, y, z] = v.position.subarray(3 * i, 3 * i + 3);
    if (v.move[i] !== 2) continue;
    near(Math.hypot(x, y - 1), 5, 1e-5);
    near(z, 4 * v.share[i], 1e-5);
    near(v.time[i], 1 + 8 * v.share[i], 1e-5);
  }
  assert.deepEqual([...v.position.slice(-3)], [-6, 1, 4]);
  assert.equal(v.move[v.move.length - 1], 3);
});

function distanceToSegment(p, a, b) {
  const u = b.map((x, k) => x - a[k]);
  const w = p.map((x, k) => x - a[k]);
  const uu = u.reduce((s, x) => s + x * x, 0);
  const t = uu > 0 ? Math.max(0, Math.min(1, u.reduce((s, x, k) => s + x * w[k], 0) / uu)) : 0;
  return Math.hypot(...w.map((x, k) => x - t * u[k]));
}

test("a thinned path keeps its bound, its classes and the vertices that stay", () => {
  const seed = 11;
  const random = randomFrom(seed);
  const count = 3000;
  const position = new Float32Array(3 * count);
  const classes = new Uint8Array(count);
  const stays = new Uint8Array(count);
  for (let i = 1; i < count; i++) {
    for (let k = 0; k < 3; k++) position[3 * i + k] = position[3 * i - 3 + k] + random() - (k === 0 ? 0.2 : 0.5);
    classes[i] = Math.floor(i / 250) % 3;
    stays[i] = i % 700 === 0 ? 1 : 0;
  }
  const point = (i) => [...position.subarray(3 * i, 3 * i + 3)];
  let before = count;
  for (const { tolerance, kept } of thin(position, classes, stays, [0.1, 0.4, 1.6, 6.4])) {
    assert.equal(kept[0], 0);
    assert.equal(kept[kept.length - 1], count - 1);
    assert.ok(kept.length < before);
    before = kept.length;
    for (let j = 1; j < kept.length; j++) {
      for (let i = kept[j - 1]; i < kept[j]; i++) {
        const d = distanceToSegment(point(i), point(kept[j - 1]), point(kept[j]));
        assert.ok(d <= tolerance * (1 + 1e-5), `seed ${seed}: vertex ${i} is ${d} mm off, ${tolerance} are allowed`);
      }
    }
    for (let i = 0; i < count; i += 700) assert.ok(kept.includes(i));
  }
});

test("straight lines are thinned to their ends", () => {
  const count = 1000;
  const position = Float32Array.from({ length: 3 * count }, (_, i) => (i % 3 === 0 ? i / 3 : 0));
  const [level] = thin(position, new Uint8Array(count), new Uint8Array(count), [0.01]);
  assert.deepEqual([...level.kept], [0, count - 1]);
});

test("the move under a ray is that of a search over all", () => {
  const random = randomFrom(3);
  const tips = Array.from({ length: 500 }, () => [random() * 100, random() * 100, random() * 10]);
  const vertices = makePathVertices(new Timeline(pathOf(tips)), 0.01);
  const picker = new PathPicker(vertices);
  for (let n = 0; n < 50; n++) {
    const m = 1 + Math.floor(random() * 499);
    const share = 0.1 + 0.8 * random();
    const on = tips[m].map((v, k) => tips[m - 1][k] + share * (v - tips[m - 1][k]));
    const ray = { origin: [on[0], on[1], 1000], direction: [0, 0, -1] };
    const hit = picker.pick(ray, 2, () => 0.001, () => true, Infinity);
    near(hit.offset, 0, 1);
    // Another segment may lie above it at this place; then it is the nearer one.
    if (hit.move === m) near(hit.share, share, 1e-3);
    else assert.ok(hit.distance <= 1000 - on[2] + 1e-3);
    assert.equal(picker.pick(ray, 2, () => 0.001, () => true, hit.distance - 0.01), null);
  }
});

// A plane z = x / 2 over a square, as a grid.
function slopedMesh(n) {
  const position = [];
  const index = [];
  for (let j = 0; j <= n; j++) for (let i = 0; i <= n; i++) position.push(i, j, i / 2);
  for (let j = 0; j < n; j++) {
    for (let i = 0; i < n; i++) {
      const v = j * (n + 1) + i;
      index.push(v, v + 1, v + n + 2, v, v + n + 2, v + n + 1);
    }
  }
  return {
    position: Float32Array.from(position), index: Uint32Array.from(index),
    normal: null, slope: null, curvature: null, leftover: null, gouge: null, region: null, surface: null,
  };
}

test("the surface under a ray, and values between vertices", () => {
  const mesh = slopedMesh(20);
  const picker = new MeshPicker(mesh);
  const values = Float32Array.from({ length: mesh.position.length / 3 }, (_, v) => 3 * mesh.position[3 * v] - mesh.position[3 * v + 1]);
  const random = randomFrom(5);
  for (let n = 0; n < 100; n++) {
    const [x, y] = [random() * 20, random() * 20];
    const hit = picker.pick({ origin: [x, y, 50], direction: [0, 0, -1] }, () => true);
    nearAll(hit.point, [x, y, x / 2], 1e-6);
    near(valueAt(mesh, values, hit), 3 * x - y, 1e-4);
  }
  assert.equal(picker.pick({ origin: [-1, 5, 50], direction: [0, 0, -1] }, () => true), null);
  assert.equal(picker.pick({ origin: [5, 5, 50], direction: [0, 0, -1] }, () => false), null);
});

test("the nearest point of a plane is the foot of the normal", async () => {
  const nearest = new NearestPoint(new MeshPicker(slopedMesh(20)));
  const n = [-1 / Math.sqrt(5), 0, 2 / Math.sqrt(5)];
  const out = [0, 0, 0];
  for (const [x, y] of [[10, 10], [11, 3], [4, 18]]) {
    assert.ok(nearest.find([x + 3 * n[0], y, x / 2 + 3 * n[2]], 3.1, out));
    nearAll(out, [x, y, x / 2], 1e-5);
    assert.ok(!nearest.find([x + 3 * n[0], y, x / 2 + 3 * n[2]], 2.9, out));
  }
  assert.deepEqual(nearestOnTriangle([5, 5, 1], [0, 0, 0], [1, 0, 0], [0, 1, 0]).map((v) => v + 0), [0.5, 0.5, 0]);
  // The ball of radius 3 that touches (10, 10, 5) has its tip at the contact + 3 n - (0, 0, 3).
  const tip = [10 + 3 * n[0], 10, 5 + 3 * n[2] - 3];
  const vertices = makePathVertices(new Timeline(pathOf([[10, 10, 90], tip])), 0.01);
  const contact = await contactVertices(vertices, new MeshPicker(slopedMesh(20)), 3, () => {});
  nearAll([...contact.position], [10, 10, 90, 10, 10, 5], 1e-5);
});

test("ranks of passes halve, and leads go with their pass", () => {
  // A lead and two cuts for each of 16 passes.
  const kind = [1];
  const pass = [-1];
  for (let p = 0; p < 16; p++) {
    kind.push(4, 5, 5);
    pass.push(p, p, p);
  }
  const path = pathOf(kind.map((_, i) => [i, 0, 0]), { kind: Uint8Array.from(kind), pass: Int32Array.from(pass) });
  const vertices = makePathVertices(new Timeline(path), 0.01);
  const { ranks, counts } = passRanks(path, vertices);
  assert.equal(counts[PathClass.cut], 16);
  // Pass 5 has the moves 16 to 18; its lead is one of them.
  const ends = vertices.time;
  assert.deepEqual(currentSpan(vertices, ranks, ends[17]), [ends[15], ends[18]]);
  assert.deepEqual(currentSpan(vertices, ranks, 0), [1, 0]);
  for (const k of [0, 1, 2, 3]) {
    const drawn = new Set([...ranks.keys()].filter((v) => v > 0 && ranks[v] >= k).map((v) => pass[v]));
    assert.equal(drawn.size, 16 / 2 ** k);
  }
  for (let v = 1; v < kind.length; v += 3) assert.equal(ranks[v], ranks[v + 1]);
  const spacing = new Float64Array(256).fill(Infinity);
  spacing[PathClass.firstPass] = 0.1;
  // Passes at 0.1 mm: at 0.2 mm to the pixel each eighth one is 4 pixels from the next.
  assert.equal(leastRanks(spacing, 0.2)[PathClass.firstPass], 3);
  assert.equal(leastRanks(spacing, 0.03)[PathClass.firstPass], 0);
});

test("a long spiral is counted by its turns", () => {
  const steps = 1000; // of a turn
  const tips = Array.from({ length: 30 * steps + 1 }, (_, i) => {
    const angle = (2 * Math.PI * i) / steps;
    return [(10 + i / steps) * Math.cos(angle), (10 + i / steps) * Math.sin(angle), 0];
  });
  const path = pathOf(tips, { pass: new Int32Array(tips.length) });
  const { ranks, counts, hasTurns } = passRanks(path, makePathVertices(new Timeline(path), 0.01));
  assert.ok(hasTurns);
  near(counts[PathClass.cut], 30, 1);
  // Each other turn has rank 0.
  const drawn = [...ranks.subarray(1)].filter((r) => r > 0).length;
  near(drawn / (30 * steps), 0.5, 0.05);
});

test("chunks cover the path without gaps", () => {
  const ranks = Uint8Array.from({ length: 20000 }, (_, v) => Math.floor(v / 90) % 4);
  const starts = chunkStarts(ranks);
  assert.equal(starts[0], 0);
  assert.equal(starts[starts.length - 1], ranks.length - 1);
  for (let c = 1; c < starts.length; c++) assert.ok(starts[c] > starts[c - 1] && starts[c] - starts[c - 1] <= 4096);
});

test("a measured distance", () => {
  assert.deepEqual(distanceOf([1, 2, 3], [3, 5, 9]), { length: 7, delta: [2, 3, 6] });
});

test("texts of times and numbers", () => {
  assert.equal(clockText(59.96, 100), "1:00.0");
  assert.equal(clockText(61, 700), "1:01");
  assert.equal(clockText(3723, 7200), "1:02:03");
  assert.equal(usualSpeed(600), 10);
  assert.deepEqual([0.7, 1, 3, 40, 51].map(roundUp), [1, 1, 5, 50, 100]);
  assert.equal(formatNumber(-0.25), "\u22120.25");
});

test("the profile of a tool", () => {
  const tool = { ball_diameter: 6, flute_length: 12, shank_diameter: 8, holder: { stickout: 30, profile: [[0, 9], [20, 12]] } };
  const { flutes, shank, holder } = toolProfiles(tool);
  for (const [z, r] of flutes.slice(0, -1)) near(Math.hypot(3 - z, r), 3); // the ball
  assert.deepEqual(flutes[flutes.length - 1], [12, 3]);
  assert.deepEqual(shank, [[12, 3], [12, 4], [30, 4], [30, 0]]);
  assert.deepEqual(holder, [[30, 0], [30, 9], [50, 12], [50, 0]]);
});

test("a point and the ray through its pixel", () => {
  const camera = new Camera();
  Object.assign(camera, { width: 800, heightPx: 600, height: 50, yaw: 33, pitch: 41 });
  const random = randomFrom(2);
  for (const isOrthographic of [false, true]) {
    camera.isOrthographic = isOrthographic;
    for (let n = 0; n < 20; n++) {
      const point = [random() * 20 - 10, random() * 20 - 10, random() * 20 - 10];
      const { x, y } = camera.project(point);
      const { origin, direction } = camera.rayAt(x, y);
      const along = point.reduce((s, v, k) => s + (v - origin[k]) * direction[k], 0);
      nearAll(origin.map((v, k) => v + along * direction[k]), point, 1e-6);
    }
  }
  camera.look("top");
  camera.update();
  nearAll(camera.right.toArray(), [1, 0, 0]);
  nearAll(camera.up.toArray(), [0, 1, 0]);
});

test("fitting shows each corner of a box, and one of them near the edge", () => {
  const camera = new Camera();
  Object.assign(camera, { width: 800, heightPx: 600 });
  for (const isOrthographic of [false, true]) {
    camera.isOrthographic = isOrthographic;
    for (const view of ["top", "front", "iso"]) {
      camera.look(view);
      camera.fit([0, 0, 0], [90, 50, 30]);
      let most = 0;
      for (let c = 0; c < 8; c++) {
        const { x, y } = camera.project([c & 1 ? 90 : 0, c & 2 ? 50 : 0, c & 4 ? 30 : 0]);
        most = Math.max(most, Math.abs(x - 400) / 400, Math.abs(y - 300) / 300);
      }
      assert.ok(most < 1 && most > 0.85, `${view}: ${most}`);
    }
  }
});

test("zooming keeps what is under the pixel", () => {
  const camera = new Camera();
  Object.assign(camera, { width: 800, heightPx: 600, height: 50, isOrthographic: true });
  const { origin: before } = camera.rayAt(700, 100);
  camera.zoom(1.5, 700, 100);
  const { origin, direction } = camera.rayAt(700, 100);
  const along = before.reduce((s, v, k) => s + (v - origin[k]) * direction[k], 0);
  nearAll(origin.map((v, k) => v + along * direction[k]), before, 1e-6);
});

test("vertices between regions are copied, and triangles keep their corners", () => {
  const mesh = slopedMesh(4);
  mesh.region = Int32Array.from({ length: 32 }, (_, t) => (t < 16 ? 3 : -1));
  const { index, source, region } = splitByRegion(mesh);
  assert.equal(source.length, 25 + 5);
  index.forEach((v, i) => {
    assert.equal(source[v], mesh.index[i]);
    assert.equal(region[v], mesh.region[Math.floor(i / 3)]);
  });
  const normal = meshNormals(mesh);
  for (let v = 0; v < 25; v++) nearAll([...normal.subarray(3 * v, 3 * v + 3)], [-1 / Math.sqrt(5), 0, 2 / Math.sqrt(5)], 1e-6);
});
