// A small server of static files for this computer alone:
//
//     node web/serve.mjs FOLDER [PORT]      a free port unless one is named
//     node web/serve.mjs FOLDER --set SET   the viewer of tile sets in FOLDER, and a set beside it
import { createReadStream, statSync } from "node:fs";
import { createServer } from "node:http";
import { basename, extname, join, resolve, sep } from "node:path";
import { fileURLToPath } from "node:url";

const kTypes = {
  ".css": "text/css; charset=utf-8",
  ".glb": "model/gltf-binary",
  ".html": "text/html; charset=utf-8",
  ".jpg": "image/jpeg",
  ".json": "application/json",
  ".js": "text/javascript; charset=utf-8",
  ".mjs": "text/javascript; charset=utf-8",
  ".png": "image/png",
  ".svg": "image/svg+xml",
  ".wasm": "application/wasm",
};

/** The file that a request means, or null. The first of `folders`, [path below the address, folder] each, that fits. */
function fileOf(folders, url) {
  try {
    const wanted = decodeURIComponent(new URL(`http://localhost${url}`).pathname);
    const [at, folder] = folders.find(([at]) => wanted.startsWith(at));
    let path = join(folder, wanted.slice(at.length));
    if (path !== folder && !path.startsWith(folder + sep)) return null;
    if (statSync(path).isDirectory()) path = join(path, "index.html");
    const { size } = statSync(path);
    return { path, size };
  } catch {
    return null;
  }
}

/**
 * Serves `folder` on the loopback interface, and `others`, { "/sets/name/": folder }, below it. Resolves to the
 * server and its address.
 */
export function serve(folder, port = 0, others = {}) {
  const folders = Object.entries({ ...others, "/": folder }).map(([at, path]) => [at, resolve(path)]);
  const server = createServer((request, response) => {
    const file = request.method === "GET" || request.method === "HEAD" ? fileOf(folders, request.url) : null;
    if (!file) {
      response.writeHead(404, { "content-type": "text/plain" }).end("There is no such file.\n");
      return;
    }
    response.writeHead(200, {
      "content-type": kTypes[extname(file.path)] ?? "application/octet-stream",
      "content-length": file.size,
      "cache-control": "no-cache",
    });
    if (request.method === "HEAD") response.end();
    else createReadStream(file.path).on("error", () => response.destroy()).pipe(response);
  });
  return new Promise((done, failed) => {
    server.once("error", failed);
    server.listen(port, "127.0.0.1", () => done({ server, address: `http://127.0.0.1:${server.address().port}/` }));
  });
}

if (process.argv[1] && resolve(process.argv[1]) === fileURLToPath(import.meta.url)) {
  const [folder, ...others] = process.argv.slice(2);
  if (!folder) {
    console.error("serve.mjs: error: expected the folder to serve");
    process.exit(2);
  }
  try {
    const [option, set] = others;
    if (option === "--set") {
      const name = basename(resolve(set)); // the page shows it
      const { address } = await serve(folder, 0, { [`/sets/${name}/`]: set });
      console.log(`The tile set is at ${address}?set=sets/${encodeURIComponent(name)}/ - Ctrl-C ends it.`);
    } else {
      const { address } = await serve(folder, Number(option ?? 0));
      console.log(`The page is at ${address} - Ctrl-C ends it.`);
    }
  } catch (error) {
    console.error(`serve.mjs: error: ${error.message}`);
    process.exit(1);
  }
}
