/**
 * What is drawn of the image.
 *
 * @module
 */

import DECLARED from "../commands.js";

export class Layers {
  /** By name. @type {Record<string, boolean>} */
  visible = Object.fromEntries(DECLARED.layers.map(({ name, shown }) => [name, shown]));
  /** A key is held that hides all caps for a moment. */
  allHidden = false;
}
