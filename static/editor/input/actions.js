/**
 * What every command of `commands.js` does, by its name.
 *
 * @module
 */

import DECLARED from "../commands.js";
import { areaOfRing, circleOfWhole, measure, polygonOfCircle } from "../geometry/caps.js";
import { isPrediction } from "../geometry/shapes.js";
import { questionOf } from "../state/finishing.js";
import { acceptAll, acceptSelected, changeSelected, deleteSelected, nudge } from "../state/edits.js";
import { commandOfLayer } from "./keys.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Status} Status */
/** @typedef {import("../protocol.js").ToServer} ToServer */
/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tools/tool.js").Tool} Tool */
/** @typedef {import("../state/finishing.js").Question} Question */

/**
 * @typedef {Object} Context  what commands work with
 * @property {EditorState} state
 * @property {() => Tool} tool
 * @property {(name: string) => void} use  takes up a tool
 * @property {() => void} finish  closes the outline that is half drawn
 * @property {() => void} undo
 * @property {() => void} redo
 * @property {(status: Status) => void} setStatus  of the image on screen
 * @property {(question: Question) => Promise<boolean>} ask
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
  undo: ({ state, tool, undo }) => tool().undo?.() || (state.commitDrafts(), undo()),
  redo: ({ state, tool, redo }) => tool().redo?.() || (state.commitDrafts(), redo()),
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
  done: (context) => void finishImage(context),
  to_do: ({ state, setStatus }) => (state.commitDrafts(), setStatus("new")),
  annotated: (context) => void finishAs(context, "annotated"),
  approved: (context) => void finishAs(context, "approved"),
  switch_focus: ({ switchFocus }) => switchFocus(),
  help: ({ help }) => help(),
  select: ({ use }) => use("select"),
  polygon: ({ use }) => use("polygon"),
  circle: ({ use }) => use("circle"),
  rim: ({ use }) => use("rim"),
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

/** @type {(state: EditorState, factor: number) => void} */
function zoom({ viewport }, factor) {
  viewport.zoomAt(viewport.size.width / 2, viewport.size.height / 2, factor);
}

/** @type {(context: Context, by: 1 | -1) => void} */
function step({ state, send }, by) {
  state.commitDrafts();
  send({ type: "step", by });
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

/** @type {(context: Context) => Promise<void>} */
async function finishImage(context) {
  const { image } = context.state;
  if (image && (await finishAs(context, "annotated"))) context.send({ type: "step", by: 1 });
}

/**
 * Says something of the image. Predictions that nobody has looked at are asked about first: without them the
 * photo teaches that there are no caps where they are.
 *
 * @param {Context} context
 * @param {"annotated" | "approved"} status
 * @returns {Promise<boolean>} whether it was said
 */
async function finishAs({ state, setStatus, ask, say }, status) {
  state.commitDrafts();
  const { image } = state;
  if (!image) return false;
  if (!state.halfDrawn.empty) {
    say(HALF_DRAWN);
    return false;
  }
  const open = state.items.all.filter(isPrediction).length;
  const counts = { name: image.file_name, open, caps: state.items.all.length - open };
  if (open && !(await ask(questionOf(status, counts)))) return false;
  if (state.image?.id !== image.id) return false;
  setStatus(status);
  return true;
}
