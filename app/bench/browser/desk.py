"""The reviewer's desk with 1000 images of 60 caps: what people wait for, and 50 images decided by keys.

Every image holds a mark that is off and a cap that nobody predicted; all else is predicted as it was drawn.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from typing import Any
from uuid import uuid4

import msgspec
from playwright.sync_api import Browser

from fairyring.app.bench.browser.tab import Tab, chromium
from fairyring.app.bench.plain import synced_inserts
from fairyring.app.bench.projects import Bed, write_labels
from fairyring.app.bench.serving import Server, served
from fairyring.app.bench.timing import Row, milliseconds, p95_row, row
from fairyring.app.caps.filling_in import fill_in
from fairyring.app.jobs.comparing import compare_work
from fairyring.model.geometry.shapes import bounds_of_outline
from fairyring.model.progress import silent
from fairyring.storage.choices import ImportAs
from fairyring.storage.importing.paths import import_paths
from fairyring.storage.journal import commit
from fairyring.storage.project import Project, create_project
from fairyring.storage.records import Verdict

OFF_PX = 6.0
"""By how much the mark of the first cap of each image is off."""
FIRST_FIGURES_MS, FILTER_MS, VERDICT_MS = 300, 150, 50
CLICKS = 20
PART, PARTS = 50, 4
"""So many images are decided at a time, and so many times."""
FIRST = "first figures, from the click on Review on (reference: what History takes)"
OPENED = "first figures, from the editor's hello on (reference: the list of images)"
WATCH = r"""
(() => {
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function (data) {
    if (typeof data === "string" && data.startsWith('{"type":"hello"')) window.helloAt = performance.now();
    return send.call(this, data);
  };
  const shown = { Review: ".fr-totals", History: ".fr-history", annotator: ".fr-groups" };
  addEventListener("click", (event) => {
    const name = event.target.closest("[role=tab], [role=option]")?.textContent;
    const since = performance.now();
    const look = () => document.querySelector(shown[name])?.checkVisibility()
      ? (window.taken = performance.now() - since) : setTimeout(look, 1);
    if (shown[name]) look();
  }, { capture: true });
  new MutationObserver(() => {
    const there = document.querySelector(".fr-totals") && document.querySelector(".fr-gallery button");
    if (there) window.figuresAt ??= performance.now();
    if (document.querySelector(".fr-images tr")) window.listAt ??= performance.now();
  }).observe(document, { childList: true, subtree: true });
})();
"""
CLICKED_UNTIL = r"""
([button, done]) => new Promise((resolve) => {
  const since = performance.now();
  const look = () => document.querySelector(done) ? resolve(performance.now() - since) : setTimeout(look, 1);
  document.querySelector(button).click();
  look();
})
"""


def desk_rows(*, quick: bool = False) -> list[Row]:
    """First figures, filtering, verdicts, a reviewer's 50 images, and the server's memory."""
    count, caps, decided = (16, 5, 3) if quick else (1000, 60, PART)
    with tempfile.TemporaryDirectory(prefix="fairyring-bench-") as folder:
        with _reviewable(Path(folder), count=count, caps=caps) as project:
            rows = [_verdicts(project, Path(folder), count)]
        with served(project.folder) as server, chromium() as browser:
            return [*rows, *_waiting(browser, server), *_decide(browser, server, decided)]


def _reviewable(folder: Path, *, count: int, caps: int) -> Project:
    """A project whose images are annotated, predicted and compared; open."""
    beds = [Bed(name=f"bed_{i:04}.jpg", width=640, height=480, caps=caps, vertices=40) for i in range(count)]
    drawn = msgspec.json.decode(write_labels(folder / "photos", beds).read_bytes())
    (folder / "photos" / "labels.json").unlink()
    annotated, predicted = folder / "annotated.json", folder / "predicted.json"
    images = [image | {"status": "annotated"} for image in drawn["images"]]
    annotated.write_bytes(msgspec.json.encode(drawn | {"images": images, "annotations": _marked(drawn)}))
    predicted.write_bytes(msgspec.json.encode(drawn | {"annotations": _said(drawn)}))
    project = create_project(folder / "project")
    import_paths(project, [folder / "photos"], link=True)
    import_paths(project, [annotated])
    import_paths(project, [predicted], as_=ImportAs.predictions)
    fill_in(project)
    compare_work(project)(silent)
    return project


def _firsts(drawn: dict[str, Any]) -> dict[int, int]:
    """The id of the first annotation of each image."""
    return {each["image_id"]: each["id"] for each in reversed(drawn["annotations"])}


def _marked(drawn: dict[str, Any]) -> list[dict[str, Any]]:
    firsts = _firsts(drawn)
    return [
        each | {"circle": _circle(each, OFF_PX if firsts[each["image_id"]] == each["id"] else 0.0)}
        for each in drawn["annotations"]
    ]


def _said(drawn: dict[str, Any]) -> list[dict[str, Any]]:
    """What is predicted: all caps but the second of each image, where they were drawn."""
    seconds = {image: number + 1 for image, number in _firsts(drawn).items()}
    return [
        each | {"score": 0.9, "circle": _circle(each, 0.0)}
        for each in drawn["annotations"]
        if each["id"] != seconds[each["image_id"]]
    ]


def _circle(annotation: dict[str, Any], off: float) -> list[float]:
    x, y, width, height = bounds_of_outline(annotation["segmentation"])
    return [x + width / 2 + off, y + height / 2, (width + height) / 4]


def _verdicts(project: Project, folder: Path, count: int) -> Row:
    said = [
        Verdict(id=uuid4().hex, image=1 + nth % count, says="comment", words="Is it one?")
        for nth in range(100)
    ]
    taken = milliseconds(lambda each: commit(project, [], verdicts=[each], user="Rev"), said)
    plain = synced_inserts(folder / "plain.db", payload="Is it one?")
    figure = "a verdict on disk (reference: a synced insert by sqlite3)"
    return p95_row(figure, taken, target=VERDICT_MS, reference=plain)


def _waiting(browser: Browser, server: Server) -> list[Row]:
    page = browser.new_page(viewport={"width": 1500, "height": 900})
    page.add_init_script(WATCH)
    tab = Tab(page)
    taken, lists, opened, histories = [], [], [], []
    try:
        tab.enter(server.url, name="Rev")
        for _ in range(CLICKS):
            page.reload()
            tab.wait_for("window.listAt && window.helloAt")
            taken.append(_shown(tab, "Review"))
            tab.wait_for("window.figuresAt")
            histories.append(_shown(tab, "History"))
            _shown(tab, "Review")
            lists.append(page.evaluate("window.listAt - window.helloAt"))
            opened.append(page.evaluate("window.figuresAt - window.helloAt"))
        filtered = [_filter(tab, ("missed", "extra", "worst")[nth % 3]) for nth in range(CLICKS)]
        grouped = [_grouped(tab) for _ in range(CLICKS)]
    finally:
        page.close()
    return [
        p95_row(FIRST, taken, target=FIRST_FIGURES_MS, reference=histories),
        p95_row(OPENED, opened, reference=lists),
        p95_row("other caps of all images, from the click to the page", filtered, target=FILTER_MS),
        p95_row("figures by annotator, from the choice to the page", grouped, target=FILTER_MS),
    ]


def _filter(tab: Tab, kind: str) -> float:
    button = f"[data-fairyring-gallery={kind}][aria-pressed]"
    return tab.page.evaluate(CLICKED_UNTIL, [button, f"[data-fairyring-gallery={kind}][aria-pressed=true]"])


def _shown(tab: Tab, name: str) -> float:
    """Clicks a tab of the panel; milliseconds until what it holds is in sight."""
    tab.page.evaluate("window.taken = null")
    tab.page.get_by_role("tab", name=name).click()
    tab.wait_for("window.taken !== null")
    return tab.page.evaluate("window.taken")


def _grouped(tab: Tab) -> float:
    """Has figures shown by annotator; milliseconds from the choice until they stand there."""
    tab.page.evaluate("window.taken = null")
    _choose(tab, "annotator")
    tab.wait_for("window.taken !== null")
    taken = tab.page.evaluate("window.taken")
    _choose(tab, "nothing")
    tab.wait_for("!document.querySelector('.fr-groups')")
    return taken


def _choose(tab: Tab, words: str) -> None:
    tab.page.get_by_label("Figures by", exact=True).first.click()
    tab.page.get_by_role("option", name=words, exact=True).click()


def _decide(browser: Browser, server: Server, count: int) -> list[Row]:
    """A reviewer takes the annotator's where nobody predicted a cap, the model's where a mark is off.

    Then they go on, to tell whether the server keeps anything of an image: its memory would grow as before.
    """
    page = browser.new_page(viewport={"width": 1500, "height": 900})
    tab = Tab(page)
    try:
        tab.enter(server.url, name="Rev")
        memory, start = [server.memory_mb()], time.perf_counter()
        inputs = sum(_decide_one(tab) for _ in range(count))
        tab.saved()
        taken = time.perf_counter() - start
        memory.append(server.memory_mb())
        for _ in range(PARTS - 1):
            for _ in range(count):
                _decide_one(tab)
            memory.append(server.memory_mb())
    finally:
        page.close()
    return [
        row(f"inputs for {count} images, two decisions each", inputs, unit="keys"),
        row("machine time of an image, key by key", taken / count * 1e3, unit="ms"),
        row("what the server's memory grew by meanwhile", memory[1] - memory[0], unit="MB"),
        row(f"and over the last {count} of {PARTS * count} images", memory[-1] - memory[-2], unit="MB"),
    ]


def _decide_one(tab: Tab) -> int:
    """Decides the image on screen and goes on to the next; how many keys that took."""
    number = tab.state("image")["id"]
    tab.press(".")
    tab.wait_for("window.fairyring.state.selection.length === 1")
    (missed,) = tab.state("selection")
    tab.press("u")
    tab.wait_for(f"window.fairyring.state.selection[0] !== {missed!r}")
    tab.press("s", "Shift+Enter")
    tab.wait_for(f"window.fairyring.state.image.id !== {number}")
    return 4
