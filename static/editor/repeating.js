/**
 * Has a person mark caps again: asks the server for one, shows it, sends the second mark until it is kept.
 *
 * @module
 */

import { newId } from "./ids.js";
import { markAgain } from "./ui/mark_again.js";

/** @typedef {import("./protocol.js").MarkAgain} MarkAgain */
/** @typedef {import("./protocol.js").ToServer} ToServer */

export class Repeating {
  /** More are asked for once this one is kept. */
  #goOn = false;
  /** @type {{id: string, close: () => void} | null} */
  #open = null;
  #send;
  #say;

  /**
   * @param {(message: ToServer) => boolean} send
   * @param {(text: string, level?: "info" | "warning" | "error") => void} say
   */
  constructor(send, say) {
    this.#send = send;
    this.#say = say;
  }

  /** Asks for one cap after the other until none is left, or quietly for a single one. @type {(how: {quiet: boolean}) => void} */
  ask({ quiet }) {
    this.#goOn = !quiet;
    this.#send({ type: "ask_again", quiet });
  }

  /** @type {(asked: MarkAgain) => Promise<void>} */
  async take(asked) {
    if (this.#open) return;
    const id = newId();
    this.#open = { id, close: () => {} };
    try {
      const photo = await createImageBitmap(await (await fetch(asked.photo)).blob());
      const { annotation, mirrored } = asked;
      const dialog = markAgain(
        asked,
        photo,
        (mark) => {
          if (!this.#send({ type: "marked_again", id, annotation, mirrored, mark }))
            this.#say("There is no connection; the mark can be taken once it is back.", "warning");
        },
        () => this.#closed(id),
      );
      this.#open.close = dialog.close;
    } catch {
      this.#open = null;
      this.#say("The photo of the cap to be marked again could not be loaded.", "warning");
    }
  }

  /** @type {(id: string) => void} */
  kept(id) {
    if (this.#open?.id !== id) return;
    this.#open.close();
    // The dialog tells of its end only later, when the next cap may be here already.
    this.#closed(id);
    if (this.#goOn) this.ask({ quiet: false });
  }

  /** @type {(id: string) => void} */
  #closed(id) {
    if (this.#open?.id === id) this.#open = null;
  }
}
