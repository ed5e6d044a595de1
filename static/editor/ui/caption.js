import { ARCS } from "../render/palette.js";
import { element } from "./dom.js";

/** @typedef {import("../protocol.js").Arc} Arc */
/** @typedef {import("../protocol.js").Fitted} Fitted */

const KINDS = /** @type {Arc["kind"][]} */ (Object.keys(ARCS));

/**
 * The lines that say how the outline of the selected cap came about, and what its arcs are.
 *
 * @param {HTMLElement} host
 * @returns {(fitted: Fitted | null) => void}
 */
export function captionIn(host) {
  const reason = document.createTextNode("");
  const key = element("span", { class: "fairyring-key" });
  const caption = element("div", { class: "fairyring-caption" }, element("span", {}, reason), key);
  caption.dataset.fairyringChrome = "";
  caption.hidden = true;
  host.append(caption);
  let named = "";
  return (fitted) => {
    caption.hidden = !fitted?.note;
    if (!fitted) return;
    const text = captionOf(fitted);
    if (reason.data !== text) reason.data = text;
    const kinds = KINDS.filter((kind) => fitted.arcs.some((arc) => arc.kind === kind));
    if (kinds.join() === named) return;
    named = kinds.join();
    key.replaceChildren(...kinds.map(sampleOf));
  };
}

/** What the key for marks does to the cap. */
const MARKS = { circle: " · M: mark a circle", polygon: " · M: mark the outline" };

/** @type {(fitted: Pick<Fitted, "note" | "fit" | "mark">) => string} */
export function captionOf({ note, fit, mark }) {
  const marks = mark ? MARKS[mark] : "";
  if (!fit.centre_sd) return note + marks;
  const [sx, sy] = fit.centre_sd.map((sd) => sd.toFixed(2));
  return `${note} · centre ± ${sx}, ${sy} px${marks}`;
}

/** The name of a kind of arc after a piece of its line. @type {(kind: Arc["kind"]) => HTMLElement} */
function sampleOf(kind) {
  const { name, colour, dash } = ARCS[kind];
  const line = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  line.setAttribute("viewBox", "0 0 36 6");
  line.innerHTML = '<path d="M2 3h32" fill="none" stroke-width="3" stroke-linecap="round" />';
  line.firstElementChild?.setAttribute("stroke", colour);
  line.firstElementChild?.setAttribute("stroke-dasharray", dash.join(" "));
  return element("span", {}, line, document.createTextNode(name));
}
