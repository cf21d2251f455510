// The Export panel: files come as downloads, and the programs read them.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { openStudio, root, startBrowser } from "./studio.mjs";

const browser = await startBrowser();
const folder = mkdtempSync(join(tmpdir(), "imgmesh-export-"));
after(async () => {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
});
const bin = process.env.IMGMESH_BIN ?? join(root, "build/dev/bin");

/** Saves one kind of file; returns the paths of the files that came. */
async function save(page, label, names) {
  await page.getByRole("radio", { name: label }).check();
  const downloads = [];
  const take = (download) => downloads.push(download);
  page.on("download", take);
  await page.getByRole("button", { name: "Save", exact: true }).click();
  await page.getByText(`Saved ${names.join(", ")}:`).waitFor();
  page.off("download", take);
  // Downloads that begin together are told in any order.
  const place = (download) => names.indexOf(download.suggestedFilename());
  downloads.sort((a, b) => place(a) - place(b));
  assert.deepEqual(downloads.map((d) => d.suggestedFilename()), names);
  return Promise.all(downloads.map(async (download) => {
    const path = join(folder, download.suggestedFilename());
    await download.saveAs(path);
    return path;
  }));
}

test("every kind of file is saved, under the name that was given", async () => {
  const studio = await openStudio(browser);
  const { page } = studio;
  await page.getByRole("tab", { name: "Export" }).click();
  await page.getByLabel("File name").fill("my image");
  const [container] = await save(page, "Container (.glb)", ["my image.glb"]);
  assert.equal(readFileSync(container).toString("latin1", 0, 4), "glTF");
  if (existsSync(join(bin, "imgmesh-info"))) execFileSync(join(bin, "imgmesh-info"), ["--validate", container]);
  await save(page, "3D mesh (.glb)", ["my image.glb"]);
  await save(page, "3D mesh with the image on it", ["my image.glb"]);
  await page.getByRole("radio", { name: "Poster" }).check();
  await page.getByLabel("Width in pixels").fill("2000");
  await page.getByLabel("Width in pixels").fill("0");
  await page.getByRole("button", { name: "Save", exact: true }).click();
  await page.locator("#problem", { hasText: "from 1 to 100000" }).waitFor();
  await page.getByLabel("Width in pixels").fill("2000");
  const [poster] = await save(page, "Poster", ["my image.svg"]);
  assert.match(readFileSync(poster, "utf8").slice(0, 300), /width="2000" height="\d+" viewBox/);
  const [sheet, picture] = await save(page, "Sprite", ["my image.json", "my image.png"]);
  assert.equal(JSON.parse(readFileSync(sheet, "utf8")).meta.image, "my image.png");
  assert.equal(readFileSync(picture).toString("latin1", 1, 4), "PNG");
  await save(page, "Wavefront", ["my image.obj", "my image.mtl", "my image-texture.png"]);
  await save(page, "Points and triangles", ["my image.ply"]);
  await save(page, "Reconstruction", ["my image.png"]);
  await studio.finish();
});

test("the panel fits a narrow page and shows what counts alone", async () => {
  const studio = await openStudio(browser, { viewport: { width: 360, height: 740 } });
  const { page } = studio;
  await page.getByRole("tab", { name: "Export" }).click();
  assert.ok(await page.getByLabel("Pixel map").isVisible());
  await page.getByRole("radio", { name: "Poster" }).check();
  assert.ok(!(await page.getByLabel("Pixel map").isVisible()));
  assert.ok(await page.getByLabel("Width in pixels").isVisible());
  assert.ok(await page.evaluate("document.documentElement.scrollWidth <= 360"));
  await studio.finish();
});
