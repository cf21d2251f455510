// validate_gltf.mjs FOLDER: the Khronos validator finds no error and no warning in any container of the folder.
import { readdirSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

let validator;
try {
  ({ default: validator } = await import('gltf-validator'));
} catch {
  const here = dirname(fileURLToPath(import.meta.url));
  console.error(`gltf-validator is not installed; run: npm ci --prefix "${here}"`);
  process.exit(1);
}

const folder = process.argv[2];
const names = readdirSync(folder).filter((name) => /\.(glb|gltf)$/.test(name));
if (names.length === 0) {
  console.error(`${folder}: no containers`);
  process.exit(1);
}

let bad = 0;
for (const name of names) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(join(folder, name))), {
    uri: name,
    externalResourceFunction: async (uri) => new Uint8Array(readFileSync(join(folder, decodeURIComponent(uri)))),
  });
  const { numErrors, numWarnings, messages } = report.issues;
  if (numErrors > 0 || numWarnings > 0) {
    bad += 1;
    for (const m of messages.filter((message) => message.severity < 2)) {
      console.error(`${name}: ${m.code} at ${m.pointer}: ${m.message}`);
    }
  }
}
console.log(`${names.length} containers, ${bad} with errors or warnings`);
process.exit(bad > 0 ? 1 : 0);
