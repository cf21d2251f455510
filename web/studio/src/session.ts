// Sessions: workers that hold the engine, one image and its mesh.
import type { Args, Method, Report, Result, Session } from "./contracts";
import type { Answer, Question } from "./worker/protocol";

/** What a session rejects with when its worker ends before it answers. */
export class SessionLost extends Error {
  constructor(text: string) {
    super(text);
    this.name = "SessionLost";
  }
}

interface Waiting {
  resolve(value: never): void;
  reject(reason: Error): void;
  onProgress: Report | undefined;
}

/** A worker that has the compiled engine is ready within a second, or something is wrong [ms]. */
const kMostStart = 60_000;

let engine: Promise<WebAssembly.Module> | null = null;

/** Fetches and compiles the engine, once for all sessions; again after a failure. */
export function loadEngine(): Promise<WebAssembly.Module> {
  engine ??= compileEngine().catch((error: unknown) => {
    engine = null;
    throw error;
  });
  return engine;
}

async function compileEngine(): Promise<WebAssembly.Module> {
  let response: Response;
  try {
    response = await fetch(new URL("engine.wasm", import.meta.url));
  } catch {
    throw new Error("The engine could not be loaded. Is the connection to the server gone?");
  }
  if (!response.ok) throw new Error(`The engine could not be loaded: the server answers ${response.status}.`);
  if (response.headers.get("content-type")?.startsWith("application/wasm"))
    return WebAssembly.compileStreaming(response);
  return WebAssembly.compile(await response.arrayBuffer());
}

/**
 * Starts a worker. Its script comes through a blob, as only such workers are under the page's
 * Content-Security-Policy too: they cannot send anything anywhere either.
 */
function startWorker(): Worker {
  const script = new URL("worker.js", import.meta.url).href;
  const blob = URL.createObjectURL(new Blob([`import ${JSON.stringify(script)};`], { type: "text/javascript" }));
  const worker = new Worker(blob, { type: "module" });
  // The address may go once the worker has read it, which its first message shows.
  worker.addEventListener("message", () => URL.revokeObjectURL(blob), { once: true });
  return worker;
}

function rebuiltError(error: { name: string; message: string; kind?: string | undefined }): Error {
  const rebuilt = new Error(error.message);
  rebuilt.name = error.name;
  return error.kind === undefined ? rebuilt : Object.assign(rebuilt, { kind: error.kind });
}

export function startSession(): Session {
  const worker = startWorker();
  const waiting = new Map<number, Waiting>();
  let next = 0;
  let ended: Error | null = null;
  let start = 0; // the timer that waits for the engine

  const end = (reason: Error): void => {
    if (ended) return;
    ended = reason;
    window.clearTimeout(start);
    worker.terminate();
    for (const call of waiting.values()) call.reject(reason);
    waiting.clear();
  };

  worker.onmessage = ({ data }: MessageEvent<Answer>) => {
    if (data.type === "ready") return window.clearTimeout(start);
    if (data.type === "lost") return end(rebuiltError(data.error));
    const call = waiting.get(data.id);
    if (!call) return;
    if (data.type === "progress") return call.onProgress?.(data.fraction, data.stage);
    waiting.delete(data.id);
    if (data.type === "result") call.resolve(data.value as never);
    else call.reject(rebuiltError(data.error));
  };
  worker.onerror = (event) => {
    event.preventDefault();
    end(new SessionLost(`The worker that computes has ended: ${event.message || "its script did not load"}.`));
  };
  const send = (question: Question, transfer: Transferable[] = []): void => worker.postMessage(question, transfer);
  loadEngine().then((module) => {
    if (ended) return;
    send({ type: "start", module });
    start = window.setTimeout(() => end(new SessionLost("The engine has not started. Load the page again.")), kMostStart);
  }, end);

  return {
    ask<M extends Method>(method: M, args: Args<M>, transfer?: Transferable[], onProgress?: Report): Promise<Result<M>> {
      if (ended) return Promise.reject(ended);
      const id = next++;
      return new Promise<Result<M>>((resolve, reject) => {
        waiting.set(id, { resolve, reject, onProgress });
        try {
          send({ type: "call", id, method, args }, transfer);
        } catch (error) {
          waiting.delete(id);
          reject(error instanceof Error ? error : new Error(String(error)));
        }
      });
    },
    close: () => end(new SessionLost("The work was stopped.")),
  };
}
