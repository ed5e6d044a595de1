import { element } from "./dom.js";

/** @typedef {import("../protocol.js").Notice["level"]} Level */

/** What can be done about a sentence. @typedef {{word: string, act: (close: () => void) => void}} Remedy */
/** What happens when a sentence is there no longer; a later one about the same takes its place. @typedef {{closed?: () => void, about?: string}} Going */
/** @typedef {(text: string, level?: Level, more?: (Partial<Remedy> & Going) | null) => void} Say */

const SHOWN_MS = { info: 4000, warning: 9000, error: 0 };
const MOST = 4;

/**
 * Sentences for the person at this tab. Errors stay until they are closed.
 *
 * @param {HTMLElement} host
 * @returns {Say}
 */
export function noticesIn(host) {
  const list = element("div", {
    class: "fairyring-notices",
    attributes: { role: "status", "aria-live": "polite" },
  });
  list.dataset.fairyringChrome = "";
  host.append(list);
  /** What to do when a sentence goes. @type {WeakMap<Element, () => void>} */
  const closing = new WeakMap();
  const remove = (/** @type {Element} */ notice) => {
    if (!notice.isConnected) return;
    notice.remove();
    closing.get(notice)?.();
  };
  return (text, level = "info", more = null) => {
    const notice = element("div", { class: `fairyring-notice is-${level}` }, element("span", { text }));
    if (more?.act) {
      const { word, act } = more;
      const attributes = { type: "button" };
      const click = () => act(() => remove(notice));
      notice.append(element("button", { class: "is-remedy", text: word, click, attributes }));
    }
    const attributes = { type: "button", "aria-label": "Close" };
    notice.append(element("button", { text: "×", click: () => remove(notice), attributes }));
    if (more?.closed) closing.set(notice, more.closed);
    if (more?.about) notice.dataset.about = more.about;
    for (const old of [...list.children]) if (isReplaced(old, text, more?.about)) remove(old);
    list.append(notice);
    while (list.children.length > MOST) remove(list.children[0]);
    if (SHOWN_MS[level]) setTimeout(() => remove(notice), SHOWN_MS[level] * (more?.act ? 2 : 1));
  };
}

/** @type {(old: Element, text: string, about?: string) => boolean} */
function isReplaced(old, text, about) {
  const before = old instanceof HTMLElement ? old.dataset.about : undefined;
  return old.firstChild?.textContent === text || (before !== undefined && before === about);
}
