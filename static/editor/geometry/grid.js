/**
 * Finds rectangles by place: a grid of square cells, each of which knows the rectangles that touch it.
 *
 * @module
 */

import { overlap } from "./bounds.js";

/** @typedef {import("./bounds.js").Bounds} Bounds */
/** @typedef {{column0: number, row0: number, column1: number, row1: number}} Cells */

/** About the size of a cap, image pixels. */
const CELL_PX = 64;
/** What covers more cells than this is looked at in every search, rather than put into all of them. */
const MOST_CELLS = 256;

export class Grid {
  /** @type {Map<string, Bounds>} */
  #bounds = new Map();
  /** @type {Map<string, Set<string>>} */
  #cells = new Map();
  /** @type {Set<string>} */
  #wide = new Set();

  /** Puts a rectangle under a name, in the place of the one that has this name. @type {(name: string, bounds: Bounds) => void} */
  put(name, bounds) {
    this.remove(name);
    this.#bounds.set(name, bounds);
    const cells = cellsOf(bounds);
    if (countOf(cells) > MOST_CELLS) this.#wide.add(name);
    else for (const key of keysOf(cells)) this.#cellAt(key).add(name);
  }

  /** @type {(name: string) => void} */
  remove(name) {
    const bounds = this.#bounds.get(name);
    if (!bounds) return;
    this.#bounds.delete(name);
    if (this.#wide.delete(name)) return;
    for (const key of keysOf(cellsOf(bounds))) this.#cells.get(key)?.delete(name);
  }

  /** The names of the rectangles that overlap this one, in no order. @type {(bounds: Bounds) => string[]} */
  near(bounds) {
    return [...this.#candidates(bounds)].filter((name) => {
      const found = this.#bounds.get(name);
      return found !== undefined && overlap(found, bounds);
    });
  }

  /** @type {(bounds: Bounds) => Iterable<string>} */
  #candidates(bounds) {
    const cells = cellsOf(bounds);
    if (!(countOf(cells) <= this.#bounds.size)) return this.#bounds.keys();
    const found = new Set(this.#wide);
    for (const key of keysOf(cells)) for (const name of this.#cells.get(key) ?? []) found.add(name);
    return found;
  }

  /** @type {(key: string) => Set<string>} */
  #cellAt(key) {
    let cell = this.#cells.get(key);
    if (!cell) this.#cells.set(key, (cell = new Set()));
    return cell;
  }
}

/** @type {(bounds: Bounds) => Cells} */
function cellsOf({ x0, y0, x1, y1 }) {
  return {
    column0: Math.floor(x0 / CELL_PX),
    row0: Math.floor(y0 / CELL_PX),
    column1: Math.floor(x1 / CELL_PX),
    row1: Math.floor(y1 / CELL_PX),
  };
}

/** @type {(cells: Cells) => number} */
function countOf({ column0, row0, column1, row1 }) {
  return (column1 - column0 + 1) * (row1 - row0 + 1);
}

/** @type {(cells: Cells) => Generator<string>} */
function* keysOf({ column0, row0, column1, row1 }) {
  for (let row = row0; row <= row1; row++) {
    for (let column = column0; column <= column1; column++) yield `${column},${row}`;
  }
}
