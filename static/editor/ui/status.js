import { element } from "./dom.js";

/** @typedef {import("../sync/transport.js").Connection} Connection */
/** @typedef {{connection: Connection, waiting: number, kept: boolean, conflicts: number}} State */

/**
 * The line that says, truthfully, whether the work is saved.
 *
 * @param {HTMLElement} host
 * @returns {(state: State) => void}
 */
export function statusIn(host) {
  const line = element("div", { class: "fairyring-status", attributes: { role: "status" } });
  line.dataset.fairyringChrome = "";
  host.append(line);
  return (state) => {
    const { text, tone } = statusOf(state);
    if (line.textContent !== text) line.textContent = text;
    line.dataset.tone = tone;
  };
}

/** @type {(state: State) => {text: string, tone: "good" | "busy" | "bad"}} */
export function statusOf({ connection, waiting, kept, conflicts }) {
  const more = conflicts ? ` · ${count(conflicts, "conflict")} to settle` : "";
  if (!kept) {
    return {
      text: `${count(waiting, "edit")} not saved, and this browser cannot keep them: leave this page open${more}`,
      tone: "bad",
    };
  }
  if (connection !== "online") {
    const kept = waiting ? `, ${count(waiting, "edit")} kept in this browser` : "";
    return { text: `${connection === "offline" ? "Offline" : "Connecting"}${kept}${more}`, tone: "bad" };
  }
  if (waiting) return { text: `Saving ${count(waiting, "edit")}…${more}`, tone: "busy" };
  return { text: `Saved${more}`, tone: conflicts ? "bad" : "good" };
}

/** @type {(n: number, what: string) => string} */
function count(n, what) {
  return `${n} ${what}${n === 1 ? "" : "s"}`;
}
