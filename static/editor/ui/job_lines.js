/**
 * Writes how far a job is into its line in the panel.
 *
 * @module
 */

/** @type {(told: import("../protocol.js").JobProgress) => void} */
export function showJob({ job, done, total, words }) {
  for (const line of document.querySelectorAll(`[data-fairyring-job="${job}"]`)) {
    const bar = line.querySelector("progress");
    if (bar && total) {
      bar.max = total;
      bar.value = done;
    }
    const said = line.querySelector(".fr-what");
    if (said && said.textContent !== words) said.textContent = words;
  }
}
