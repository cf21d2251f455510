// Edits made in a page, and the same edits read by imgmesh-warp.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import test from "node:test";
import { startEngine } from "./support/engine.mjs";
import { readExr } from "./support/exr.mjs";
import { temporaryFolder, tool } from "./support/native.mjs";
import { landscape, ring } from "./support/pictures.mjs";
import { decodePng, encodePng } from "./support/png.mjs";

const engine = await startEngine();
const kFolder = temporaryFolder();

const kBuild = { "level-faces": [160, 60, 20] };
function built(pixels) {
  return engine.build(pixels, kBuild, {}, null);
}

// Direct, ARAP with pins and a turn, several levels; and edits of one vertex that add up.
const kEdits = {
  edits: [
    { level: 2, solver: "arap", handles: [{ near: [30, 30], move: [6, -3.5] }], pins: [{ border: true }] },
    { level: 1, handles: [{ circle: [50, 40, 14], scale: 1.25, rotate: 12.5 }] },
    { level: 1, solver: "injective", handles: [{ near: [60, 30], move: [-9, 4] }], pins: [{ beyond: [55, 35, 30] }] },
    { level: 0, solver: "arap", handles: [{ near: [20, 40], move: [1.5, 2] }, { box: [50, 5, 70, 16], rotate: -20 }], pins: [{ border: true }] },
  ],
};

function sameBits(found, expected, what) {
  const bits = (values) => Buffer.from(values.buffer, values.byteOffset, values.byteLength);
  assert.ok(bits(found).equals(bits(expected)), `${what}: values differ`);
}

function everyNth(values, n, first) {
  return values.filter((_, i) => i % n === first);
}

for (const [name, pixels] of [["landscape", landscape()], ["ring", ring()]])
  test(`${name}: imgmesh-warp makes the same image and the same maps of the page's edits`, () => {
    const file = (suffix) => path.join(kFolder, name + suffix);
    fs.writeFileSync(file(".png"), encodePng(pixels));
    fs.writeFileSync(file(".edits.json"), JSON.stringify(kEdits));
    tool("imgmesh-build", file(".png"), "-o", file(".glb"), "--level-faces", "160,60,20");
    tool("imgmesh-warp", file(".glb"), "--image", file(".png"), "--edits", file(".edits.json"), "-o", file(".out.png"), "--displacement", file(".exr"));

    const mesh = built(pixels);
    const session = engine.warpSession(mesh);
    session.solve(JSON.stringify(kEdits), false);
    const expected = decodePng(fs.readFileSync(file(".out.png")));
    const picture = session.picture(pixels, 0, 0);
    assert.deepEqual([picture.width, picture.height], [expected.width, expected.height]);
    sameBits(new Uint8Array(picture.data), expected.data, "image");

    const [stmap, forward] = readExr(fs.readFileSync(file(".exr")));
    const move = session.displacement();
    sameBits(everyNth(move.data, 2, 0), forward.channels["displacement.x"], "displacement.x");
    sameBits(everyNth(move.data, 2, 1), forward.channels["displacement.y"], "displacement.y");
    const map = session.stMap(pixels);
    map.channels.forEach((channel, c) => sameBits(everyNth(map.data, 3, c), stmap.channels[channel], channel));
    session.delete();
    mesh.delete();
  });

test("without edits the image comes back, and no vertex moves", () => {
  const pixels = landscape();
  const mesh = built(pixels), session = engine.warpSession(mesh);
  sameBits(session.picture(pixels, 0, 0).data, pixels.data, "image");
  session.solve('{"edits": []}', false);
  sameBits(session.picture(pixels, 0, 0).data, pixels.data, "image");
  assert.equal(session.moves(0).length, 0);
  sameBits(session.places(1), mesh.positions(1), "places");
  session.delete();
  mesh.delete();
});

test("a vertex moves by its own level and by what another level does at its place", () => {
  const mesh = built(landscape()), session = engine.warpSession(mesh);
  // All of level 2 moves alike, so level 0 does too, beside its own edit.
  session.solve(JSON.stringify({ edits: [
    { level: 2, handles: [{ beyond: [-1000, -1000, 0], move: [4, 1] }] },
    { level: 0, handles: [{ vertex: 3, move: [0.5, -2] }] },
  ] }), false);
  const rest = mesh.positions(0), places = session.places(0);
  for (let v = 0; v < rest.length / 2; ++v) {
    const own = v === 3 ? [0.5, -2] : [0, 0];
    assert.ok(Math.abs(places[2 * v] - rest[2 * v] - 4 - own[0]) < 1e-4, `vertex ${v}`);
    assert.ok(Math.abs(places[2 * v + 1] - rest[2 * v + 1] - 1 - own[1]) < 1e-4, `vertex ${v}`);
  }
  session.delete();
  mesh.delete();
});

test("folds are listed where they are, and such a mesh is not made", () => {
  const pixels = landscape();
  const mesh = built(pixels), session = engine.warpSession(mesh);
  session.solve('{"edits": [{"handles": [{"near": [48, 36], "move": [1, 0.5]}]}]}', false);
  assert.equal(session.turnedFaces(0).length, 0);
  assert.equal(session.warpedMesh().facts().levels[0].vertices, mesh.facts().levels[0].vertices);
  // The vertex nearest to the middle goes beyond all its neighbours.
  session.solve('{"edits": [{"handles": [{"near": [48, 36], "move": [60, 0]}]}]}', false);
  const turned = session.turnedFaces(0);
  const faces = mesh.faces(0), rest = mesh.positions(0);
  const nearest = [...Array(rest.length / 2).keys()].reduce((a, b) =>
    Math.hypot(rest[2 * b] - 48, rest[2 * b + 1] - 36) < Math.hypot(rest[2 * a] - 48, rest[2 * a + 1] - 36) ? b : a);
  assert.ok(turned.length > 0);
  for (const face of turned) assert.ok(faces.subarray(3 * face, 3 * face + 3).includes(nearest), `face ${face}`);
  assert.ok(session.foldedPixels().length > 0);
  assert.throws(() => session.warpedMesh(), (e) => e.name === "ImgmeshError" && e.kind === "unsupported" && /would turn over/.test(e.message));
  session.delete();
  mesh.delete();
});

test("mistakes in edits are one line, and leave the moves as they are", () => {
  const mesh = built(landscape()), session = engine.warpSession(mesh);
  session.solve('{"edits": [{"handles": [{"vertex": 2, "move": [1, 0]}]}]}', false);
  const refused = (edits, text) =>
    assert.throws(() => session.solve(edits, false), (e) => e.name === "ImgmeshError" && e.kind === "file" && text.test(e.message));
  refused('{"edits": [{"handles": [{"vertex": 9999, "move": [1, 0]}]}]}', /\/edits\/0\/handles\/0\/vertex: vertex 9999 is not there/);
  refused('{"edits": [', /no JSON/);
  refused('{"edits": [{"level": 9, "handles": []}]}', /level 9 is not there/);
  assert.equal(session.moves(0)[4], 1);
  assert.throws(() => session.picture(landscape(10, 10), 0, 0), (e) => e.kind === "file" && /10x10/.test(e.message));
  session.delete();
  mesh.delete();
});
