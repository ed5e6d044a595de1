/**
 * What a person sees of an undo or a redo.
 *
 * @module
 */

import { uidOfPrediction } from "../geometry/shapes.js";
import { wordsOfChanges } from "../state/words_of_changes.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("../sync/sync.js").Travelled} Travelled */
/** @typedef {import("../sync/sync.js").Way} Way */

/** More caps than these are not selected. */
const MOST_SELECTED = 20;

const OUT_OF_SIGHT = "That was out of sight; Z shows it.";
const DONE = { undo: "Taken back", redo: "Done again" };

/** Why nothing can be taken back or done again. */
const STUCK = {
  nothing: {
    undo: "There is nothing to undo on this image.",
    redo: "There is nothing to redo.",
  },
  offline: {
    undo: "What was done before this page was loaded can be undone when the server is back.",
    redo: "What was undone before this page was loaded can be done again when the server is back.",
  },
};

/**
 * @param {EditorState} state
 * @param {Object} how
 * @param {(image: number, select: null) => void} how.open
 * @param {(text: string, level?: "info" | "warning") => void} how.say
 * @param {(text: string) => void} how.tell  in place of what was told before
 * @param {(uid: string, way: Way) => void} how.said  what was said of a cap is taken back, or said again
 */
export function travelIn(state, { open, say, tell, said }) {
  /** The one cap that was selected last: what was done to its neighbours on the way was done to it. @type {string | null} */
  let inHand = null;
  state.selection.changed.listen((_before, now) => {
    if (now.length) inHand = now.length === 1 ? now[0] : null;
  });
  return {
    /** @type {(travelled: Travelled) => void} */
    travelled({ image, way, changes, stayed, verdict }) {
      // Of a status the server says what it is again.
      const words = verdict ? `what you said of ${verdict.annotation ? "a cap" : "the image"}` : wordsOfChanges(way === "undo" ? changes.map(turned) : changes);
      if (words) tell(`${DONE[way]}: ${words}.`);
      if (stayed) say(`${stayed} of these caps were changed since and stay as they are.`);
      if (image !== state.image?.id) return open(image, null);
      const own = changes.filter(({ before, after }) => [before, after].some((shape) => shape && isOf(shape, inHand)));
      const seen = own.length ? own : changes;
      const uids = seen.flatMap(({ before, after }) => (after.deleted ? openAgain(before) : after.uid));
      const known = uids.filter((uid) => state.items.get(uid));
      if (verdict?.annotation) said(verdict.annotation, way);
      if (changes.length) state.select(known.length <= MOST_SELECTED ? known : []);
      // The view stays where it is: whoever works there may not want to be taken away.
      if (state.selected.length && !state.selectionOnScreen) say(OUT_OF_SIGHT);
    },
    /** @type {(why: keyof typeof STUCK, way: Way) => void} */
    stuck: (why, way) => say(STUCK[why][way], "warning"),
  };
}

/** As it was done before it was taken back. @type {(change: Travelled["changes"][number]) => import("../state/words_of_changes.js").Became} */
function turned({ before, after }) {
  return { before: after, after: before };
}

/** Whether it is this one, or the annotation of this prediction. @type {(shape: Shape, uid: string | null) => boolean} */
function isOf({ uid, cap }, other) {
  return uid === other || (cap.prediction !== null && uidOfPrediction(cap.prediction) === other);
}

/**
 * The prediction that is open again when its annotation is gone.
 *
 * @type {(before: Shape | null) => string[]}
 */
function openAgain(before) {
  return before && before.cap.prediction !== null ? [uidOfPrediction(before.cap.prediction)] : [];
}
