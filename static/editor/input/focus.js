/**
 * Which keys belong to what has the focus rather than to the editor, and how the focus comes back to the
 * photo.
 *
 * @module
 */

const TEXT = [
  "text",
  "search",
  "url",
  "tel",
  "email",
  "password",
  "number",
  "date",
  "time",
  "datetime-local",
];
/** What is open over the page keeps its keys. */
const DIALOG = "[role=dialog], dialog";
/** Keys by which people walk through a page and use what they come to. */
const WALKING = /^(Arrow.*|Tab|Enter| |Home|End|Escape)$/;
const EDITOR = "#fairyring-editor";

/**
 * Whether the key belongs to what has the focus rather than to the editor.
 *
 * @param {KeyboardEvent} event
 * @returns {boolean}
 */
export function isForThePage(event) {
  const target = event.target instanceof Element ? event.target : null;
  if (!target || target === document.body) return false;
  if (target.closest(DIALOG) || (takesText(target) && event.key !== "F6")) return true;
  const alone = !event.ctrlKey && !event.metaKey && !event.altKey;
  return alone && WALKING.test(event.key) && target.closest(EDITOR) === null;
}

/** Whether letters go into an element. @type {(element: Element) => boolean} */
export function takesText(element) {
  if (element instanceof HTMLInputElement)
    return TEXT.includes(element.type) && !element.readOnly && !element.disabled;
  if (element instanceof HTMLTextAreaElement) return !element.readOnly && !element.disabled;
  return element instanceof HTMLElement && element.isContentEditable;
}

/**
 * Gives the photo the focus back when something in the panel was used by pointer, when something was chosen
 * in a list, and after Enter or Escape in a field. Who walks through the panel by keys stays there.
 *
 * @param {HTMLElement} host
 */
export function bringFocusBack(host) {
  const back = () => {
    if (document.querySelector("dialog[open], [role=dialog]:not([hidden])")) return;
    if (document.activeElement?.closest(EDITOR)) return;
    host.focus({ preventScroll: true });
  };
  // What was pressed still has to hear of it.
  const soon = () => setTimeout(back);
  window.addEventListener("pointerup", ({ target }) => !keepsFocus(target) && soon(), { capture: true });
  window.addEventListener("click", ({ target }) => isOption(target) && soon(), { capture: true });
  window.addEventListener(
    "keydown",
    ({ key, target }) => {
      const field = target instanceof Element && takesText(target) && !target.closest(DIALOG);
      if (field && !(target instanceof HTMLTextAreaElement) && ["Enter", "Escape"].includes(key)) soon();
    },
    { capture: true },
  );
}

/**
 * Whether a press belongs to something that needs the focus from then on.
 *
 * @type {(target: EventTarget | null) => boolean}
 */
function keepsFocus(target) {
  if (!(target instanceof Element)) return true;
  const label = target.closest("label");
  const field = label?.control ?? target;
  return (
    takesText(field) || isOption(target) || target.closest(`${DIALOG}, [role=listbox], a[href]`) !== null
  );
}

/** @type {(target: EventTarget | null) => boolean} */
function isOption(target) {
  return target instanceof Element && target.closest("[role=option]") !== null;
}

/** From the photo to the panel, or back. @type {(host: HTMLElement) => void} */
export function switchFocus(host) {
  if (!document.activeElement?.closest(EDITOR) && document.activeElement !== document.body) {
    host.focus({ preventScroll: true });
    return;
  }
  const found = [...document.querySelectorAll("[role=tab][aria-selected=true], [data-fairyring-command]")];
  const first = found.find((element) => element instanceof HTMLElement && element.checkVisibility());
  if (first instanceof HTMLElement) first.focus();
}
