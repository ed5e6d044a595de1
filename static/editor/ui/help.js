import { element } from "./dom.js";
import { GESTURES, KEYS } from "../input/keys.js";

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
    element(
      "div",
      { class: "fairyring-help-columns" },
      ...KEYS.map(([title, bindings]) => group(title, rowsOf(bindings))),
      group("Pointer", GESTURES),
    ),
  );
  close.addEventListener("click", () => dialog.close());
  dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
  dialog.addEventListener("keydown", (event) => event.key === "?" && dialog.close());
  document.body.append(dialog);
  return () => (dialog.open ? dialog.close() : dialog.showModal());
}

/**
 * Keys without words share the words of those that follow.
 *
 * @type {(bindings: import("../input/keys.js").Binding[]) => [string, string][]}
 */
function rowsOf(bindings) {
  /** @type {[string, string][]} */
  const rows = [];
  let keys = [];
  for (const binding of bindings) {
    keys.push(...binding.keys);
    if (!binding.text) continue;
    rows.push([keys.map(readable).join(" ").replaceAll(" Shift+", " "), binding.text]);
    keys = [];
  }
  return rows;
}

/** @type {(key: string) => string} */
function readable(key) {
  const arrows = key
    .replace("ArrowLeft", "←")
    .replace("ArrowRight", "→")
    .replace("ArrowUp", "↑")
    .replace("ArrowDown", "↓");
  return arrows.length === 1 ? arrows.toUpperCase() : arrows.replace("Escape", "Esc");
}

/** @type {(title: string, rows: [string, string][]) => HTMLElement} */
function group(title, rows) {
  const entries = rows.flatMap(([keys, text]) => [element("dt", { text: keys }), element("dd", { text })]);
  return element("section", {}, element("h3", { text: title }), element("dl", {}, ...entries));
}
