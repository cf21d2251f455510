// Builds what is served and what is published, from web/ and the engine that the preset web has built:
//
//     node web/build.mjs package          web/package/dist, so that web/package can be packed
//     node web/build.mjs studio OUT       the page, as static files in OUT
//     node web/build.mjs decoder OUT      imgm.min.js, the decoder of coded pictures
//     node web/build.mjs placeholders OUT the page of placeholders; imgmesh-encode of build/release makes them
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

// What the files contain of others, who want their notices kept. draco3d has the licence of imgmesh itself.
function writeNotices(folder) {
  const debian = ["emscripten", "libeigen3-dev", "libimath-dev", "libtinygltf-dev", "nlohmann-json3-dev"];
  const files = [
    ["imgmesh and draco3d", join(root, "LICENSE")],
    ...["fflate", "@noble/hashes"].map((name) => [name, join(web, "node_modules", name, "LICENSE")]),
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
  writeNotices(dist);
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

async function buildStudio(out) {
  checkEngine();
  check();
  const studio = join(web, "studio"), assets = join(out, "assets");
  mkdirSync(assets, { recursive: true });
  await esbuild.build({
    entryPoints: { main: join(studio, "src/main.ts"), worker: join(studio, "src/worker/worker.ts") },
    outdir: assets,
    bundle: true,
    format: "esm",
    target: ["chrome100", "firefox114", "safari16.4"],
    minify: true,
    sourcemap: process.env.IMGMESH_SOURCEMAP === "1",
    legalComments: "none",
    tsconfig: join(web, "tsconfig.json"),
    plugins: [findEngine, noNode],
    logLevel: "warning",
  });
  await esbuild.build({
    entryPoints: { style: join(studio, "styles/main.css") },
    outdir: assets,
    bundle: true,
    minify: true,
    logLevel: "warning",
  });
  copyFileSync(join(engine, "engine.wasm"), join(assets, "engine.wasm"));
  copyDraco(assets);
  writeNotices(out);
  cpSync(join(studio, "static"), out, { recursive: true });
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
else fail("expected one of: check, package, studio OUT, decoder OUT, placeholders OUT");
