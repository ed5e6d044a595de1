/**
 * viser's panel: clicks on the HTML the server puts there, and which buttons look pressed.
 *
 * @module
 */

import { keptUp, marked, put } from "./following.js";

/**
 * @typedef {Object} Callbacks
 * @property {(image: number, select: string | null) => void} open
 * @property {(command: string) => void} perform
 * @property {(tool: string) => void} use
 * @property {(image: number, changeSet: number) => void} takeBack  a change set of the image's history
 * @property {() => void} compare  shows where annotations and predictions differ
 * @property {(message: import("../protocol.js").ToServer) => void} send
 */

/** @type {(callbacks: Callbacks) => void} */
export function listenToPanel(callbacks) {
  document.addEventListener("click", (event) => {
    if (event.target instanceof Element) carryOut(event.target, callbacks);
  });
  document.addEventListener("keydown", (event) => {
    const target = event.target;
    if (event.key !== "Enter" || !(target instanceof Element) || target instanceof HTMLButtonElement) return;
    if (target.closest("input, textarea, select, a")) return;
    carryOut(target, callbacks);
  });
}

/** @type {(target: Element, callbacks: Callbacks) => void} */
function carryOut(target, { open, perform, use, takeBack, send, compare }) {
  const button = target.closest(
    "[data-fairyring-open], [data-fairyring-command], [data-fairyring-tool], [data-fairyring-recall], [data-fairyring-cancel], [data-fairyring-predict], [data-fairyring-gallery]",
  );
  if (!(button instanceof HTMLElement)) return;
  const { fairyringOpen, fairyringSelect, fairyringCommand, fairyringTool, fairyringRecall, fairyringImage } =
    button.dataset;
  const { fairyringCancel, fairyringPredict, fairyringGallery, fairyringDifferences, fairyringRun } = button.dataset;
  if (isKind(fairyringGallery)) send({ type: "show_caps", kind: fairyringGallery, group: groupOf(button) });
  if (fairyringRun) send({ type: "compare_with", run: Number(fairyringRun) });
  if (fairyringDifferences !== undefined) compare();
  if (fairyringCancel) send({ type: "cancel", job: Number(fairyringCancel) });
  if (fairyringPredict) send({ type: "predict", image: Number(fairyringPredict) });
  if (fairyringOpen) open(Number(fairyringOpen), fairyringSelect || null);
  if (fairyringCommand) perform(fairyringCommand);
  if (fairyringTool) use(fairyringTool);
  if (fairyringRecall) takeBack(Number(fairyringImage), Number(fairyringRecall));
}

/** @type {(word: string | undefined) => word is import("../protocol.js").ShowCaps["kind"]} */
function isKind(word) {
  return ["worst", "matched", "missed", "extra", "doubtful", "unsure", "ignored"].includes(word ?? "");
}

/** The group of caps that a button speaks of. @type {(button: HTMLElement) => import("../protocol.js").Group | null} */
function groupOf({ dataset: { fairyringBy, fairyringValue, fairyringOfImage, fairyringBeside } }) {
  const by = GROUPS.find((each) => each === fairyringBy);
  if (by === undefined) return null;
  return { by, value: fairyringValue ?? null, image: number(fairyringOfImage), beside: number(fairyringBeside) };
}

/** @type {(said: string | undefined) => number | null} */
function number(said) {
  return said === undefined ? null : Number(said);
}

/** @type {import("../protocol.js").Group["by"][]} */
const GROUPS = ["light", "form", "size", "visibility", "shape", "annotator", "image", "run"];

/** Which button says which status. @type {Record<string, import("../protocol.js").Status>} */
const STATUSES = { to_do: "new", annotated: "annotated", approved: "approved" };

/**
 * Shows which tool is in hand and which status the image has, also on buttons that viser puts into the page
 * later.
 *
 * @param {() => {tool: string, status: import("../protocol.js").Status | null}} now
 * @returns {() => void} to call when that changes
 */
export function pressedButtons(now) {
  return keptUp(() => {
    const { tool, status } = now();
    for (const button of marked("data-fairyring-tool"))
      put(button, "aria-pressed", String(button.dataset.fairyringTool === tool));
    for (const [command, its] of Object.entries(STATUSES))
      for (const button of document.querySelectorAll(`[data-fairyring-command=${command}]`))
        put(button, "aria-pressed", String(its === status));
  });
}
