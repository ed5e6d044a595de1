/**
 * Circles and ellipses by points of their rim, for what a hand is placing. What is kept is fitted by the server.
 *
 * @module
 */

/** @typedef {import("../protocol.js").Circle} Circle */
/** @typedef {import("../protocol.js").Ellipse} Ellipse */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {[number, number, number]} Triple */

/** From so many points on they tell an ellipse. */
export const FEWEST_OF_ELLIPSE = 5;
/** Longer than this, in units of the shorter axis, points tell no ellipse but a line. */
const LONGEST = 8;

/** Through three points, else nearest to them by least squares; null where they lie on a line. @type {(points: Point[]) => Circle | null} */
export function circleBy(points) {
  if (points.length < 3) return null;
  const { middle, scale, all } = normalised(points);
  // x² + y² + D x + E y + F = 0, linear in D, E, F.
  const rows = all.map(([x, y]) => /** @type {Triple} */ ([x, y, 1]));
  const solution = leastSquares(rows, all.map(([x, y]) => -(x * x + y * y)));
  if (!solution) return null;
  const [d, e, f] = solution;
  const square = (d * d + e * e) / 4 - f;
  if (!(square > 0)) return null;
  const r = Math.sqrt(square) * scale;
  return { kind: "circle", cx: middle[0] - (d / 2) * scale, cy: middle[1] - (e / 2) * scale, r };
}

/**
 * Nearest to five points or more by the direct least squares of Halíř and Flusser (1998); null where they tell
 * none.
 *
 * @type {(points: Point[]) => Ellipse | null}
 */
export function ellipseBy(points) {
  if (points.length < FEWEST_OF_ELLIPSE) return null;
  const { middle, scale, all } = normalised(points);
  const conic = conicBy(all);
  const ellipse = conic && ellipseOfConic(conic);
  if (!ellipse || ellipse.a > LONGEST * ellipse.b) return null;
  const { cx, cy, a, b, theta_deg } = ellipse;
  const [x, y] = [middle[0] + cx * scale, middle[1] + cy * scale];
  return { kind: "ellipse", cx: x, cy: y, a: a * scale, b: b * scale, theta_deg };
}

/** Around zero, about one away from it. @type {(points: Point[]) => {middle: Point, scale: number, all: Point[]}} */
function normalised(points) {
  const count = points.length;
  const cx = points.reduce((sum, [x]) => sum + x, 0) / count;
  const cy = points.reduce((sum, [, y]) => sum + y, 0) / count;
  const scale = points.reduce((sum, [x, y]) => sum + Math.hypot(x - cx, y - cy), 0) / count || 1;
  const all = points.map(([x, y]) => /** @type {Point} */ ([(x - cx) / scale, (y - cy) / scale]));
  return { middle: [cx, cy], scale, all };
}

/** The coefficients of x², xy, y², x, y, 1. @type {(points: Point[]) => number[] | null} */
function conicBy(points) {
  const quadratic = points.map(([x, y]) => /** @type {Triple} */ ([x * x, x * y, y * y]));
  const linear = points.map(([x, y]) => /** @type {Triple} */ ([x, y, 1]));
  const [s1, s2, s3] = [product(quadratic, quadratic), product(quadratic, linear), product(linear, linear)];
  const inverse = inverted(s3);
  if (!inverse) return null;
  const t = times(inverse, transposed(s2)).map((row) => row.map((value) => -value));
  const m = times(s2, t).map((row, i) => row.map((value, k) => value + s1[i][k]));
  const reduced = [m[2].map((v) => v / 2), m[1].map((v) => -v), m[0].map((v) => v / 2)];
  for (const value of eigenvalues(reduced)) {
    const vector = nullVector(reduced.map((row, i) => row.map((v, k) => v - (i === k ? value : 0))));
    if (4 * vector[0] * vector[2] - vector[1] ** 2 <= 0) continue;
    return [...vector, ...t.map((row) => dot(row, vector))];
  }
  return null;
}

/** @type {(conic: number[]) => Omit<Ellipse, "kind"> | null} */
function ellipseOfConic([a, b, c, d, e, f]) {
  const det = 4 * a * c - b * b;
  const cx = (b * e - 2 * c * d) / det;
  const cy = (b * d - 2 * a * e) / det;
  const value = f + (d * cx + e * cy) / 2;
  const half = Math.hypot(a - c, b) / 2;
  // By the smaller eigenvalue of the quadratic form the longer axis.
  const axes = [(a + c) / 2 - half, (a + c) / 2 + half].map((eigen) => Math.sqrt(-value / eigen));
  const [long, short] = axes.toSorted((p, q) => q - p);
  if (!(short > 0) || !Number.isFinite(long)) return null;
  const tilt = 0.5 * Math.atan2(b, a - c) + (a + c > 0 ? Math.PI / 2 : 0);
  const theta_deg = (((tilt * 180) / Math.PI) % 180 + 180) % 180;
  return { cx, cy, a: long, b: short, theta_deg };
}

/** Real roots of the characteristic polynomial. @type {(m: number[][]) => number[]} */
function eigenvalues(m) {
  const trace = m[0][0] + m[1][1] + m[2][2];
  const minors =
    m[0][0] * m[1][1] - m[0][1] * m[1][0] + m[0][0] * m[2][2] - m[0][2] * m[2][0] + m[1][1] * m[2][2] - m[1][2] * m[2][1];
  const shift = trace / 3;
  const p = minors - trace * shift;
  const q = -2 * shift ** 3 + shift * minors - determinant(m);
  const inside = (q / 2) ** 2 + (p / 3) ** 3;
  if (inside > 0) {
    const root = Math.sqrt(inside);
    return [Math.cbrt(-q / 2 + root) + Math.cbrt(-q / 2 - root) + shift];
  }
  const radius = 2 * Math.sqrt(-p / 3);
  const angle = Math.acos(Math.min(1, Math.max(-1, (3 * q) / (p * radius)))) || 0;
  return [0, 1, 2].map((k) => radius * Math.cos((angle - 2 * Math.PI * k) / 3) + shift);
}

/** What a matrix of rank two makes zero of. @type {(m: number[][]) => Triple} */
function nullVector([a, b, c]) {
  const candidates = [cross(a, b), cross(b, c), cross(a, c)];
  return candidates.reduce((best, each) => (dot(each, each) > dot(best, best) ? each : best));
}

/** @type {(rows: Triple[], values: number[]) => Triple | null} */
function leastSquares(rows, values) {
  const inverse = inverted(product(rows, rows));
  if (!inverse) return null;
  const right = [0, 1, 2].map((k) => rows.reduce((sum, row, i) => sum + row[k] * values[i], 0));
  return [dot(inverse[0], right), dot(inverse[1], right), dot(inverse[2], right)];
}

/** aᵀ b, of rows. @type {(a: number[][], b: number[][]) => number[][]} */
function product(a, b) {
  return [0, 1, 2].map((i) => [0, 1, 2].map((k) => a.reduce((sum, row, n) => sum + row[i] * b[n][k], 0)));
}

/** @type {(a: number[][], b: number[][]) => number[][]} */
function times(a, b) {
  return a.map((row) => [0, 1, 2].map((k) => row.reduce((sum, value, n) => sum + value * b[n][k], 0)));
}

/** @type {(m: number[][]) => number[][]} */
function transposed(m) {
  return [0, 1, 2].map((i) => m.map((row) => row[i]));
}

/** @type {(m: number[][]) => number} */
function determinant([a, b, c]) {
  return dot(a, cross(b, c));
}

/** @type {(m: number[][]) => number[][] | null} */
function inverted(m) {
  const size = determinant(m);
  if (!(Math.abs(size) > 1e-9)) return null;
  const [a, b, c] = m;
  return transposed([cross(b, c), cross(c, a), cross(a, b)]).map((row) => row.map((value) => value / size));
}

/** @type {(a: number[], b: number[]) => number} */
function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** @type {(a: number[], b: number[]) => Triple} */
function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
