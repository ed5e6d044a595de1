/**
 * The controls of the view in viser's panel: they show what is so, and what is done to them is so at once.
 *
 * @module
 */

import { keptUp, marked } from "./following.js";

/** @typedef {import("../state/layers.js").Layers} Layers */
/** @typedef {import("../state/photo_look.js").PhotoLook} PhotoLook */

const KEPT = "fairyring:look";

/** @type {(layers: Layers, look: PhotoLook) => void} */
export function followView(layers, look) {
  const { shown, as } = kept();
  layers.visible = { ...layers.visible, ...shown };
  look.set(as);
  const update = keptUp(() => {
    for (const box of marked("data-fairyring-layer")) show(box, layers.visible[box.dataset.fairyringLayer ?? ""]);
    for (const control of marked("data-fairyring-look"))
      show(control, Reflect.get(look.now, control.dataset.fairyringLook ?? ""));
  });
  const changed = () => {
    keep({ shown: layers.visible, as: look.now });
    update();
  };
  layers.changed.listen(changed);
  look.changed.listen(changed);
  document.addEventListener("input", ({ target }) => {
    if (!(target instanceof HTMLInputElement || target instanceof HTMLSelectElement)) return;
    const { fairyringLayer: layer, fairyringLook: part } = target.dataset;
    if (layer) layers.visible = { ...layers.visible, [layer]: valueOf(target) === true };
    if (part) look.set({ [part]: valueOf(target) });
  });
}

/** @type {(control: HTMLInputElement | HTMLSelectElement) => string | number | boolean} */
function valueOf(control) {
  if (control.type === "checkbox" && control instanceof HTMLInputElement) return control.checked;
  return control.type === "range" ? Number(control.value) : control.value;
}

/** @type {(control: HTMLElement, value: unknown) => void} */
function show(control, value) {
  if (control instanceof HTMLInputElement && control.type === "checkbox") {
    if (control.checked !== value) control.checked = value === true;
  } else if (control instanceof HTMLInputElement || control instanceof HTMLSelectElement) {
    if (control.value !== String(value)) control.value = String(value);
    const said = control.parentElement?.querySelector("output");
    const words = Number(value).toFixed(2);
    if (said && said.textContent !== words) said.textContent = words;
  }
}

/** @typedef {{shown: Record<string, boolean>, as: Partial<import("../state/photo_look.js").Look>}} Kept */

/** In this tab, as long as it is open. @type {(view: Kept) => void} */
function keep(view) {
  try {
    window.sessionStorage.setItem(KEPT, JSON.stringify(view));
  } catch {
    // The next page begins with the usual view.
  }
}

/** @returns {Kept} */
function kept() {
  try {
    const { shown, as } = JSON.parse(window.sessionStorage.getItem(KEPT) ?? "{}");
    return { shown: shown ?? {}, as: as ?? {} };
  } catch {
    return { shown: {}, as: {} };
  }
}
