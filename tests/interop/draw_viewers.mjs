// draw_viewers.mjs CHROMIUM PAGES FOLDER JOBS.json: screenshots of pages that show containers.
//
// JOBS.json: [{"page": "three.html", "file": "a.glb", "zoom": 2, "output": "a.png"}, ...]. Pages come from the
// folder PAGES, containers from FOLDER, screenshots go there; node_modules is the one beside this script. Nothing is
// fetched from elsewhere: every other address fails, and so does the run.
import { readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { dirname, extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
let chromium;
try {
  ({ chromium } = await import('playwright-core'));
} catch {
  console.error(`playwright-core is not installed; run: npm ci --prefix "${here}"`);
  process.exit(1);
}

const types = {
  '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm',
  '.glb': 'model/gltf-binary', '.gltf': 'model/gltf+json', '.png': 'image/png', '.json': 'application/json',
};

function serve(roots) {
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
    const isFile = (name) => statSync(name, { throwIfNoEntry: false })?.isFile();
    const file = roots.map((root) => join(root, path)).find(isFile);
    if (!file) {
      // Every browser asks for an icon.
      response.writeHead(path === '/favicon.ico' ? 204 : 404).end();
      return;
    }
    response.writeHead(200, { 'Content-Type': types[extname(file)] ?? 'application/octet-stream' });
    response.end(readFileSync(file));
  });
  return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve(server)));
}

const [executable, pages, folder, jobs] = process.argv.slice(2);
const server = await serve([pages, here, folder]);
const origin = `http://127.0.0.1:${server.address().port}`;
// No GPU is needed: SwiftShader draws.
const browser = await chromium.launch({
  executablePath: executable,
  args: ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--force-color-profile=srgb'],
});
const problems = [];
try {
  const page = await browser.newPage({ viewport: { width: 1024, height: 1024 }, deviceScaleFactor: 1 });
  let name = '';
  page.on('pageerror', (error) => problems.push(`${name}: ${error.message}`));
  page.on('console', (message) => {
    if (message.type() === 'error') problems.push(`${name}: ${message.text()}`);
  });
  page.on('request', (request) => {
    const url = request.url();
    if (!/^(data|blob):/.test(url) && !url.startsWith(`${origin}/`)) problems.push(`${name}: asks for ${url}`);
  });
  for (const job of JSON.parse(readFileSync(jobs))) {
    name = `${job.page} ${job.file}`;
    const query = new URLSearchParams({ file: job.file, zoom: job.zoom });
    await page.goto(`${origin}/${job.page}?${query}`);
    const drawn = page.waitForFunction("document.title === 'drawn'", null, { timeout: 30000 });
    await drawn.catch((error) => problems.push(`${name}: nothing drawn: ${error.message.split('\n')[0]}`));
    if (problems.length > 0) break;
    await page.locator('canvas').screenshot({ path: join(folder, job.output), omitBackground: true });
  }
} finally {
  await browser.close();
  server.close();
}
for (const problem of problems) console.error(problem);
process.exit(problems.length > 0 ? 1 : 0);
