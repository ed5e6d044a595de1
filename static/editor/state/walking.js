/**
 * Walking through a bed: which caps are still open, which of them comes next, and how long the rest may take.
 *
 * @module
 */

import { changed } from "./changes.js";
import { boundsOf, isPrediction } from "../geometry/shapes.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("./editor_state.js").EditorState} EditorState */

/** A pause longer than this is no work. */
const PAUSE_MS = 60000;
/** How many of the latest caps tell the pace, and what one takes before any has. */
const LATEST = 20;
const USUAL_MS = 3000;

/** Open caps: predictions nobody has decided upon, and what a file said and nobody has looked at. @type {(shapes: Shape[]) => Shape[]} */
export function openOnes(shapes) {
  return shapes.filter(({ checked, cap }) => !checked && !cap.ignored);
}

/** The open cap that is most worth a look, of those that are shown. @type {(state: EditorState) => Shape | null} */
export function worstOpen(state) {
  return openOnes(state.visible).sort((a, b) => b.doubt - a.doubt)[0] ?? null;
}

/** Says that the selected caps are right as they are, and selects the next worst. @type {(state: EditorState) => boolean} false where none is open */
export function checkAndGoOn(state) {
  state.commitDrafts();
  const right = openOnes(state.selected);
  if (right.length) state.commit(right.map((shape) => changed(shape, shape)));
  const next = worstOpen(state);
  state.select(next ? [next.uid] : []);
  const bounds = next && boundsOf(next);
  if (bounds) state.viewport.centre(bounds);
  return next !== null;
}

/** How fast a person goes through caps. */
export class Pace {
  #open = Infinity;
  #at = 0;
  /** Milliseconds a cap. @type {number[]} */
  #taken = [];

  /** So many caps are open now. @type {(open: number, now: number) => void} */
  count(open, now) {
    const done = this.#open - open;
    const took = now - this.#at;
    if (done > 0 && done < LATEST && took < PAUSE_MS) this.#taken = [...this.#taken, took / done].slice(-LATEST);
    if (done === 0) return;
    this.#open = open;
    this.#at = now;
  }

  /** Another image: nothing is known of when its first cap was begun. @type {(open: number, now: number) => void} */
  start(open, now) {
    this.#open = open;
    this.#at = now;
  }

  /** How long so many caps take, milliseconds. @type {(open: number) => number} */
  expect(open) {
    const sorted = this.#taken.toSorted((a, b) => a - b);
    return open * (sorted[sorted.length >> 1] ?? USUAL_MS);
  }
}

/** @type {(shapes: Shape[], left_ms: number) => string} */
export function progressOf(shapes, left_ms) {
  const all = shapes.filter(({ cap }) => !cap.ignored);
  const open = openOnes(all).length;
  if (all.length === 0) return "no caps";
  if (open === 0) return `all ${all.length} checked`;
  const minutes = left_ms / 60000;
  const left = minutes < 1 ? "under a minute" : `about ${Math.round(minutes)} min`;
  return `${all.length - open} of ${all.length}, ${left}`;
}

/** Predictions of at least this score, of those that are shown. @type {(state: EditorState, score: number) => Shape[]} */
export function atLeast(state, score) {
  return state.visible.filter((shape) => isPrediction(shape) && (shape.score ?? 0) >= score);
}
