/**
 * The browser's side of a trace that a Python test replays on the real journal: store, history, outbox and
 * sync of a tab, told by lines of JSON what a person, the line and the server do. Answers each line with
 * what the tab has sent since, and how it looks.
 *
 * @module
 */

import { createInterface } from "node:readline";

import { newShape, shapeOfPrediction } from "../../../static/editor/geometry/shapes.js";
import { changed } from "../../../static/editor/state/changes.js";
import { Store } from "../../../static/editor/state/store.js";
import { Outbox } from "../../../static/editor/sync/outbox.js";
import { Sync } from "../../../static/editor/sync/sync.js";
import { MemoryStorage } from "./memory_storage.js";

/** @typedef {import("../../../static/editor/protocol.js").Annotation} Annotation */
/** @typedef {import("../../../static/editor/protocol.js").Cap} Cap */
/** @typedef {import("../../../static/editor/protocol.js").Image} Image */
/** @typedef {import("../../../static/editor/protocol.js").Outcome} Outcome */
/** @typedef {import("../../../static/editor/protocol.js").Prediction} Prediction */
/** @typedef {import("../../../static/editor/protocol.js").Recalled} Recalled */
/** @typedef {import("../../../static/editor/protocol.js").Status} Status */
/** @typedef {import("../../../static/editor/protocol.js").ToServer} ToServer */
/** @typedef {import("../../../static/editor/state/changes.js").Change} Change */

class Tab {
  up = true;
  /** @type {ToServer[]} */
  sent = [];
  /** @type {string[]} */
  refused = [];
  stuck = "";
  /** @type {import("../../../static/editor/geometry/shapes.js").Shape | null} */
  #held = null;
  store = new Store();
  #sync;

  /** @param {Storage} storage */
  constructor(storage) {
    this.#sync = new Sync({
      store: this.store,
      send: (message) => this.up && this.sent.push(structuredClone(message)) > 0,
      stalled: () => {},
      progress: () => {},
      refused: (_edit, reason) => this.refused.push(reason),
      travelled: () => {},
      stuck: (why) => void (this.stuck = why),
    });
    this.#sync.use(new Outbox(storage, "p:"));
  }

  look() {
    const { waiting, conflicts, status } = this.#sync;
    const live = Object.fromEntries(this.store.live().map(({ uid, cap }) => [uid, cap]));
    const told = { sent: this.sent.splice(0), refused: this.refused.splice(0), stuck: this.stuck };
    this.stuck = "";
    return { ...told, live, status, waiting, conflicts: conflicts.map(({ uid, user }) => ({ uid, user })) };
  }

  /** @type {(uid: string, cap: Cap) => void} */
  create(uid, cap) {
    this.#held = null;
    this.#sync.commit([{ before: null, after: newShape(uid, cap) }]);
  }

  /** Several caps become something else in one step; null deletes. @type {(caps: Record<string, Cap | null>) => void} */
  become(caps) {
    this.#held = null;
    /** @type {Change[]} */
    const changes = Object.entries(caps).flatMap(([uid, cap]) => {
      const shape = this.store.get(uid);
      return shape ? [changed(shape, cap ? { ...shape, cap } : { ...shape, deleted: true })] : [];
    });
    this.#sync.commit(changes);
  }

  /** A person takes hold of a cap as it is now; whatever else they do ends that. @type {(uid: string) => void} */
  hold(uid) {
    this.#held = this.store.get(uid);
  }

  /** What was held is let go as another cap, whatever has become of it meanwhile. @type {(cap: Cap | null) => void} */
  release(cap) {
    const held = this.#held;
    this.#held = null;
    if (held) this.#sync.commit([changed(held, cap ? { ...held, cap } : { ...held, deleted: true })]);
  }

  /** Takes a prediction up, or turns it down. @type {(prediction: Prediction, deleted: boolean) => void} */
  take(prediction, deleted) {
    this.#held = null;
    const shape = shapeOfPrediction(prediction);
    this.#sync.commit([changed(shape, { ...shape, deleted })]);
  }

  undo() {
    this.#held = null;
    this.#sync.undo();
  }

  redo() {
    this.#held = null;
    this.#sync.redo();
  }

  /** @type {(image: Image, annotations: Annotation[]) => void} */
  open(image, annotations) {
    this.#sync.open(image, annotations, []);
  }

  /** Ada says something of the image. @type {(status: Status) => void} */
  say(status) {
    this.#sync.say(status);
  }

  /** @type {(image: number, status: Status, own: boolean) => void} */
  status_changed(image, status, own) {
    this.#sync.statusChanged(image, status, own);
  }

  /** @type {(recalled: Recalled) => void} */
  recalled(recalled) {
    this.#sync.recalled(recalled);
  }

  /** @type {(image: number, changeSet: number) => void} */
  take_back(image, changeSet) {
    this.#sync.takeBack(image, changeSet);
  }

  connect() {
    this.up = true;
    this.#sync.resume();
  }

  disconnect() {
    this.up = false;
    this.#sync.pause();
  }

  /** @type {(outcomes: Outcome[]) => void} */
  receive(outcomes) {
    this.#sync.receive(outcomes);
  }

  /** @type {(image: number, annotations: Annotation[]) => void} */
  changed(image, annotations) {
    this.#sync.changed(image, annotations);
  }

  /** @type {(uid: string, whose: "mine" | "theirs") => void} */
  resolve(uid, whose) {
    this.#held = null;
    const conflict = this.#sync.conflicts.find((open) => open.uid === uid);
    if (conflict) this.#sync.resolve(conflict, whose);
  }
}

let storage = new MemoryStorage();
let tab = new Tab(storage);
for await (const line of createInterface({ input: process.stdin })) {
  const [what, ...how] = JSON.parse(line);
  if (what === "forget") storage = new MemoryStorage();
  if (what === "forget" || what === "reload") {
    tab.disconnect();
    tab = new Tab(storage);
  } else Reflect.get(tab, what).apply(tab, how);
  process.stdout.write(`${JSON.stringify(tab.look())}\n`);
}
// Whoever waits for an answer keeps the process alive.
tab.disconnect();
