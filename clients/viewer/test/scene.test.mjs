// Reading of scenes: what is read equals what was written, and each damage has a message.
import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateRawSync, gzipSync } from "node:zlib";
import { makeScene, pack } from "../make_scene.mjs";
import { load, randomFrom } from "./load.mjs";

const { readScene, readSceneText, decodeBase64, Inflater, SceneError, ProgramText, firstMoves } = await load(
  "read_scene",
  "page_data",
  "base64",
  "inflate",
  "scene",
  "program_text",
);

const small = makeScene({ segments: 60, grid: 6 });
const blockOf = (buffer) => buffer.buffer.slice(buffer.byteOffset, buffer.byteOffset + buffer.byteLength);
// Reads the small scene after `change` has been at its header and its buffers.
function readChanged(change = () => {}) {
  const scene = structuredClone({ header: small.header, buffers: { ...small.buffers, "program.text": new Uint8Array(small.buffers["program.text"]) } });
  change(scene.header, scene.buffers);
  const { header, block } = pack(scene);
  return readScene(header, blockOf(block));
}

test("a scene is read as it was written", () => {
  const scene = readChanged();
  for (const [name, array] of Object.entries({
    "mesh.position": scene.mesh.position,
    "mesh.index": scene.mesh.index,
    "mesh.region": scene.mesh.region,
    "mesh.curvature": scene.mesh.curvature,
    "path.tip": scene.path.tip,
    "path.seconds": scene.path.seconds,
    "path.line": scene.path.line,
    "arc.center": scene.path.arcs.center,
  })) {
    assert.deepEqual([...array], [...small.buffers[name]], name);
  }
  const { buffers, version, ...header } = pack(small).header;
  assert.deepEqual(scene.header, header);
});

test("buffers that are not there are not known", () => {
  const scene = readChanged((_, b) => {
    for (const name of ["mesh.normal", "mesh.leftover", "path.seconds", "path.line", "path.pass_kind", "arc.move", "program.text"]) delete b[name];
  });
  assert.equal(scene.mesh.leftover, null);
  assert.equal(scene.path.arcs, null);
  assert.equal(scene.program, null);
});

const damages = {
  "of a later version": [(h) => (h.version = 2), /version 1.*version 2/],
  "without a title": [(h) => delete h.title, /"title"/],
  "with a region colour that is no colour": [(h) => (h.regions[0].color = "red;}"), /regions\[0\]\.color/],
  "with a clamp of two corners": [(h) => h.clamps[0].outline.splice(2), /clamps\[0\]\.outline/],
  "with holder heights that fall": [(h) => (h.tool.holder.profile[1][0] = -1), /rise/],
  "without positions": [(_, b) => delete b["mesh.position"], /mesh\.position is missing/],
  "without triangles": [(_, b) => delete b["mesh.index"], /mesh\.index is missing/],
  "without kinds": [(_, b) => delete b["path.kind"], /path\.kind is missing/],
  "without tips": [(_, b) => delete b["path.tip"], /path\.tip is missing/],
  "without centres of arcs": [(_, b) => delete b["arc.center"], /arc\.center is missing/],
  "with a slope too few": [(_, b) => (b["mesh.slope"] = b["mesh.slope"].slice(1)), /mesh\.slope must hold/],
  "with a corner out of range": [(_, b) => (b["mesh.index"][5] = 1e6), /mesh\.index holds 1000000 at 5/],
  "with a position that is no number": [(_, b) => (b["mesh.position"][4] = NaN), /mesh\.position.*not finite, at 4/],
  "with an infinite tip": [(_, b) => (b["path.tip"][7] = Infinity), /path\.tip.*not finite, at 7/],
  "with an infinite curvature": [(_, b) => (b["mesh.curvature"][3] = -Infinity), /infinite value, at 3/],
  "with times that run back": [(_, b) => (b["path.seconds"][2] = -1), /path\.seconds holds -1 at 2/],
  "with an unknown kind": [(_, b) => (b["path.kind"][3] = 8), /path\.kind holds 8 at 3/],
  "with an unknown kind of pass": [(_, b) => (b["path.pass_kind"][3] = 9), /path\.pass_kind holds 9 at 3/],
  "with an unknown region": [(_, b) => (b["mesh.region"][3] = 77), /region 77 at 3/],
  "with an unknown surface": [(_, b) => (b["mesh.surface"][3] = 77), /mesh\.surface holds 77 at 3/],
  "with a line behind the program": [(_, b) => (b["path.line"][3] = 1e6), /path\.line holds 1000000 at 3/],
  "with arcs out of order": [(_, b) => b["arc.move"].reverse(), /arc\.move must rise/],
  "with an arc of two turns": [(_, b) => (b["arc.turns"][0] = 2), /arc\.turns holds 2 at 0/],
  "with a border that has no points": [(h) => (h.borders[0].count = 1e6), /border .* needs/],
  "with a section behind the end": [(h) => (h.sections[0].first_move = 1e6), /begins at move/],
};
for (const [name, [change, message]] of Object.entries(damages)) {
  test(`a scene ${name} is refused`, () => {
    assert.throws(() => readChanged(change), (error) => error instanceof SceneError && message.test(error.message));
  });
}

test("places of buffers are checked", () => {
  const { header, block } = pack(small);
  const readWith = (change) => {
    const h = structuredClone(header);
    change(h.buffers);
    return () => readScene(h, blockOf(block));
  };
  assert.throws(readWith((b) => (b["path.kind"].offset += 1)), /multiple of 4/);
  assert.throws(readWith((b) => (b["path.kind"].type = "f32")), /must hold u8/);
  assert.throws(readWith((b) => (b["path.kind"].count = 1.5)), /no whole number/);
  assert.throws(readWith((b) => (b["mesh.position"].count = 2 ** 40)), /end early/);
  assert.throws(() => readScene(header, blockOf(block).slice(0, 1000)), /end early/);
  assert.throws(() => readScene(null, new ArrayBuffer(0)), SceneError);
});

test("base64 is decoded as Node encodes it, by table and by the browser", () => {
  for (const size of [0, 1, 2, 3, 4, 1000, 1001]) {
    const bytes = Uint8Array.from({ length: size }, (_, i) => (i * 89) & 255);
    const text = Buffer.from(bytes).toString("base64");
    const spaced = text.replace(/(.{60})/g, "$1\n");
    assert.deepEqual([...decodeBase64(text, undefined)], [...bytes]);
    assert.deepEqual([...decodeBase64(`\n${spaced}\n`, undefined)], [...bytes]);
  }
  assert.throws(() => decodeBase64("AAAA*AAA", undefined), SceneError);
  assert.throws(() => decodeBase64("AAAAA", undefined), /end early/);
  // A browser's own decoder that refuses the text gives the message of the table.
  const refusing = () => {
    throw new SyntaxError();
  };
  assert.throws(() => decodeBase64("AAAA*AAA", refusing), /no base64/);
});

test("a compressed scene is read, and a compressed one that ends early is refused", async () => {
  const { header, block } = pack(small);
  const text = JSON.stringify({ ...header, data_encoding: "gzip" });
  const data = gzipSync(block);
  const scene = await readSceneText(text, data.toString("base64"));
  assert.deepEqual([...scene.path.tip], [...small.buffers["path.tip"]]);
  await assert.rejects(readSceneText(text, data.subarray(0, data.length - 200).toString("base64")), /end early/);
  await assert.rejects(readSceneText("{", ""), /not JSON/);
  await assert.rejects(readSceneText(JSON.stringify({ ...header, data_encoding: "zip" }), ""), /encoding/);
});

// The block that comes out of texts, where the header states a size.
async function inflated(texts, isPacked, size) {
  const inflater = new Inflater(isPacked, size);
  for (const text of texts) await inflater.push(text);
  return new Uint8Array(await inflater.end());
}

test("data that come in pieces are the same as at once, however they are cut", async () => {
  const random = randomFrom(7);
  const bytes = Uint8Array.from({ length: 50_001 }, () => 16 * random());
  for (const pack of [(b) => b, gzipSync, deflateRawSync]) {
    const isPacked = pack(bytes) !== bytes;
    // Lines of 76 signs, cut at any place, and pieces without any sign.
    const text = Buffer.from(pack(bytes)).toString("base64").replace(/(.{76})/g, "$1\r\n");
    const pieces = ["", "\n"];
    for (let at = 0; at < text.length; ) {
      const end = at + 1 + Math.floor(3000 * random() ** 3);
      pieces.push(text.slice(at, end), "");
      at = end;
    }
    for (const stated of [bytes.length, 1000, 0, 60_000]) assert.deepEqual(await inflated(pieces, isPacked, stated), bytes);
  }
});

test("data that are damaged, end early, go on behind their end or grow without end are refused", async () => {
  const random = randomFrom(3);
  const bytes = Uint8Array.from({ length: 40_000 }, () => 256 * random());
  const whole = gzipSync(bytes).toString("base64");
  const flipped = Buffer.from(gzipSync(bytes));
  flipped[flipped.length - 6] ^= 1; // in the check sum
  const cases = [
    [[], /end early/],
    [[whole.slice(0, 4001)], /end early/],
    [[flipped.toString("base64")], /damaged/],
    [[Buffer.from("no gzip at all, and no deflate").toString("base64")], /damaged/],
    [["AA==", "AAAA"], /behind its end, at the sign 4/],
    [[whole.slice(0, 400), `${whole.slice(400, 403)}*`, whole.slice(404)], /the sign 403 is no base64/],
    // 64 MB out of 64 kB: it is not unpacked further than the header goes.
    [[gzipSync(Buffer.alloc(64 * 2 ** 20)).toString("base64")], /longer than the header states/],
  ];
  for (const [texts, wanted] of cases) {
    await assert.rejects(inflated(texts, true, bytes.length), (error) => error instanceof SceneError && wanted.test(error.message), String(wanted));
  }
  await assert.rejects(inflated([Buffer.alloc(3 * 2 ** 20).toString("base64")], false, 100), /longer than the header states/);
  // A header that states far more than there is costs nothing but its message.
  const { header, block } = pack(small);
  const much = { ...header, buffers: { ...header.buffers, "path.tip": { type: "f32", offset: 0, count: 3 * 2 ** 42 } } };
  await assert.rejects(readSceneText(JSON.stringify(much), block.toString("base64")), /path\.tip ends at byte 52776558133248/);
});

test("lines of a program", () => {
  const encode = (text) => new ProgramText(new TextEncoder().encode(text));
  assert.equal(encode("").lines, 0);
  assert.equal(encode("a\nb\n").lines, 2);
  assert.equal(encode("a\nb").lines, 2);
  assert.equal(encode("\n".repeat(5000)).lines, 5000);
  const text = encode("G0 X1\r\n\n(\u00fc <b>)");
  assert.deepEqual([0, 1, 2, 3, 4].map((n) => text.line(n)), ["", "G0 X1", "", "(\u00fc <b>)", ""]);
  assert.equal(encode("x".repeat(5000)).line(1).length, 401);
  // Lines 2 and 3 have moves 0 and 1, 2; line 4 has none, and line 5 has move 3.
  assert.deepEqual([...firstMoves(Uint32Array.of(2, 3, 3, 5), 6)], [0, 0, 0, 1, 3, 3, 3]);
});
