// Opens the page in headless Chromium, and notes what it must not do. Tests of the browser use it.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateSync } from "node:zlib";

const root = join(dirname(fileURLToPath(import.meta.url)), "../../..");
const { chromium } = await import(join(root, "web/node_modules/playwright-core/index.mjs"));
const { serve } = await import(join(root, "web/serve.mjs"));

/** Where the page's files are: `node web/build.mjs studio build/studio` leaves them there. */
export const studioFolder = process.env.IMGMESH_STUDIO ?? join(root, "build/studio");
export { root };

/** Starts a browser and a server. close() ends both. */
export async function startBrowser() {
  assert.ok(existsSync(join(studioFolder, "index.html")), `${studioFolder} has no page: ./run studio --build makes one`);
  const { server, address } = await serve(studioFolder);
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox"],
  });
  return {
    address,
    browser,
    async close() {
      await browser.close();
      server.closeAllConnections();
      server.close();
    },
  };
}

/**
 * Opens the page in a context of its own and waits until the first image is meshed, unless `wait` is false.
 * finish() fails on console errors, exceptions and requests to other hosts, and closes the page.
 */
export async function openStudio({ browser, address }, { viewport = { width: 1280, height: 800 }, wait = true, ...options } = {}) {
  const context = await browser.newContext({ viewport, acceptDownloads: true, ...options });
  const page = await context.newPage();
  const errors = [], foreign = [];
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(String(error)));
  context.on("request", (request) => {
    const url = request.url();
    if (!url.startsWith(address) && !/^(blob|data):/.test(url)) foreign.push(url);
  });
  await page.goto(address);
  if (wait) await meshed(page).catch(async () => {
    // Seen once in a hundred pages on a machine with much else to do; what the page says then is wanted.
    console.error("no mesh:", await page.locator("#status").textContent(), await page.locator("#problem").textContent(), errors);
    await page.reload();
    await meshed(page);
  });
  return {
    page,
    errors,
    foreign,
    async finish() {
      assert.deepEqual(errors, []);
      assert.deepEqual(foreign, []);
      await context.close();
    },
  };
}

/** Waits until the status bar says that a mesh is there. */
export async function meshed(page, timeout = 45_000) {
  await page.locator("#status", { hasText: /^Meshed / }).waitFor({ timeout });
}

/** The line that says what went wrong, once it is there. */
export async function problem(page) {
  const line = page.locator("#problem p");
  await line.waitFor({ timeout: 30_000 });
  return line.textContent();
}

export function figure(page, id) {
  return page.locator(`#figure-${id}`).textContent();
}

/** Drops files, { name, type, bytes } each, onto the page. */
export async function drop(page, ...files) {
  const plain = files.map(({ name, type, bytes }) => ({ name, type, text: Buffer.from(bytes).toString("base64") }));
  await page.evaluate((files) => {
    const transfer = new DataTransfer();
    for (const { name, type, text } of files) {
      const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
      transfer.items.add(new File([bytes], name, { type }));
    }
    for (const event of ["dragenter", "dragover", "drop"])
      document.body.dispatchEvent(new DragEvent(event, { dataTransfer: transfer, bubbles: true, cancelable: true }));
  }, plain);
}

/** A PNG of 8-bit RGBA, `color(x, y)` being [R, G, B, A]; without it all is transparent black. */
export function png(width, height, color) {
  const rows = Buffer.alloc(height * (1 + 4 * width));
  for (let y = 0; color && y < height; ++y)
    for (let x = 0; x < width; ++x) rows.set(color(x, y), y * (1 + 4 * width) + 1 + 4 * x);
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([8, 6, 0, 0, 0], 8);
  const chunk = (type, bytes) => {
    const body = Buffer.concat([Buffer.from(type, "latin1"), bytes]), out = Buffer.alloc(body.length + 8);
    out.writeUInt32BE(bytes.length, 0);
    out.set(body, 4);
    out.writeUInt32BE(crc32(body), body.length + 4);
    return out;
  };
  return Buffer.concat([
    Buffer.from([0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10]),
    chunk("IHDR", header), chunk("IDAT", deflateSync(rows)), chunk("IEND", Buffer.alloc(0)),
  ]);
}

function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let k = 0; k < 8; ++k) crc = (crc >>> 1) ^ (0xedb88320 & -(crc & 1));
  }
  return ~crc >>> 0;
}
