/**
 * Puts the parts together: state, picture, tools, server.
 *
 * @module
 */

import { goingIn } from "./going.js";
import { Fingers } from "./input/fingers.js";
import { tightened } from "./input/actions/tightening.js";
import { Pointer } from "./input/pointer.js";
import { RimSuggestion } from "./input/rim_suggestion.js";
import { Toolbox } from "./input/toolbox.js";
import { travelIn } from "./input/travel.js";
import { listen } from "./listening.js";
import { Opening } from "./opening.js";
import { performer } from "./performing.js";
import { expose } from "./probe.js";
import { Repeating } from "./repeating.js";
import { Reviewing } from "./reviewing.js";
import { receiver } from "./receiving.js";
import { Frame } from "./render/frame.js";
import { Photos } from "./render/photos.js";
import { EditorState } from "./state/editor_state.js";
import { browserStorage } from "./sync/browser_storage.js";
import { CapRequests, LOOK } from "./sync/cap_requests.js";
import { KeptDrawings } from "./sync/kept_drawings.js";
import { LiveFit } from "./sync/live_fit.js";
import { Sync } from "./sync/sync.js";
import { openOutbox } from "./sync/tab_outbox.js";
import { Transport } from "./sync/transport.js";
import { firstAddress } from "./ui/address.js";
import { captionIn } from "./ui/caption.js";
import { ConflictDialog } from "./ui/conflict.js";
import { hintIn } from "./ui/hint.js";
import { noticesIn } from "./ui/notices.js";
import { pressedButtons } from "./ui/panel.js";
import { Refusals } from "./ui/refusals.js";
import { statusIn } from "./ui/status.js";
import { Threshold } from "./ui/threshold.js";
import { aboutWindow } from "./ui/window.js";

/** @typedef {import("./geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("./protocol.js").FromServer} FromServer */
/** @typedef {import("./protocol.js").ToServer} ToServer */

/** Close codes of the server. */
const NO_NAME = 4401;
const TOO_BIG = 1009;

export class Editor {
  #project = "";
  #user = "";
  /** How many unsaved edits the server was last told of. */
  #waiting = 0;
  /** @type {Promise<void> | null} */
  #ready = null;
  #state;
  #transport;
  #sync;
  #liveFit;
  #drawings;
  #opening;
  #frame;
  #say;
  #status;
  #conflicts;
  #refusals;
  #toolbox;
  #found;
  /** Whether the network looks at photos before anybody points. */
  #looksAhead = true;
  #reviewing;
  #repeating;
  #perform;
  #going;
  #receive;
  #pressed = () => {};
  #window = aboutWindow(() => this.#transport.send(this.#window()));

  /**
   * @param {HTMLElement} host
   * @param {string} url of the editor's socket
   */
  constructor(host, url) {
    const send = (/** @type {ToServer} */ message) => this.#send(message);
    const state = (this.#state = new EditorState((changes) => this.#sync.commit(changes)));
    const select = (/** @type {string} */ uid) => void this.#reviewing.select(uid);
    this.#going = goingIn(state, send, select);
    this.#transport = new Transport(url, {
      hello: (token) => ({ type: "hello", token, image: state.image?.id ?? firstAddress()?.image ?? null }),
      message: (message) => this.#receiveInOrder(message),
      state: () => this.#connectionChanged(),
      closed: (code, reason) => this.#closed(code, reason),
    });
    this.#sync = new Sync({
      store: state.store,
      send,
      stalled: () => this.#transport.drop(),
      progress: () => this.#progress(),
      refused: (edit, reason) => this.#refusals.tell(edit, reason),
      ...travelIn(state, {
        open: (image) => this.#going.open(image, null),
        say: (text, level) => this.#say(text, level),
        tell: (text) => this.#say(text, "info", { about: "undo" }),
        said: (uid, way) => this.#reviewing.saidAgain(uid, way),
      }),
    });
    this.#reviewing = new Reviewing(state, send);
    this.#repeating = new Repeating(send, (text, level) => this.#say(text, level));
    this.#found = new CapRequests(send, () => state.image?.id ?? null);
    const sight = {
      state,
      patch: (/** @type {Bounds} */ bounds) => photos.patch(bounds),
      rimIn: this.#found.rimIn.bind(this.#found),
    };
    const suggestion = new RimSuggestion(state, {
      tightened: (shape) => tightened(sight, shape),
      tightenedByPhoto: (shape) => tightened({ ...sight, rimIn: async () => null }, shape),
    });
    const threshold = new Threshold(state);
    const photos = new Photos(() => this.#frame.redrawPhoto());
    this.#frame = new Frame(host, state, photos, () => [
      ...this.#toolbox.sketches,
      this.#conflicts.sketch,
      this.#refusals.sketch,
      threshold.sketch,
      this.#reviewing.sketch,
      suggestion.sketch,
    ]);
    this.#say = noticesIn(host);
    this.#refusals = new Refusals({
      say: this.#say,
      show: (image, uid) => this.#going.showCap(image, uid),
      image: () => state.image?.id ?? 0,
      redraw: () => state.signals.overlay.emit(),
    });
    this.#status = statusIn(host);
    this.#liveFit = new LiveFit(state, { send, told: captionIn(host) });
    this.#conflicts = new ConflictDialog(host, {
      resolve: (conflict, whose) => this.#sync.resolve(conflict, whose),
      show: ({ image, uid }) => this.#going.showCap(image, uid),
    });
    const tool = () => this.#toolbox.tool;
    this.#pressed = pressedButtons(() => ({ tool: tool().name, status: state.image?.status ?? null }));
    const hint = hintIn(host);
    new Fingers(host, state.viewport, () => host.dispatchEvent(new PointerEvent("pointercancel")));
    const pointer = new Pointer(host, state, {
      tool,
      caused: (event, kind) => this.#frame.causedBy(event, kind),
    });
    this.#toolbox = new Toolbox(state, {
      changed: () => {
        this.#pressed();
        hint(tool().name);
        pointer.letGo();
        pointer.cursor();
      },
      say: (text) => this.#say(text),
      network: { ask: (question, how) => this.#found.ask(question, how), busy: () => this.#found.busy },
    });
    this.#drawings = new KeptDrawings(state.halfDrawn, { storage: browserStorage() });
    this.#opening = new Opening({
      state,
      toolbox: this.#toolbox,
      sync: this.#sync,
      liveFit: this.#liveFit,
      photos,
      frame: this.#frame,
      drawings: this.#drawings,
      select,
      say: this.#say,
      look: () => void (this.#looksAhead && this.#found.ask(LOOK, { keep: false })),
    });
    this.#perform = performer({
      host,
      toolbox: this.#toolbox,
      sync: this.#sync,
      pointer,
      ...sight,
      suggestion,
      reviewing: this.#reviewing,
      repeating: this.#repeating,
      send,
      say: (text) => this.#say(text),
      toggle: (layer) => state.layers.toggle(layer),
      askScore: () => threshold.ask(),
    });
    this.#receive = receiver({
      state,
      sync: this.#sync,
      reviewing: this.#reviewing,
      repeating: this.#repeating,
      liveFit: this.#liveFit,
      found: this.#found,
      opening: this.#opening,
      perform: this.#perform,
      say: this.#say,
      user: () => this.#user,
      progress: () => this.#progress(),
    });
    listen({
      host,
      state,
      pointer,
      toolbox: this.#toolbox,
      frame: this.#frame,
      sync: this.#sync,
      drawings: this.#drawings,
      going: this.#going,
      reviewing: this.#reviewing,
      perform: this.#perform,
      send,
      say: this.#say,
      progress: () => this.#progress(),
    });
    hint(tool().name);
    this.#progress();
    expose(host, {
      state,
      frame: this.#frame,
      suggestion: () => suggestion.shown,
      waiting: () => this.#unsaved,
      asking: () => this.#found.busy,
      connection: () => this.#transport.state,
      tool: () => tool().name,
      review: this.#reviewing.review,
    });
  }

  /** @type {(token: string) => void} */
  offer(token) {
    this.#transport.offer(token);
  }

  /** @type {(message: ToServer) => boolean} */
  #send(message) {
    const sent = this.#transport.send(message);
    if (message.type === "step" || message.type === "open") this.#opening.ask(sent);
    return sent;
  }

  /** @type {(code: number, reason: string) => void} */
  #closed(code, reason) {
    if (code === NO_NAME) this.#say(`${reason} Load the page anew.`, "error");
    if (code === TOO_BIG) this.#sync.giveUp(reason);
  }

  #connectionChanged() {
    if (this.#transport.state === "offline") {
      this.#sync.pause();
      this.#found.forget();
    }
    this.#progress();
  }

  /** Edits that are not acknowledged, and nudges that are not even committed. */
  get #unsaved() {
    return this.#sync.waiting + this.#state.drafts.waiting;
  }

  #progress() {
    const { kept, conflicts, status } = this.#sync;
    const waiting = this.#unsaved;
    const { image } = this.#state;
    if (image && image.id === this.#sync.image && image.status !== status)
      this.#state.image = { ...image, status };
    this.#pressed();
    this.#status({ connection: this.#transport.state, waiting, kept, conflicts: conflicts.length });
    this.#conflicts.update(conflicts, this.#state.image?.id ?? 0);
    if (waiting !== this.#waiting && this.#transport.send({ type: "saving", waiting }))
      this.#waiting = waiting;
  }

  /**
   * Opening the outbox takes a moment, and no image may overtake it.
   *
   * @type {(message: FromServer) => void}
   */
  #receiveInOrder(message) {
    if (message.type === "welcome") this.#ready = this.#welcome(message);
    else if (this.#ready) void this.#ready.then(() => this.#receive(message));
  }

  /** @type {(welcome: import("./protocol.js").Welcome) => Promise<void>} */
  async #welcome({ project, user, look_ahead }) {
    this.#waiting = 0;
    this.#user = user;
    this.#looksAhead = look_ahead;
    this.#transport.send(this.#window());
    if (this.#project !== project) {
      this.#project = project;
      this.#drawings.use(project);
      this.#sync.use(await openOutbox(project, () => this.#sync.adopted()));
    }
    this.#sync.resume();
  }
}
