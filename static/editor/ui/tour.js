/**
 * A tour of a minute: each step says what to do and goes on when it is done.
 *
 * @module
 */

import { isPrediction } from "../geometry/shapes.js";
import { element } from "./dom.js";

/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {{accepted: number, points: string, marked: number, finished: boolean}} Done  what somebody has done so far */
/** @typedef {{text: string, isDone: (before: Done, now: Done) => boolean}} Step */

const LOOK_MS = 250;

/** @type {Step[]} */
const STEPS = [
  {
    text: "Dashed caps are what the network saw. Click one and press A: you accept it.",
    isDone: (before, now) => now.accepted > before.accepted,
  },
  {
    text: "Press R and draw one stroke along its rim, a little outside: that stretch follows. Ctrl+Z takes it back.",
    isDone: (before, now) => now.points !== before.points,
  },
  {
    text: "With the cap still selected press C and drag from its centre to its rim: the circle marks the centre, also where it is hidden.",
    isDone: (before, now) => now.marked > before.marked,
  },
  {
    text: "Ctrl+Enter says that the photo is done, and opens the next. It asks first while predictions are open.",
    isDone: (_, now) => now.finished,
  },
];

/**
 * @param {HTMLElement} host
 * @param {EditorState} state
 * @returns {() => void} begins the tour, or ends it
 */
export function tourIn(host, state) {
  const words = element("p");
  const skip = element("button", { text: "End the tour", attributes: { type: "button" } });
  const box = element("section", { class: "fairyring-tour", attributes: { "aria-label": "Tour", "aria-live": "polite" } }, words, skip);
  box.dataset.fairyringChrome = "";
  box.hidden = true;
  host.append(box);
  let timer = 0;
  const end = () => {
    clearInterval(timer);
    box.hidden = true;
  };
  const begin = () => {
    let at = 0;
    let before = doneOn(state, state.image?.id ?? 0);
    const image = state.image?.id ?? 0;
    const say = () => {
      words.textContent = at < STEPS.length ? `${at + 1} of ${STEPS.length}. ${STEPS[at].text}` : "That is all it takes. F1 lists the keys.";
      skip.textContent = at < STEPS.length ? "End the tour" : "Close";
    };
    say();
    box.hidden = false;
    timer = window.setInterval(() => {
      const now = doneOn(state, image);
      if (at >= STEPS.length || !STEPS[at].isDone(before, now)) return;
      at += 1;
      before = now;
      say();
    }, LOOK_MS);
  };
  skip.addEventListener("click", end);
  return () => (box.hidden ? begin() : end());
}

/** @type {(state: EditorState, image: number) => Done} */
function doneOn(state, image) {
  const caps = state.items.all.filter((shape) => !isPrediction(shape)).map(({ cap }) => cap);
  return {
    accepted: caps.filter((cap) => cap.prediction !== null).length,
    points: caps.map((cap) => cap.visible.map((ring) => ring.length + ring[0])).join(),
    marked: caps.filter((cap) => cap.mark).length,
    finished: state.image?.id !== image || state.image.status !== "new",
  };
}
