// Builds what is served and what is published, from web/ and the engine that the preset web has built:
//
//     node web/build.mjs package          web/package/dist, so that web/package can be packed
//     node web/build.mjs studio OUT       the page, as static files in OUT
//     node web/build.mjs decoder OUT      imgm.min.js, the decoder of coded pictures
//     node web/build.mjs placeholders OUT the page of placeholders; imgmesh-encode of build/release makes them
//     node web/build.mjs tiles OUT        the viewer of tile sets, as static files in OUT
//     node web/build.mjs check            only checks the types
import { execFileSync } from "node:child_process";
import { copyFileSync, cpSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import * as esbuild from "esbuild";

const web = dirname(fileURLToPath(import.meta.url));
const root = dirname(web);
const engine = process.env.IMGMESH_ENGINE ?? join(root, "build/web/bin");
const tools = process.env.IMGMESH_BIN ?? join(root, "build/release/bin");

function fail(text) {
  console.error(`build.mjs: error: ${text}`);
  process.exit(1);
}

function checkEngine() {
  for (const name of ["engine.mjs", "engine.wasm"])
    if (!existsSync(join(engine, name))) fail(`${join(engine, name)} is not there; ./run build web makes it`);
}

function copyDraco(folder) {
  for (const name of ["draco_encoder.wasm", "draco_decoder.wasm"])
    copyFileSync(join(web, "node_modules/draco3d", name), join(folder, name));
}

// What the files contain of others, who want their notices kept. Draco has the licence of imgmesh itself.
const kEngineNotices = {
  packages: ["fflate", "@noble/hashes"],
  debian: ["emscripten", "libeigen3-dev", "libimath-dev", "libtinygltf-dev", "nlohmann-json3-dev"],
};
const kTilesNotices = { packages: ["three", "3d-tiles-renderer"], debian: [] };

function writeNotices(folder, { packages, debian }) {
  const files = [
    ["imgmesh and Draco", join(root, "LICENSE")],
    ...packages.map((name) => [name, join(web, "node_modules", name, "LICENSE")]),
    ...debian.map((name) => [name, join("/usr/share/doc", name, "copyright")]),
  ].filter(([, file]) => existsSync(file));
  const text = files.map(([name, file]) => `==== ${name} ====\n\n${readFileSync(file, "utf8").trim()}\n`).join("\n\n");
  writeFileSync(join(folder, "licenses.txt"), text);
}

function tsc(...options) {
  try {
    execFileSync(process.execPath, [join(web, "node_modules/typescript/bin/tsc"), ...options], { stdio: "inherit" });
  } catch {
    fail("the types do not agree");
  }
}

function check() {
  tsc("-p", join(web, "tsconfig.json"));
}

function buildPackage() {
  checkEngine();
  const folder = join(web, "package"), dist = join(folder, "dist");
  rmSync(dist, { recursive: true, force: true });
  tsc("-p", join(folder, "tsconfig.json"));
  copyFileSync(join(folder, "src/engine.d.mts"), join(dist, "engine.d.mts"));
  for (const name of ["engine.mjs", "engine.wasm"]) copyFileSync(join(engine, name), join(dist, name));
  copyDraco(dist);
  writeNotices(dist, kEngineNotices);
  copyFileSync(join(root, "LICENSE"), join(folder, "LICENSE"));
}

// The package's sources name the loader as it lies beside them once they are built.
const findEngine = {
  name: "engine",
  setup(build) {
    build.onResolve({ filter: /^\.\/engine\.mjs$/ }, () => ({ path: join(engine, "engine.mjs") }));
  },
};

// draco3d asks for these where it runs in Node.
const noNode = {
  name: "no-node",
  setup(build) {
    build.onResolve({ filter: /^(fs|path)$/ }, ({ path }) => ({ path, namespace: "no-node" }));
    build.onLoad({ filter: /.*/, namespace: "no-node" }, () => ({ contents: "module.exports = {}" }));
  },
};

/** Joins a page's scripts, by the names that they get, and its styles into OUT/assets, and copies what stays as it is. */
async function buildPage(page, entryPoints, out, plugins = []) {
  const folder = join(web, page), assets = join(out, "assets");
  mkdirSync(assets, { recursive: true });
  await esbuild.build({
    entryPoints: Object.fromEntries(Object.entries(entryPoints).map(([name, file]) => [name, join(folder, file)])),
    outdir: assets,
    bundle: true,
    format: "esm",
    target: ["chrome100", "firefox114", "safari16.4"],
    minify: true,
    sourcemap: process.env.IMGMESH_SOURCEMAP === "1",
    legalComments: "none",
    tsconfig: join(web, "tsconfig.json"),
    plugins,
    logLevel: "warning",
  });
  await esbuild.build({
    entryPoints: { style: join(folder, "styles/main.css") },
    outdir: assets,
    bundle: true,
    minify: true,
    logLevel: "warning",
  });
  cpSync(join(folder, "static"), out, { recursive: true });
  return assets;
}

async function buildStudio(out) {
  checkEngine();
  check();
  const assets = await buildPage("studio", { main: "src/main.ts", worker: "src/worker/worker.ts" }, out, [findEngine, noNode]);
  copyFileSync(join(engine, "engine.wasm"), join(assets, "engine.wasm"));
  copyDraco(assets);
  writeNotices(out, kEngineNotices);
}

// The viewer needs no engine: Draco's decoder comes with three.js.
async function buildTiles(out) {
  check();
  const assets = await buildPage("tiles", { main: "src/main.ts" }, out);
  const draco = join(web, "node_modules/three/examples/jsm/libs/draco/gltf");
  for (const name of ["draco_wasm_wrapper.js", "draco_decoder.wasm"]) copyFileSync(join(draco, name), join(assets, name));
  copyFileSync(join(web, "studio/static/assets/icon.svg"), join(assets, "icon.svg"));
  writeNotices(out, kTilesNotices);
}

// Names that end in _ are the decoder's own; `let` is shorter than `const`.
async function buildDecoder(out) {
  const contents = readFileSync(join(web, "decoder/imgm.js"), "utf8").replace(/\bconst\b/g, "let");
  await esbuild.build({
    stdin: { contents },
    outfile: join(out, "imgm.min.js"),
    format: "esm",
    target: "es2021",
    minify: true,
    mangleProps: /_$/,
    logLevel: "warning",
  });
}

async function buildPlaceholders(out) {
  const page = join(web, "placeholders");
  mkdirSync(out, { recursive: true });
  await buildDecoder(out);
  for (const name of ["placeholders.css", "placeholders.js"]) copyFileSync(join(page, name), join(out, name));
  const coded = (_, picture, bytes) => {
    copyFileSync(join(root, "tests/data", `${picture}.png`), join(out, `${picture}.png`));
    const file = join(out, `${picture}-${bytes}.imgm`);
    execFileSync(join(tools, "imgmesh-encode"), [join(out, `${picture}.png`), "-o", file, "--bytes", bytes, "--quiet"]);
    return `data-imgm="${readFileSync(file).toString("base64")}"`;
  };
  const text = readFileSync(join(page, "index.html"), "utf8").replace(/data-imgm="(\w+) (\d+)"/g, coded);
  writeFileSync(join(out, "index.html"), text);
}

const [what, out] = process.argv.slice(2);
if (what === "check") check();
else if (what === "package") buildPackage();
else if (what === "studio" && out) await buildStudio(resolve(out));
else if (what === "decoder" && out) await buildDecoder(resolve(out));
else if (what === "placeholders" && out) await buildPlaceholders(resolve(out));
else if (what === "tiles" && out) await buildTiles(resolve(out));
else fail("expected one of: check, package, studio OUT, decoder OUT, placeholders OUT, tiles OUT");
