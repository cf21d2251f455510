// Regions in Node, and those of imgmesh-segment from the same pixels.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { temporaryFolder, tool } from "./support/native.mjs";
import { landscape, ring } from "./support/pictures.mjs";
import { decodePng, encodePng } from "./support/png.mjs";

const { Regions, loadImgmesh } = await import(new URL("../../web/package/dist/node.js", import.meta.url));
const imgmesh = await loadImgmesh();
const kOutside = 0xffffffff;

/** The labels of an .npy as the tools write it. */
function readNpy(file) {
  const bytes = fs.readFileSync(file), start = 10 + bytes.readUInt16LE(8);
  return new Uint32Array(bytes.buffer.slice(bytes.byteOffset + start, bytes.byteOffset + bytes.length));
}

function segmented(pixels, options, use, build = { density: 12 }) {
  const mesh = imgmesh.build(pixels, build), segmentation = imgmesh.segment(mesh, pixels, options);
  try {
    return use(segmentation, mesh);
  } finally {
    segmentation.free();
    mesh.free();
  }
}

/** Six stripes, each cut from the next by a stronger contrast, on a map of one pixel a cell. */
function stripes() {
  const data = { width: 6, height: 2, count: 6, forced: 0, cells: Uint32Array.from([0, 1, 2, 3, 4, 5, 0, 1, 2, 3, 4, 5]) };
  return {
    ...data,
    merges: Uint32Array.from([0, 1, 2, 3, 4, 5, 2, 4, 0, 2]),
    heights: Float32Array.from([1, 2, 3, 5, 8]),
    borders: Uint32Array.from([0, 1, 2, 1, 1, 2, 2, 5, 2, 3, 2, 2, 3, 4, 2, 4, 4, 5, 2, 3]),
    sums: Float64Array.from([2, 0, 0, 0, 2, 20, 0, 0, 2, 40, 0, 0, 2, 60, 0, 0, 2, 80, 0, 0, 2, 100, 0, 0]),
  };
}

test("a threshold and a number cut the hierarchy where they say", () => {
  const regions = new Regions(stripes());
  assert.deepEqual([...regions.table], [0, 1, 2, 3, 4, 5]);
  assert.deepEqual([0.5, 1, 1.5, 3, 99].map((t) => regions.mergesBelow(t)), [0, 0, 1, 2, 5]); // below, not up to
  assert.deepEqual([1, 2, 6, 99].map((n) => regions.mergesFor(n)), [5, 4, 0, 0]);
  regions.cut(regions.mergesFor(3));
  assert.deepEqual([...regions.table], [0, 0, 1, 1, 2, 2]);
  assert.equal(regions.height, 3);
  assert.deepEqual([...regions.means()], [4, 5, 0, 0, 4, 25, 0, 0, 4, 45, 0, 0]);
  assert.equal(regions.regionAt(3, 1), 1);
  assert.equal(regions.regionAt(6, 1), null);
});

test("regions are joined and split, keep their outlines under another cut, and come back by undo", () => {
  const regions = new Regions(stripes(), 3);
  assert.equal(regions.mostAlike(0), 1);
  assert.equal(regions.mostAlike(1), 2); // 4 merges make them one, with region 0 only 5
  assert.equal(regions.join([0, 2]), 0); // they do not touch
  assert.equal(regions.canUndo, false);
  assert.equal(regions.join([0, 1]), 1);
  assert.deepEqual([...regions.table], [0, 0, 0, 0, 1, 1]);
  regions.cut(0);
  assert.deepEqual([...regions.table], [0, 0, 0, 0, 1, 2]);
  assert.equal(regions.split(0), true); // between cells 1 and 2, which the hierarchy joins last
  assert.deepEqual([...regions.table], [0, 0, 1, 1, 2, 3]);
  regions.cut(5);
  assert.deepEqual([...regions.table], [0, 0, 1, 1, 2, 2]);
  for (const table of [[0, 0, 1, 1, 2, 3], [0, 0, 0, 0, 1, 2], [0, 0, 0, 0, 1, 1], [0, 0, 1, 1, 2, 2]]) {
    assert.equal(regions.undo(), true);
    assert.deepEqual([...regions.table], table);
  }
  assert.equal(regions.undo(), false);
  assert.equal(regions.redo(), true);
  assert.deepEqual([...regions.table], [0, 0, 0, 0, 1, 1]);
  regions.reset();
  assert.deepEqual([...regions.table], [0, 0, 1, 1, 2, 2]);
  assert.equal(regions.canRedo, false);
  regions.cut(0);
  assert.equal(regions.split(3), false); // one cell
});

test("a number of regions counts those that the user made", () => {
  const regions = new Regions(stripes(), 3);
  regions.join([0, 1]);
  for (const count of [2, 3]) {
    regions.cut(regions.mergesFor(count));
    assert.equal(regions.count, count);
  }
});

test("what the user takes out of the middle leaves two regions", () => {
  const regions = new Regions(stripes());
  regions.join([2, 3]);
  regions.cut(5);
  assert.deepEqual([...regions.table], [0, 0, 1, 1, 2, 2]);
});

test("a cut on its way is no step", () => {
  const regions = new Regions(stripes());
  for (const merges of [1, 2, 3]) regions.cut(merges, false);
  assert.equal(regions.canUndo, false);
  regions.cut(3);
  regions.undo();
  assert.equal(regions.merges, 0);
});

test("every region is connected, whatever is joined, split and cut", () => {
  segmented(landscape(), { quality: "fast" }, (segmentation) => {
    const regions = segmentation.regions();
    let seed = 7;
    const random = (n) => (seed = (seed * 48271) % 0x7fffffff) % n;
    for (let k = 0; k < 60; ++k) {
      if (k % 3 === 0) regions.join([random(regions.count), random(regions.count), regions.mostAlike(0) ?? 0]);
      else if (k % 3 === 1) regions.split(random(regions.count));
      else regions.cut(random(regions.data.heights.length));
      const { borders } = regions.data, parts = new Set(regions.table.keys()), root = [...regions.table.keys()];
      const find = (c) => (root[c] === c ? c : (root[c] = find(root[c])));
      for (let e = 0; e < borders.length; e += 4) {
        const a = find(borders[e]), b = find(borders[e + 1]);
        if (a === b || regions.table[borders[e]] !== regions.table[borders[e + 1]]) continue;
        root[b] = a;
        parts.delete(b);
      }
      assert.equal(parts.size, regions.count);
    }
    while (regions.undo());
    assert.deepEqual(regions.table, segmentation.regions().table);
  });
});

test("facts, drawings, shapes and the mesh's pieces belong to the same regions", () => {
  const pixels = ring();
  segmented(pixels, {}, (segmentation, mesh) => {
    const regions = segmentation.regions(), labels = regions.labels();
    regions.cut(regions.mergesFor(4));
    const facts = segmentation.regionFacts(regions.table), counts = Array(regions.count).fill(0);
    for (const label of regions.labels()) if (label !== kOutside) ++counts[label];
    assert.deepEqual(facts.map((f) => f.pixels), counts);
    const means = regions.means();
    facts.forEach((f, r) => f.luv.forEach((c, k) => assert.ok(Math.abs(c - means[4 * r + k + 1]) < 1e-3)));
    for (const what of ["outlines", "flat", "colors"]) {
      const drawing = segmentation.draw(what, regions.table);
      assert.deepEqual([drawing.width, drawing.height], [pixels.width, pixels.height]);
      labels.forEach((label, i) => assert.equal(drawing.data[4 * i + 3], label === kOutside ? 0 : 255));
    }
    assert.equal(segmentation.svg(regions.table).match(/id="region-/g).length, regions.count);
    const faces = segmentation.faceRegions(regions.table);
    assert.equal(faces.length, mesh.facts().levels[0].faces);
    assert.ok(faces.every((r) => r < regions.count || r === kOutside));
    const contours = segmentation.contours();
    assert.deepEqual([contours.width, contours.height], [2 * pixels.width + 1, 2 * pixels.height + 1]);
  });
});

test("images of one pixel, one row and one colour have their regions", () => {
  for (const [width, height] of [[1, 1], [1, 9], [9, 1], [20, 20]]) {
    const pixels = { width, height, data: new Uint8ClampedArray(4 * width * height).fill(255) };
    for (const options of [{}, { quality: "fast" }, { superpixels: 3 }])
      segmented(pixels, options, (segmentation) => {
        const regions = segmentation.regions();
        assert.ok(regions.count >= 1);
        assert.equal(segmentation.draw("colors", regions.table).data.length, 4 * width * height);
      }, {});
  }
});

test("wrong options and tables are refused in a line", () => {
  const refused = (work, text) => assert.throws(work, (e) => e.name === "ImgmeshError" && e.kind === "argument" && text.test(e.message));
  const pixels = landscape(24, 20), mesh = imgmesh.build(pixels);
  refused(() => imgmesh.segment(mesh, pixels, { quality: "best" }), /quality: expected default or fast/);
  refused(() => imgmesh.segment(mesh, pixels, { superpixels: 0 }), /superpixels: expected a whole number from 1/);
  refused(() => imgmesh.segment(mesh, pixels, { level: 3 }), /level/);
  refused(() => imgmesh.segment(mesh, landscape(20, 20)), /20x20/);
  const segmentation = imgmesh.segment(mesh, pixels);
  refused(() => segmentation.svg(new Uint32Array(1)), /expected \d+/);
  refused(() => segmentation.svg(new Uint32Array(segmentation.facts().cells).fill(7)), /numbered/);
  refused(() => segmentation.mask(segmentation.regions().table, [], []), /./);
  segmentation.free();
  mesh.free();
});

test("labels, shapes, drawings and masks are those of imgmesh-segment, to the bit", () => {
  const folder = temporaryFolder(), file = (name) => path.join(folder, name);
  for (const [name, pixels] of Object.entries({ landscape: landscape(), ring: ring() })) {
    const flat = name === "landscape" ? pixels : { ...pixels, data: pixels.data.map((v, i) => (i % 4 === 3 ? (v > 127 ? 255 : 0) : v)) };
    fs.writeFileSync(file("in.png"), encodePng(flat));
    // Draco would round the vertices, which the mesh in pieces shows.
    tool("imgmesh-build", "--quiet", file("in.png"), "-o", file("in.glb"), "--density", "12", "--overwrite", "--draco", "none");
    for (const [options, native] of [
      [{}, []],
      [{ quality: "fast" }, ["--quality", "fast"]],
      [{ superpixels: 20 }, ["--superpixels", "20"]],
      [{ distance: "paper", minSize: 30 }, ["--distance", "paper", "--min-size", "30"]],
    ])
      segmented(flat, options, (segmentation) => {
        const regions = segmentation.regions();
        const counts = options.superpixels ? [null] : [null, 5];
        for (const count of counts) {
          if (count) regions.cut(regions.mergesFor(count));
          tool("imgmesh-segment", "--quiet", "--overwrite", file("in.glb"), "--image", file("in.png"), "-o", file("l.npy"), ...native,
            ...(count ? ["--segments", String(count)] : []), "--svg", file("r.svg"), "--colors", file("c.png"), "--flat", file("f.png"),
            "--outlines", file("o.png"), "--mesh", file("p.glb"), "--ucm", file("u.npy"));
          assert.deepEqual(regions.labels(), readNpy(file("l.npy")));
          assert.equal(segmentation.svg(regions.table), fs.readFileSync(file("r.svg"), "utf8"));
          assert.deepEqual(Buffer.from(segmentation.pieces(regions.table)), fs.readFileSync(file("p.glb")));
          assert.deepEqual(Buffer.from(segmentation.contourFile("u.npy")), fs.readFileSync(file("u.npy")));
          for (const [what, png] of [["colors", "c.png"], ["flat", "f.png"], ["outlines", "o.png"]])
            assert.deepEqual([...segmentation.draw(what, regions.table).data], [...decodePng(fs.readFileSync(file(png))).data], `${name} ${what}`);
        }
      });
    segmented(flat, {}, (segmentation) => {
      const marks = [segmentation.regions().table, [[{ x: 66, y: 18 }]], [[{ x: 9, y: 20 }, { x: 14, y: 40 }]]];
      const mask = segmentation.mask(...marks);
      tool("imgmesh-segment", "--quiet", "--overwrite", file("in.glb"), "--image", file("in.png"), "-o", file("l.npy"), "--keep", "66,18",
        "--drop", "9,20:14,40", "--mask", file("m.png"));
      const expected = decodePng(fs.readFileSync(file("m.png"))).data;
      assert.ok(mask.every((inside, i) => inside === Number(expected[4 * i] === 255)));
      assert.deepEqual(decodePng(segmentation.maskPng(...marks)), { ...flat, data: expected }); // packed by another library
    });
  }
});
