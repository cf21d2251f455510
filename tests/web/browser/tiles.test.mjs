// The viewer of tile sets in Chromium: one sees through it nowhere, at any zoom, in either mode, and where levels meet.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { temporaryFolder, tool } from "../support/native.mjs";
import { decodePng, encodePng } from "../support/png.mjs";
import { root } from "./studio.mjs";

const { chromium } = await import(path.join(root, "web/node_modules/playwright-core/index.mjs"));
const { serve } = await import(path.join(root, "web/serve.mjs"));

/** Two photographs, each beside the other turned by 180 degrees: 1536 x 1024 pixels. */
function fourPhotographs() {
  const [a, b] = ["kodim23", "kodim05"].map((name) => decodePng(fs.readFileSync(path.join(root, "tests/data", `${name}.png`))));
  const { width, height } = a, data = Buffer.alloc(16 * width * height);
  for (let y = 0; y < 2 * height; ++y)
    for (let x = 0; x < 2 * width; ++x) {
      const turned = y >= height, from = x >= width === turned ? a : b, pixel = (y % height) * width + (x % width);
      const i = 4 * (turned ? width * height - 1 - pixel : pixel);
      data.set(from.data.subarray(i, i + 4), 4 * (2 * width * y + x));
    }
  return { width: 2 * width, height: 2 * height, data };
}

const picture = fourPhotographs();
const folder = temporaryFolder(), page = path.join(folder, "page"), set = path.join(folder, "photographs");
let host, browser;
before(async () => {
  execFileSync(process.execPath, [path.join(root, "web/build.mjs"), "tiles", page]);
  const source = path.join(folder, "photographs.png");
  fs.writeFileSync(source, encodePng(picture));
  tool("imgmesh-build", source, "-o", `${set}/`, "--tiles", "256", "--preset", "fast", "--quiet");
  host = await serve(page, 0, { "/sets/photographs/": set });
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
});
after(async () => {
  await browser?.close();
  host?.server.closeAllConnections();
  host?.server.close();
});

/** Opens the viewer; `prepare` gets the page before. finish() fails on errors and on requests to other hosts. */
async function open(address = "?set=sets/photographs/", { at = host, prepare = () => {}, ...options } = {}) {
  const view = await browser.newPage({ viewport: { width: 900, height: 640 }, ...options });
  const errors = [], foreign = [];
  view.on("pageerror", (error) => errors.push(String(error)));
  view.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  view.on("request", (request) => !/^(blob|data):/.test(request.url()) && !request.url().startsWith(at.address) && foreign.push(request.url()));
  await prepare(view);
  await view.goto(at.address + address);
  return {
    view,
    errors,
    async finish() {
      assert.deepEqual([errors, foreign], [[], []]);
      await view.close();
    },
  };
}

/** Waits until the view is at rest, with these levels on the screen. */
async function settled(view, levels) {
  await view.waitForFunction(
    (start) => document.getElementById("status").textContent.startsWith(start) && document.getElementById("stage").ariaBusy === "false",
    `Level ${levels} ·`,
    { timeout: 20_000 },
  );
}

/** What the view shows above a background. */
async function shot(view, background) {
  await view.evaluate((color) => (document.getElementById("stage").style.background = color), background);
  return decodePng(await view.locator("#stage").screenshot());
}

/** The part of the view that the picture covers, in whole pixels. Its corners are centres of pixels. */
function covered({ width, height }, { x, y, zoom }, shown = picture) {
  const side = (middle, at, last) => [
    Math.max(Math.ceil(middle - (at * zoom) / 100), 0),
    Math.min(Math.floor(middle + ((last - at) * zoom) / 100), 2 * middle),
  ];
  const [left, right] = side(width / 2, x, shown.width - 1), [top, bottom] = side(height / 2, y, shown.height - 1);
  return { left, right, top, bottom };
}

/** Counts pixels inside the rectangle whose colours differ. */
function differing(a, b, { left, right, top, bottom }) {
  let count = 0;
  for (let y = top; y < bottom; ++y)
    for (let x = left; x < right; ++x) {
      const i = 4 * (y * a.width + x);
      if (a.data[i] !== b.data[i] || a.data[i + 1] !== b.data[i + 1] || a.data[i + 2] !== b.data[i + 2]) ++count;
    }
  return count;
}

/** The drawing over magenta. Over green it must be the same: where it is not, one sees the background. */
async function closedShot(view, place, what, shown = picture) {
  const drawing = await shot(view, "#f0f"), inside = covered(drawing, place, shown);
  assert.ok(inside.right - inside.left > 100 && inside.bottom - inside.top > 100, what);
  assert.equal(differing(drawing, await shot(view, "#0f0"), inside), 0, `pixels that show the background: ${what}`);
  return { drawing, inside };
}

/** The mean of a channel in a rectangle. */
function mean({ data, width }, channel, { left, right, top, bottom }) {
  let sum = 0;
  for (let y = top; y < bottom; ++y) for (let x = left; x < right; ++x) sum += data[4 * (y * width + x) + channel];
  return sum / ((right - left) * (bottom - top));
}

/** Both show the same around the middle of the view: coarser levels in a larger part of it. */
function checkColors(drawing, { x, y, zoom, level }, what) {
  const around = (at, reach) => ({ left: Math.round(at.x - reach), right: Math.round(at.x + reach), top: Math.round(at.y - reach), bottom: Math.round(at.y + reach) });
  const reach = zoom > 1000 ? 6 : 16 << level, middle = { x: drawing.width / 2, y: drawing.height / 2 };
  for (const channel of [0, 1, 2]) {
    const shown = mean(drawing, channel, around(middle, (reach * zoom) / 100)), own = mean(picture, channel, around({ x: x + 0.5, y: y + 0.5 }, reach));
    assert.ok(Math.abs(shown - own) < 10, `${what}: channel ${channel} is ${shown} in place of ${own}`);
  }
}

const hashOf = ({ x, y, zoom }, show = "") => `#x=${x}&y=${y}&zoom=${zoom}${show && `&show=${show}`}`;

// Tiles of level 0 meet at multiples of 256 pixels, those of level 1 at multiples of 512. Level 1 is shown from 25 % down.
const places = [
  { x: 767.5, y: 511.5, zoom: 12.3, level: 2 },
  { x: 1024, y: 512, zoom: 25, level: 1 },
  { x: 512, y: 512, zoom: 17.89, level: 1 },
  { x: 700, y: 400, zoom: 49.3, level: 0 },
  { x: 768, y: 512, zoom: 61.803, level: 0 },
  { x: 768.3, y: 511.7, zoom: 100, level: 0 },
  { x: 258.1, y: 255.9, zoom: 133.7, level: 0 },
  { x: 512.25, y: 256.125, zoom: 271.8, level: 0 },
  { x: 1280, y: 768, zoom: 777.7, level: 0 },
  { x: 1024, y: 768, zoom: 3333, level: 0 },
];

test("no background is seen inside the picture at ten places and zooms, as a picture and as wireframe", async () => {
  const { view, finish } = await open();
  for (const place of places) {
    const what = JSON.stringify(place);
    // In a small window one can zoom out further.
    await view.setViewportSize(place.level > 1 ? { width: 450, height: 400 } : { width: 900, height: 640 });
    await view.evaluate((hash) => (location.hash = hash), hashOf(place));
    await settled(view, place.level);
    const plain = await closedShot(view, place, what);
    checkColors(plain.drawing, place, what);
    await view.getByRole("button", { name: "Wireframe" }).click();
    await settled(view, place.level);
    const wired = await closedShot(view, place, `${what} as wireframe`);
    const { left, right, top, bottom } = wired.inside;
    const lines = differing(plain.drawing, wired.drawing, wired.inside) / ((right - left) * (bottom - top));
    assert.ok(lines > 0.005 && (place.level > 0 || lines < 0.8), `${what}: lines cover ${lines}`);
    await view.getByRole("button", { name: "Wireframe" }).click();
  }
  await finish();
});

test("no background is seen where levels meet: one tile is late, so its parent stands beside finer ones", async () => {
  let arrive;
  const late = new Promise((resolve) => (arrive = resolve));
  const prepare = (view) => view.route("**/view/0/2_1.glb", async (route) => (await late, route.continue()));
  for (const at of [{ x: 512, y: 384, zoom: 97.3 }, { x: 768, y: 512, zoom: 213.7 }]) {
    const { view, finish } = await open(`?set=sets/photographs/${hashOf(at, "wire")}`, { prepare });
    const start = "Level 0 and 1 ·";
    await view.waitForFunction((text) => document.getElementById("status").textContent.startsWith(text), start);
    await closedShot(view, at, "two levels as wireframe");
    await view.getByRole("button", { name: "Wireframe" }).click();
    const { drawing } = await closedShot(view, at, "two levels");
    await view.getByRole("button", { name: "Tiles" }).click();
    await view.waitForFunction(() => location.hash.endsWith("show=tiles"));
    const frames = await shot(view, "#f0f");
    assert.ok(differing(drawing, frames, covered(drawing, at)) > 1000, "borders are drawn");
    assert.match(await view.locator("#status").textContent(), /^Level 0 and 1 · \d+ tiles on the screen, \d+ in memory · [\d,]+ triangles$/);
    if (at.zoom > 200) {
      arrive();
      await settled(view, 0);
    }
    await finish();
  }
});

test("a tile that cannot be read is named, and its parent is shown there", async () => {
  const prepare = (view) => view.route("**/view/0/2_1.glb", (route) => route.fulfill({ status: 404 }));
  const at = { x: 512, y: 384, zoom: 100 }, { view } = await open(`?set=sets/photographs/${hashOf(at)}`, { prepare });
  await view.locator("#problem p").waitFor();
  assert.equal(await view.locator("#problem").textContent(), "The tile view/0/2_1.glb could not be read; a coarser one is shown there.");
  await settled(view, "0 and 1");
  await closedShot(view, at, "a broken tile");
  await view.close();
});

test("the view goes into the address, and a link brings it back", async () => {
  const { view, finish } = await open(), canvas = view.locator("#stage canvas").first(), zoom = view.locator("#zoom");
  await view.locator("#file-name", { hasText: "photographs, 1536 × 1024 pixels" }).waitFor();
  assert.equal(new URL(view.url()).hash, "");
  const box = await canvas.boundingBox(), pointer = { x: box.x + 0.3 * box.width, y: box.y + 0.4 * box.height };
  const pixel = async () => {
    await view.mouse.move(pointer.x, pointer.y);
    return view.locator("#pixel").textContent();
  };
  const before = await pixel();
  assert.match(before, /^\d+, \d+$/);
  await view.mouse.wheel(0, -400);
  await view.waitForFunction(() => location.hash.includes("zoom"));
  const [x, y] = before.split(", ").map(Number), [x2, y2] = (await pixel()).split(", ").map(Number);
  assert.ok(Math.abs(x - x2) <= 1 && Math.abs(y - y2) <= 1, "the pixel under the pointer stays there");
  await canvas.focus();
  await view.keyboard.press("1");
  await view.waitForFunction(() => location.hash.includes("zoom=100"));
  assert.equal(await zoom.textContent(), "100 %");
  await view.keyboard.press("ArrowRight");
  await view.getByRole("button", { name: "Zoom in" }).click();
  await view.getByRole("button", { name: "Tiles" }).click();
  await view.waitForFunction(() => /zoom=125&show=tiles$/.test(location.hash));
  const link = view.url(), shown = (await shot(view, "#f0f")).data;
  const other = await open(link.slice(host.address.length));
  await settled(other.view, 0);
  await settled(view, 0);
  assert.equal(await other.view.locator("#zoom").textContent(), "125 %");
  assert.equal(await other.view.getByRole("button", { name: "Tiles" }).getAttribute("aria-pressed"), "true");
  assert.equal(other.view.url(), link);
  await other.finish();
  await canvas.dblclick();
  await view.waitForFunction(() => location.hash === "#show=tiles");
  assert.ok(shown.length > 0);
  await finish();
});

test("a set opens from a folder of this computer, and by its address; where there is none, the page says so", async () => {
  const { view, errors } = await open("");
  await view.locator("#status", { hasText: "Drop the folder of a tile set here" }).waitFor();
  await view.locator("#folder").setInputFiles(set);
  await view.locator("#file-name", { hasText: "photographs, 1536 × 1024 pixels" }).waitFor();
  await settled(view, 0);
  await view.getByRole("textbox", { name: "Address" }).fill("sets/none/tileset.json");
  await view.getByRole("button", { name: "Open", exact: true }).click();
  await view.locator("#problem p").waitFor();
  assert.equal(await view.locator("#problem").textContent(), `There is no tile set at ${host.address}sets/none/tileset.json.`);
  assert.equal(await view.locator("#zoom").textContent(), "", "there is nothing to zoom");
  assert.ok(errors.every((text) => /404|Failed to load|not in the folder/.test(text)), errors.join("\n"));
  await view.close();
});

test("a set of six levels opens from the root of a host, and its coarser levels name further tilesets", async () => {
  const strip = { width: 600, height: 17, data: Buffer.concat(Array.from({ length: 17 }, (_, y) => picture.data.subarray(4 * picture.width * y, 4 * (picture.width * y + 600)))) };
  const source = path.join(folder, "strip.png"), own = path.join(folder, "strip");
  fs.writeFileSync(source, encodePng(strip));
  tool("imgmesh-build", source, "-o", `${own}/`, "--tiles", "16", "--density", "10", "--preset", "fast", "--quiet");
  fs.cpSync(page, own, { recursive: true });
  const alone = await serve(own), requests = [];
  const { view, finish } = await open("index.html#x=300&y=8&zoom=1000", {
    at: alone,
    prepare: (view) => view.on("request", (request) => requests.push(new URL(request.url()).pathname)),
  });
  await settled(view, 0);
  await closedShot(view, { x: 300, y: 8, zoom: 1000 }, "a set of six levels", strip);
  assert.ok(requests.some((at) => /^\/view\/\d\/\d+_0\.json$/.test(at)), "a tileset below the first");
  assert.deepEqual(requests.filter((at) => at.startsWith("//")), []);
  await finish();
  alone.server.closeAllConnections();
  alone.server.close();
});

test("on a phone, two fingers zoom and everything is in reach", async () => {
  const { view, finish } = await open(undefined, { viewport: { width: 390, height: 700 }, isMobile: true, hasTouch: true, deviceScaleFactor: 2 });
  await view.locator("#file-name", { hasText: "photographs" }).waitFor();
  const zoom = async () => Number.parseFloat(await view.locator("#zoom").textContent()), fitted = await zoom();
  const box = await view.locator("#stage").boundingBox(), x = box.x + box.width / 2, y = box.y + box.height / 2;
  const touch = await view.context().newCDPSession(view), fingers = (by) => [{ x: x - by, y, id: 1 }, { x: x + by, y, id: 2 }];
  await touch.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: fingers(30) });
  for (const by of [50, 70, 90]) await touch.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: fingers(by) });
  await touch.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  await view.waitForFunction(() => location.hash.includes("zoom"));
  assert.ok((await zoom()) > 2 * fitted);
  for (const name of ["Wireframe", "Tiles", "Zoom out", "Zoom in", "Show all of the picture"]) {
    const button = await view.getByRole("button", { name }).boundingBox();
    assert.ok(button.x >= 0 && button.x + button.width <= 390 && button.y + button.height <= 700, name);
  }
  await finish();
});
