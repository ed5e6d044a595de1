/**
 * Starts viser's client, beside whose parts this is served. The client looks for its decoder, compiled, under
 * this global name.
 *
 * It takes the address of its server from the page's when it starts, and stumbles over what follows a #. So
 * that is laid aside for the editor (`editor/ui/address.js`), which puts it back.
 *
 * @module
 */

const { hash, pathname, search } = window.location;
globalThis.__fairyringAddress = hash;
if (hash) window.history.replaceState(null, "", pathname + search);

globalThis.__viserZstdWasm = await WebAssembly.compileStreaming(
  fetch(new URL("./zstd.wasm", import.meta.url)),
);
await import("./client.js");
