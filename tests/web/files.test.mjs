// Containers and exports of the package in Node, against those of the programs: `node web/build.mjs package`, then
// `IMGMESH_BIN=build/dev/bin node --test tests/web`. Without the programs, what needs them is skipped.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { fileURLToPath } from "node:url";
import { pixelsOf } from "./support/pictures.mjs";

const root = fileURLToPath(new URL("../../", import.meta.url));
const { loadDraco, loadImgmesh, needsDraco } = await import(new URL("../../web/package/dist/node.js", import.meta.url));
const imgmesh = await loadImgmesh();

const bin = process.env.IMGMESH_BIN ?? join(root, "build/dev/bin");
const skip = existsSync(join(bin, "imgmesh-build")) ? false : `${bin} has no programs`;
const folder = mkdtempSync(join(tmpdir(), "imgmesh-web-"));
after(() => rmSync(folder, { recursive: true, force: true }));

const tool = (name, ...options) =>
  execFileSync(join(bin, `imgmesh-${name}`), ["--quiet", ...options], { cwd: folder, encoding: "utf8" });
const read = (name) => readFileSync(join(folder, name));
const write = (files) => files.forEach(({ name, bytes }) => writeFileSync(join(folder, name), bytes));
const named = (...names) => names.map((name) => ({ name, bytes: new Uint8Array(read(name)) }));

const disc = (x, y) => Math.hypot(x - 32, y - 24) < 15;
const images = {
  disc: pixelsOf(64, 48, (x, y) => (disc(x, y) ? [230, 120, 40] : [3 * x, 4 * y, 160])),
  cut: pixelsOf(64, 48, (x, y) => [3 * x, 250 - 4 * y, 99, disc(x, y) ? 255 : 0]),
  soft: pixelsOf(64, 48, (x, y) => [3 * x, 250 - 4 * y, 99, disc(x, y) ? 255 : 3 * x]),
  dot: pixelsOf(1, 1, () => [10, 200, 30]),
  row: pixelsOf(37, 1, (x) => [x, 5 * x, 90]),
};
for (const [name, pixels] of Object.entries(images)) write([{ name: `${name}.png`, bytes: imgmesh.encodePng(pixels) }]);

// What the programs read of a container, to the bit: meshes, maps and features.
function arraysOf(name, level = 0) {
  rmSync(join(folder, "arrays.npz"), { force: true });
  tool("convert", name, "--level", String(level), "-o", "arrays.npz");
  return read("arrays.npz");
}

function using(mesh, use) {
  try {
    return use(mesh);
  } finally {
    mesh.free();
  }
}

function checkEqual(mesh, other) {
  for (let k = 0; k < mesh.facts().levels.length; ++k)
    for (const array of ["positions", "faces", "features", "faceIds", "barycentrics"])
      assert.deepEqual(Buffer.from(mesh[array](k).buffer), Buffer.from(other[array](k).buffer), `${array} ${k}`);
}

test("without Draco, open() and save() say what to wait for", () => {
  using(imgmesh.build(images.disc), (mesh) => {
    assert.throws(() => mesh.save({ name: "a.glb" }), { kind: "argument", message: /loadDraco/ });
    const files = mesh.save({ name: "a.glb", draco: "none" });
    assert.equal(needsDraco(files), false);
    using(imgmesh.open(files), (again) => assert.equal(again.facts().width, 64));
  });
});

test("a saved container is the mesh, in every layout and coding", async () => {
  await loadDraco();
  for (const [name, pixels] of Object.entries(images))
    using(imgmesh.build(pixels, { levels: name === "disc" ? 2 : 1 }), (mesh) => {
      for (const layers of ["exr", "compact"])
        for (const draco of ["none", "sequential", "edgebreaker"]) {
          const files = mesh.save({ name: `${name}.gltf`, layers, draco });
          assert.deepEqual(files.map((f) => f.name), [`${name}.gltf`, `${name}.bin`, `${name}.${layers === "exr" ? "exr" : "imgmap"}`]);
          assert.equal(needsDraco(files), draco !== "none");
          using(imgmesh.open(files.reverse()), (again) => {
            if (draco !== "edgebreaker") checkEqual(mesh, again);
            assert.deepEqual(again.draw().data, mesh.draw().data);
            assert.deepEqual(again.facts().parameters, mesh.facts().parameters);
            // As it was opened, so it is saved; Draco's own order is reordered every time.
            if (draco !== "edgebreaker")
              assert.deepEqual(again.save({ name: "x.glb" }), mesh.save({ name: "x.glb", layers, draco }));
          });
        }
    });
});

test("page and programs make the same mesh and map of the same pixels", { skip }, () => {
  for (const [name, pixels] of Object.entries(images)) {
    const levels = name === "disc" ? 3 : 1;
    tool("build", `${name}.png`, "--levels", String(levels), "-o", `${name}-tool.glb`);
    using(imgmesh.build(pixels, { levels }), (mesh) => {
      for (const layers of ["exr", "compact"]) {
        write(mesh.save({ name: `${name}-page.glb`, layers }));
        tool("info", "--validate", `${name}-page.glb`);
        for (let k = 0; k < levels; ++k)
          assert.deepEqual(arraysOf(`${name}-page.glb`, k), arraysOf(`${name}-tool.glb`, k), `${name} ${layers} ${k}`);
      }
    });
  }
});

test("containers of the programs open, in either layout and with files beside them", { skip }, () => {
  for (const layers of ["exr", "compact"])
    for (const variant of ["glb", "gltf"]) {
      tool("build", "soft.png", "--levels", "2", "--layers", layers, "-o", `opened.${variant}`);
      const companions = readdirSync(folder).filter((n) => n.startsWith("opened") && !/gl(b|tf)$/.test(n));
      const files = named(`opened.${variant}`, ...(variant === "glb" ? [] : companions));
      assert.ok(needsDraco(files));
      using(imgmesh.open(files), (mesh) => {
        assert.equal(mesh.facts().levels.length, 2);
        write(mesh.save({ name: "again.glb", draco: "sequential" })); // which keeps the order
        for (const k of [0, 1]) assert.deepEqual(arraysOf("again.glb", k), arraysOf(`opened.${variant}`, k));
      });
      for (const name of companions) rmSync(join(folder, name));
    }
});

test("a tracked map and a texture are kept", { skip }, () => {
  tool("build", "disc.png", "--map", "tracked", "--visits", "--texture", "-o", "texture.glb");
  using(imgmesh.open(named("texture.glb")), (mesh) => {
    write(mesh.save({ name: "texture-again.glb", draco: "sequential" }));
    tool("info", "--validate", "texture-again.glb");
    assert.deepEqual(arraysOf("texture-again.glb"), arraysOf("texture.glb"));
    const texture = mesh.exportTextured("t").at(-1).bytes;
    using(imgmesh.open(named("texture-again.glb")), (again) =>
      assert.deepEqual(again.exportTextured("t").at(-1).bytes, texture));
  });
});

test("exports are the programs' bytes", { skip }, () => {
  for (const name of ["disc", "cut", "dot", "row"]) {
    tool("build", `${name}.png`, "-o", `${name}.glb`);
    using(imgmesh.open(named(`${name}.glb`)), (mesh) => {
      const check = (file, text, ...options) => {
        tool("convert", `${name}.glb`, "-o", file, ...options);
        assert.equal(text, read(file).toString(), `${name} ${file}`);
      };
      check("x.svg", mesh.svg("flat"));
      check("y.svg", mesh.svg("gradient"), "--shading", "gradient");
      for (const format of ["ply", "obj", "json"]) check(`x.${format}`, mesh.exportText(format, 0, "x.png"));
      tool("reconstruct", `${name}.glb`, "--mode", "wire", "-o", "w.svg");
      assert.equal(mesh.svg("wire"), read("w.svg").toString());
      tool("convert", `${name}.glb`, "--image", `${name}.png`, "-o", "t.obj");
      const files = mesh.exportTextured("t", 0, new Uint8Array(read("t-texture.png")));
      for (const file of files) assert.deepEqual(Buffer.from(file.bytes), read(file.name), file.name);
    });
  }
});

test("assets for engines are the programs' meshes", { skip }, () => {
  for (const [name, pixels] of Object.entries(images)) {
    tool("build", `${name}.png`, "--draco", "none", "-o", "with-map.glb");
    tool("convert", "with-map.glb", "--no-map", "-o", "plain-tool.glb");
    tool("build", `${name}.png`, "--texture", "--draco", "none", "-o", "texture-tool.glb");
    using(imgmesh.build(pixels), (mesh) => {
      assert.deepEqual(Buffer.from(mesh.save({ name: "p.glb", layers: "none" })[0].bytes), read("plain-tool.glb"));
      using(imgmesh.open(named("texture-tool.glb")), (opened) => {
        const texture = opened.exportTextured("t").at(-1).bytes;
        write(mesh.save({ name: "texture-page.glb", texture, draco: "none" }));
      });
      tool("info", "--validate", "texture-page.glb");
      assert.deepEqual(arraysOf("texture-page.glb"), arraysOf("texture-tool.glb"));
    });
  }
});

test("labels are written as images and arrays", { skip }, () => {
  const labels = Uint32Array.from({ length: 40 * 33 }, (_, i) => (i % 7 === 0 ? 0xffffffff : i % 1000));
  for (const extension of ["png", "tif", "npy", "mat", "exr"])
    write([{ name: `labels.${extension}`, bytes: imgmesh.exportLabels(`labels.${extension}`, 40, 33, labels) }]);
  const npy = read("labels.npy");
  assert.deepEqual(npy.subarray(-4 * labels.length), Buffer.from(labels.buffer));
  if (!skip) {
    // The programs read floats, which do not hold the number for none.
    const numbers = labels.map((label) => (label === 0xffffffff ? 5000 : label));
    write([{ name: "labels.exr", bytes: imgmesh.exportLabels("labels.exr", 40, 33, numbers) }]);
    for (const extension of ["png", "tif", "exr"]) tool("build", `labels.${extension}`, "--values", "-o", "labels.glb");
  }
  assert.throws(() => imgmesh.exportLabels("x.png", 1, 1, Uint32Array.of(70000)), { kind: "argument" });
  assert.throws(() => imgmesh.exportLabels("x.gif", 1, 1, Uint32Array.of(1)), { kind: "argument" });
});

test("what is no container is refused in one line", async () => {
  await loadDraco();
  const good = using(imgmesh.build(images.disc), (mesh) => mesh.save({ name: "good.glb" })[0].bytes);
  const refused = (files, kind, message) => assert.throws(() => imgmesh.open(files), (error) => {
    assert.equal(error.name, "ImgmeshError");
    assert.equal(error.kind, kind, error.message);
    assert.match(error.message, message);
    assert.ok(!error.message.includes("\n"));
    return true;
  });
  refused([], "argument", /\.glb or \.gltf/);
  refused([{ name: "../x.glb", bytes: good }], "argument", /without its folder/);
  refused([{ name: "a.glb", bytes: good }, { name: "b.glb", bytes: good }], "argument", /one container/);
  refused([{ name: "x.glb", bytes: new Uint8Array() }], "file", /^x\.glb/);
  refused([{ name: "x.glb", bytes: good.subarray(0, good.length / 2) }], "file", /^x\.glb/);
  refused([{ name: "x.gltf", bytes: new TextEncoder().encode("{}") }], "file", /^x\.gltf/);
  using(imgmesh.build(images.disc), (mesh) => {
    const files = mesh.save({ name: "x.gltf" });
    refused(files.slice(0, 2), "io", /x\.exr/);
    assert.throws(() => mesh.save({ name: "x.png" }), { kind: "argument" });
    assert.throws(() => mesh.save({ name: "x.glb", layers: "zip" }), { kind: "argument", message: /compact, exr, none/ });
    assert.throws(() => mesh.save({ name: "x.glb", layers: "compact", texture: good }), { kind: "argument" });
  });
  // Changed bytes: refused, or another mesh; never an error of the engine itself.
  let seed = 7;
  const random = (n) => (seed = (seed * 48271) % 2147483647) % n;
  for (let i = 0; i < 300; ++i) {
    const bytes = good.slice();
    for (let k = 0; k <= random(3); ++k) bytes[random(bytes.length)] ^= 1 << random(8);
    await loadDraco();
    try {
      imgmesh.open([{ name: "x.glb", bytes }]).free();
    } catch (error) {
      assert.ok(["file", "unsupported"].includes(error.kind), `${error.kind}: ${error.message}`);
    }
  }
});
