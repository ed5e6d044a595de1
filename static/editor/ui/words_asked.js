/**
 * Asks for a reason or a comment, and whether it is about the selected cap or the whole image. A number in an empty
 * field fills in the reason of that number, unless one writes on: then it was the first letter. Enter says it, Ctrl+Enter says it of the other one, Shift+Enter begins a
 * new line, Escape says nothing.
 *
 * @module
 */

import { element } from "./dom.js";

/** @typedef {import("../state/review.js").Said} Said */
/** @typedef {import("../state/review.js").WordsQuestion} WordsQuestion */
/** @typedef {"cap" | "image"} About */

const LABELS = { cap: "this cap", image: "the image" };

/** @type {(question: WordsQuestion) => Promise<Said | null>} */
export function askWords({ title, question, verb, reasons, cap, first }) {
  const main = cap ? first : "image";
  /** @type {About | null} */
  const other = cap ? (main === "cap" ? "image" : "cap") : null;
  const dialog = element("dialog", { class: "fairyring-question fairyring-words", attributes: { "aria-label": title } });
  const field = element("textarea", { attributes: { rows: "3", maxlength: "2000", "aria-label": question } });
  field.placeholder = reasons.length ? "Or in your own words" : "";
  const missing = element("p", { class: "is-missing", attributes: { role: "alert" } });
  missing.hidden = true;
  const fill = (/** @type {string} */ reason) => {
    field.value = reason;
    field.focus();
    field.select();
  };
  const say = (/** @type {About} */ about) => {
    if (field.value.trim()) return dialog.close(about);
    missing.textContent = missingWords(reasons.length);
    missing.hidden = false;
    field.focus();
  };
  const button = (/** @type {About} */ about, /** @type {string} */ keys) => {
    const label = element("span", { text: `${verb} ${LABELS[about]}` });
    return element("button", { attributes: { type: "button" }, click: () => say(about) }, label, element("kbd", { text: keys }));
  };
  const cancel = element(
    "button",
    { attributes: { type: "button" }, click: () => dialog.close() },
    element("span", { text: "Cancel" }),
    element("kbd", { text: "Esc" }),
  );
  const buttons = [cancel, ...(other ? [button(other, "Ctrl+Enter")] : []), button(main, "Enter")];
  const list = reasons.length ? [listOf(reasons, fill)] : [];
  dialog.append(element("h2", { text: title }), ...list, field, missing, element("div", {}, ...buttons));
  field.addEventListener("input", () => (missing.hidden = true));
  /** The number that was pressed last, until anything else is written. */
  let number = "";
  field.addEventListener("beforeinput", (event) => {
    const writesOn = event.inputType === "insertText" && field.selectionEnd - field.selectionStart === field.value.length;
    if (number && writesOn) field.setRangeText(number, 0, field.value.length, "end");
    number = "";
  });
  field.addEventListener("keydown", (event) => {
    const reason = field.value === "" && !event.ctrlKey && !event.altKey && !event.metaKey ? reasons[Number(event.key) - 1] : undefined;
    const enters = event.key === "Enter" && !event.shiftKey;
    if (!enters && reason === undefined) return;
    event.preventDefault();
    if (reason !== undefined) {
      fill(reason);
      number = event.key;
    } else say((event.ctrlKey && other) || main);
  });
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      dialog.remove();
      const words = field.value.trim();
      const about = dialog.returnValue;
      resolve(about === "cap" || about === "image" ? { about, words } : null);
    });
    document.body.append(dialog);
    dialog.showModal();
    field.focus();
  });
}

/** Each reason in a row with its key. @type {(reasons: string[], fill: (reason: string) => void) => HTMLElement} */
function listOf(reasons, fill) {
  const rows = reasons.map((reason, nth) => {
    const button = element(
      "button",
      { attributes: { type: "button" }, click: () => fill(reason) },
      element("kbd", { text: String(nth + 1) }),
      element("span", { text: reason }),
    );
    return element("li", {}, button);
  });
  return element("ul", { class: "fairyring-reasons" }, ...rows);
}

/** @type {(reasons: number) => string} */
function missingWords(reasons) {
  return reasons ? `Say why first: press 1 to ${reasons}, or write it.` : "Write something first.";
}
