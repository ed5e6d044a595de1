import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import path from "node:path";
import test from "node:test";

const EDITOR = path.resolve(import.meta.dirname, "../../static/editor");

/**
 * The rooms: folders of the editor, and modules beside the folders. Each may import those on lower lines, be
 * it only a type, and none on its own line or above.
 */
const DRAWING = `
  main
  editor
  receiving  listening
  opening  performing  probe  going
  reviewing  repeating
  ui  input
  sync  render
  state
  geometry
  protocol  commands  ids
  messages
`;
const LINES = DRAWING.trim().split("\n");

const FILES = readdirSync(EDITOR, { recursive: true, encoding: "utf-8" }).filter((file) =>
  file.endsWith(".js"),
);

/** @type {(file: string) => string} */
const roomOf = (file) => file.split(path.sep)[0].replace(/\.js$/, "");

/** Counted from the top; -1 for a room that is not drawn. @type {(room: string) => number} */
const lineOf = (room) => LINES.findIndex((line) => line.trim().split(/\s+/).includes(room));

/** What a module imports by this pattern, as paths within the editor. @type {(file: string, pattern: RegExp) => string[]} */
function importsOf(file, pattern) {
  const source = readFileSync(path.join(EDITOR, file), "utf-8");
  const imported = [...source.matchAll(pattern)].map(([, to]) => {
    assert.match(to, /^\.\.?\//, `${file} imports ${to}, which is not of the editor`);
    return path.relative(EDITOR, path.resolve(EDITOR, path.dirname(file), to));
  });
  // What others wrote lies beside the editor, and only its geometry builds on it.
  return imported.filter((to) => !(to.startsWith(path.join("..", "vendor")) && roomOf(file) === "geometry"));
}

const EVERYTHING = /(?:\bfrom\s+|\bimport\s+|\bimport\(|new URL\()"([^"]+)"/g;
const VALUES = /^(?:import|export)\b[^;]*?\bfrom\s+"([^"]+)";/gm;

test("every module is in a room that is drawn, and every import is there", () => {
  assert.ok(FILES.length > 40);
  for (const file of FILES) {
    assert.ok(lineOf(roomOf(file)) >= 0, `${file} is in no room that is drawn`);
    for (const to of importsOf(file, EVERYTHING)) assert.ok(FILES.includes(to), `${file} imports ${to}`);
  }
});

test("every import between rooms points down", () => {
  const wrong = FILES.flatMap((file) =>
    importsOf(file, EVERYTHING)
      .filter((to) => roomOf(to) !== roomOf(file) && lineOf(roomOf(to)) <= lineOf(roomOf(file)))
      .map((to) => `${file} imports ${to}`),
  );
  assert.deepEqual(wrong, []);
});

test("no module needs itself by way of others", () => {
  /** @type {Set<string>} */
  const safe = new Set();
  /** @type {(file: string, above: string[]) => void} */
  const follow = (file, above) => {
    assert.ok(!above.includes(file), [...above, file].join(" → "));
    for (const to of importsOf(file, VALUES)) if (!safe.has(to)) follow(to, [...above, file]);
    safe.add(file);
  };
  for (const file of FILES) follow(file, []);
});
