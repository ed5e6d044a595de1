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
    const value = (/** @type {string} */ name) =>
      /** @type {HTMLSelectElement | null} */ (tags.querySelector(`select[name=${name}]`))?.value || null;
    /** @type {Tag} */
    const before = { type: "tag", image: shown.id, light: shown.light, form: shown.form };
    /** @type {Tag} */
    const now = { ...before, light: value("light"), form: value("form") };
    const tell = (/** @type {Tag} */ tag) => {
      shown.light = tag.light;
      shown.form = tag.form;
      send(tag);
    };
    tell(now);
    say(`${shown.file_name}: light ${now.light ?? "not known"}, form ${now.form ?? "not known"}.`, "info", {
      word: "Undo",
      act: () => tell(before),
    });
  });
}
