/**
 * The editor's WebSocket. Each connection needs a token that viser puts into the page; when one breaks,
 * the next token (or, where none was spent, the same) opens another, ever more patiently.
 *
 * @module
 */

/** @typedef {import("../protocol.js").FromServer} FromServer */
/** @typedef {import("../protocol.js").ToServer} ToServer */
/** @typedef {"connecting" | "online" | "offline"} Connection */

/**
 * @typedef {Object} Events
 * @property {(token: string) => ToServer} hello  the first message
 * @property {(message: FromServer) => void} message
 * @property {(state: Connection) => void} state
 * @property {(code: number, reason: string) => void} closed  by the server, which says why
 */

const FIRST_WAIT_MS = 250;
const LONGEST_WAIT_MS = 8000;

export class Transport {
  /** @type {WebSocket | null} */
  #socket = null;
  #token = "";
  #wait = 0;
  #timer = 0;
  #url;
  #events;
  /** @type {Connection} */
  state = "connecting";

  /**
   * @param {string} url
   * @param {Events} events
   */
  constructor(url, events) {
    this.#url = url;
    this.#events = events;
  }

  /**
   * The token now in the page.
   *
   * @param {string} token
   */
  offer(token) {
    if (token === this.#token) return;
    this.#token = token;
    this.#socket?.close();
    this.#socket = null;
    this.#wait = Math.min(this.#wait, FIRST_WAIT_MS);
    this.#plan();
  }

  /** @type {(message: ToServer) => boolean} */
  send(message) {
    if (this.state !== "online" || this.#socket?.readyState !== WebSocket.OPEN) return false;
    this.#socket.send(JSON.stringify(message));
    return true;
  }

  /** Gives up on a connection that does not answer. */
  drop() {
    const socket = this.#socket;
    this.#socket = null;
    socket?.close();
    this.#lost();
  }

  #plan() {
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => this.#connect(), this.#wait);
    this.#wait = Math.min(LONGEST_WAIT_MS, Math.max(FIRST_WAIT_MS, this.#wait * 2));
  }

  #connect() {
    const socket = new WebSocket(this.#url);
    const current = () => this.#socket === socket;
    this.#socket = socket;
    socket.addEventListener("open", () => {
      if (current()) socket.send(JSON.stringify(this.#events.hello(this.#token)));
    });
    socket.addEventListener("message", (event) => {
      if (current()) this.#receive(JSON.parse(event.data));
    });
    socket.addEventListener("close", ({ code, reason }) => {
      if (!current()) return;
      this.#events.closed(code, reason);
      this.#lost();
    });
  }

  /** @type {(message: FromServer) => void} */
  #receive(message) {
    if (message.type === "welcome") {
      this.#wait = 0;
      this.#enter("online");
    }
    this.#events.message(message);
  }

  #lost() {
    this.#socket = null;
    this.#enter("offline");
    this.#plan();
  }

  /** @type {(state: Connection) => void} */
  #enter(state) {
    this.state = state;
    this.#events.state(state);
  }
}
