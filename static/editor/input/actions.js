/**
 * What every command of `commands.js` does, by its name.
 *
 * @module
 */

import DECLARED from "../commands.js";
import { isPrediction } from "../geometry/shapes.js";
import { acceptSelected, changeSelected, deleteMeant, nudge } from "../state/edits.js";
import { cancel, cycle } from "./actions/choosing.js";
import { copySelected, mergeSelected, pasteBefore, pasteCopied } from "./actions/copying.js";
import { finishAs, finishImage, step } from "./actions/image.js";
import { converted, flag, markSelected, reorder } from "./actions/marking.js";
import { tightenSelected } from "./actions/tightening.js";
import {
  approveAndGoOn,
  comment,
  reject,
  sendBack,
  takeAnnotators,
  takeModels,
  toggleReview,
  walkDifferences,
} from "./actions/reviewing.js";
import { acceptFrom, check, goToOpen, ignoreBuds } from "./actions/walking.js";
import { commandOfLayer } from "./keys.js";

/** @typedef {import("./actions/context.js").Action} Action */

/** @type {Record<string, Action>} */
export const ACTIONS = {
  undo: ({ state, tool, undo }) => tool().undo?.() || (state.commitDrafts(), undo()),
  redo: ({ state, tool, redo }) => tool().redo?.() || (state.commitDrafts(), redo()),
  fit: ({ state }) => state.viewport.showAll(),
  zoom_selection: ({ state }) =>
    state.selection.uids.size ? state.reveal({ close: true }) : state.viewport.showAll(),
  zoom_in: ({ state }) => state.viewport.zoomBy(1.25),
  zoom_out: ({ state }) => state.viewport.zoomBy(0.8),
  delete: ({ state, tool }) => tool().back?.() || deleteMeant(state),
  finish: ({ finish }) => finish(),
  cancel,
  accept: ({ state }) => acceptSelected(state),
  accept_all: (context) => void acceptFrom(context),
  check,
  next_open: goToOpen,
  ignore_buds: ignoreBuds,
  doubtful: ({ state }) => flag(state, "doubtful"),
  ignored: ({ state }) => flag(state, "ignored"),
  raise: ({ state }) => reorder(state, 1),
  lower: ({ state }) => reorder(state, -1),
  tighten: (context) => void tightenSelected(context),
  merge: mergeSelected,
  copy: copySelected,
  paste: pasteCopied,
  paste_before: pasteBefore,
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
  review: toggleReview,
  next_difference: (context) => void walkDifferences(context, 1),
  previous_difference: (context) => void walkDifferences(context, -1),
  take_models: takeModels,
  take_annotators: takeAnnotators,
  approve: (context) => void approveAndGoOn(context),
  send_back: (context) => void sendBack(context),
  reject: (context) => void reject(context),
  comment: (context) => void comment(context),
  mark_again: ({ markAgain }) => markAgain({ quiet: false }),
  magnify: ({ review }) => review.magnify(),
  blink: ({ blink }) => blink(),
  loupe: ({ state }) => state.look.set({ loupe: !state.look.now.loupe }),
  plain_photo: ({ state }) => state.look.reset(),
  switch_focus: ({ switchFocus }) => switchFocus(),
  help: ({ help }) => help(),
  tour: ({ tour }) => tour(),
  select: ({ use }) => use("select"),
  polygon: ({ use }) => use("polygon"),
  circle: ({ use }) => use("circle"),
  rim_points: ({ use }) => use("rim_points"),
  rim: ({ use }) => use("rim"),
  split: ({ use }) => use("split"),
  arcs: ({ use }) => use("arcs"),
  point: ({ use }) => use("point"),
  part: ({ drawPart }) => drawPart(),
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
