"""Measures inside the page, by the browser's own clock, what a person waits for."""

from __future__ import annotations

from fairyring.app.bench.browser.tab import Tab

SCRIPT = r"""
(() => {
  const last = {};
  for (const kind of ["pointermove", "pointerup", "keydown"]) {
    addEventListener(kind, (event) => (last[kind] = event.timeStamp), true);
  }
  // Some browsers tell of a move before they tell of it to those that listen for `pointermove`.
  addEventListener("pointerrawupdate", ({ timeStamp }) => (last.pointermove = timeStamp), true);
  const laps = { saved: [], accepted: [], fit: [], vertex: [], preview: [] };
  const asked = new Map();
  const sequence = (data) => Number(/"seq":\s*(\d+)/.exec(data)[1]);
  const after = (task) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = task;
    port2.postMessage(null);
  };
  const onScreen = (lap, since) => {
    requestAnimationFrame(() => after(() => laps[lap].push(performance.now() - since)));
  };
  const dragged = ({ buttons, timeStamp }) => buttons === 1 && onScreen("vertex", timeStamp);
  addEventListener("pointermove", dragged, true);
  function received(data) {
    if (data.startsWith('{"type":"outcomes"')) {
      laps.saved.push(performance.now() - last.pointerup);
      laps.accepted.push(performance.now() - last.keydown);
    }
    if (data.startsWith('{"type":"found_cap"')) onScreen("preview", last.pointermove);
    if (data.startsWith('{"type":"fit"')) onScreen("fit", asked.get(sequence(data)));
  }
  window.WebSocket = class extends WebSocket {
    constructor(...where) {
      super(...where);
      this.addEventListener("message", ({ data }) => typeof data === "string" && received(data));
    }
    send(data) {
      const refit = typeof data === "string" && data.startsWith('{"type":"refit"');
      if (refit) asked.set(sequence(data), last.pointermove);
      super.send(data);
    }
  };
  window.stopwatch = { last, laps };
})();
"""
"""Notes when a press, a move or a key came, and when the answer to it was there (a fit: was on screen).

How long the dragged vertex itself takes to be on screen tells what is the browser's share of that."""

BLANK = r"""
<body style="margin: 0; height: 100vh"><script>
  let since = null;
  const frames = [];
  for (const kind of ["pointermove", "pointerup", "wheel"]) {
    addEventListener(kind, (event) => {
      if (since !== null) return;
      since = event.timeStamp;
      requestAnimationFrame(() => {
        frames.push(performance.now() - since);
        since = null;
      });
    });
  }
</script>
"""
"""A page that draws nothing: ``frames`` is what the browser itself takes from an event to a frame."""


def start(tab: Tab) -> None:
    """Forgets what was measured before."""
    tab.page.evaluate(
        """() => {
            fairyring.timings.length = 0;
            for (const lap of Object.values(stopwatch.laps)) lap.length = 0;
        }"""
    )


def frames(tab: Tab, kind: str) -> tuple[list[float], list[float]]:
    """Milliseconds of every frame that a ``kind`` of event caused.

    From the event to the end of the drawing, and the drawing alone.
    """
    timings = [t for t in tab.page.evaluate("() => fairyring.timings") if t["kind"] == kind]
    return [t["drawn"] - t["event"] for t in timings], [t["draw_ms"] for t in timings]


def laps(tab: Tab, name: str) -> list[float]:
    """Milliseconds of one kind of lap: from a release or key to its receipt, or a move to its drawing."""
    return tab.page.evaluate("name => stopwatch.laps[name]", name)


def ask_for(tab: Tab, image: int) -> float:
    """Asks for an image as a link in the panel does; returns the time, by the page's clock."""
    return tab.page.evaluate(
        """image => {
            const link = document.createElement("a");
            link.dataset.fairyringOpen = String(image);
            document.body.append(link);
            const now = performance.now();
            link.click();
            link.remove();
            return now;
        }""",
        image,
    )


def key_pressed(tab: Tab) -> float:
    """The time at which a key was pressed last, by the page's clock."""
    return tab.page.evaluate("() => stopwatch.last.keydown")


def shown(tab: Tab) -> float:
    """Waits for the image asked for; returns the time at which its caps were drawn, by the page's clock."""
    tab.wait_for("fairyring.timings.some(({ kind }) => kind === 'switch')")
    return tab.page.evaluate("() => fairyring.timings.findLast(({ kind }) => kind === 'switch').drawn")


def photo_alone(tab: Tab) -> float:
    """Fetches and decodes the photo on screen without the editor; milliseconds."""
    return tab.page.evaluate(
        """async () => {
            const { id, sha256 } = fairyring.state.image;
            const start = performance.now();
            const url = `/photos/${id}/${sha256.slice(0, 16)}?w=2000`;
            const answer = await fetch(url, { cache: "no-store" });
            (await createImageBitmap(await answer.blob())).close();
            return performance.now() - start;
        }"""
    )


def drawn_as_saved(tab: Tab) -> float:
    """Waits until every edit is acknowledged and drawn; milliseconds since a key was pressed last."""
    return tab.page.evaluate(
        """() => new Promise((resolve) => {
            const look = () => {
                if (fairyring.state.waiting > 0) return requestAnimationFrame(look);
                fairyring.whenDrawn(() => resolve(performance.now() - stopwatch.last.keydown));
            };
            look();
        })"""
    )
