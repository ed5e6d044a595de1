/**
 * Everything that can be done without pointing: by key, from the panel, or asked for by the server.
 *
 * @module
 */

import { areaOfRing, circleOfWhole, measure, polygonOfCircle } from "../geometry/caps.js";
import { isPrediction } from "./store.js";

/** @typedef {import("./desk.js").Desk} Desk */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").ToServer} ToServer */
/** @typedef {import("./store.js").Shape} Shape */
/** @typedef {import("../sync/sync.js").Sync} Sync */
/** @typedef {import("../input/tools/tool.js").Tool} Tool */

/**
 * @typedef {Object} Bench  what commands work with
 * @property {Desk} desk
 * @property {Sync} sync
 * @property {() => Tool} tool
 * @property {(name: string) => void} use  takes up a tool
 * @property {(message: ToServer) => boolean} send
 * @property {(layer: string) => void} toggle  shows or hides a layer
 * @property {() => void} help
 * @property {(text: string) => void} say
 */

/** @typedef {(bench: Bench) => void} Run */

/** @type {Record<string, Run>} */
export const COMMANDS = {
  undo: (bench) => travel(bench, "undo"),
  redo: (bench) => travel(bench, "redo"),
  fit: ({ desk }) => desk.lens.fit(),
  zoom_selection: ({ desk }) => (desk.selected.size ? desk.reveal({ close: true }) : desk.lens.fit()),
  zoom_in: ({ desk: { lens } }) => lens.zoomAt(lens.size.width / 2, lens.size.height / 2, 1.25),
  zoom_out: ({ desk: { lens } }) => lens.zoomAt(lens.size.width / 2, lens.size.height / 2, 0.8),
  delete: (bench) => bench.tool().back?.() || bench.desk.deleteSelected(),
  finish: (bench) => bench.tool().finish?.(),
  cancel,
  accept: ({ desk }) => desk.accept(desk.selection),
  accept_all: ({ desk }) => desk.accept(desk.items.filter(isPrediction)),
  doubtful: ({ desk }) => flag(desk, "doubtful"),
  ignored: ({ desk }) => flag(desk, "ignored"),
  raise: ({ desk }) => reorder(desk, 1),
  lower: ({ desk }) => reorder(desk, -1),
  mark: ({ desk }) => desk.changeSelected((cap) => ({ ...cap, mark: cap.mark ? null : outlineAsMark(cap) })),
  convert: ({ desk }) => desk.changeSelected(converted),
  next_cap: ({ desk }) => cycle(desk, 1),
  previous_cap: ({ desk }) => cycle(desk, -1),
  select_all: ({ desk }) =>
    desk.select(desk.items.filter((shape) => !isPrediction(shape)).map(({ uid }) => uid)),
  next_image: ({ desk, send }) => (desk.settle(), send({ type: "step", by: 1 })),
  previous_image: ({ desk, send }) => (desk.settle(), send({ type: "step", by: -1 })),
  done: finishImage,
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
  COMMANDS[`nudge_${name}`] = ({ desk }) => desk.nudge(dx / 4, dy / 4);
  COMMANDS[`push_${name}`] = ({ desk }) => desk.nudge(dx, dy);
}

for (const layer of ["photo", "outline", "fill", "whole", "centre", "label", "prediction"]) {
  COMMANDS[`layer_${layer}`] = ({ toggle }) => toggle(layer);
}

/** @type {(bench: Bench, way: "undo" | "redo") => void} */
function travel({ desk, sync, say }, way) {
  desk.settle();
  const changes = way === "undo" ? sync.undo() : sync.redo();
  if (!changes)
    return say(way === "undo" ? "There is nothing to undo on this image." : "There is nothing to redo.");
  const uids = changes.flatMap(({ before, after }) => (after.deleted ? openAgain(before) : after.uid));
  const known = uids.filter((uid) => desk.item(uid));
  desk.select(known.length <= 20 ? known : [], { reveal: true });
}

/**
 * The prediction that is open again when its annotation is gone.
 *
 * @type {(before: Shape | null) => string[]}
 */
function openAgain(before) {
  return before && before.cap.prediction !== null ? [`prediction:${before.cap.prediction}`] : [];
}

/** @type {Run} */
function cancel({ desk, tool, use }) {
  if (tool().cancel()) return;
  if (desk.selected.size) desk.select([]);
  else use("select");
}

/** All on unless all are on already. @type {(desk: Desk, name: "doubtful" | "ignored") => void} */
function flag(desk, name) {
  const on = desk.selection.some(({ cap }) => !cap[name]);
  desk.changeSelected((cap) => (cap[name] === on ? null : { ...cap, [name]: on }));
}

/** @type {(desk: Desk, by: number) => void} */
function reorder(desk, by) {
  desk.changeSelected((cap) => ({ ...cap, order: (cap.order ?? 0) + by }));
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

/** To the next cap in reading order. @type {(desk: Desk, by: number) => void} */
function cycle(desk, by) {
  const order = desk.pickable
    .map((shape) => ({ uid: shape.uid, key: readingKey(shape) }))
    .sort((a, b) => a.key - b.key);
  if (order.length === 0) return;
  const here = order.findIndex(({ uid }) => desk.selected.has(uid));
  const start = here < 0 && by < 0 ? 0 : here;
  desk.select([order[(start + by + order.length) % order.length].uid], { reveal: true });
}

/** Rows of 64 pixels, each from left to right. @type {(shape: Shape) => number} */
function readingKey({ cap }) {
  const bounds = measure(cap).bounds ?? { x0: 0, x1: 0, y0: 0, y1: 0 };
  return Math.floor((bounds.y0 + bounds.y1) / 128) * 1e6 + bounds.x0 + bounds.x1;
}

/** @type {Run} */
function finishImage({ desk, send }) {
  if (!desk.image) return;
  desk.settle();
  send({ type: "status", image: desk.image.id, status: "annotated" });
  send({ type: "step", by: 1 });
}
