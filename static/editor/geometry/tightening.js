/**
 * Draws a rough outline to the rim nearby: the cheapest closed path around the middle of the cap through a picture of it in
 * polar coordinates, where crossing a strong edge costs little (Timp and Karssemeijer, 2004).
 *
 * @module
 */

import { areaOfRing, axesOf, hundredths } from "./caps.js";
import { FEWEST_OF_ELLIPSE, circleBy, ellipseBy } from "./fits.js";
import { simplified } from "./strokes.js";

/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../protocol.js").Whole} Whole */

/**
 * How bright a piece of the photo is.
 *
 * @typedef {Object} Patch
 * @property {Float32Array} values  row by row
 * @property {number} width  and height, samples
 * @property {number} height
 * @property {number} x0  where the first sample's corner lies, image pixels
 * @property {number} y0
 * @property {number} step  from sample to sample, image pixels
 */

/** How far from the rough outline the rim is looked for: this share of the radius, and at least so many pixels. */
const SHARE = 0.25;
const LEAST_PX = 5;
/** An edge to something brighter outside counts so much of one to something darker: caps are bright. */
const BRIGHTER = 0.5;
/** What it costs to go as far as that from the rough outline, of what a usual edge saves. */
const STRAYING = 0.35;
/** What it costs to come nearer to the middle, or go farther from it, by one sample a ray. */
const BENDING = 0.08;
/** By so many samples at most. */
const STEEPEST = 3;
/** What the rim that the network sees saves, of what a usual edge does; it saves less the farther away, up to so many pixels. */
const SEEN = 1.5;
const SEEN_WITHIN_PX = 4;
/** Beyond that the rim is not looked for. */
const FAR = 10;
const RAYS = { least: 48, most: 240 };
/** A mark is drawn along by points that lie so near to it, in radii. */
const ALONG = 0.2;
/** So many times, and the last times by this share of them that fits best: the rest may be a neighbour's rim. */
const TRIMMINGS = 5;
const TRUSTED = 0.6;
const TOLERANCE_PX = 0.35;

/** How much of the photo around a ring is needed. @type {(ring: number[]) => number} image pixels */
export function reachAround(ring) {
  return 2 + Math.max(LEAST_PX, SHARE * Math.sqrt(areaOfRing(ring)));
}

/**
 * The rim near a rough outline.
 *
 * @param {number[]} ring
 * @param {Patch} patch
 * @param {number[] | null} [seen]  where the network sees a rim
 * @returns {number[]}
 */
export function tightened(ring, patch, seen = null) {
  const middle = middleOf(ring);
  const radius = Math.sqrt(areaOfRing(ring) / Math.PI);
  const count = Math.round(Math.min(RAYS.most, Math.max(RAYS.least, 2 * Math.PI * radius)));
  const step = Math.max((2 * Math.PI * radius) / count, 0.5) / 2;
  const reach = Math.max(LEAST_PX, SHARE * radius);
  const rays = Array.from({ length: count }, (_, i) => {
    const angle = (2 * Math.PI * i) / count;
    const rough = reachOf(ring, middle, angle);
    return { dx: Math.cos(angle), dy: Math.sin(angle), rough, seen: seen && reachOf(seen, middle, angle) };
  });
  const samples = Math.ceil((Math.max(...rays.map(({ rough }) => rough)) + reach) / step);
  const costs = costsOf(rays.map((ray) => slopesAlong(patch, middle, ray, { step, samples })), {
    rough: rays.map(({ rough }) => rough / step),
    reach: reach / step,
    seen: rays.map((ray) => (ray.seen === null ? null : ray.seen / step)),
    within: SEEN_WITHIN_PX / step,
  });
  const radii = smoothed(cheapestRound(costs)).map((k) => k * step);
  const points = rays.map(({ dx, dy }, i) => {
    return /** @type {Point} */ ([middle[0] + radii[i] * dx, middle[1] + radii[i] * dy]);
  });
  const line = simplified([...points, points[0]], TOLERANCE_PX).slice(0, -1);
  return line.flatMap(([x, y]) => [hundredths(x), hundredths(y)]);
}

/** Each between its neighbours on the round. @type {(values: number[]) => number[]} */
function smoothed(values) {
  const count = values.length;
  return values.map((value, i) => (values[(i + count - 1) % count] + 2 * value + values[(i + 1) % count]) / 4);
}

/**
 * A circle or ellipse drawn along with the rim, by those points of it that lie near; as it is where these are too
 * few to tell, or tell of something else.
 *
 * @param {Whole} whole
 * @param {Point[]} rim
 * @returns {Whole}
 */
export function drawnAlong(whole, rim) {
  const near = rim.filter((point) => Math.abs(outside(whole, point)) <= ALONG);
  let found = whole;
  for (let i = 0; i < TRIMMINGS; i++) {
    const nearest = near.toSorted((p, q) => Math.abs(outside(found, p)) - Math.abs(outside(found, q)));
    const kept = i === 0 ? near : nearest.slice(0, Math.ceil(TRUSTED * near.length));
    const next = whole.kind === "circle" ? circleBy(kept) : ellipseBy(kept);
    if (!next || kept.length < FEWEST_OF_ELLIPSE) return whole;
    found = next;
  }
  const [before, after] = [axesOf(whole), axesOf(found)];
  const alike = Math.abs(Math.sqrt((after.a * after.b) / (before.a * before.b)) - 1) <= SHARE;
  return alike ? found : whole;
}

/** How far outside a point lies, in radii; below zero inside. @type {(whole: Whole, point: Point) => number} */
function outside(whole, [x, y]) {
  const { a, b, angle } = axesOf(whole);
  const [dx, dy] = [x - whole.cx, y - whole.cy];
  const u = (dx * Math.cos(angle) + dy * Math.sin(angle)) / a;
  const v = (dy * Math.cos(angle) - dx * Math.sin(angle)) / b;
  return Math.hypot(u, v) - 1;
}

/** @type {(ring: number[]) => Point} */
function middleOf(ring) {
  let [twice, x, y] = [0, 0, 0];
  for (let i = 0, j = ring.length - 2; i < ring.length; j = i, i += 2) {
    const cross = ring[j] * ring[i + 1] - ring[i] * ring[j + 1];
    twice += cross;
    x += (ring[j] + ring[i]) * cross;
    y += (ring[j + 1] + ring[i + 1]) * cross;
  }
  return [x / (3 * twice), y / (3 * twice)];
}

/** How far a ring reaches from a point within it in a direction. @type {(ring: number[], from: Point, angle: number) => number} */
function reachOf(ring, [x, y], angle) {
  const [dx, dy] = [Math.cos(angle), Math.sin(angle)];
  let far = 0;
  for (let i = 0, j = ring.length - 2; i < ring.length; j = i, i += 2) {
    const [ax, ay, ex, ey] = [ring[j] - x, ring[j + 1] - y, ring[i] - ring[j], ring[i + 1] - ring[j + 1]];
    const det = dx * ey - dy * ex;
    if (det === 0) continue;
    const along = (ax * ey - ay * ex) / det;
    const share = (ax * dy - ay * dx) / det;
    if (share >= 0 && share <= 1) far = Math.max(far, along);
  }
  return far;
}

/**
 * Where it leads, and how far out the rough outline is, and the rim that the network sees.
 *
 * @typedef {{dx: number, dy: number, rough: number, seen: number | null}} Ray
 */

/**
 * How strong an edge is at each of the samples of a ray, from the middle outwards.
 *
 * @type {(patch: Patch, from: Point, ray: Ray, how: {step: number, samples: number}) => number[]}
 */
function slopesAlong(patch, [x, y], { dx, dy }, { step, samples }) {
  const at = (/** @type {number} */ r) => brightness(patch, x + r * dx, y + r * dy);
  return Array.from({ length: samples }, (_, k) => {
    const r = Math.max(k * step, 1.5);
    const slope = at(r - 1.5) + at(r - 0.5) - at(r + 0.5) - at(r + 1.5);
    return slope > 0 ? slope : -BRIGHTER * slope;
  });
}

/**
 * What it costs to put the rim at each sample of each ray; an edge as strong as a usual ray's strongest saves one.
 *
 * @type {(slopes: number[][], band: {rough: number[], reach: number, seen: (number | null)[], within: number}) => Float32Array[]}
 */
function costsOf(slopes, { rough, reach, seen, within }) {
  const inBand = (/** @type {number} */ k, /** @type {number} */ i) => Math.abs(k - rough[i]) <= reach;
  const strongest = slopes.map((ray, i) => Math.max(...ray.filter((_, k) => inBand(k, i)), 0)).sort((a, b) => a - b);
  const usual = Math.max(strongest[strongest.length >> 1], 1);
  return slopes.map((ray, i) =>
    Float32Array.from(ray, (slope, k) => {
      const strayed = (k - rough[i]) / reach;
      if (Math.abs(strayed) > 1) return FAR * Math.abs(strayed);
      const far = Math.abs(k - (seen[i] ?? Infinity)) / within;
      return STRAYING * strayed ** 2 - Math.min(slope / usual, 1.5) - SEEN * Math.max(0, 1 - far);
    }),
  );
}

/** Between samples; beyond the patch as at its border. @type {(patch: Patch, x: number, y: number) => number} */
function brightness({ values, width, height, x0, y0, step }, x, y) {
  const u = Math.min(Math.max((x - x0) / step - 0.5, 0), width - 1.001);
  const v = Math.min(Math.max((y - y0) / step - 0.5, 0), height - 1.001);
  const [column, row] = [Math.floor(u), Math.floor(v)];
  const [p, q] = [u - column, v - row];
  const i = row * width + column;
  const above = values[i] * (1 - p) + values[i + 1] * p;
  return above * (1 - q) + (values[i + width] * (1 - p) + values[i + width + 1] * p) * q;
}

/**
 * Which sample of each ray the cheapest closed path takes. It is looked for over three rounds, of which the middle one
 * knows nothing of where it began.
 *
 * @type {(costs: Float32Array[]) => number[]}
 */
function cheapestRound(costs) {
  const [count, samples] = [costs.length, costs[0].length];
  let sums = costs[0].slice();
  /** @type {Int8Array[]} */
  const taken = [];
  for (let i = 1; i < 3 * count; i++) {
    const next = new Float32Array(samples);
    const steps = new Int8Array(samples);
    for (let k = 0; k < samples; k++) {
      const step = cheapestStep(sums, k);
      next[k] = sums[k + step] + BENDING * Math.abs(step) + costs[i % count][k];
      steps[k] = step;
    }
    taken.push(steps);
    sums = next;
  }
  let k = sums.indexOf(Math.min(...sums));
  const path = new Array(3 * count);
  for (let i = 3 * count - 1; i > 0; i--) {
    path[i] = k;
    k += taken[i - 1][k];
  }
  return path.slice(count, 2 * count);
}

/** From where on the ray before. @type {(sums: Float32Array, k: number) => number} */
function cheapestStep(sums, k) {
  let [best, least] = [0, sums[k]];
  for (let step = -STEEPEST; step <= STEEPEST; step++) {
    const cost = k + step < 0 || k + step >= sums.length ? Infinity : sums[k + step] + BENDING * Math.abs(step);
    if (cost < least) [best, least] = [step, cost];
  }
  return best;
}
