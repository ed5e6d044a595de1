import { element } from "./dom.js";

/** @typedef {import("../state/finishing.js").Answer} Answer */
/** @typedef {import("../state/finishing.js").Question} Question */

/** @type {Answer[]} */
const ANSWERS = ["yes", "no", "down"];

/**
 * Asks something before it is done; Escape is a no.
 *
 * @param {Question} question
 * @returns {Promise<Answer>}
 */
export function ask({ text, yes, no, down }) {
  return new Promise((resolve) => {
    const button = (/** @type {string} */ word, /** @type {Answer} */ answer) =>
      element("button", { text: word, attributes: { type: "submit", value: answer } });
    const buttons = [button(no, "no"), button(yes, "yes"), ...(down ? [button(down, "down")] : [])];
    const form = element("form", { attributes: { method: "dialog" } }, ...buttons);
    const dialog = element(
      "dialog",
      { class: "fairyring-question", attributes: { "aria-label": "Question", role: "alertdialog" } },
      element("p", { text }),
      form,
    );
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(ANSWERS.find((answer) => answer === dialog.returnValue) ?? "no");
    });
    document.body.append(dialog);
    dialog.showModal();
  });
}
