/**
 * What the colours of caps mean, while they are coloured by a figure.
 *
 * @module
 */

import { ENDS, RAMP, lineOf } from "../render/colouring.js";
import { element } from "./dom.js";

/** @typedef {import("../render/colouring.js").Colouring} Colouring */

/** @type {(host: HTMLElement) => (colouring: Colouring) => void} */
export function legendIn(host) {
  const legend = element("div", { class: "fairyring-legend" });
  legend.dataset.fairyringChrome = "";
  legend.hidden = true;
  host.append(legend);
  return (colouring) => {
    legend.hidden = colouring === "none";
    if (colouring === "none") return;
    const [bad, good] = ENDS[colouring];
    const lines = RAMP.map((colour, at) => {
      const line = element("i");
      line.style.borderTop = `${lineOf((at + 0.5) / RAMP.length).width}px solid ${colour}`;
      return line;
    });
    legend.replaceChildren(element("span", { text: bad }), ...lines, element("span", { text: good }));
  };
}
