// The tools, as a user calls them. IMGMESH_BIN is their folder, build/dev/bin unless it is set.
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";

const kFolder = process.env.IMGMESH_BIN ?? fileURLToPath(new URL("../../../build/dev/bin", import.meta.url));

/** Runs a tool. Throws with what it says if it fails. */
export function tool(name, ...args) {
  return execFileSync(path.join(kFolder, name), args, { stdio: ["ignore", "pipe", "pipe"], encoding: "utf8" });
}

/** Returns a new folder, and removes it when the process ends. */
export function temporaryFolder() {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "imgmesh-web-"));
  process.on("exit", () => fs.rmSync(folder, { recursive: true, force: true }));
  return folder;
}
