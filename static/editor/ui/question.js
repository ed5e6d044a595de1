import { element } from "./dom.js";

/** @typedef {import("../state/finishing.js").Question} Question */

/**
 * Asks something before it is done; Escape is a no.
 *
 * @param {Question} question
 * @returns {Promise<boolean>}
 */
export function ask({ text, yes, no }) {
  return new Promise((resolve) => {
    const button = (/** @type {string} */ word, /** @type {string} */ answer) =>
      element("button", { text: word, attributes: { type: "submit", value: answer } });
    const form = element("form", { attributes: { method: "dialog" } }, button(no, "no"), button(yes, "yes"));
    const dialog = element(
      "dialog",
      { class: "fairyring-question", attributes: { "aria-label": "Question", role: "alertdialog" } },
      element("p", { text }),
      form,
    );
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(dialog.returnValue === "yes");
    });
    document.body.append(dialog);
    dialog.showModal();
  });
}
