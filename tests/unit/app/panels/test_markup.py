"""Nothing a person or a file says is ever read as HTML."""

from __future__ import annotations

from html.parser import HTMLParser

from hypothesis import given
from hypothesis import strategies as st
from msgspec import structs

from fairyring.app.jobs.learnt import Learnt
from fairyring.app.jobs.runner import Job
from fairyring.app.live.session import Session
from fairyring.app.panels import (
    annotators,
    beside,
    desk,
    gallery,
    images,
    jobs,
    queue,
    review_found,
    review_tables,
    status,
)
from fairyring.app.panels import inspector as cap
from fairyring.app.panels.inspector import Background
from fairyring.app.panels.learning import learnt_table
from fairyring.app.panels.markup import element
from fairyring.app.panels.several import several_facts
from fairyring.app.review.queueing import standing_of
from fairyring.model.evaluate.centres import Pair
from fairyring.model.geometry.shapes import Circle
from fairyring.storage.cap_groups import Group
from fairyring.storage.compared_caps import KINDS, CapFigures
from fairyring.storage.compared_runs import BothRuns, ChangedCap
from fairyring.storage.comparisons import Comparison, ComparisonRow
from fairyring.storage.images import ImagePage, ImageRow
from fairyring.storage.journal import Entry
from fairyring.storage.records import (
    Annotation,
    Cap,
    GivenVerdict,
    Image,
    ImageContents,
    Prediction,
    Queue,
    Run,
)
from fairyring.storage.review_figures import Totals
from fairyring.storage.second_versions import SecondVersion

EVIL = "\"'><script>alert(1)</script><img src=x onerror=alert(1)>&lt;"
HARMLESS_TAGS = (
    "a button dd details div dl dt figcaption figure h3 header image img kbd label li line ol option p path "
    "polygon progress section select span strong summary svg table tbody td th thead tr ul"
)


class Reader(HTMLParser):
    """Reads HTML as a browser does: elements, attributes and text."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str | None]] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += attrs

    def handle_data(self, data: str) -> None:
        self.text += data


def read(html: str) -> Reader:
    reader = Reader()
    reader.feed(html)
    return reader


@given(text=st.text(), value=st.text())
def test_text_and_attributes_come_out_as_they_went_in(text: str, value: str) -> None:
    page = read(element("p", text, title=value, data_some_thing=value, hidden=False).html)
    assert page.tags == ["p"]
    clean = [part.replace("\r\n", "\n").replace("\r", "\n").replace("\0", "") for part in (page.text, text)]
    assert clean[0] == clean[1] or "\0" in text
    assert page.attributes == [("title", value), ("data-some-thing", value)]


def test_markup_inside_markup_is_not_escaped_twice() -> None:
    assert element("p", element("b", "a & b"), None, 3).html == "<p><b>a &amp; b</b>3</p>"


IMAGE = Image(id=1, file_name=EVIL, path=EVIL, width=100, height=80, sha256="0" * 64, light=EVIL, form=EVIL)
RUN = Run(id=1, name=EVIL, kind="network", made_at=EVIL)
PREDICTION = Prediction(id=1, run=1, image=1, visible=[], score=0.5, category=EVIL)
ANNOTATION = Annotation(
    uid=EVIL,
    image=1,
    revision=1,
    cap=Cap(visible=[], category=EVIL, doubtful=True, ignored=True, mark=Circle(1.0, 2.0, 3.0)),
    whole=Circle(1.0, 2.0, 3.0),
    centre=(1.0, 2.0),
)
FIGURES = Comparison(
    image=1, run=1, version=1, caps=1, marked=1, matched=1, missed=0, extra=0,
    cdr_mean=0.1, cdr_worst=0.2, worst=EVIL, dx=0.1, dy=-0.2,
)  # fmt: skip


TOTALS = Totals(measured=1, matched=1, missed=0, extra=0, cdr=0.1, floor=0.05, dx=0.1, dy=-0.2)
CHANGED = ChangedCap(image=1, file_name=EVIL, annotation=EVIL, before=0.1, after=0.2, floor=None)
VERDICT = GivenVerdict(
    number=1, image=1, annotation=EVIL, revision=1, says="comment", words=EVIL, user=EVIL, made_at=EVIL
)
QUEUE = Queue(number=1, user=EVIL, title=EVIL, images=[1])
THUMBNAIL = gallery.Thumbnail(
    IMAGE, CapFigures(image=1, run=1, annotation=EVIL, prediction=1, cdr=1.0), ANNOTATION, PREDICTION
)
SECOND = SecondVersion(
    image=1,
    file_name=EVIL,
    matched=1,
    missed=0,
    extra=0,
    measured=1,
    iou_mean=None,
    px_mean=None,
    stale=True,
)
SHOWN = gallery.Shown(
    kind="worst",
    group=Group(by="annotator", value=EVIL),
    name=EVIL,
    counts=dict.fromkeys(KINDS, 1),
    thumbnails=[THUMBNAIL],
)
LEARNT = Learnt(
    name=EVIL, base=EVIL, weights=EVIL, photos=EVIL, held_out=2, before={"AP": 0.5}, after={"AP": 0.6}
)


def session() -> Session:
    nobody = object()
    opened = Session(client=nobody, beacon=nobody, token=None, user=EVIL)
    opened.show(ImageContents(image=IMAGE, annotations=[ANNOTATION], predictions=[PREDICTION], run=RUN))
    return opened


def every_panel() -> dict[str, str]:
    """Each panel's HTML, fed with hostile strings wherever a person or a file has a say."""
    entry = Entry(
        id=EVIL, annotation=EVIL, image=1, revision=1, before=None, after=None, user=EVIL, made_at=EVIL
    )
    background = Background(
        entries=[entry],
        prediction=PREDICTION,
        run=RUN,
        note=EVIL,
        pair=Pair(truth=0, prediction=0, iou=1.0, error=None),
    )
    figures = {"cdr_mean": 0.1, "floor_mean": 0.05, "cdr_worst": 0.2, "worst": EVIL}
    row = ImageRow(image=IMAGE, caps=1, ignored=0, predicted=1, **figures)
    told = Job(id=1, title=EVIL, user=EVIL, state="failed", message=EVIL, link=EVIL)
    running = Job(id=2, title=EVIL, user=EVIL, what=EVIL, total=3)
    listed = ComparisonRow(file_name=EVIL, comparison=FIGURES, stale=True)
    reviewed = review_found.Review(
        run=RUN, totals=TOTALS, groups={EVIL: TOTALS}, rows=[listed], total=1, stale=1, untouched=(1, [EVIL])
    )
    return {
        "status": status.header(session(), project=EVIL, jobs=[running]).html,
        "images": images.image_list(ImagePage(rows=[row], total=1), 0, 1).html,
        "annotation": cap.annotation_facts(ANNOTATION, background).html,
        "prediction": cap.prediction_facts(PREDICTION, RUN).html,
        "summary": cap.summary(session().caps, EVIL).html,
        "several": several_facts([ANNOTATION, PREDICTION]).html,
        "learnt": learnt_table(LEARNT).html,
        "figures": review_tables.review_figures(reviewed).html,
        "review": review_tables.review_page(reviewed, 1, review_found.Wanted(by="annotator")).html,
        "jobs": jobs.job_list([told, running]).html,
        "desk": desk.said_of_image([VERDICT]).html,
        "beside": beside.beside_page(
            beside.Beside(
                runs=[EVIL],
                before=RUN,
                after=RUN,
                both=BothRuns(images=1, first=TOTALS, second=TOTALS),
                changed=[
                    ChangedCap(image=1, file_name=EVIL, annotation=EVIL, before=0.1, after=0.2, floor=None)
                ],
            )
        ).html,
        "annotators": annotators.annotators_page(
            annotators.Both(versions=[EVIL], second=RUN, images=[SECOND], lacking=2), 1
        ).html,
        "queue": queue.queue_line(QUEUE, standing_of(QUEUE, {}), waiting=0).html,
        "gallery": gallery.gallery(SHOWN).html,
    }


def test_hostile_strings_stay_text_in_every_panel() -> None:
    for name, html in every_panel().items():
        page = read(html)
        assert set(page.tags) <= set(HARMLESS_TAGS.split()), name
        assert not [key for key, _ in page.attributes if key.startswith("on")], name
        assert not [value for key, value in page.attributes if key == "src" and value == "x"], name
        assert EVIL in page.text or name in {"images", "several"}, name


def test_a_simulated_run_is_called_that_plainly() -> None:
    simulated = Run(id=1, name="nicely named", kind="simulated", made_at="")
    assert read(status.run_badge(simulated).html).text == "simulated predictions"


def test_no_cdr_is_shown_without_what_the_marks_are_off_by() -> None:
    figures = structs.replace(FIGURES, floor_mean=0.05)
    listed = ComparisonRow(file_name="bed", comparison=figures, stale=False)
    reviewed = review_found.Review(run=RUN, totals=TOTALS, rows=[listed], total=1)
    figures = read(review_tables.review_figures(reviewed).html)
    assert "floor of marks" in figures.text
    assert "0.050 %" in figures.text
    page = read(review_tables.review_page(reviewed, 1).html)
    titles = [value for key, value in page.attributes if key == "title"]
    assert any("CDR 0.10 % (the marks alone 0.050 %)" in title for title in titles)


def test_every_number_of_a_group_leads_to_the_caps_it_is_of() -> None:
    listed = ComparisonRow(file_name="bed", comparison=FIGURES, stale=False)
    groups = {"m": structs.replace(TOTALS, missed=7, extra=8), "not_known": TOTALS}
    reviewed = review_found.Review(run=RUN, totals=TOTALS, groups=groups, rows=[listed], total=1)
    page = read(review_tables.review_page(reviewed, None, review_found.Wanted(by="size")).html)
    kinds = [value for key, value in page.attributes if key == "data-fairyring-gallery"]
    values = [value for key, value in page.attributes if key == "data-fairyring-value"]
    # Ten numbers of two groups, and two of the image.
    assert kinds == [*(["worst"] * 3 + ["missed", "extra"]) * 2, "missed", "extra"]
    assert values == ["m"] * 5 + [str(FIGURES.image)] * 2
    assert "78" in page.text
