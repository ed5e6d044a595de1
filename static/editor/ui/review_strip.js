/**
 * The line over the photo that tells a reviewer how many differences there are, which one is selected, and what the
 * lines mean.
 *
 * @module
 */

import DECLARED from "../commands.js";
import { COLOURS } from "../render/palette.js";
import { heirsIn } from "../state/changes.js";
import { partnerOf } from "../state/deciding.js";
import { Standing } from "../state/standing.js";
import { element } from "./dom.js";

/** @typedef {import("../protocol.js").ComparedCap} ComparedCap */
/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("../state/review.js").Review} Review */

/** What a reviewer needs at every image, with its key. */
const KEYS = ["next_difference", "take_models", "take_annotators", "approve", "send_back", "reject"];

/** @type {(host: HTMLElement, state: EditorState, review: Review) => void} */
export function reviewStripIn(host, state, review) {
  const counter = element("strong");
  const kind = element("span");
  const centres = lineOf("", COLOURS.selected);
  const other = lineOf("", COLOURS.predicted, "5 3");
  const first = lineOf("", COLOURS.outline);
  const key = element("div", {}, first, other, centres);
  const told = element("div", { attributes: { role: "status" } }, counter, kind);
  const keys = element("div", {});
  const strip = element("div", { class: "fairyring-review" }, told, key, keys);
  strip.dataset.fairyringChrome = "";
  host.append(strip);
  const update = () => {
    const { image } = state;
    strip.hidden = !review.on || !image;
    if (strip.hidden || !image) return;
    const known = review.image === image.id;
    const cap = known ? review.selected(state) : null;
    counter.textContent = known ? countWords(new Standing(state, review)) : "Comparing…";
    kind.textContent = cap ? kindWords(state, review, cap) : "";
    first.lastChild?.replaceWith(review.second ? "first annotator’s" : "annotator’s");
    other.lastChild?.replaceWith(review.second ? `second annotator’s: ${review.second}` : "model’s");
    keys.replaceChildren(...keysOf(KEYS, review.second));
    centres.lastChild?.replaceWith(`between centres${review.times > 1 ? ` × ${review.times}` : ""}`);
  };
  review.changed.listen(update);
  state.signals.selection.listen(update);
  state.store.changed.listen(update);
  update();
}

/** @type {(standing: Pick<Standing, "at" | "done" | "total" | "left">) => string} */
export function countWords({ at, done, total, left }) {
  const differences = total === 1 ? "difference" : "differences";
  if (total === 0) return "No differences";
  if (left.length === 0) return `All ${total} ${differences} decided`;
  if (at < 0 && done === 0) return `${total} ${differences}`;
  if (at < 0) return `${left.length} of ${total} ${differences} left`;
  return `${done + at + 1} of ${total} ${differences}`;
}

/** How what was annotated and what was predicted differ. @type {(state: EditorState, review: Review, cap: ComparedCap) => string} */
export function kindWords(state, review, cap) {
  const { annotation, prediction, iou, cdr, floor } = cap;
  const isMoved = partnerOf(state, review, cap) !== null;
  if (annotation && !prediction) return isMoved ? "missed: moved off its prediction" : `missed: ${review.second ?? "the model"} has no such cap`;
  if (!annotation && prediction) {
    if (isMoved) return "extra: its cap was moved away";
    if (heirsIn(state.store).get(prediction.id)?.deleted) return "extra: turned down";
    return review.second ? `extra: only ${review.second} has it` : "extra: nobody has drawn it";
  }
  const centres = cdr === null ? "no mark" : `CDR ${cdr.toFixed(2)} %, floor ${floor?.toFixed(2) ?? "–"} %`;
  return `${centres}, IoU ${iou?.toFixed(2) ?? "–"}`;
}

/** The keys of commands, each with what it does, to a second annotator's version where one is compared. @type {(names: string[], second: string | null) => HTMLElement[]} */
function keysOf(names, second) {
  /** @type {{name: string, keys: string[], label?: string, second?: {label: string}}[]} */
  const declared = DECLARED.groups.flatMap(({ commands }) => commands);
  return declared.filter(({ name }) => names.includes(name)).map(({ keys: [key = ""], label = "", second: besides }) => {
    const words = (second !== null && besides?.label) || label;
    return element("span", {}, element("kbd", { text: key }), document.createTextNode(` ${words}`));
  });
}

/** Words after a piece of their line. @type {(words: string, colour: string, dash?: string) => HTMLElement} */
function lineOf(words, colour, dash = "") {
  const line = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  line.setAttribute("viewBox", "0 0 28 6");
  line.innerHTML = '<path d="M1 3h26" fill="none" stroke-width="3" />';
  line.firstElementChild?.setAttribute("stroke", colour);
  line.firstElementChild?.setAttribute("stroke-dasharray", dash);
  return element("span", {}, line, document.createTextNode(words));
}
