// A small server of static files for this computer alone:
//
//     node web/serve.mjs FOLDER [PORT]      a free port unless one is named
import { createReadStream, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, resolve, sep } from "node:path";
import { fileURLToPath } from "node:url";

const kTypes = {
  ".css": "text/css; charset=utf-8",
  ".glb": "model/gltf-binary",
  ".html": "text/html; charset=utf-8",
  ".jpg": "image/jpeg",
  ".js": "text/javascript; charset=utf-8",
  ".mjs": "text/javascript; charset=utf-8",
  ".png": "image/png",
  ".svg": "image/svg+xml",
  ".wasm": "application/wasm",
};

/** The file in `folder` that a request means, or null. */
function fileOf(folder, url) {
  try {
    let path = join(folder, decodeURIComponent(new URL(url, "http://localhost").pathname));
    if (path !== folder && !path.startsWith(folder + sep)) return null;
    if (statSync(path).isDirectory()) path = join(path, "index.html");
    const { size } = statSync(path);
    return { path, size };
  } catch {
    return null;
  }
}

/** Serves `folder` on the loopback interface. Resolves to the server and its address. */
export function serve(folder, port = 0) {
  const root = resolve(folder);
  const server = createServer((request, response) => {
    const file = request.method === "GET" || request.method === "HEAD" ? fileOf(root, request.url) : null;
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
  const [folder, port] = process.argv.slice(2);
  if (!folder) {
    console.error("serve.mjs: error: expected the folder to serve");
    process.exit(2);
  }
  try {
    const { address } = await serve(folder, Number(port ?? 0));
    console.log(`The studio is at ${address} - Ctrl-C ends it.`);
  } catch (error) {
    console.error(`serve.mjs: error: ${error.message}`);
    process.exit(1);
  }
}
