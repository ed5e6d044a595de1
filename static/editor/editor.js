/**
 * Puts the parts together: desk, picture, tools, server.
 *
 * @module
 */

import { COMMANDS } from "./state/commands.js";
import { ConflictCard } from "./ui/conflict.js";
import { Desk } from "./state/desk.js";
import { Fitting } from "./sync/live_fit.js";
import { Frame } from "./render/frame.js";
import { keyList } from "./ui/help.js";
import { listenToKeys } from "./input/keyboard.js";
import { noticesIn } from "./ui/notices.js";
import { listenToPanel, pressedButtons } from "./ui/panel.js";
import { Photos } from "./render/photos.js";
import { Pointer } from "./input/pointer.js";
import { expose } from "./probe.js";
import { statusIn } from "./ui/status.js";
import { Sync } from "./sync/sync.js";
import { openOutbox } from "./sync/outbox_owner.js";
import { Toolbox } from "./input/toolbox.js";
import { Transport } from "./sync/transport.js";

/** @typedef {import("./protocol.js").FromServer} FromServer */
/** @typedef {import("./protocol.js").Layers} Layers */
/** @typedef {import("./protocol.js").Show} Show */
/** @typedef {import("./protocol.js").ToServer} ToServer */

/** Close codes of the server. */
const NO_NAME = 4401;
const TOO_BIG = 1009;

export class Editor {
  #project = "";
  #waiting = 0;
  /** @type {Promise<void> | null} */
  #ready = null;
  /** When the person asked for another image. @type {number | null} */
  #switchAsked = null;
  #host;
  #transport;
  #sync;
  #fitting;
  #photos;
  #frame;
  #desk;
  #say;
  #status;
  #card;
  #pointer;
  #toolbox;

  /**
   * @param {HTMLElement} host
   * @param {string} url of the editor's socket
   */
  constructor(host, url) {
    this.#host = host;
    const send = (/** @type {ToServer} */ message) => this.#send(message);
    this.#desk = new Desk((changes) => this.#sync.commit(changes));
    this.#transport = new Transport(url, {
      hello: (token) => ({ type: "hello", token, image: this.#desk.image?.id ?? null }),
      message: (message) => this.#receiveInOrder(message),
      state: () => this.#connectionChanged(),
      closed: (code, reason) => this.#closed(code, reason),
    });
    this.#sync = new Sync({
      store: this.#desk.store,
      send,
      stalled: () => this.#transport.drop(),
      progress: () => this.#progress(),
      refused: (reason) => this.#say(reason, "error"),
    });
    this.#photos = new Photos(() => this.#frame.redrawPhoto());
    this.#frame = new Frame(host, this.#desk, this.#photos, () => [
      this.#toolbox.tool.sketch ?? (() => false),
      this.#card.sketch,
    ]);
    this.#say = noticesIn(host);
    this.#status = statusIn(host);
    this.#fitting = new Fitting(host, this.#desk, send);
    this.#card = new ConflictCard(host, {
      resolve: (clash, whose) => this.#sync.resolve(clash, whose),
      show: (clash) => this.#showClash(clash),
    });
    const pressed = pressedButtons(() => this.#toolbox.tool.name);
    this.#toolbox = new Toolbox(this.#desk, () => {
      pressed();
      this.#pointer.cursor();
    });
    this.#pointer = new Pointer(host, this.#desk, this.#frame, () => this.#toolbox.tool);
    const run = this.#makeRunner();
    listenToKeys({
      run,
      desk: this.#desk,
      pointer: this.#pointer,
      blame: (at) => this.#frame.blame(at, "key"),
    });
    listenToPanel({
      run,
      use: (name) => this.#toolbox.use(name),
      open: (image, select) => this.#open(image, select),
    });
    this.run = run;
    this.#listen();
    this.#progress();
    expose(host, {
      desk: this.#desk,
      frame: this.#frame,
      waiting: () => this.#unsaved,
      connection: () => this.#transport.state,
      tool: () => this.#toolbox.tool.name,
    });
  }

  /** @type {(token: string) => void} */
  offer(token) {
    this.#transport.offer(token);
  }

  /** @returns {(name: string) => boolean} */
  #makeRunner() {
    const bench = {
      desk: this.#desk,
      sync: this.#sync,
      tool: () => this.#toolbox.tool,
      use: (/** @type {string} */ name) => this.#toolbox.use(name),
      send: (/** @type {ToServer} */ message) => this.#send(message),
      toggle: (/** @type {string} */ layer) => this.#toggle(layer),
      help: keyList(),
      say: (/** @type {string} */ text) => this.#say(text),
    };
    return (name) => {
      const command = Object.hasOwn(COMMANDS, name) ? COMMANDS[name] : null;
      command?.(bench);
      return command !== null;
    };
  }

  #listen() {
    const { signals } = this.#desk;
    signals.selection.listen(() => this.#tellSelection());
    signals.nudge.listen(() => this.#progress());
    new ResizeObserver(([entry]) => this.#desk.lens.resize(entry.contentRect)).observe(this.#host);
    window.addEventListener("beforeunload", (event) => {
      this.#desk.settle();
      if (!this.#sync.kept) event.preventDefault();
    });
  }

  /** @type {(message: ToServer) => boolean} */
  #send(message) {
    if (message.type === "step" || message.type === "open") this.#switchAsked = performance.now();
    const sent = this.#transport.send(message);
    if (!sent && this.#switchAsked !== null) {
      this.#say("The server cannot be reached; other images can be opened when it is back.", "warning");
      this.#switchAsked = null;
    }
    return sent;
  }

  /** @type {(image: number, select: string | null) => void} */
  #open(image, select) {
    this.#desk.settle();
    if (image === this.#desk.image?.id) {
      if (select) this.#desk.select([select], { reveal: true });
      return;
    }
    this.#send({ type: "open", image, select });
  }

  /** @type {(clash: import("./sync/sync.js").Clash) => void} */
  #showClash(clash) {
    if (clash.image !== this.#desk.image?.id) this.#open(clash.image, clash.uid);
    else if (this.#desk.item(clash.uid)) {
      this.#desk.select([clash.uid]);
      this.#desk.reveal({ close: true });
    }
  }

  #tellSelection() {
    const sole = this.#desk.sole;
    const predicted = sole?.score != null;
    this.#transport.send({
      type: "select",
      annotation: sole && !predicted ? sole.uid : null,
      prediction: predicted ? (sole?.cap.prediction ?? null) : null,
    });
  }

  /** @type {(code: number, reason: string) => void} */
  #closed(code, reason) {
    if (code === NO_NAME) this.#say(`${reason} Load the page anew.`, "error");
    if (code === TOO_BIG) this.#sync.giveUp(reason);
  }

  #connectionChanged() {
    if (this.#transport.state === "offline") this.#sync.pause();
    this.#progress();
  }

  get #unsaved() {
    return this.#sync.waiting + this.#desk.unsettled;
  }

  #progress() {
    const { kept, clashes } = this.#sync;
    const waiting = this.#unsaved;
    this.#status({ connection: this.#transport.state, waiting, kept, clashes: clashes.length });
    this.#card.update(clashes, this.#desk.image?.id ?? 0);
    if (waiting !== this.#waiting && this.#transport.send({ type: "saving", waiting }))
      this.#waiting = waiting;
  }

  /**
   * Opening the outbox takes a moment, and no image may overtake it.
   *
   * @type {(message: FromServer) => void}
   */
  #receiveInOrder(message) {
    if (message.type === "welcome") this.#ready = this.#welcome(message.project);
    else if (this.#ready) void this.#ready.then(() => this.#receive(message));
  }

  /** @type {(message: FromServer) => void} */
  #receive(message) {
    switch (message.type) {
      case "show":
        return this.#show(message);
      case "outcomes":
        return this.#sync.settle(message.outcomes);
      case "changed":
        return this.#sync.changed(message.image, message.annotations);
      case "predicted":
        if (message.image === this.#desk.image?.id) this.#desk.predict(message.predictions);
        return;
      case "fit":
        return this.#fitting.take(message);
      case "layers":
        return this.#layers(message);
      case "command":
        return void this.run(message.name);
      case "notice":
        return this.#say(message.text, message.level);
    }
  }

  /** @type {(project: string) => Promise<void>} */
  async #welcome(project) {
    this.#waiting = 0;
    if (this.#project !== project) {
      this.#project = project;
      this.#sync.use(await openOutbox(project));
    }
    this.#sync.resume();
  }

  /** @type {(show: Show) => void} */
  #show({ contents, photo, select, ahead }) {
    const asked = this.#switchAsked ?? performance.now();
    this.#switchAsked = null;
    const { image } = contents;
    if (image.id !== this.#desk.image?.id) {
      this.#toolbox.tool.cancel();
      this.#desk.settle();
      this.#frame.blank();
    }
    this.#fitting.forget();
    this.#sync.open(image.id, contents.annotations);
    this.#desk.open(contents);
    if (select) this.#desk.select([select], { reveal: true });
    this.#progress();
    this.#photos
      .open(photo, image)
      .then(() => this.#frame.whenComplete(() => this.#shown(asked, ahead)))
      .catch((error) => this.#say(`${image.file_name}: ${error.message}`, "error"));
  }

  /** @type {(asked: number, ahead: string[]) => void} */
  #shown(asked, ahead) {
    const drawn = performance.now();
    this.#frame.log({ event: asked, drawn, draw_ms: 0, kind: "switch" });
    this.#photos.prefetch(ahead);
  }

  /** @type {(layers: Layers) => void} */
  #layers({ visible, brightness, contrast }) {
    const plain = brightness === 1 && contrast === 1;
    this.#frame.tint(plain ? "" : `brightness(${brightness}) contrast(${contrast})`);
    const layers = { ...this.#desk.layers, ...visible };
    if (JSON.stringify(layers) === JSON.stringify(this.#desk.layers)) return;
    this.#desk.layers = layers;
    this.#frame.redraw();
  }

  /** @type {(layer: string) => void} */
  #toggle(layer) {
    this.#desk.layers = { ...this.#desk.layers, [layer]: !this.#desk.layers[layer] };
    this.#frame.redraw();
    this.#transport.send({ type: "toggle", layer });
  }
}
