import DECLARED from "../commands.js";
import { element } from "./dom.js";

/** @typedef {{keys: string[], words: string}} Row */

/**
 * The key list.
 *
 * @returns {() => void} opens it, or closes it when it is open
 */
export function keyList() {
  const close = element("button", { text: "Close", attributes: { type: "button" } });
  const dialog = element(
    "dialog",
    { class: "fairyring-help", attributes: { "aria-label": "Keys" } },
    element("header", {}, element("h2", { text: "Keys" }), close),
    element("div", { class: "fairyring-help-columns" }, ...sections()),
  );
  close.addEventListener("click", () => dialog.close());
  dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
  dialog.addEventListener("keydown", (event) => event.key === "?" && dialog.close());
  document.body.append(dialog);
  return () => (dialog.open ? dialog.close() : dialog.showModal());
}

function sections() {
  const { groups, layers, held, gestures } = DECLARED;
  return [
    ...groups.map(({ title, commands }) => section(title, commands)),
    section(
      "Show or hide",
      layers.map(({ key, words }) => ({ keys: [key], words })),
    ),
    section("Pointer", [
      ...gestures.map(({ gesture, words }) => ({ keys: [gesture], words })),
      ...held.map(({ key, words }) => ({ keys: [`Hold ${key}`], words })),
    ]),
  ];
}

/** @type {(title: string, rows: Row[]) => HTMLElement} */
function section(title, rows) {
  const entries = joinedRows(rows.filter(({ keys }) => keys.length)).flatMap(({ keys, words }) => [
    element("dt", { text: keys.join(" ").replaceAll(" Shift+", " ") }),
    element("dd", { text: words }),
  ]);
  return element("section", {}, element("h3", { text: title }), element("dl", {}, ...entries));
}

/** Rows of the same words that follow each other, as one. @type {(rows: Row[]) => Row[]} */
function joinedRows(rows) {
  /** @type {Row[]} */
  const joined = [];
  for (const { keys, words } of rows) {
    const last = joined.at(-1);
    if (last?.words === words) last.keys.push(...keys);
    else joined.push({ keys: [...keys], words });
  }
  return joined;
}
