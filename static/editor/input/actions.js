/**
 * What every command of `commands.js` does, by its name.
 *
 * @module
 */

import DECLARED from "../commands.js";
import { areaOfRing, circleOfWhole, measure, polygonOfCircle } from "../geometry/caps.js";
import { isPrediction, uidOfPrediction } from "../geometry/shapes.js";
import { acceptAll, acceptSelected, changeSelected, deleteSelected, nudge } from "../state/edits.js";
import { commandOfLayer } from "./keys.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").ToServer} ToServer */
/** @typedef {import("../state/changes.js").Change} Change */
/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tools/tool.js").Tool} Tool */

/**
 * @typedef {Object} Context  what commands work with
 * @property {EditorState} state
 * @property {() => Tool} tool
 * @property {(name: string) => void} use  takes up a tool
 * @property {() => void} finish  closes the outline that is half drawn
 * @property {() => Change[] | null} undo  null where there is nothing to undo
 * @property {() => Change[] | null} redo
 * @property {(message: ToServer) => boolean} send
 * @property {(layer: string) => void} toggle  shows or hides a layer
 * @property {() => void} switchFocus  from the photo to the panel, and back
 * @property {() => void} help
 * @property {(text: string) => void} say
 */

/** @typedef {(context: Context) => unknown} Action  false where there was nothing to do, and the key is the browser's */

const MARKED = "What is selected is marked already; Shift+M takes marks away.";
const HALF_DRAWN = "An outline is still half drawn on this image: Enter closes it, W and Esc drop it.";

/** @type {Record<string, Action>} */
export const ACTIONS = {
  undo: (context) =>
    context.tool().undo?.() || travel(context, context.undo, "There is nothing to undo on this image."),
  redo: (context) => context.tool().redo?.() || travel(context, context.redo, "There is nothing to redo."),
  fit: ({ state }) => state.viewport.showAll(),
  zoom_selection: ({ state }) =>
    state.selection.uids.size ? state.reveal({ close: true }) : state.viewport.showAll(),
  zoom_in: ({ state }) => zoom(state, 1.25),
  zoom_out: ({ state }) => zoom(state, 0.8),
  delete: ({ state, tool }) => tool().back?.() || deleteSelected(state),
  finish: ({ finish }) => finish(),
  cancel,
  accept: ({ state }) => acceptSelected(state),
  accept_all: ({ state }) => acceptAll(state),
  doubtful: ({ state }) => flag(state, "doubtful"),
  ignored: ({ state }) => flag(state, "ignored"),
  raise: ({ state }) => reorder(state, 1),
  lower: ({ state }) => reorder(state, -1),
  mark: markSelected,
  unmark: ({ state }) => changeSelected(state, (cap) => (cap.mark ? { ...cap, mark: null } : null)),
  convert: ({ state }) => changeSelected(state, converted),
  next_cap: ({ state }) => cycle(state, 1),
  previous_cap: ({ state }) => cycle(state, -1),
  select_all: ({ state }) =>
    state.select(state.visible.filter((shape) => !isPrediction(shape)).map(({ uid }) => uid)),
  next_image: (context) => step(context, 1),
  previous_image: (context) => step(context, -1),
  done: finishImage,
  switch_focus: ({ switchFocus }) => switchFocus(),
  help: ({ help }) => help(),
  select: ({ use }) => use("select"),
  polygon: ({ use }) => use("polygon"),
  circle: ({ use }) => use("circle"),
  pan: ({ use }) => use("pan"),
};

for (const [name, dx, dy] of /** @type {[string, number, number][]} */ ([
  ["left", -1, 0],
  ["right", 1, 0],
  ["up", 0, -1],
  ["down", 0, 1],
])) {
  ACTIONS[`nudge_${name}`] = ({ state }) => nudge(state, dx / 4, dy / 4);
  ACTIONS[`push_${name}`] = ({ state }) => nudge(state, dx, dy);
}

for (const { name } of DECLARED.layers) ACTIONS[commandOfLayer(name)] = ({ toggle }) => toggle(name);

/** @type {(context: Context, move: () => Change[] | null, nothing: string) => void} */
function travel({ state, say }, move, nothing) {
  state.commitDrafts();
  const changes = move();
  if (!changes) return say(nothing);
  const uids = changes.flatMap(({ before, after }) => (after.deleted ? openAgain(before) : after.uid));
  const known = uids.filter((uid) => state.items.get(uid));
  state.select(known.length <= 20 ? known : []);
  state.glimpse();
}

/** @type {(state: EditorState, factor: number) => void} */
function zoom({ viewport }, factor) {
  viewport.zoomAt(viewport.size.width / 2, viewport.size.height / 2, factor);
}

/** @type {(context: Context, by: 1 | -1) => void} */
function step({ state, send }, by) {
  state.commitDrafts();
  send({ type: "step", by });
}

/**
 * The prediction that is open again when its annotation is gone.
 *
 * @type {(before: Shape | null) => string[]}
 */
function openAgain(before) {
  return before && before.cap.prediction !== null ? [uidOfPrediction(before.cap.prediction)] : [];
}

/** @type {(context: Context) => void} */
function cancel({ state, tool, use }) {
  if (tool().cancel()) return;
  if (state.selection.uids.size) state.select([]);
  else use("select");
}

/**
 * Gives a mark to those that have none; a mark that somebody placed is taken away by another key.
 *
 * @type {(context: Context) => void}
 */
function markSelected({ state, say }) {
  const { selected } = state;
  if (selected.length && selected.every(({ cap }) => cap.mark)) say(MARKED);
  changeSelected(state, (cap) => (cap.mark ? null : { ...cap, mark: outlineAsMark(cap) }));
}

/** All on unless all are on already. @type {(state: EditorState, name: "doubtful" | "ignored") => void} */
function flag(state, name) {
  const on = state.selected.some(({ cap }) => !cap[name]);
  changeSelected(state, (cap) => (cap[name] === on ? null : { ...cap, [name]: on }));
}

/** @type {(state: EditorState, by: number) => void} */
function reorder(state, by) {
  changeSelected(state, (cap) => ({ ...cap, order: (cap.order ?? 0) + by }));
}

/**
 * The largest part, as that is where the rim shows.
 *
 * @type {(cap: Cap) => import("../protocol.js").Polygon | null}
 */
function outlineAsMark({ visible }) {
  if (visible.length === 0) return null;
  const points = visible.reduce((a, b) => (areaOfRing(b) > areaOfRing(a) ? b : a));
  return { kind: "polygon", points };
}

/**
 * A circle mark becomes a polygon mark of the same centre, anything else a circle mark.
 *
 * @type {(cap: Cap, shape: Shape) => Cap | null}
 */
function converted(cap, { whole }) {
  if (cap.mark?.kind === "circle") {
    return { ...cap, mark: { kind: "polygon", points: polygonOfCircle(cap.mark) } };
  }
  return whole && { ...cap, mark: circleOfWhole(whole) };
}

/**
 * To the next cap in reading order; from the last one the key leads on into the page.
 *
 * @type {(state: EditorState, by: number) => boolean}
 */
function cycle(state, by) {
  const order = state.visible
    .map((shape) => ({ uid: shape.uid, key: readingKey(shape) }))
    .sort((a, b) => a.key - b.key);
  const here = order.findIndex(({ uid }) => state.selection.has(uid));
  const next = order.at(here < 0 && by < 0 ? -1 : here + by);
  if (!next || here + by >= order.length || (here === 0 && by < 0)) return false;
  state.select([next.uid], { reveal: true });
  return true;
}

/** Rows of 64 pixels, each from left to right. @type {(shape: Shape) => number} */
function readingKey({ cap }) {
  const bounds = measure(cap).bounds ?? { x0: 0, x1: 0, y0: 0, y1: 0 };
  return Math.floor((bounds.y0 + bounds.y1) / 128) * 1e6 + bounds.x0 + bounds.x1;
}

/** @type {(context: Context) => void} */
function finishImage({ state, send, say }) {
  if (!state.image) return;
  if (!state.halfDrawn.empty) return say(HALF_DRAWN);
  state.commitDrafts();
  send({ type: "status", image: state.image.id, status: "annotated" });
  send({ type: "step", by: 1 });
}
