/**
 * Starts viser's client, beside whose parts this is served. The client looks for its decoder, compiled, under
 * this global name.
 *
 * @module
 */

globalThis.__viserZstdWasm = await WebAssembly.compileStreaming(fetch(new URL("./zstd.wasm", import.meta.url)));
await import("./client.js");
