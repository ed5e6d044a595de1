import { element } from "./dom.js";

/** @typedef {import("../protocol.js").Notice["level"]} Level */

const SHOWN_MS = { info: 4000, warning: 9000, error: 0 };
const MOST = 4;

/**
 * Sentences for the person at this tab. Errors stay until they are closed.
 *
 * @param {HTMLElement} host
 * @returns {(text: string, level?: Level) => void}
 */
export function noticesIn(host) {
  const list = element("div", {
    class: "fairyring-notices",
    attributes: { role: "status", "aria-live": "polite" },
  });
  list.dataset.fairyringChrome = "";
  host.append(list);
  return (text, level = "info") => {
    const close = element("button", { text: "×", attributes: { "aria-label": "Close", type: "button" } });
    const notice = element(
      "div",
      { class: `fairyring-notice is-${level}` },
      element("span", { text }),
      close,
    );
    close.addEventListener("click", () => notice.remove());
    for (const old of list.children) if (old.firstChild?.textContent === text) old.remove();
    list.append(notice);
    while (list.children.length > MOST) list.firstElementChild?.remove();
    if (SHOWN_MS[level]) setTimeout(() => notice.remove(), SHOWN_MS[level]);
  };
}
