// Containers in the page.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { drop, figure, openStudio, png, problem, root, startBrowser } from "./studio.mjs";

let host;
before(async () => (host = await startBrowser()));
after(() => host.close());

const container = readFileSync(join(root, "tests/data/container-1.0.glb"));
const glb = (name, bytes = container) => ({ name, type: "model/gltf-binary", bytes });
const image = (name, width, height) => ({ name, type: "image/png", bytes: png(width, height, (x, y) => [8 * x, 9 * y, 90, 255]) });

test("a container is opened with its levels; together with its image it is compared with it", async () => {
  const { page, finish } = await openStudio(host);
  await drop(page, glb("small.glb"));
  await page.locator("#status", { hasText: "Opened small.glb" }).waitFor();
  assert.equal(await page.locator("#file-name").textContent(), "small.glb, 30 × 20");
  assert.equal(await figure(page, "faces"), "60");
  assert.equal(await figure(page, "bytes"), `${(container.length / 1000).toPrecision(3)} kB`);
  assert.equal(await figure(page, "psnr"), "–");
  await page.getByRole("combobox", { name: "Level of the mesh" }).selectOption("1");
  await page.waitForFunction(() => document.getElementById("figure-faces").textContent === "24");

  await drop(page, image("small.png", 30, 20), glb("small.glb"));
  await page.locator("#file-name", { hasText: "small.png, 30 × 20" }).waitFor();
  await page.waitForFunction(() => /dB/.test(document.getElementById("figure-psnr").textContent));
  await finish();
});

test("what is no container is one line, and what was open stays", async () => {
  const { page, finish } = await openStudio(host);
  const tries = [
    [[glb("broken.glb", container.subarray(0, 200))], /broken\.glb/],
    [[glb("text.glb", Buffer.from("nothing"))], /text\.glb/],
    [[{ name: "layers.exr", type: "", bytes: Buffer.from("x") }], /layers\.exr belongs to a container/],
    [[glb("small.glb"), image("other.png", 9, 9)], /other\.png has another size/],
  ];
  for (const [files, text] of tries) {
    await drop(page, ...files);
    await page.locator("#problem", { hasText: text }).waitFor();
    assert.doesNotMatch(await problem(page), /\n/);
    assert.equal(await page.locator("#file-name").textContent(), "sample.jpg, 768 × 512");
  }
  await page.waitForFunction(() => document.getElementById("figure-vertices").textContent === "3\u2009932");
  await finish();
});
