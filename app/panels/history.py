"""The history of the image on screen: who did what and when, newest first, and a way to take it back."""

from __future__ import annotations

from functools import partial

from sqlalchemy import Connection

from fairyring.app.live.session import Session
from fairyring.app.live.workspace import Workspace
from fairyring.app.panels.callbacks import Redraw, person_did
from fairyring.app.panels.markup import Markup, element
from fairyring.app.panels.status import STATUS_WORDS
from fairyring.app.panels.verdicts import WORDS
from fairyring.storage.image_history import ChangeSet, ChangeSetPage, list_change_sets
from fairyring.storage.records import Cap, GivenVerdict

PAGE = 10


def build(workspace: Workspace, session: Session) -> Redraw:
    """Builds the history; it starts at the newest page again when another image is opened."""
    gui = session.client.gui
    shown = gui.add_html("")
    pages = gui.add_button_group("Page", ("‹", "›"), visible=False)
    page, of_image = [0], [0]

    async def turn() -> None:
        page[0] = max(page[0] + (1 if pages.value == "›" else -1), 0)
        session.refresh("history")

    async def redraw() -> None:
        image_id = session.image.id if session.image else 0
        if image_id != of_image[0]:
            of_image[0], page[0] = image_id, 0
        page[0], found = await workspace.read(partial(_page, image_id=image_id, wanted=page[0]))
        shown.content = history_list(found, page[0], image_id).html
        pages.visible = found.total > PAGE

    pages.on_click(person_did(session, turn))
    return redraw


def _page(connection: Connection, *, image_id: int, wanted: int) -> tuple[int, ChangeSetPage]:
    """The page asked for, or the last one if there are fewer, with its number."""
    found = list_change_sets(connection, image_id, offset=wanted * PAGE, limit=PAGE)
    last = max(found.total - 1, 0) // PAGE
    return (wanted, found) if wanted <= last else _page(connection, image_id=image_id, wanted=last)


def history_list(page: ChangeSetPage, number: int, image_id: int) -> Markup:
    """A page of the history."""
    if not page.change_sets:
        return element("div", "Nobody has changed anything on this image yet.", class_="fr-history fr-quiet")
    first = number * PAGE + 1
    counted = f"{first}–{first + len(page.change_sets) - 1} of {page.total} changes"
    return element(
        "div",
        element("ol", *(_row(done, image_id) for done in page.change_sets), class_="fr-changes"),
        element("div", counted, class_="fr-quiet"),
        class_="fr-history",
    )


def _row(done: ChangeSet, image_id: int) -> Markup:
    when = f"{done.made_at[:16].replace('T', ' ')} UTC"
    back = "taken back" if done.taken_back else None
    return element(
        "li",
        element("div", element("strong", done.user), " ", words_of(done)),
        element(
            "div",
            element("span", when, class_="fr-quiet"),
            element("span", back, class_="fr-badge") if back else None,
            _take_back(done, image_id),
            class_="fr-line",
        ),
    )


def _take_back(done: ChangeSet, image_id: int) -> Markup | None:
    """What was said is not unsaid; what it did to the status can be taken back."""
    if done.verdict is not None and done.status is None:
        return None
    return element(
        "button",
        "Bring back" if done.deleted and not done.made + done.changed else "Take back",
        type="button",
        title="Return these caps to how they were before; those that were changed since stay",
        data_fairyring_recall=done.number,
        data_fairyring_image=image_id,
    )


def words_of(done: ChangeSet) -> str:
    """What somebody did, as the end of a sentence that begins with the name."""
    made = "accepted" if _is_of_prediction(done) else "imported" if done.user == "import" else "drew"
    said = "prediction" if done.second is None else f"cap of {done.second}"
    counted = (
        (made, done.made, said if made == "accepted" else "cap"),
        ("changed", done.changed, "cap"),
        ("deleted", done.deleted, "cap"),
        ("turned down", done.turned_down, said),
        ("brought back", done.brought_back, "cap"),
    )
    parts = [f"{verb} {_count(n, what)}" for verb, n, what in counted if n]
    if done.changed == 1 and done.first is not None and (detail := _difference(done)):
        parts = [part.replace("changed a cap", detail) for part in parts]
    if done.status is not None:
        parts.append(
            f"set the status from “{STATUS_WORDS[done.status[0]]}” to “{STATUS_WORDS[done.status[1]]}”"
        )
    if done.verdict is not None and (done.verdict.words or done.status is None):
        parts.append(_said(done.verdict))
    told = ", ".join(parts) or "changed nothing"
    return {"done": "", "undone": "took back: ", "redone": "did again: "}[done.kind] + told


def _said(verdict: GivenVerdict) -> str:
    about = "" if verdict.annotation is None else " of a cap"
    if verdict.says == "withdrawn":
        return f"withdrew the verdict{about and ' on a cap'}"
    return f"said{about}: {verdict.words}" if verdict.words else f"{WORDS[verdict.says]} a cap"


def _count(number: int, what: str) -> str:
    noun, _, rest = what.partition(" ")
    return f"a {what}" if number == 1 else f"{number} {noun}s {rest}".rstrip()


def _is_of_prediction(done: ChangeSet) -> bool:
    return done.first is not None and done.first[2] is not None and done.first[2].prediction is not None


def _difference(done: ChangeSet) -> str:
    """What is another about the one cap that was changed."""
    _, before, after = done.first or ("", None, None)
    if before is None or after is None:
        return ""
    taken = done.outline_of if done.kind != "undone" else None
    return " and ".join(_differences(before, after, outline_of=taken))


def _differences(before: Cap, after: Cap, *, outline_of: str | None) -> list[str]:
    changes = []
    if before.visible != after.visible:
        changes.append(
            f"took {outline_of}’s outline of a cap" if outline_of else "changed the outline of a cap"
        )
    if before.told != after.told:
        changes.append("called a piece of a rim something else")
    if before.mark != after.mark:
        verb = "cleared" if after.mark is None else "placed" if before.mark is None else "moved"
        changes.append(f"{verb} the mark of a cap")
    for name, value in (("ignored", after.ignored), ("doubtful", after.doubtful)):
        if getattr(before, name) != value:
            changes.append(f"set a cap to {name}" if value else f"set a cap to not {name}")
    if before.order != after.order:
        changes.append("changed the overlap order of a cap")
    if before.category != after.category:
        changes.append(f"called a cap {after.category}")
    return changes
