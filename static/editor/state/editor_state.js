/**
 * The image on screen and what a person is doing to it. Tools and commands work on this and know nothing
 * of canvases or sockets.
 *
 * @module
 */

import { joinedAll } from "../geometry/bounds.js";
import { placedWhole } from "../geometry/caps.js";
import { boundsOf, shapeOfPrediction, uidOfPrediction } from "../geometry/shapes.js";
import { changed, madeApart } from "./changes.js";
import { Clipboard } from "./clipboard.js";
import { Drafts } from "./drafts.js";
import { Gesture } from "./gesture.js";
import { HalfDrawn } from "./half_drawn.js";
import { Items } from "./items.js";
import { Layers } from "./layers.js";
import { PhotoLook } from "./photo_look.js";
import { Selection } from "./selection.js";
import { Sight } from "./sight.js";
import { signal } from "./signal.js";
import { Store } from "./store.js";
import { Viewport } from "./viewport.js";

/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").ImageContents} ImageContents */
/** @typedef {import("../protocol.js").Fitted} Fitted */
/** @typedef {import("../protocol.js").Image} Image */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../protocol.js").Prediction} Prediction */
/** @typedef {import("./changes.js").Change} Change */

export class EditorState {
  /** @type {Image | null} */
  image = null;
  store = new Store();
  items = new Items(this.store);
  selection = new Selection();
  drafts = new Drafts();
  clipboard = new Clipboard();
  halfDrawn = new HalfDrawn();
  layers = new Layers();
  look = new PhotoLook();
  viewport = new Viewport((how) => this.#viewMoved(how));
  /** A reviewer looks at what differs: nobody is expected to lay caps over those that are there. */
  reviewing = false;
  /** What the server said last about an outline. @type {Fitted | null} */
  fitted = null;

  signals = {
    /** The picture of these shapes has changed. @type {import("./signal.js").Signal<[Shape[]]>} */
    shapes: signal(),
    /** The picture of everything has. @type {import("./signal.js").Signal<[]>} */
    picture: signal(),
    /** Only what is drawn over the picture has. @type {import("./signal.js").Signal<[]>} */
    overlay: signal(),
    /** @type {import("./signal.js").Signal<[]>} */
    selection: signal(),
    /** A cap is being changed, and so its outline. @type {import("./signal.js").Signal<[Shape]>} */
    draft: signal(),
    /** A cap is being drawn out, as it would be put down now; null once it no longer is. @type {import("./signal.js").Signal<[Shape | null]>} */
    drawing: signal(),
    /** A cap was drawn by hand. @type {import("./signal.js").Signal<[Shape]>} */
    drawn: signal(),
    /** Caps were moved by a key and wait to be committed. @type {import("./signal.js").Signal<[]>} */
    nudge: signal(),
  };

  #sight = new Sight(this.items, this.layers);
  #gesture = new Gesture();
  #commit;

  /** @param {(changes: Change[]) => void} commit  puts changes into the store and sends them */
  constructor(commit) {
    this.#commit = commit;
    this.store.changed.listen((changes) => this.#storeChanged(changes));
    this.selection.pointed.listen(() => this.signals.overlay.emit());
    this.halfDrawn.changed.listen(() => this.signals.overlay.emit());
    this.layers.changed.listen(() => this.#layersChanged());
    this.selection.changed.listen((before, after) => {
      this.signals.shapes.emit([...before, ...after].flatMap((uid) => this.items.get(uid) ?? []));
      this.signals.selection.emit();
    });
  }

  /** Where the photo moves by itself under the pointer, that is on another cap than it was. @type {(how: {led: boolean}) => void} */
  #viewMoved({ led }) {
    if (!led) this.selection.hover(null);
    this.signals.overlay.emit();
  }

  /** @type {(changes: Change[]) => void} */
  #storeChanged(changes) {
    this.signals.shapes.emit(changes.flatMap(({ before, after }) => (before ? [before, after] : [after])));
    if (!changes.some(({ after }) => after.deleted && this.selection.has(after.uid))) return;
    // A cap that somebody deletes while it is changed here stays in hand: it becomes a conflict.
    this.selection.keep((uid) => this.shape(uid) !== null);
  }

  /** What is not seen any more is not acted on either. */
  #layersChanged() {
    this.commitDrafts();
    this.selection.hover(null);
    this.selection.keep((uid) => this.#sight.shows(uid));
    this.signals.picture.emit();
  }

  /** The selected shapes, as they look while being changed; none while all are hidden. */
  get selected() {
    return this.layers.allHidden ? [] : [...this.selection.uids].flatMap((uid) => this.shape(uid) ?? []);
  }

  /** The one selected shape. @returns {Shape | null} */
  get sole() {
    const uid = this.selection.soleUid;
    return uid === null ? null : this.shape(uid);
  }

  /** An item as it looks while being changed. @type {(uid: string) => Shape | null} */
  shape(uid) {
    return this.drafts.get(uid) ?? this.items.get(uid);
  }

  /**
   * How the outline of the one selected cap came about; a placed one needs no telling.
   *
   * @returns {Fitted | null}
   */
  get explanation() {
    const { sole, fitted } = this;
    return sole && fitted?.annotation === sole.uid && !placedWhole(sole.cap) ? fitted : null;
  }

  /** The uids of what is drawn over the picture rather than in it. */
  get lifted() {
    const uids = new Set(this.drafts.all.map(({ uid }) => uid));
    if (this.selection.soleUid !== null) uids.add(this.selection.soleUid);
    return uids;
  }

  /** The items that the layers let one see. */
  get visible() {
    return this.#sight.all;
  }

  /** The visible item at a point of the image, else the one whose outline is nearest within `reach` pixels. @type {(point: Point, reach: number) => Shape | null} */
  at(point, reach) {
    return this.#sight.at(point, reach);
  }

  /** The visible items whose outline passes within `reach` of a point, the nearest first. @type {(point: Point, reach: number) => Shape[]} */
  rimsNear(point, reach) {
    return this.#sight.rimsNear(point, reach);
  }

  /** The visible items that a point lies in, the one that is meant first. @type {(point: Point) => Shape[]} */
  allAt(point) {
    return this.#sight.allAt(point);
  }

  /** The visible items of which anything may be drawn in the rectangle. @type {(bounds: Bounds) => Shape[]} */
  near(bounds) {
    return this.#sight.near(bounds);
  }

  /**
   * Opens another image, or a fresh copy of the same. The store holds its annotations already.
   *
   * @param {ImageContents} contents
   */
  open({ image, predictions }) {
    const same = this.image?.id === image.id;
    this.image = image;
    this.items.predictions = predictions.map(shapeOfPrediction);
    if (!same) {
      this.items.besides = [];
      this.#forgetDrafts();
    }
    this.selection.hover(null);
    this.viewport.open(image);
    const kept = same ? [...this.selection.uids].filter((uid) => this.shape(uid)) : [];
    // The server knows nothing of the selection after a break, so it is told even where it is the same.
    if (!this.selection.set(kept)) this.signals.selection.emit();
    this.signals.picture.emit();
  }

  /**
   * Puts what a later run said in the place of what earlier ones did; what is being changed stays as it is.
   *
   * @param {Prediction[]} predictions
   */
  predict(predictions) {
    const held = this.items.predictions.filter(({ uid }) => this.drafts.has(uid));
    this.items.predictions = [...held, ...predictions.map(shapeOfPrediction)];
    this.selection.hover(null);
    this.selection.keep((uid) => this.shape(uid) !== null);
    this.signals.picture.emit();
  }

  #forgetDrafts() {
    this.drafts.clear();
    this.endGesture();
  }

  /** Has a reviewer see and pick these predictions besides. @type {(predictions: Prediction[]) => void} */
  showBesides(predictions) {
    this.items.besides = predictions.map(shapeOfPrediction);
    this.selection.keep((uid) => this.shape(uid) !== null);
  }

  /**
   * Selects those of these items that are shown.
   *
   * @param {string[]} uids
   * @param {{reveal?: boolean}} [how]
   */
  select(uids, { reveal = false } = {}) {
    this.commitDrafts();
    this.selection.set(uids.filter((uid) => this.#sight.shows(uid)));
    if (reveal) this.reveal();
  }

  /** Brings the selection into view. @param {{close?: boolean}} [how] */
  reveal({ close = false } = {}) {
    const bounds = joinedAll(this.#boundsOfSelected());
    if (bounds) this.viewport.reveal(bounds, { close });
  }

  /** Whether anything of the selection is on screen. */
  get selectionOnScreen() {
    return this.#boundsOfSelected().some((bounds) => this.viewport.shows(bounds));
  }

  #boundsOfSelected() {
    return this.selected.flatMap((shape) => boundsOf(shape) ?? []);
  }

  /**
   * Shows caps as they would become, without committing them.
   *
   * @param {Shape[]} shapes
   */
  propose(shapes) {
    const { lifted } = this;
    const fresh = shapes.filter(({ uid }) => !lifted.has(uid));
    for (const shape of shapes) this.drafts.put(shape, this.items.get(shape.uid));
    if (fresh.length) this.signals.shapes.emit(fresh.flatMap(({ uid }) => this.items.get(uid) ?? []));
    if (shapes.length === 1) this.signals.draft.emit(shapes[0]);
    this.signals.overlay.emit();
  }

  /** Forgets what was proposed. */
  withdraw() {
    const drafts = this.drafts.clear();
    if (drafts.length)
      this.signals.shapes.emit(drafts.flatMap(({ draft }) => this.items.get(draft.uid) ?? []));
  }

  /** Commits what was proposed, as one step. */
  commitDrafts() {
    const drafts = this.drafts.clear();
    if (drafts.length === 0) return;
    this.commit(
      drafts.flatMap(({ before, draft }) =>
        before && before.cap !== draft.cap ? [changed(before, draft)] : [],
      ),
    );
    this.signals.overlay.emit();
  }

  /**
   * Commits changes, to be undone in one step; the selection follows predictions that became annotations.
   *
   * @param {Change[]} changes
   */
  commit(changes) {
    if (changes.length && this.halfDrawn.empty) this.halfDrawn.begin([]);
    const apart = madeApart(changes, this.store);
    this.#commit(this.#gesture.asBegun(apart));
    /** @type {Map<string, string>} */
    const heirs = new Map();
    for (const { before, after } of apart) {
      const { prediction } = after.cap;
      if ((!before || before.deleted) && !after.deleted && prediction !== null)
        heirs.set(uidOfPrediction(prediction), after.uid);
    }
    if ([...this.selection.uids].some((uid) => heirs.has(uid))) this.selection.follow(heirs);
  }

  /** A press begins a gesture: what it does to caps it does to them as they are now. */
  beginGesture() {
    this.commitDrafts();
    this.#gesture.begin(this.items.all);
  }

  endGesture() {
    this.#gesture.end();
  }
}
