/**
 * From asking for another image to the moment when it is drawn.
 *
 * @module
 */

import { LookSoon } from "./sync/look_soon.js";
import { firstAddress, putCapInAddress, putInAddress } from "./ui/address.js";

/** @typedef {import("./input/toolbox.js").Toolbox} Toolbox */
/** @typedef {import("./protocol.js").Show} Show */
/** @typedef {import("./render/frame.js").Frame} Frame */
/** @typedef {import("./render/photos.js").Photos} Photos */
/** @typedef {import("./state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./sync/kept_drawings.js").KeptDrawings} KeptDrawings */
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
 * @property {KeptDrawings} drawings
 * @property {() => void} look  has the network look at the photo
 * @property {(uid: string) => void} select  a cap of the image
 * @property {(text: string, level: "info" | "warning" | "error") => void} say
 */

const HALF_DRAWN = "An outline is half drawn here: W goes on with it, Enter closes it.";

export class Opening {
  /** When the person asked for the image that has not come yet. @type {number | null} */
  #asked = null;
  #parts;
  #lookSoon;

  /** @param {Parts} parts */
  constructor(parts) {
    this.#parts = parts;
    this.#lookSoon = new LookSoon(parts.state, parts.look);
  }

  /** The person asks for another image. @type {(sent: boolean) => void} */
  ask(sent) {
    this.#asked = sent ? performance.now() : null;
    if (!sent)
      this.#parts.say("The server cannot be reached; other images can be opened when it is back.", "warning");
  }

  /** The server sends an image, which may be a fresh copy of the same. @type {(message: Show) => void} */
  show({ contents, photo, select, ahead }) {
    const { state, sync, liveFit, photos, frame, select: selectCap, say } = this.#parts;
    const asked = this.#asked ?? performance.now();
    this.#asked = null;
    const { image } = contents;
    const another = image.id !== state.image?.id;
    // The cap that a link leads to.
    const first = state.image ? null : firstAddress();
    if (another) this.#leave();
    liveFit.forget();
    sync.open(image, contents.annotations, contents.unchecked);
    state.open(contents);
    const cap = select ?? (first?.image === image.id ? first.cap : null);
    if (cap) selectCap(cap);
    if (another) this.#arrive(image.id);
    photos
      .open(photo, image)
      .then(() => frame.whenComplete(() => this.#drawn(asked, ahead)))
      .catch((error) => say(error.message, "error"));
  }

  /** What is half done on the image on screen is finished or kept. */
  #leave() {
    const { state, toolbox, frame, drawings, say } = this.#parts;
    const name = state.image?.file_name;
    this.#lookSoon.stop();
    toolbox.leave();
    if (state.image) state.clipboard.leave(state.items.all, state.image.id);
    if (drawings.leave() && name) say(`The outline stays half drawn on ${name}.`, "info");
    frame.blank();
  }

  /** What was half drawn on the image is there again. @type {(image: number) => void} */
  #arrive(image) {
    putInAddress(image);
    putCapInAddress(this.#parts.state);
    this.#parts.toolbox.tool.begin?.();
    void this.#parts.drawings.open(image).then((drawn) => {
      if (drawn) this.#parts.say(HALF_DRAWN, "info");
    });
  }

  /** @type {(asked: number, ahead: string[]) => void} */
  #drawn(asked, ahead) {
    const { photos, frame } = this.#parts;
    frame.log({ event: asked, drawn: performance.now(), draw_ms: 0, kind: "switch" });
    photos.prefetch(ahead);
    this.#lookSoon.begin();
  }
}
