/**
 * From asking for another image to the moment when it is drawn.
 *
 * @module
 */

/** @typedef {import("./input/toolbox.js").Toolbox} Toolbox */
/** @typedef {import("./protocol.js").Show} Show */
/** @typedef {import("./render/frame.js").Frame} Frame */
/** @typedef {import("./render/photos.js").Photos} Photos */
/** @typedef {import("./state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./sync/live_fit.js").LiveFit} LiveFit */
/** @typedef {import("./sync/sync.js").Sync} Sync */

/**
 * @typedef {Object} Parts
 * @property {EditorState} state
 * @property {Toolbox} toolbox
 * @property {Sync} sync
 * @property {LiveFit} liveFit
 * @property {Photos} photos
 * @property {Frame} frame
 * @property {(text: string, level: "warning" | "error") => void} say
 */

export class Opening {
  /** When the person asked for the image that has not come yet. @type {number | null} */
  #asked = null;
  #parts;

  /** @param {Parts} parts */
  constructor(parts) {
    this.#parts = parts;
  }

  /** The person asks for another image. @type {(sent: boolean) => void} */
  ask(sent) {
    this.#asked = sent ? performance.now() : null;
    if (!sent)
      this.#parts.say("The server cannot be reached; other images can be opened when it is back.", "warning");
  }

  /** The server sends an image, which may be a fresh copy of the same. @type {(message: Show) => void} */
  show({ contents, photo, select, ahead }) {
    const { state, toolbox, sync, liveFit, photos, frame, say } = this.#parts;
    const asked = this.#asked ?? performance.now();
    this.#asked = null;
    const { image } = contents;
    if (image.id !== state.image?.id) {
      toolbox.tool.cancel();
      state.commitDrafts();
      frame.blank();
    }
    liveFit.forget();
    sync.open(image.id, contents.annotations);
    state.open(contents);
    if (select) state.select([select], { reveal: true });
    photos
      .open(photo, image)
      .then(() => frame.whenComplete(() => this.#drawn(asked, ahead)))
      .catch((error) => say(error.message, "error"));
  }

  /** @type {(asked: number, ahead: string[]) => void} */
  #drawn(asked, ahead) {
    const { photos, frame } = this.#parts;
    frame.log({ event: asked, drawn: performance.now(), draw_ms: 0, kind: "switch" });
    photos.prefetch(ahead);
  }
}
