"""Which outbox is whose, where several tabs share the storage of one browser."""

from __future__ import annotations


def test_two_tabs_keep_outboxes_of_their_own_and_a_third_takes_over_when_one_closes(page, static_url) -> None:
    use = """async (id) => {
      const m = await import('/editor/sync/tab_outbox.js');
      const box = await m.openOutbox('project', () => {});
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


def test_what_a_page_that_is_just_being_left_holds_is_taken_over_a_moment_later(page, static_url) -> None:
    other = page.context.new_page()
    other.goto(f"{static_url}/jsconfig.json")
    other.evaluate("""async () => {
      const m = await import('/editor/sync/tab_outbox.js');
      const box = await m.openOutbox('project', () => {});
      box.add([{id: 'left', annotation: 'left', image: 1, base: 0, cap: null}]);
    }""")
    page.evaluate("""async () => {
      const m = await import('/editor/sync/tab_outbox.js');
      window.late = new Promise((told) => window.told = told);
      window.box = await m.openOutbox('project', () => window.told(true));
    }""")
    assert page.evaluate("window.box.edits().length") == 0
    other.close()
    assert page.evaluate("window.late")
    assert page.evaluate("window.box.edits().map(({id}) => id)") == ["left"]
