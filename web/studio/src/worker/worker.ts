// The worker: it starts the engine, then calls methods one after another.
import { loadImgmesh } from "imgmesh.wasm";
import type { Report, WorkerState } from "../contracts";
import * as build from "./build";
import * as files from "./export";
import type { Answer, PlainError, Question } from "./protocol";
import * as segment from "./segment";
import * as view from "./view";
import * as warp from "./warp";

type AnyMethod = (args: never, report: Report) => unknown;
type Methods = Record<string, AnyMethod>;

// The library of types for pages has no worker's global object.
const scope = globalThis as unknown as {
  onmessage: ((event: MessageEvent<Question>) => void) | null;
  postMessage(message: Answer, transfer?: Transferable[]): void;
};

let begin: (module: WebAssembly.Module) => void;
const methods = new Promise<WebAssembly.Module>((resolve) => (begin = resolve)).then(start);
// One method after another, in the order in which they were asked for.
let queue: Promise<void> = Promise.resolve();

async function start(module: WebAssembly.Module): Promise<Methods> {
  const state: WorkerState = { imgmesh: await loadImgmesh(module), pixels: null, mesh: null };
  return { ...build.methods(state), ...view.methods(state), ...warp.methods(state), ...segment.methods(state), ...files.methods(state) };
}

function plain(error: unknown): PlainError {
  if (!(error instanceof Error)) return { name: "Error", message: String(error) };
  // Arrays of JavaScript that do not fit either.
  if (error instanceof RangeError)
    return { name: "ImgmeshError", kind: "memory", message: "the image needs more memory than there is" };
  return { name: error.name, message: error.message, kind: (error as { kind?: string }).kind };
}

/** The buffers of the typed arrays in a result; they are moved to the page. */
function buffersIn(value: unknown, found = new Set<ArrayBuffer>(), depth = 0): Set<ArrayBuffer> {
  if (value === null || typeof value !== "object" || depth > 3) return found;
  if (ArrayBuffer.isView(value)) {
    if (value.buffer instanceof ArrayBuffer) found.add(value.buffer);
  } else if (value instanceof ArrayBuffer) {
    found.add(value);
  } else if (Object.getPrototypeOf(value) === Object.prototype || Array.isArray(value)) {
    for (const member of Object.values(value)) buffersIn(member, found, depth + 1);
  }
  return found;
}

async function call(id: number, name: string, args: unknown): Promise<void> {
  try {
    const method = (await methods)[name];
    if (!method) throw new Error(`there is no method ${name}`);
    const report: Report = (fraction, stage) => scope.postMessage({ type: "progress", id, fraction, stage });
    const value = await method(args as never, report);
    scope.postMessage({ type: "result", id, value }, [...buffersIn(value)]);
  } catch (error) {
    // The engine has stopped in the middle of its work, and cannot be used any more.
    const lost = error instanceof WebAssembly.RuntimeError;
    if (lost) scope.postMessage({ type: "lost", error: { name: "SessionLost", message: `The engine has failed: ${error.message}` } });
    else scope.postMessage({ type: "error", id, error: plain(error) });
  }
}

methods.then(
  () => scope.postMessage({ type: "ready" }),
  (error: unknown) => scope.postMessage({ type: "lost", error: plain(error) }),
);
scope.onmessage = ({ data }) => {
  if (data.type === "start") begin(data.module);
  else queue = queue.then(() => call(data.id, data.method, data.args));
};
