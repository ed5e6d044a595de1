"""Keys, the status line, live fits, the connection."""

from __future__ import annotations

import pytest


def test_every_key_runs_a_command_that_exists_and_no_key_runs_two(call) -> None:
    body = """
      const {KEYS} = await import('/editor/input/keys.js');
      const all = KEYS.flatMap(([, bindings]) => bindings);
      const keys = all.flatMap((binding) => binding.keys.map((key) => key.toLowerCase()));
      const missing = all.filter(({command}) => !(command in m.COMMANDS)).map(({command}) => command);
      return [missing, keys.filter((key, i) => keys.indexOf(key) !== i)];
    """
    assert call("state/commands", body) == [[], []]


@pytest.mark.parametrize(
    ("event", "command"),
    [
        ({"key": "z", "ctrlKey": True}, "undo"),
        ({"key": "Z", "ctrlKey": True, "shiftKey": True}, "redo"),
        ({"key": "z", "metaKey": True}, "undo"),
        ({"key": "?", "shiftKey": True}, "help"),
        ({"key": "Tab", "shiftKey": True}, "previous_cap"),
        ({"key": "A", "shiftKey": True}, "accept_all"),
        ({"key": "ArrowLeft", "shiftKey": True}, "push_left"),
        ({"key": "ф", "code": "KeyA"}, "accept"),
        ({"key": "r", "ctrlKey": True}, None),
    ],
)
def test_a_chord_runs_its_command_on_any_layout(call, event: dict, command: str | None) -> None:
    assert call("input/keys", "return m.commandOf(new KeyboardEvent('keydown', a))", event) == command


@pytest.mark.parametrize(
    ("state", "text"),
    [
        ({"connection": "online", "waiting": 0, "kept": True, "clashes": 0}, "Saved"),
        ({"connection": "online", "waiting": 1, "kept": True, "clashes": 0}, "Saving 1 edit…"),
        (
            {"connection": "offline", "waiting": 3, "kept": True, "clashes": 0},
            "Offline, 3 edits kept in this browser",
        ),
        ({"connection": "online", "waiting": 0, "kept": True, "clashes": 2}, "Saved · 2 conflicts to settle"),
    ],
)
def test_the_status_line_says_what_is_so(call, state: dict, text: str) -> None:
    assert call("ui/status", "return m.statusOf(a).text", state) == text


def test_the_status_line_never_says_saved_when_edits_could_not_be_kept(call) -> None:
    state = {"connection": "offline", "waiting": 2, "kept": False, "clashes": 0}
    status = call("ui/status", "return m.statusOf(a)", state)
    assert "not saved" in status["text"]
    assert status["tone"] == "bad"


def test_one_fit_is_asked_for_at_a_time_and_the_latest_wins(call) -> None:
    body = """
      const sent = [];
      const refits = new m.Refits((message) => sent.push(message) > 0);
      const question = (name) => ({image: 1, annotation: 'u', cap: name});
      for (const name of ['a', 'b', 'c']) refits.ask(question(name));
      const late = refits.take({seq: 99});
      const first = refits.take({seq: 1});
      const second = refits.take({seq: 2});
      return [sent.map(({seq, cap}) => [seq, cap]), late, first.cap, second.cap];
    """
    assert call("sync/fit_requests", body) == [[[1, "a"], [2, "c"]], None, "a", "c"]


def test_a_question_that_was_given_up_does_not_hold_up_the_next(call) -> None:
    body = """
      const sent = [];
      const refits = new m.Refits((message) => sent.push(message) > 0);
      const question = (name) => ({image: 1, annotation: 'u', cap: name});
      refits.ask(question('a')); refits.ask(question('b'));
      refits.forget();
      refits.ask(question('c'));
      return [sent.map(({seq, cap}) => [seq, cap]), refits.take({seq: 1}), refits.take({seq: 2}).cap];
    """
    assert call("sync/fit_requests", body) == [[[1, "a"], [2, "c"]], None, "c"]


def test_the_caption_gives_the_reason_and_how_well_the_centre_is_known(call) -> None:
    fits = [{"note": "regular", "centre_sd": [0.1234, 2]}, {"note": "the marked circle", "centre_sd": None}]
    captions = call("ui/caption", "return a.map(m.captionOf)", fits)
    assert captions == ["regular · centre ± 0.12, 2.00 px", "the marked circle"]


def test_arcs_of_all_kinds_differ_by_dash_alone(call) -> None:
    dashes = call("render/palette", "return Object.values(m.ARCS).map(({dash}) => dash.join())")
    assert len(dashes) == len(set(dashes)) == 4


DRAWN = """
  const canvas = new OffscreenCanvas(60, 40);
  const context = canvas.getContext('2d');
  context.lineCap = 'round';
  m[a.draw](context, {scale: 2, x: 10, y: 0}, a.fit);
  const {data} = context.getImageData(0, 0, 60, 40);
  const at = (x, y) => [...data.slice(4 * (60 * y + x), 4 * (60 * y + x) + 4)];
  return a.where.map(([x, y]) => at(x, y));
"""


def test_an_arc_is_drawn_where_it_lies_in_the_colour_of_its_kind(call) -> None:
    arcs = [
        {"kind": "visible", "points": [0, 5, 20, 5]},
        {"kind": "border", "points": [10, 15]},
    ]
    where = [(30, 10), (30, 30), (30, 20)]
    painted = call("render/arcs", DRAWN, {"draw": "drawArcs", "fit": {"arcs": arcs}, "where": where})
    assert painted == [[0x45, 0xC8, 0xFF, 255], [255, 255, 255, 255], [0, 0, 0, 0]]


def test_the_uncertainty_is_an_ellipse_of_one_standard_deviation_that_never_vanishes(call) -> None:
    where = [(30 + 16, 20), (30, 20 + 6), (30 + 2, 20), (30, 20)]
    wide = {"centre": [10, 10], "centre_sd": [8, 3]}
    tiny = {"centre": [10, 10], "centre_sd": [0.01, 0.01]}
    seen = [
        [
            pixel[3] > 100
            for pixel in call("render/arcs", DRAWN, {"draw": "drawUncertainty", "fit": fit, "where": where})
        ]
        for fit in (wide, tiny)
    ]
    assert seen[0] == [True, True, False, False]
    assert seen[1][:3] == [False, False, True]


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


def test_a_browser_without_webgl_is_told_so_in_words(browser, static_url) -> None:
    context = browser.new_context()
    page = context.new_page()
    page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    page.goto(f"{static_url}/jsconfig.json")
    page.evaluate("import('/editor/main.js')")
    assert "needs WebGL" in page.get_by_role("alert").inner_text()
    context.close()
