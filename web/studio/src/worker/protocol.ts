// Messages between a session and its worker.
export type Question =
  | { type: "start"; module: WebAssembly.Module }
  | { type: "call"; id: number; method: string; args: unknown };

export interface PlainError {
  name: string;
  message: string;
  kind?: string | undefined;
}

export type Answer =
  | { type: "ready" }
  | { type: "lost"; error: PlainError }
  | { type: "progress"; id: number; fraction: number; stage: string }
  | { type: "result"; id: number; value: unknown }
  | { type: "error"; id: number; error: PlainError };
