import DECLARED from "../commands.js";
import { element } from "./dom.js";

/** How far from the bottom of the window the pointer is near, CSS pixels. */
const NEAR_PX = 80;

/** What is said of each tool. @type {Map<string, string>} */
const HINTS = new Map(
  [...DECLARED.groups.flatMap(({ commands }) => commands), ...DECLARED.held].flatMap(({ name, ...rest }) => {
    return "hint" in rest ? [[name, String(rest.hint)]] : [];
  }),
);

/**
 * A line over the bottom of the photo that says what the tool in hand does. It fades where the pointer comes near.
 *
 * @param {HTMLElement} host
 * @returns {(tool: string) => void}
 */
export function hintIn(host) {
  const line = element("div", { class: "fairyring-hint", attributes: { "aria-live": "polite" } });
  line.dataset.fairyringChrome = "";
  host.append(line);
  host.addEventListener("pointermove", ({ clientY }) => {
    line.classList.toggle("is-near", clientY > window.innerHeight - NEAR_PX);
  });
  return (tool) => {
    line.textContent = HINTS.get(tool) ?? "";
    line.hidden = !HINTS.has(tool);
  };
}
