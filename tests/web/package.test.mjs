// The package imgmesh.wasm in Node: `node web/build.mjs package`, then `node --test tests/web`.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { pixelsOf } from "./support/pictures.mjs";

const folder = new URL("../../web/package/", import.meta.url);
const { isImgmeshError, loadImgmesh } = await import(new URL("dist/node.js", folder));
const imgmesh = await loadImgmesh();

const disc = pixelsOf(64, 48, (x, y) => (Math.hypot(x - 32, y - 24) < 15 ? [230, 120, 40] : [2 * x, 4 * y, 160]));

function withMesh(pixels, parameters, options, use) {
  const mesh = imgmesh.build(pixels, parameters, options);
  try {
    return use(mesh);
  } finally {
    mesh.free();
  }
}

/** What must hold of every mesh. */
function checkSound(mesh, pixels) {
  const facts = mesh.facts(), { vertices, faces } = facts.levels[0];
  assert.deepEqual([facts.width, facts.height], [pixels.width, pixels.height]);
  assert.equal(mesh.positions().length, 2 * vertices);
  assert.equal(mesh.faces().length, 3 * faces);
  assert.equal(mesh.edges().length % 2, 0);
  assert.ok(mesh.faces().every((v) => v < vertices));
  assert.ok(mesh.faceIds().every((f) => f < faces || f === 0xffffffff));
  assert.equal(mesh.faceIds().length, pixels.width * pixels.height);
  assert.equal(mesh.barycentrics().length, 2 * pixels.width * pixels.height);
  const quality = mesh.quality();
  assert.equal(quality.flippedFaces, 0);
  assert.equal(quality.flippedPixelTriangles, 0);
}

test("a mesh has the vertices that were asked for, and gives the image back", () => {
  withMesh(disc, { vertices: 200 }, {}, (mesh) => {
    checkSound(mesh, disc);
    assert.equal(mesh.facts().levels[0].vertices, 200);
    const again = mesh.draw();
    assert.deepEqual([again.width, again.height, again.data.length], [64, 48, disc.data.length]);
    assert.ok(mesh.compare(disc).psnr > 30);
    assert.equal(mesh.facts().hasColor, true);
    assert.equal(mesh.facts().alphaFeature, -1);
  });
});

test("the same pixels make the same mesh in every instance", async () => {
  const other = await loadImgmesh();
  const a = imgmesh.build(disc, { vertices: 100 }), b = other.build(disc, { vertices: 100 });
  assert.deepEqual(a.positions(), b.positions());
  assert.deepEqual(a.barycentrics(), b.barycentrics());
  a.free();
  b.free();
});

test("images of one pixel and of one row or column are meshed", () => {
  for (const [width, height] of [[1, 1], [1, 9], [9, 1], [2, 2], [1, 200]]) {
    const pixels = pixelsOf(width, height, (x, y) => [20 * x, 20 * y, 100]);
    withMesh(pixels, {}, {}, (mesh) => checkSound(mesh, pixels));
  }
});

test("a grey image stays grey", () => {
  const grey = pixelsOf(40, 30, (x, y) => Array(3).fill(3 * x + 4 * y));
  withMesh(grey, { vertices: 60 }, {}, (mesh) => {
    checkSound(mesh, grey);
    const { data } = mesh.draw();
    for (let i = 0; i < data.length; i += 4)
      assert.ok(Math.abs(data[i] - data[i + 1]) <= 1 && Math.abs(data[i] - data[i + 2]) <= 1);
  });
});

test("alpha that is 0 or 255 cuts out; soft alpha is kept as a channel", () => {
  const hard = pixelsOf(40, 30, (x, y) => [6 * x, 8 * y, 90, Math.hypot(x - 20, y - 15) < 12 ? 255 : 0]);
  withMesh(hard, { vertices: 80 }, {}, (mesh) => {
    checkSound(mesh, hard);
    assert.equal(mesh.facts().hasMask, true);
    assert.equal(mesh.faceIds()[0], 0xffffffff);
    assert.equal(mesh.draw().data[3], 0);
  });
  const soft = pixelsOf(40, 30, (x, y) => [6 * x, 8 * y, 90, 6 * x]);
  withMesh(soft, { vertices: 80 }, {}, (mesh) => assert.equal(mesh.facts().alphaFeature, 3));
  withMesh(soft, { vertices: 80 }, { alpha: "ignore" }, (mesh) => {
    assert.equal(mesh.facts().alphaFeature, -1);
    assert.equal(mesh.facts().hasMask, false);
  });
});

test("levels are coarser one after another, and each can be drawn", () => {
  withMesh(disc, { vertices: 200, levels: 3 }, {}, (mesh) => {
    const { levels } = mesh.facts();
    assert.equal(levels.length, 3);
    assert.ok(levels[0].faces > levels[1].faces && levels[1].faces > levels[2].faces);
    for (let level = 0; level < 3; ++level)
      for (const mode of ["map", "gouraud", "flat", "patches", "wire"]) assert.equal(mesh.draw(mode, level).width, 64);
    assert.equal(mesh.draw("flat", 0, 2).width, 128);
    assert.match(mesh.svg("flat", 1), /^<\?xml|^<svg/);
  });
});

test("progress rises to 1", () => {
  const seen = [];
  withMesh(disc, {}, { onProgress: (fraction, stage) => seen.push([fraction, stage]) }, () => {});
  assert.ok(seen.length > 2);
  for (let i = 1; i < seen.length; ++i) assert.ok(seen[i][0] >= seen[i - 1][0]);
  assert.equal(seen.at(-1)[0], 1);
});

test("what is wrong is one line with a kind", () => {
  const wrong = [
    [disc, { foo: 1 }, {}, /no parameter 'foo'/],
    [disc, { vertices: 3 }, {}, /vertices is 3/],
    [disc, { vertices: "many" }, {}, /vertices: expected a number/],
    [disc, { preset: "none" }, {}, /preset 'none'/],
    [disc, { vertices: 50, density: 1 }, {}, /expected one of them/],
    [disc, {}, { alpha: "perhaps" }, /alpha: expected one of/],
    [{ width: 3, height: 3, data: new Uint8Array(4) }, {}, {}, /data: expected 36 values/],
    [{ width: 0, height: 3, data: new Uint8Array(0) }, {}, {}, /width: expected a whole number/],
  ];
  for (const [pixels, parameters, options, text] of wrong)
    assert.throws(() => imgmesh.build(pixels, parameters, options), (error) => {
      assert.ok(isImgmeshError(error));
      assert.equal(error.kind, "argument");
      assert.match(error.message, text);
      assert.doesNotMatch(error.message, /\n/);
      return true;
    });
  const invisible = pixelsOf(8, 8, () => [1, 2, 3, 0]);
  assert.throws(() => imgmesh.build(invisible, {}, { alpha: "cut" }), isImgmeshError);
  // The engine is still sound.
  withMesh(disc, { vertices: 50 }, {}, (mesh) => {
    assert.throws(() => mesh.positions(1), isImgmeshError);
    assert.throws(() => mesh.draw("map", 0, 2), isImgmeshError);
    checkSound(mesh, disc);
  });
});

test("what a callback throws comes through unchanged", () => {
  const stop = new Error("stop");
  const onProgress = () => {
    throw stop;
  };
  assert.throws(() => imgmesh.build(disc, {}, { onProgress }), (error) => error === stop);
});

test("parameters are those of the builds", () => {
  const names = imgmesh.parameters().map(({ name }) => name);
  for (const name of ["vertices", "shape-weight", "map-smoothness", "levels"]) assert.ok(names.includes(name));
});

test("the package has the version of the engine", async () => {
  const { version } = JSON.parse(await readFile(new URL("package.json", folder), "utf8"));
  assert.equal(version, imgmesh.version);
});

test("an engine may be given as bytes or compiled", async () => {
  const bytes = await readFile(new URL("dist/engine.wasm", folder));
  assert.equal((await loadImgmesh(bytes)).version, imgmesh.version);
  assert.equal((await loadImgmesh(await WebAssembly.compile(bytes))).version, imgmesh.version);
  await assert.rejects(loadImgmesh(new Uint8Array([1, 2, 3])));
});

test("the example runs, and the package can be packed", () => {
  const run = (program, ...args) => execFileSync(program, args, { cwd: fileURLToPath(folder), encoding: "utf8" });
  assert.match(run(process.execPath, "example.mjs"), /400 vertices.*\nPSNR .* 0 folds\n/);
  const [{ files }] = JSON.parse(run("npm", "pack", "--dry-run", "--json"));
  const names = files.map(({ path }) => path);
  for (const name of ["dist/index.js", "dist/index.d.ts", "dist/node.js", "dist/engine.mjs", "dist/engine.wasm", "README.md", "LICENSE"])
    assert.ok(names.includes(name), name);
});
