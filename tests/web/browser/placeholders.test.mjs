// The page of placeholders in Chromium: it shows what the native decoder draws, then the photographs.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { temporaryFolder, tool } from "../support/native.mjs";
import { decodePng } from "../support/png.mjs";
import { root } from "./studio.mjs";

const { chromium } = await import(path.join(root, "web/node_modules/playwright-core/index.mjs"));
const { serve } = await import(path.join(root, "web/serve.mjs"));

const folder = temporaryFolder();
let host, browser;
before(async () => {
  execFileSync(process.execPath, [path.join(root, "web/build.mjs"), "placeholders", folder]);
  host = await serve(folder);
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
});
after(async () => {
  await browser.close();
  host.server.closeAllConnections();
  host.server.close();
});

/** Opens the page. Photographs wait until `photographs.load()`. */
async function open(options) {
  const page = await browser.newPage(options), errors = [];
  let load;
  const wanted = new Promise((resolve) => (load = resolve));
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => message.type() !== "info" && errors.push(message.text()));
  await page.route("**/*.png*", async (route) => {
    await wanted;
    await route.continue();
  });
  await page.goto(host.address, { waitUntil: "commit" });
  await page.locator("canvas").nth(2).waitFor();
  return { page, errors, load };
}

test("the minified decoder is at most 12 kB", () => {
  assert.ok(fs.statSync(path.join(folder, "imgm.min.js")).size <= 12288);
});

test("placeholders are of 400 and 200 bytes, and show what the native decoder draws", async () => {
  const { page, errors, load } = await open();
  const shown = await page.locator("canvas").evaluateAll((all) => all.map((canvas) => {
    const { width, height } = canvas, { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
    return { width, height, data: [...data], coded: canvas.nextElementSibling.dataset.imgm };
  }));
  assert.deepEqual(shown.map(({ coded }) => Buffer.from(coded, "base64").length <= 400), [true, true, true]);
  assert.ok(Buffer.from(shown[2].coded, "base64").length <= 200);
  for (const { width, height, data, coded } of shown) {
    fs.writeFileSync(path.join(folder, "shown.imgm"), Buffer.from(coded, "base64"));
    tool("imgmesh-decode", path.join(folder, "shown.imgm"), "-o", path.join(folder, "shown.png"), "--quiet");
    const native = decodePng(fs.readFileSync(path.join(folder, "shown.png")));
    assert.deepEqual([width, height], [native.width, native.height]);
    assert.ok(Buffer.from(data).equals(Buffer.from(native.data)));
  }
  load();
  await page.close();
  assert.deepEqual(errors, []);
});

test("a photograph fades in above its placeholder once it has loaded, in the same place", async () => {
  const { page, errors, load } = await open();
  const photograph = page.locator("img").first(), opacity = () => photograph.evaluate((img) => getComputedStyle(img).opacity);
  assert.equal(await opacity(), "0");
  load();
  await page.waitForFunction(() => [...document.images].every((img) => getComputedStyle(img).opacity === "1"));
  assert.deepEqual(await photograph.boundingBox(), await page.locator("canvas").first().boundingBox());
  await page.locator("#again").click();
  assert.equal(await photograph.evaluate((img) => img.classList.contains("loaded")), false);
  await page.waitForFunction(() => [...document.images].every((img) => img.classList.contains("loaded")));
  await page.close();
  assert.deepEqual(errors, []);
});

test("a placeholder that cannot be decoded leaves the photograph as it is", async () => {
  const { page, load } = await open();
  load();
  const shown = await page.evaluate(async () => {
    const { showPlaceholder } = await import(new URL("placeholders.js", location.href).href);
    const img = document.images[0].cloneNode();
    img.dataset.imgm = "mklN";
    document.querySelector("main").append(img);
    showPlaceholder(img);
    return [img.previousElementSibling?.localName, getComputedStyle(img).opacity];
  });
  assert.deepEqual(shown, ["figure", "1"]);
  await page.close();
});

test("the page follows the colour scheme", async () => {
  const backgrounds = [];
  for (const colorScheme of ["light", "dark"]) {
    const { page, load } = await open({ colorScheme });
    backgrounds.push(await page.evaluate(() => getComputedStyle(document.body).backgroundColor));
    load();
    await page.close();
  }
  assert.notEqual(backgrounds[0], backgrounds[1]);
});
