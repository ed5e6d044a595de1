/**
 * Finding and changing the vertices of a cap. A vertex is named by its ring (in the order of `ringsOf`)
 * and its index there; a vertex of the visible outline and one of the mark at the same place are one.
 *
 * @module
 */

import { ringsOf, withRings } from "./caps.js";

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {{ring: number, index: number}} Vertex */

export const FEWEST = 3;

/**
 * The vertices nearest to a point within `reach`: several only where rings share a place.
 *
 * @param {Cap} cap
 * @param {Point} point
 * @param {number} reach
 * @returns {Vertex[]}
 */
export function nearestVertices(cap, [x, y], reach) {
  let best = reach;
  /** @type {Vertex[]} */
  let found = [];
  ringsOf(cap).forEach((ring, r) => {
    for (let i = 0; i < ring.length; i += 2) {
      const distance = Math.hypot(ring[i] - x, ring[i + 1] - y);
      if (distance > best + 1e-9) continue;
      const same = found.length > 0 && samePlace(cap, found[0], { ring: r, index: i / 2 });
      found = same ? [...found, { ring: r, index: i / 2 }] : [{ ring: r, index: i / 2 }];
      best = distance;
    }
  });
  return found;
}

/** @type {(cap: Cap, a: Vertex, b: Vertex) => boolean} */
function samePlace(cap, a, b) {
  if (a.ring === b.ring) return false;
  const [ax, ay] = vertexAt(cap, a);
  const [bx, by] = vertexAt(cap, b);
  return ax === bx && ay === by;
}

/** @type {(cap: Cap, vertex: Vertex) => Point} */
export function vertexAt(cap, { ring, index }) {
  const points = ringsOf(cap)[ring];
  return [points[2 * index], points[2 * index + 1]];
}

/**
 * The edges nearest to a point within `reach`, each named by the vertex before it, and the point's foot.
 *
 * @param {Cap} cap
 * @param {Point} point
 * @param {number} reach
 * @returns {{edges: Vertex[], foot: Point} | null}
 */
export function nearestEdges(cap, [x, y], reach) {
  let best = reach;
  /** @type {{edges: Vertex[], foot: Point} | null} */
  let found = null;
  ringsOf(cap).forEach((ring, r) => {
    for (let i = 0; i < ring.length; i += 2) {
      const j = (i + 2) % ring.length;
      const foot = footOn(ring[i], ring[i + 1], ring[j], ring[j + 1], x, y);
      const distance = Math.hypot(foot[0] - x, foot[1] - y);
      if (distance > best + 1e-9) continue;
      const edge = { ring: r, index: i / 2 };
      const same =
        found && found.edges[0].ring !== r && foot[0] === found.foot[0] && foot[1] === found.foot[1];
      found = found && same ? { edges: [...found.edges, edge], foot } : { edges: [edge], foot };
      best = distance;
    }
  });
  return found;
}

/** @type {(x0: number, y0: number, x1: number, y1: number, x: number, y: number) => Point} */
function footOn(x0, y0, x1, y1, x, y) {
  const dx = x1 - x0;
  const dy = y1 - y0;
  const length = dx * dx + dy * dy;
  const along = length === 0 ? 0 : Math.min(1, Math.max(0, ((x - x0) * dx + (y - y0) * dy) / length));
  return [x0 + along * dx, y0 + along * dy];
}

/**
 * Moves the vertices by (dx, dy) and pulls the outline along: neighbours within `pull` pixels along the
 * ring follow, less the farther they are. Where vertices are sparser than that, only the grabbed one moves.
 *
 * @param {Cap} cap
 * @param {Vertex[]} vertices
 * @param {{dx: number, dy: number, pull: number}} by
 * @returns {Cap}
 */
export function draggedVertices(cap, vertices, { dx, dy, pull }) {
  const rings = ringsOf(cap).map((ring) => ring.slice());
  for (const { ring, index } of vertices) {
    const weights = pullOf(ringsOf(cap)[ring], index, pull);
    for (const [i, weight] of weights) {
      rings[ring][2 * i] += dx * weight;
      rings[ring][2 * i + 1] += dy * weight;
    }
  }
  return withRings(cap, rings);
}

/**
 * How strongly each vertex follows the one at `index`.
 *
 * @param {number[]} ring
 * @param {number} index
 * @param {number} pull
 * @returns {Map<number, number>}
 */
function pullOf(ring, index, pull) {
  const count = ring.length / 2;
  const weights = new Map([[index, 1]]);
  for (const step of [1, -1]) {
    let along = 0;
    for (let k = 1, last = index; k < count; k++) {
      const i = (index + step * k + count * k) % count;
      along += Math.hypot(ring[2 * i] - ring[2 * last], ring[2 * i + 1] - ring[2 * last + 1]);
      if (along >= pull) break;
      weights.set(i, Math.max(weights.get(i) ?? 0, Math.cos((Math.PI * along) / (2 * pull)) ** 2));
      last = i;
    }
  }
  return weights;
}

/**
 * Puts a vertex at `point` into each of the edges.
 *
 * @param {Cap} cap
 * @param {Vertex[]} edges
 * @param {Point} point
 * @returns {{cap: Cap, vertices: Vertex[]}}
 */
export function insertedVertices(cap, edges, point) {
  const rings = ringsOf(cap).map((ring) => ring.slice());
  const vertices = edges.map(({ ring, index }) => {
    rings[ring].splice(2 * (index + 1), 0, ...point);
    return { ring, index: index + 1 };
  });
  return { cap: withRings(cap, rings), vertices };
}

/**
 * Takes the vertices out; null where a ring would fall below three.
 *
 * @param {Cap} cap
 * @param {Vertex[]} vertices
 * @returns {Cap | null}
 */
export function removedVertices(cap, vertices) {
  const rings = ringsOf(cap).map((ring) => ring.slice());
  for (const { ring, index } of vertices) {
    if (rings[ring].length / 2 <= FEWEST) return null;
    rings[ring].splice(2 * index, 2);
  }
  return withRings(cap, rings);
}

/**
 * The cap without the neighbours that these vertices were put upon: so near that both are one point. A ring
 * keeps three.
 *
 * @param {Cap} cap
 * @param {Vertex[]} vertices
 * @param {number} reach  image pixels
 * @returns {Cap}
 */
export function mergedVertices(cap, vertices, reach) {
  const rings = ringsOf(cap).map((ring) => ring.slice());
  for (const { ring, index } of vertices) {
    const count = rings[ring].length / 2;
    const [x, y] = vertexAt(cap, { ring, index });
    const near = [(index + 1) % count, (index + count - 1) % count].find((other) => {
      const [ox, oy] = vertexAt(cap, { ring, index: other });
      return Math.hypot(ox - x, oy - y) <= reach;
    });
    if (near !== undefined && count > FEWEST) rings[ring].splice(2 * near, 2);
  }
  return withRings(cap, rings);
}

/**
 * Indices of the vertices worth a handle when handles closer than `gap` along the ring would touch.
 *
 * @param {number[]} ring
 * @param {number} gap
 * @returns {number[]}
 */
export function spacedVertices(ring, gap) {
  const kept = [];
  let along = Infinity;
  for (let i = 0; i < ring.length; i += 2) {
    if (i > 0) along += Math.hypot(ring[i] - ring[i - 2], ring[i + 1] - ring[i - 1]);
    if (along < gap) continue;
    kept.push(i / 2);
    along = 0;
  }
  return kept;
}
