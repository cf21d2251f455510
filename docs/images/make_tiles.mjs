// Draws docs/images/tile-viewer.jpg: a tile set in headless Chromium, while one of its tiles is late. After ./run tiles --build
// build/tiles, with the folder of imgmesh-build:
//
//     node docs/images/make_tiles.mjs build/release/bin
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url)), root = join(here, "../..");
const { chromium } = await import(join(root, "web/node_modules/playwright-core/index.mjs"));
const { serve } = await import(join(root, "web/serve.mjs"));

const set = mkdtempSync(join(tmpdir(), "imgmesh-"));
const photograph = join(root, "tests/data/kodim23.png");
execFileSync(join(process.argv[2], "imgmesh-build"), [photograph, "-o", `${set}/`, "--tiles", "128", "--preset", "fast", "--quiet"]);
const { server, address } = await serve(join(root, "build/tiles"), 0, { "/sets/macaws/": set });
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
await page.route("**/view/0/4_2.glb", () => {});
await page.goto(`${address}?set=sets/macaws/#x=400&y=250&zoom=190&show=wire,tiles`);
await page.locator("#status", { hasText: "Level 0 and 1" }).waitFor();
await page.waitForTimeout(1000); // what is drawn last
await page.screenshot({ path: join(here, "tile-viewer.jpg"), type: "jpeg", quality: 85 });
await browser.close();
server.close();
rmSync(set, { recursive: true });
