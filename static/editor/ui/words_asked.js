/**
 * Asks for a reason or a comment, and whether it is about the selected cap or the whole image. Enter says it,
 * Ctrl+Enter says it of the other one, Shift+Enter begins a new line, Escape says nothing.
 *
 * @module
 */

import { element } from "./dom.js";

/** @typedef {import("../state/review.js").Said} Said */
/** @typedef {import("../state/review.js").WordsQuestion} WordsQuestion */

const LABELS = { cap: "This cap", image: "The whole image" };

/** @type {(question: WordsQuestion) => Promise<Said | null>} */
export function askWords({ question, cap, first }) {
  const main = cap ? first : "image";
  const other = cap ? (main === "cap" ? "image" : "cap") : null;
  const field = element("textarea", { attributes: { rows: "3", maxlength: "2000", "aria-label": question } });
  const button = (/** @type {"cap" | "image"} */ about, /** @type {string} */ keys) =>
    element("button", { text: `${LABELS[about]} (${keys})`, attributes: { type: "submit", value: about } });
  const buttons = [button(main, "Enter"), ...(other ? [button(other, "Ctrl+Enter")] : [])];
  const dialog = element(
    "dialog",
    { class: "fairyring-question fairyring-words", attributes: { "aria-label": question } },
    element("form", { attributes: { method: "dialog" } }, element("p", { text: question }), field, element("div", {}, ...buttons)),
  );
  field.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" || event.shiftKey) return;
    event.preventDefault();
    if (field.value.trim()) dialog.close((event.ctrlKey && other) || main);
  });
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      dialog.remove();
      const words = field.value.trim();
      const about = dialog.returnValue;
      resolve(words && (about === "cap" || about === "image") ? { about, words } : null);
    });
    document.body.append(dialog);
    dialog.showModal();
    field.focus();
  });
}
