/**
 * Photos as bitmaps, decoded off the main thread: a smaller one of a big photo first, the full one when
 * somebody zooms in, and the next image's before anybody asks.
 *
 * @module
 */

/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/view.js").Size} Size */
/** @typedef {import("../geometry/view.js").View} View */

const SMALL_WIDTH = 2000;
const KEPT = 6;
const PIXELATED_FROM = 12;

export class Photos {
  /** @type {Map<string, Promise<ImageBitmap>>} */
  #bitmaps = new Map();
  #url = "";
  /** The photo's contrast is evened out from place to place. */
  #local = false;
  /** @type {Size} */
  #size = { width: 0, height: 0 };
  /** @type {ImageBitmap | null} */
  #bitmap = null;
  #full = false;
  #changed;

  /** @param {() => void} changed  a better bitmap of the photo on screen has come */
  constructor(changed) {
    this.#changed = changed;
  }

  /**
   * Makes this the photo on screen.
   *
   * @param {string} url
   * @param {Size} size
   * @returns {Promise<void>} when it can be drawn
   */
  async open(url, size) {
    if (url === this.#url && this.#bitmap) return;
    this.#url = url;
    this.#size = size;
    this.#bitmap = null;
    await this.#load();
  }

  /** Shows photos with or without their contrast evened out from place to place. @type {(local: boolean) => Promise<void>} */
  async useLocal(local) {
    this.#local = local;
    // The photo as it was stays until the other is there.
    if (this.#url) await this.#load();
  }

  async #load() {
    const wanted = this.#address(smaller(this.#url));
    const bitmap = await this.#fetch(wanted);
    if (wanted !== this.#address(smaller(this.#url))) return;
    this.#bitmap = bitmap;
    this.#full = bitmap.width >= this.#size.width;
    this.#changed();
  }

  /** Where a photo is as it is to be seen now. @type {(url: string) => string} */
  #address(url) {
    return this.#local ? `${url}${url.includes("?") ? "&" : "?"}contrast=local` : url;
  }

  /** @type {(urls: string[]) => void} */
  prefetch(urls) {
    for (const url of urls) void this.#fetch(this.#address(smaller(url))).catch(() => {});
  }

  /**
   * @param {import("./paths.js").Context} context
   * @param {View} view
   * @param {Bounds} region
   */
  paint(context, view, region) {
    const bitmap = this.#bitmap;
    if (!bitmap) return;
    this.#sharpen(view.scale * context.getTransform().a);
    const { width, height } = this.#size;
    const x0 = Math.max(0, Math.floor(region.x0));
    const y0 = Math.max(0, Math.floor(region.y0));
    const x1 = Math.min(width, Math.ceil(region.x1));
    const y1 = Math.min(height, Math.ceil(region.y1));
    if (x1 <= x0 || y1 <= y0) return;
    const [kx, ky] = [bitmap.width / width, bitmap.height / height];
    context.imageSmoothingEnabled = view.scale < PIXELATED_FROM;
    context.drawImage(
      bitmap,
      x0 * kx,
      y0 * ky,
      (x1 - x0) * kx,
      (y1 - y0) * ky,
      x0 * view.scale + view.x,
      y0 * view.scale + view.y,
      (x1 - x0) * view.scale,
      (y1 - y0) * view.scale,
    );
  }

  /**
   * How bright a piece of the photo on screen is, in its full resolution.
   *
   * @type {(bounds: Bounds) => Promise<import("../geometry/tightening.js").Patch>}
   */
  async patch(bounds) {
    const bitmap = this.#full && this.#bitmap ? this.#bitmap : await this.#fetch(this.#url);
    const step = this.#size.width / bitmap.width;
    const [x0, y0] = [bounds.x0, bounds.y0].map((at) => Math.max(0, Math.floor(at / step)));
    const width = Math.min(bitmap.width, Math.ceil(bounds.x1 / step)) - x0;
    const height = Math.min(bitmap.height, Math.ceil(bounds.y1 / step)) - y0;
    const context = new OffscreenCanvas(width, height).getContext("2d");
    if (!context) throw new Error("This browser gives no access to the photo's pixels.");
    context.drawImage(bitmap, -x0, -y0);
    const { data } = context.getImageData(0, 0, width, height);
    const values = Float32Array.from({ length: width * height }, (_, i) => luma(data, 4 * i));
    return { values, width, height, x0: x0 * step, y0: y0 * step, step };
  }

  /** @type {(scale: number) => void} */
  #sharpen(scale) {
    if (this.#full || scale * this.#size.width <= SMALL_WIDTH * 1.2) return;
    this.#full = true;
    const url = this.#address(this.#url);
    void this.#fetch(url).then((bitmap) => {
      if (this.#address(this.#url) !== url) return;
      this.#bitmap = bitmap;
      this.#changed();
    });
  }

  /** @type {(url: string) => Promise<ImageBitmap>} */
  #fetch(url) {
    const known = this.#bitmaps.get(url);
    const bitmap = known ?? decoded(url);
    this.#bitmaps.delete(url);
    this.#bitmaps.set(url, bitmap);
    bitmap.catch(() => this.#bitmaps.delete(url));
    for (const old of this.#bitmaps.keys()) {
      if (this.#bitmaps.size <= KEPT) break;
      this.#bitmaps.delete(old);
    }
    return bitmap;
  }
}

/** @type {(url: string) => Promise<ImageBitmap>} */
async function decoded(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(await response.text());
  return createImageBitmap(await response.blob());
}

/** The photo scaled down to 2000 pixels; a smaller one comes as it is. @type {(url: string) => string} */
function smaller(url) {
  return `${url}${url.includes("?") ? "&" : "?"}w=${SMALL_WIDTH}`;
}

/** @type {(data: Uint8ClampedArray, i: number) => number} */
function luma(data, i) {
  return 0.299 * data[i] + 0.587 * data[i + 1] + 0.114 * data[i + 2];
}
