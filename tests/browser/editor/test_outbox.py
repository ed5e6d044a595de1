"""Edits the server has not acknowledged."""

from __future__ import annotations

EDIT = "const edit = (id, annotation = 'u') => ({id, annotation, image: 1, base: 0, cap: null});"


def test_unsettled_edits_are_there_after_a_reload_in_their_order(call, page) -> None:
    fill = """
      const box = new m.Outbox(localStorage, 'p:');
      for (let i = 0; i < 12; i++) box.add([edit(`e${i}`)]);
      box.settle('e0');
      box.settle('e3');
    """
    call("sync/outbox", EDIT + fill)
    page.reload()
    body = """
      const box = new m.Outbox(localStorage, 'p:');
      return [box.edits().map(({id}) => id), box.head().edits[0].id, box.kept];
    """
    ids, head, kept = call("sync/outbox", body)
    assert ids == [f"e{i}" for i in range(12) if i not in (0, 3)]
    assert (head, kept) == ("e1", True)


def test_edits_added_after_a_reload_do_not_overwrite_older_ones(call, page) -> None:
    fill = """
      const box = new m.Outbox(localStorage, 'p:');
      box.add([edit('a')]);
      box.add([edit('b')]);
      box.settle('a');
    """
    call("sync/outbox", EDIT + fill)
    page.reload()
    call("sync/outbox", EDIT + "new m.Outbox(localStorage, 'p:').add([edit('c')])")
    assert call("sync/outbox", "return new m.Outbox(localStorage, 'p:').edits().map(({id}) => id)") == [
        "b",
        "c",
    ]


def test_settled_edits_leave_nothing_in_the_browser(call) -> None:
    body = """
      const box = new m.Outbox(localStorage, 'p:');
      box.add([edit('a'), edit('b')]);
      box.settle('a');
      box.settle('b');
      return [localStorage.length, box.waiting];
    """
    assert call("sync/outbox", EDIT + body) == [0, 0]


def test_what_a_closed_tab_left_is_taken_over_once(call) -> None:
    body = (
        EDIT
        + """
      new m.Outbox(localStorage, 'p:old:').add([edit('a')]);
      const box = new m.Outbox(localStorage, 'p:new:');
      box.adopt('p:old:');
      const ids = box.edits().map(({id}) => id);
      return [ids, m.keysWith(localStorage, 'p:old:'), new m.Outbox(localStorage, 'p:new:').edits().length];
    """
    )
    assert call("sync/outbox", body) == [["a"], [], 1]


def test_a_full_storage_is_admitted(call) -> None:
    body = (
        EDIT
        + """
      const setItem = () => { throw new Error('full'); };
      const full = {length: 0, key: () => null, getItem: () => null, removeItem() {}, setItem};
      const box = new m.Outbox(full, 'p:');
      box.add([edit('a')]);
      const admitted = box.kept;
      box.settle('a');
      return [admitted, box.kept, box.waiting];
    """
    )
    assert call("sync/outbox", body) == [False, True, 0]


def test_spoilt_entries_are_passed_over(call) -> None:
    body = """
      localStorage.setItem('p:000000000', '{broken');
      localStorage.setItem('p:000000001', '7');
      return new m.Outbox(localStorage, 'p:').edits();
    """
    assert call("sync/outbox", body) == []


def test_an_edit_held_for_a_person_stands_for_all_of_its_cap_and_is_not_sent(call) -> None:
    body = (
        EDIT
        + """
      const box = new m.Outbox(localStorage, 'p:');
      box.add([edit('a', 'u'), edit('b', 'v')]); box.add([edit('c', 'u')]);
      box.hold(edit('d', 'u'));
      const ids = (edits) => edits.map(({id}) => id);
      return [ids(box.edits()), ids(box.head().edits), box.waiting, box.holds('u'), box.holds('v')];
    """
    )
    assert call("sync/outbox", body) == [["b", "d"], ["b"], 1, True, False]


def test_two_tabs_keep_outboxes_of_their_own_and_a_third_takes_over_when_one_closes(page, static_url) -> None:
    use = """async (id) => {
      const m = await import('/editor/sync/outbox_owner.js');
      const box = await m.openOutbox('project');
      box.add([{id, annotation: id, image: 1, base: 0, cap: null}]);
      return box.edits().map((edit) => edit.id);
    }"""
    other = page.context.new_page()
    other.goto(f"{static_url}/jsconfig.json")
    assert page.evaluate(use, "first") == ["first"]
    assert other.evaluate(use, "second") == ["second"]
    other.close()
    third = page.context.new_page()
    third.goto(f"{static_url}/jsconfig.json")
    assert sorted(third.evaluate(use, "third")) == ["second", "third"]
    page.reload()
    assert page.evaluate(use, "again") == ["first", "again"]
    third.close()
