// The loader that emscripten writes; engine.ts says what it makes.
declare const createEngine: unknown;
export default createEngine;
