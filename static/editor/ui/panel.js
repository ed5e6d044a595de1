/**
 * viser's panel: clicks on the HTML the server puts there, and which tool's button looks pressed.
 *
 * @module
 */

/**
 * @typedef {Object} Wishes
 * @property {(image: number, select: string | null) => void} open
 * @property {(command: string) => void} run
 * @property {(tool: string) => void} use
 */

/** @type {(wishes: Wishes) => void} */
export function listenToPanel(wishes) {
  document.addEventListener("click", (event) => {
    if (event.target instanceof Element) carryOut(event.target, wishes);
  });
  document.addEventListener("keydown", (event) => {
    const target = event.target;
    if (event.key !== "Enter" || !(target instanceof Element) || target instanceof HTMLButtonElement) return;
    if (target.closest("input, textarea, select, a")) return;
    carryOut(target, wishes);
  });
}

/** @type {(target: Element, wishes: Wishes) => void} */
function carryOut(target, { open, run, use }) {
  const place = target.closest("[data-fairyring-open], [data-fairyring-command], [data-fairyring-tool]");
  if (!(place instanceof HTMLElement)) return;
  const { fairyringOpen, fairyringSelect, fairyringCommand, fairyringTool } = place.dataset;
  if (fairyringOpen) open(Number(fairyringOpen), fairyringSelect || null);
  if (fairyringCommand) run(fairyringCommand);
  if (fairyringTool) use(fairyringTool);
}

/**
 * Shows which tool is in hand, also on buttons that viser puts into the page later.
 *
 * @param {() => string} tool
 * @returns {() => void} to call when the tool changes
 */
export function pressedButtons(tool) {
  const update = () => {
    for (const button of document.querySelectorAll("[data-fairyring-tool]")) {
      const pressed = String(button.getAttribute("data-fairyring-tool") === tool());
      if (button.getAttribute("aria-pressed") !== pressed) button.setAttribute("aria-pressed", pressed);
    }
  };
  new MutationObserver(update).observe(document.body, { childList: true, subtree: true });
  return update;
}
