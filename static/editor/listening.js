/**
 * Everything on the page that the editor listens to: keys, the panel, the window, the address.
 *
 * @module
 */

import { bringFocusBack } from "./input/focus.js";
import { listenToKeys } from "./input/keyboard.js";
import { keepPlace } from "./ui/address.js";
import { listenToArcs } from "./ui/arc_choices.js";
import { nameFields } from "./ui/field_names.js";
import { legendIn } from "./ui/legend.js";
import { listenToPanel } from "./ui/panel.js";
import { listenToPlots } from "./ui/plots.js";
import { showProgress } from "./ui/progress.js";
import { listenToTags } from "./ui/tags.js";
import { reviewStripIn } from "./ui/review_strip.js";
import { takePhotos } from "./ui/uploads.js";
import { followView } from "./ui/view_controls.js";
import { hideNoteOnSlowWebGL } from "./ui/viser_notes.js";
import { zoomButtonsIn } from "./ui/zoom_buttons.js";

/**
 * @typedef {Object} Parts  of the editor that hear of it
 * @property {HTMLElement} host
 * @property {import("./state/editor_state.js").EditorState} state
 * @property {import("./input/pointer.js").Pointer} pointer
 * @property {import("./input/toolbox.js").Toolbox} toolbox
 * @property {import("./render/frame.js").Frame} frame
 * @property {import("./sync/sync.js").Sync} sync
 * @property {import("./sync/kept_drawings.js").KeptDrawings} drawings
 * @property {ReturnType<typeof import("./going.js").goingIn>} going
 * @property {import("./reviewing.js").Reviewing} reviewing
 * @property {(command: string) => boolean} perform
 * @property {(message: import("./protocol.js").ToServer) => void} send
 * @property {import("./ui/notices.js").Say} say
 * @property {() => void} progress  more or fewer edits wait to be stored
 */

/** @type {(parts: Parts) => void} */
export function listen(parts) {
  const { host, state, going, perform, say } = parts;
  listenToInput(parts);
  listenToTags(() => state.image, parts.send, say);
  listenToArcs(state);
  reviewStripIn(host, state, parts.reviewing.review);
  const legend = legendIn(host);
  state.look.changed.listen((_, { colouring }) => legend(colouring));
  followView(state.layers, state.look);
  zoomButtonsIn(host, perform);
  nameFields();
  hideNoteOnSlowWebGL();
  takePhotos(host, say);
  bringFocusBack(host);
  showProgress(state);
  keepPlace(state, (image, cap) => going.open(image, cap));
  state.signals.selection.listen(() => going.tellSelection());
  state.signals.nudge.listen(() => parts.progress());
  listenToWindow(parts);
}

/** @type {(parts: Parts) => void} */
function listenToInput({ state, pointer, toolbox, frame, going, sync, reviewing, perform, send }) {
  listenToKeys({
    perform,
    state,
    pointer,
    sweep: (held) => toolbox.sweep(held),
    pressed: (at) => frame.causedBy(at, "key"),
  });
  const compare = () => void (reviewing.review.on = true);
  listenToPanel({
    perform,
    use: (name) => toolbox.use(name),
    open: (image, select) => going.open(image, select),
    takeBack: (image, changeSet) => {
      state.commitDrafts();
      sync.takeBack(image, changeSet);
    },
    send,
    compare,
  });
  listenToPlots((image, select) => going.open(image, select), compare);
}

/** @type {(parts: Parts) => void} */
function listenToWindow({ host, state, toolbox, sync, drawings }) {
  new ResizeObserver(([entry]) => state.viewport.resize(entry.contentRect)).observe(host);
  window.addEventListener("beforeunload", (event) => {
    toolbox.leave();
    if (!sync.kept || !drawings.kept) event.preventDefault();
  });
  window.addEventListener("pagehide", () => drawings.write());
}
