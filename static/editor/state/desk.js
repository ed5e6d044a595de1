/**
 * The annotator's desk: the image on screen, what is selected, held and looked at, and the ways to change
 * it. Tools and commands work on this and know nothing of canvases or sockets.
 *
 * @module
 */

import { placedWhole } from "../geometry/caps.js";
import { Lens } from "../geometry/viewport.js";
import { boundsOf, changed, movedShape, nudgedHandle, withCap } from "../geometry/shapes.js";
import { signal } from "./signal.js";
import { Store, isPrediction, shapeOfPrediction } from "./store.js";
import { joined } from "../geometry/view.js";

/** @typedef {import("../geometry/handles.js").Handle} Handle */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").ImageContents} ImageContents */
/** @typedef {import("../protocol.js").Fit} Fit */
/** @typedef {import("../protocol.js").Image} Image */
/** @typedef {import("../protocol.js").Prediction} Prediction */
/** @typedef {import("./store.js").Change} Change */
/** @typedef {import("./store.js").Shape} Shape */

const NUDGE_SETTLES_MS = 400;

export class Desk {
  store = new Store();
  /** @type {Image | null} */
  image = null;
  /** @type {Shape[]} */
  predictions = [];
  /** @type {Set<string>} */
  selected = new Set();
  /** @type {string | null} */
  hovered = null;
  /** @type {Handle | null} */
  active = null;
  /** Caps being changed, not yet committed, by uid. @type {Map<string, Shape>} */
  drafts = new Map();
  /** What the server said last. @type {Fit | null} */
  fitting = null;
  lens = new Lens(() => this.signals.overlay.emit());
  /** @type {Record<string, boolean>} */
  layers = {
    photo: true,
    outline: true,
    fill: true,
    whole: true,
    centre: true,
    label: false,
    prediction: true,
  };
  hidden = false;

  signals = {
    /** The picture of these caps has changed. @type {import("./signal.js").Signal<[Shape[]]>} */
    shapes: signal(),
    /** Everything has. @type {import("./signal.js").Signal<[]>} */
    picture: signal(),
    /** Only what is drawn over the picture. @type {import("./signal.js").Signal<[]>} */
    overlay: signal(),
    /** @type {import("./signal.js").Signal<[]>} */
    selection: signal(),
    /** @type {import("./signal.js").Signal<[Shape]>} */
    draft: signal(),
    /** @type {import("./signal.js").Signal<[]>} */
    nudge: signal(),
  };

  /** @type {Shape[] | null} */
  #items = null;
  #nudging = 0;
  #commit;

  /** @param {(changes: Change[]) => void} commit */
  constructor(commit) {
    this.#commit = commit;
    this.store.observe((changes) => {
      this.#items = null;
      const gone = changes.filter(({ after }) => after.deleted && this.selected.has(after.uid));
      this.signals.shapes.emit(changes.flatMap(({ before, after }) => (before ? [before, after] : [after])));
      if (gone.length) this.select([...this.selected].filter((uid) => this.item(uid)));
    });
  }

  /** What can be seen and picked: live caps, and predictions nobody has taken up or turned down. */
  get items() {
    if (!this.#items) {
      const taken = new Set(this.store.all().map(({ cap }) => cap.prediction));
      const open = this.predictions.filter(({ cap }) => !taken.has(cap.prediction));
      this.#items = [...open, ...this.store.live()];
    }
    return this.#items;
  }

  /** Items that the layers let one see. */
  get pickable() {
    return this.layers.prediction ? this.items : this.items.filter((shape) => !isPrediction(shape));
  }

  /** @type {(uid: string) => Shape | null} */
  item(uid) {
    return this.items.find((shape) => shape.uid === uid) ?? null;
  }

  /** The selected items, as they look while being changed. */
  get selection() {
    return [...this.selected].flatMap((uid) => this.drafts.get(uid) ?? this.item(uid) ?? []);
  }

  /** The one selected item. @returns {Shape | null} */
  get sole() {
    return this.selected.size === 1 ? (this.selection[0] ?? null) : null;
  }

  /**
   * How the outline of the one selected cap came about; a placed one needs no telling.
   *
   * @returns {Fit | null}
   */
  get explanation() {
    const { sole, fitting } = this;
    return sole && fitting?.annotation === sole.uid && !placedWhole(sole.cap) ? fitting : null;
  }

  /** What is drawn over the picture rather than in it. */
  get lifted() {
    const uids = new Set(this.drafts.keys());
    if (this.selected.size === 1) for (const uid of this.selected) uids.add(uid);
    return uids;
  }

  /**
   * Puts another image, or a fresh copy of the same, on the desk. The store holds its caps already.
   *
   * @param {ImageContents} contents
   */
  open(contents) {
    const same = this.image?.id === contents.image.id;
    const selected = same ? [...this.selected] : [];
    this.image = contents.image;
    this.predictions = contents.predictions.map(shapeOfPrediction);
    this.#items = null;
    this.drafts.clear();
    this.hovered = null;
    this.lens.turnTo(contents.image);
    this.selected = new Set(selected.filter((uid) => this.item(uid)));
    this.active = null;
    this.signals.picture.emit();
    this.signals.selection.emit();
  }

  /**
   * Puts what a later run said in the place of what earlier ones did; what is being changed stays as it is.
   *
   * @param {Prediction[]} predictions
   */
  predict(predictions) {
    const held = this.predictions.filter(({ uid }) => this.drafts.has(uid));
    this.predictions = [...held, ...predictions.map(shapeOfPrediction)];
    this.#items = null;
    this.hovered = null;
    const left = [...this.selected].filter((uid) => this.item(uid));
    const lost = left.length < this.selected.size;
    if (lost) this.active = null;
    this.selected = new Set(left);
    this.signals.picture.emit();
    if (lost) this.signals.selection.emit();
  }

  /**
   * @param {string[]} uids
   * @param {{reveal?: boolean}} [how]
   */
  select(uids, { reveal = false } = {}) {
    this.settle();
    const before = [...this.selected];
    this.selected = new Set(uids);
    this.active = null;
    if (reveal) this.reveal();
    if (before.join() === uids.join()) return;
    this.signals.shapes.emit([...before, ...uids].flatMap((uid) => this.item(uid) ?? []));
    this.signals.selection.emit();
  }

  /** @type {(uid: string | null) => void} */
  hover(uid) {
    if (uid === this.hovered) return;
    this.hovered = uid;
    this.signals.overlay.emit();
  }

  /**
   * Shows caps as they would become, without committing them.
   *
   * @param {Shape[]} shapes
   */
  propose(shapes) {
    const fresh = shapes.filter(({ uid }) => !this.drafts.has(uid));
    for (const shape of shapes) this.drafts.set(shape.uid, shape);
    if (fresh.some(({ uid }) => this.selected.size !== 1 || !this.selected.has(uid)))
      this.signals.shapes.emit(fresh);
    if (shapes.length === 1) this.signals.draft.emit(shapes[0]);
    this.signals.overlay.emit();
  }

  /** Forgets what was proposed. */
  withdraw() {
    this.#calm();
    const shapes = [...this.drafts.values()];
    this.drafts.clear();
    if (shapes.length) this.signals.shapes.emit(shapes);
  }

  #calm() {
    clearTimeout(this.#nudging);
    this.#nudging = 0;
  }

  /** Commits what was proposed, as one step. */
  settle() {
    this.#calm();
    if (this.drafts.size === 0) return;
    const changes = [...this.drafts.values()].flatMap((draft) => {
      const before = this.item(draft.uid);
      return before && before.cap !== draft.cap ? [changed(before, draft)] : [];
    });
    this.drafts.clear();
    this.commit(changes);
    this.signals.overlay.emit();
  }

  /**
   * Commits changes; the selection follows predictions that became annotations.
   *
   * @param {Change[]} changes
   */
  commit(changes) {
    this.#commit(changes);
    const heirs = changes.filter(
      ({ before, after }) => !before && after.cap.prediction !== null && !after.deleted,
    );
    const heirOf = new Map(heirs.map(({ after }) => [`prediction:${after.cap.prediction}`, after.uid]));
    const active = this.active;
    if ([...this.selected].some((uid) => heirOf.has(uid))) {
      this.select([...this.selected].map((uid) => heirOf.get(uid) ?? uid));
      this.active = active;
    }
  }

  /**
   * Changes the selected caps as `change` says; null leaves a cap alone.
   *
   * @param {(cap: Cap, shape: Shape) => Cap | null} change
   */
  changeSelected(change) {
    this.settle();
    const changes = this.selection.flatMap((shape) => {
      const cap = change(shape.cap, shape);
      return cap && cap !== shape.cap ? [changed(shape, withCap(shape, cap))] : [];
    });
    this.commit(changes);
  }

  /** Deletes the selected caps and turns down the selected predictions. */
  deleteSelected() {
    this.settle();
    const shapes = this.selection;
    this.select([]);
    this.commit(shapes.map((shape) => changed(shape, { ...shape, deleted: true })));
  }

  /** @type {(shapes: Shape[]) => void} */
  accept(shapes) {
    this.settle();
    this.commit(shapes.filter(isPrediction).map((shape) => changed(shape, shape)));
  }

  /**
   * Moves the active handle, or all that is selected, by a fraction of a pixel. A burst is one step.
   *
   * @param {number} dx
   * @param {number} dy
   */
  nudge(dx, dy) {
    const handle = this.selected.size === 1 ? this.active : null;
    const moved = this.selection.map((shape) =>
      handle ? withCap(shape, nudgedHandle(shape.cap, handle, dx, dy)) : movedShape(shape, dx, dy),
    );
    if (moved.length === 0) return;
    this.propose(moved);
    clearTimeout(this.#nudging);
    this.#nudging = window.setTimeout(() => this.settle(), NUDGE_SETTLES_MS);
    this.signals.nudge.emit();
  }

  /** Caps nudged and not committed yet: no more saved than an edit on its way. */
  get unsettled() {
    return this.#nudging ? this.drafts.size : 0;
  }

  /** Brings the selection into view. @param {{close?: boolean}} [how] */
  reveal({ close = false } = {}) {
    const all = this.selection.flatMap((shape) => boundsOf(shape) ?? []);
    if (all.length) this.lens.reveal(all.reduce(joined), { close });
  }
}
