import { boundsOfPoints, grown } from "../../geometry/bounds.js";
import { areaOfRing, insideCap, newCap, placedWhole, polygonOfWhole, rounded } from "../../geometry/caps.js";
import { pointsOf } from "../../geometry/places.js";
import { same } from "../../geometry/same.js";
import { drawnAlong, reachAround, tightened as rimNear } from "../../geometry/tightening.js";
import { seenOf } from "../../geometry/what_is_seen.js";
import { nearestEdges } from "../../geometry/vertices.js";
import { withCap } from "../../geometry/shapes.js";
import { changed } from "../../state/changes.js";

/** @typedef {import("../../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("../../protocol.js").Cap} Cap */
/** @typedef {import("./context.js").Context} Context */
/** @typedef {Pick<Context, "state" | "patch" | "rimIn">} Sight  what is known of where rims are */

const NO_PHOTO = { width: 0, height: 0 };
const SPREAD_PX = 1.5;
const WHICH_CAP = "Select the cap whose outline is to be drawn to its rim.";

/** Draws the outlines of the selected caps to the rims nearby. @type {(context: Context) => Promise<void>} */
export async function tightenSelected(context) {
  const { state, say } = context;
  state.commitDrafts();
  const { image, selected } = state;
  if (selected.length === 0) return say(WHICH_CAP);
  const tight = await Promise.all(selected.map(async (shape) => context.suggested(shape) ?? tightened(context, shape)));
  if (state.image?.id !== image?.id) return;
  // Meanwhile the cap may have become another, or was only stored.
  const changes = selected.flatMap(({ uid, cap }, i) => {
    const [now, after] = [state.items.get(uid), tight[i]];
    return now && after && same(now.cap, cap) ? [changed(now, withCap(now, after))] : [];
  });
  state.commit(changes);
}

/** A cap as it is once its outline is drawn to the rim nearby. @type {(sight: Sight, shape: Shape) => Promise<Cap | null>} */
export async function tightened(sight, shape) {
  const { cap } = shape;
  const placed = placedWhole(cap);
  const ring = placed ? polygonOfWhole(placed) : largestOf(cap.visible);
  if (!ring) return null;
  const { state, patch, rimIn } = sight;
  const bounds = boundsOfPoints(ring);
  const { x0, y0, x1, y1 } = bounds;
  const [photo, seen] = await Promise.all([
    patch(grown(bounds, reachAround(ring))),
    rimIn([x0, y0, x1, y1], shape.uid),
  ]);
  const tight = rimNear(ring, photo, seen);
  const others = othersAround(state, shape, tight);
  const { visible } = seenOf(tight, others, state.image ?? NO_PHOTO);
  if (visible.length === 0) return null;
  if (!placed) return { ...cap, visible: [...visible, ...cap.visible.filter((part) => part !== ring)] };
  const rim = spread(tight).filter(([x, y]) => nearestEdges(newCap({ visible }), [x, y], 0.5) && !isUnder(others, x, y));
  return { ...cap, visible, mark: rounded(drawnAlong(placed, rim)) };
}

/** What may lie in front. @type {(state: EditorState, shape: Shape, ring: number[]) => Shape[]} */
function othersAround(state, { uid }, ring) {
  return state.near(boundsOfPoints(ring)).filter((other) => other.uid !== uid && !other.cap.ignored);
}

/** Points along a ring, a pixel or two apart. @type {(ring: number[]) => Point[]} */
function spread(ring) {
  const points = pointsOf(ring);
  return points.flatMap(([x, y], i) => {
    const [nx, ny] = points[(i + 1) % points.length];
    const count = Math.ceil(Math.hypot(nx - x, ny - y) / SPREAD_PX);
    return Array.from({ length: count }, (_, k) => {
      return /** @type {Point} */ ([x + ((nx - x) * k) / count, y + ((ny - y) * k) / count]);
    });
  });
}

/** Where neighbours meet a rim, it is theirs. @type {(others: Shape[], x: number, y: number) => boolean} */
function isUnder(others, x, y) {
  return others.some(({ cap }) => insideCap(cap, x, y) || nearestEdges(cap, [x, y], SPREAD_PX) !== null);
}

/** @type {(visible: number[][]) => number[] | null} */
function largestOf(visible) {
  return visible.toSorted((a, b) => areaOfRing(b) - areaOfRing(a))[0] ?? null;
}
