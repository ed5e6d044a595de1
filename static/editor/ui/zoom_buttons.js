/**
 * Buttons over the photo for those who zoom by neither wheel nor fingers nor keys.
 *
 * @module
 */

import DECLARED from "../commands.js";
import { element } from "./dom.js";

/** What is drawn on them, in a square of 24. */
const BUTTONS = {
  zoom_in: "M12 5v14M5 12h14",
  zoom_out: "M5 12h14",
  fit: "M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5",
};

/** @type {(host: HTMLElement, perform: (command: string) => unknown) => void} */
export function zoomButtonsIn(host, perform) {
  const commands = DECLARED.groups.flatMap((group) => group.commands);
  const buttons = Object.entries(BUTTONS).map(([name, path]) => {
    const { words = name, keys = [] } = commands.find((command) => command.name === name) ?? {};
    const attributes = { type: "button", "aria-label": words, title: `${words} (${keys[0]})` };
    const button = element("button", { attributes, click: () => void perform(name) });
    button.innerHTML = `<svg viewBox="0 0 24 24" aria-hidden="true"><path d="${path}" fill="none" stroke="currentColor" stroke-width="2" stroke-linecap="round" /></svg>`;
    return button;
  });
  const bar = element("div", { class: "fairyring-zoom" }, ...buttons);
  bar.dataset.fairyringChrome = "";
  host.append(bar);
}
