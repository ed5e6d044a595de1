/**
 * What can be seen and picked on the image: live annotations, and predictions that nobody has taken up or
 * turned down. Found by uid and by place, without looking at all of them. Those that a reviewer is shown besides
 * are found by uid, too.
 *
 * @module
 */

import { joinedAll } from "../geometry/bounds.js";
import { Grid } from "../geometry/grid.js";
import { reachOf } from "../geometry/shapes.js";

/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("./store.js").Store} Store */

export class Items {
  /** @type {Shape[]} */
  #predictions = [];
  /** In the order of drawing. @type {Shape[]} */
  #all = [];
  /** @type {Map<string, {shape: Shape, order: number}>} */
  #byUid = new Map();
  #grid = new Grid();
  /** @type {Bounds | null} */
  #bounds = null;
  /** @type {Map<string, Shape>} */
  #besides = new Map();
  /** The version of the store that all this was made of. */
  #version = -1;
  #store;

  /** @param {Store} store */
  constructor(store) {
    this.#store = store;
  }

  /** What runs said of the image, taken up or not. */
  get predictions() {
    return this.#predictions;
  }

  set predictions(predictions) {
    this.#predictions = predictions;
    this.#version = -1;
  }

  /** Predictions that a reviewer is shown although somebody has decided upon them, or another run made them. */
  get besides() {
    this.#update();
    return [...this.#besides.values()].filter(({ uid }) => !this.#byUid.has(uid));
  }

  set besides(shapes) {
    this.#besides = new Map(shapes.map((shape) => [shape.uid, shape]));
  }

  /** In the order in which they are drawn, predictions first. */
  get all() {
    this.#update();
    return this.#all;
  }

  /** Around everything of them that may be drawn; null where there are none. */
  get bounds() {
    this.#update();
    return this.#bounds;
  }

  /** @type {(uid: string) => Shape | null} */
  get(uid) {
    this.#update();
    return this.#byUid.get(uid)?.shape ?? this.#besides.get(uid) ?? null;
  }

  /** The items of which anything may be drawn in `bounds`, in the order of `all`. @type {(bounds: Bounds) => Shape[]} */
  near(bounds) {
    this.#update();
    return this.#grid
      .near(bounds)
      .flatMap((uid) => this.#byUid.get(uid) ?? [])
      .sort((a, b) => a.order - b.order)
      .map(({ shape }) => shape);
  }

  #update() {
    if (this.#version === this.#store.version) return;
    this.#version = this.#store.version;
    const before = this.#byUid;
    this.#all = [...this.#openPredictions(), ...this.#store.live()];
    this.#byUid = new Map(this.#all.map((shape, order) => [shape.uid, { shape, order }]));
    for (const uid of before.keys()) if (!this.#byUid.has(uid)) this.#grid.remove(uid);
    for (const shape of this.#all) if (before.get(shape.uid)?.shape !== shape) this.#locate(shape);
    this.#bounds = joinedAll(this.#all.flatMap((shape) => reachOf(shape) ?? []));
  }

  #openPredictions() {
    const taken = new Set(this.#store.all().map(({ cap }) => cap.prediction));
    return this.#predictions.filter(({ cap }) => !taken.has(cap.prediction));
  }

  /** @type {(shape: Shape) => void} */
  #locate(shape) {
    const bounds = reachOf(shape);
    if (bounds) this.#grid.put(shape.uid, bounds);
    else this.#grid.remove(shape.uid);
  }
}
