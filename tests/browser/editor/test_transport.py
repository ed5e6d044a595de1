"""The connection to the server, in a browser that is told what its socket hears."""

from __future__ import annotations

FAKE_SOCKET = """
  const sockets = [];
  window.WebSocket = class extends EventTarget {
    static OPEN = 1;
    readyState = 1;
    sent = [];
    constructor() { super(); sockets.push(this); setTimeout(() => this.dispatchEvent(new Event('open'))); }
    send(text) { this.sent.push(JSON.parse(text)); }
    close() { this.dispatchEvent(new CloseEvent('close', {code: 1006})); }
    say(message) { this.dispatchEvent(new MessageEvent('message', {data: JSON.stringify(message)})); }
  };
  const states = [];
  const rest = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
  const line = new m.Transport('ws://nowhere', {
    hello: (token) => ({type: 'hello', token, image: null}),
    message() {},
    closed() {},
    state: (state) => states.push(state),
  });
"""


def test_a_new_token_opens_a_connection_at_once_and_only_a_welcome_makes_it_online(call) -> None:
    body = (
        FAKE_SOCKET
        + """
      line.offer('one'); await rest(30);
      const early = line.send({type: 'saving', waiting: 0});
      sockets[0].say({type: 'welcome', user: 'Ada', project: 'p'});
      const late = line.send({type: 'saving', waiting: 0});
      return [early, late, sockets[0].sent.map(({type}) => type), states];
    """
    )
    assert call("sync/transport", body) == [False, True, ["hello", "saving"], ["online"]]


def test_a_broken_connection_is_tried_again_with_the_token_in_the_page(call) -> None:
    body = (
        FAKE_SOCKET
        + """
      line.offer('one'); await rest(30);
      sockets[0].say({type: 'welcome', user: 'Ada', project: 'p'});
      sockets[0].close();
      line.offer('two'); await rest(400);
      const hello = sockets.at(-1).sent[0];
      sockets.at(-1).say({type: 'welcome', user: 'Ada', project: 'p'});
      return [hello.token, states];
    """
    )
    assert call("sync/transport", body) == ["two", ["online", "offline", "online"]]
