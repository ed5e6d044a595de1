/**
 * The tags of an image in viser's panel: what is chosen is stored, and can be taken back.
 *
 * @module
 */

/** @typedef {import("../protocol.js").Tag} Tag */

/**
 * @param {() => import("../protocol.js").Image | null} image  the one on screen
 * @param {(tag: Tag) => void} send
 * @param {import("./notices.js").Say} say
 */
export function listenToTags(image, send, say) {
  document.addEventListener("change", ({ target }) => {
    if (!(target instanceof HTMLSelectElement)) return;
    const tags = target.closest("[data-fairyring-tags]");
    const shown = image();
    if (!(tags instanceof HTMLElement) || !shown || Number(tags.dataset.fairyringTags) !== shown.id) return;
    const choices = [...tags.querySelectorAll("select")];
    /** @type {Tag} */
    const tag = { type: "tag", image: shown.id, light: null, form: null, split: null };
    // What the server drew is how things were; somebody else may have said so since the image was opened.
    const before = { ...tag, ...said(choices, (option) => option.defaultSelected) };
    const now = { ...tag, ...said(choices, (option) => option.selected) };
    for (const option of choices.flatMap(({ options }) => [...options])) option.defaultSelected = option.selected;
    send(now);
    const words = `light ${now.light ?? "not known"}, form ${now.form ?? "not known"}, split ${now.split ?? "none"}`;
    say(`${shown.file_name}: ${words}.`, "info", {
      word: "Undo",
      act: () => send(before),
    });
  });
}

/**
 * The tags by their names; null for what is not known.
 *
 * @param {HTMLSelectElement[]} choices
 * @param {(option: HTMLOptionElement) => boolean} holds
 */
function said(choices, holds) {
  return Object.fromEntries(
    choices.map(({ name, options }) => [name, [...options].find(holds)?.value || null]),
  );
}
