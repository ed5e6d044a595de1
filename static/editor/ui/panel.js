/**
 * viser's panel: clicks on the HTML the server puts there, and which tool's button looks pressed.
 *
 * @module
 */

/**
 * @typedef {Object} Callbacks
 * @property {(image: number, select: string | null) => void} open
 * @property {(command: string) => void} perform
 * @property {(tool: string) => void} use
 * @property {(image: number, changeSet: number) => void} takeBack  a change set of the image's history
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
function carryOut(target, { open, perform, use, takeBack }) {
  const button = target.closest(
    "[data-fairyring-open], [data-fairyring-command], [data-fairyring-tool], [data-fairyring-recall]",
  );
  if (!(button instanceof HTMLElement)) return;
  const { fairyringOpen, fairyringSelect, fairyringCommand, fairyringTool, fairyringRecall, fairyringImage } =
    button.dataset;
  if (fairyringOpen) open(Number(fairyringOpen), fairyringSelect || null);
  if (fairyringCommand) perform(fairyringCommand);
  if (fairyringTool) use(fairyringTool);
  if (fairyringRecall) takeBack(Number(fairyringImage), Number(fairyringRecall));
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
