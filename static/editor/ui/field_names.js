/**
 * Gives fields of viser's panel the names that stand beside them: viser writes labels, but not every field
 * has the id that they name, and the buttons that close its notes have none. What is chosen from a list is told in full
 * where the pointer rests, as the field may be too narrow for it.
 *
 * @module
 */

import { keptUp, put } from "./following.js";

const FIELD = "input, select, textarea, [role=slider], [role=combobox]";
const CLOSES_NOTE = ".mantine-Notification-closeButton";

export function nameFields() {
  keptUp(() => {
    for (const button of document.querySelectorAll(CLOSES_NOTE)) put(button, "aria-label", "Close");
    for (const label of document.querySelectorAll("[data-dock-scroll] label[for]")) {
      const name = label.textContent?.trim();
      const row = label.closest("p")?.parentElement?.parentElement;
      if (!name || !row) continue;
      for (const field of row.querySelectorAll(FIELD)) {
        const own = field instanceof HTMLInputElement && field.labels?.length;
        if (!own) put(field, "aria-label", name);
      }
    }
  });
  document.addEventListener("pointerover", ({ target }) => {
    if (isChoice(target)) put(target, "title", target.value);
  });
}

/** Whether it shows what was chosen from a list of the panel. @type {(target: EventTarget | null) => target is HTMLInputElement} */
function isChoice(target) {
  return target instanceof HTMLInputElement && target.matches("[data-dock-scroll] [aria-haspopup=listbox]");
}
