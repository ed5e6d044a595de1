import DECLARED from "../commands.js";
import { element } from "./dom.js";

/** What is said of each tool. @type {Map<string, string>} */
const HINTS = new Map(
  DECLARED.groups.flatMap(({ commands }) => commands).flatMap(({ name, ...rest }) => {
    return "hint" in rest ? [[name, String(rest.hint)]] : [];
  }),
);

/**
 * A line under the photo that says what the tool in hand does.
 *
 * @param {HTMLElement} host
 * @returns {(tool: string) => void}
 */
export function hintIn(host) {
  const line = element("div", { class: "fairyring-hint", attributes: { "aria-live": "polite" } });
  line.dataset.fairyringChrome = "";
  host.append(line);
  return (tool) => {
    line.textContent = HINTS.get(tool) ?? "";
    line.hidden = !HINTS.has(tool);
  };
}
