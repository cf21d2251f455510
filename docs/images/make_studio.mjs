// Draws docs/images/studio-*.jpg: the page in headless Chromium. After ./run studio --build build/studio:
//
//     node docs/images/make_studio.mjs
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url)), root = join(here, "../..");
const { startBrowser, meshed } = await import(join(root, "tests/web/browser/studio.mjs"));

const host = await startBrowser();

/** Opens the page, lets `use` work on it, and keeps what is seen. */
async function draw(name, viewport, colorScheme, use) {
  const page = await host.browser.newPage({ viewport, colorScheme });
  await page.goto(host.address);
  await meshed(page);
  await use(page);
  await page.waitForTimeout(1000); // what is drawn last
  await page.screenshot({ path: join(here, `studio-${name}.jpg`), type: "jpeg", quality: 85 });
  await page.close();
}

const tab = (page, name) => page.getByRole("tab", { name }).click();
const wide = { width: 1280, height: 800 };
await draw("mesh", wide, "light", async () => {});
await draw("warp", wide, "light", async (page) => {
  await tab(page, "Warp");
  await page.getByRole("button", { name: "Build 3 levels" }).click();
  await page.waitForFunction(() => document.querySelector(".warp select").options.length === 3);
  await page.locator("[data-export]:enabled").first().waitFor();
  await page.getByLabel("Level", { exact: true }).selectOption("2");
  await page.getByLabel("The rest of the image").selectOption("injective");
  await page.waitForTimeout(1000);
  const box = await page.locator(".view canvas").boundingBox(); // the beak on the left is pulled up
  await page.mouse.move(box.x + 0.17 * box.width, box.y + 0.5 * box.height);
  await page.mouse.down();
  for (let k = 1; k <= 10; ++k) await page.mouse.move(box.x + 0.17 * box.width - 3 * k, box.y + 0.5 * box.height - 7 * k);
  await page.mouse.up();
});
await draw("regions", wide, "light", async (page) => {
  await tab(page, "Regions");
  await page.locator(".segment input[type=number]:enabled").first().waitFor({ timeout: 60_000 });
  await page.getByLabel("Show", { exact: true }).selectOption("colors");
  await page.locator(".segment input[type=number]").first().fill("40");
  await page.keyboard.press("Enter");
});
await draw("phone", { width: 360, height: 740 }, "dark", async () => {});
await host.close();
