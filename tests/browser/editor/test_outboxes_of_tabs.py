"""Which outbox is whose, where several tabs share the storage of one browser."""

from __future__ import annotations


def test_two_tabs_keep_outboxes_of_their_own_and_a_third_takes_over_when_one_closes(page, static_url) -> None:
    use = """async (id) => {
      const m = await import('/editor/sync/tab_outbox.js');
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
