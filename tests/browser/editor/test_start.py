"""The editor's start in browsers that cannot show it."""

from __future__ import annotations


def test_a_browser_without_webgl_is_told_so_in_words(browser, static_url) -> None:
    context = browser.new_context()
    page = context.new_page()
    page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    page.goto(f"{static_url}/jsconfig.json")
    page.evaluate("import('/editor/main.js')")
    assert "needs WebGL" in page.get_by_role("alert").inner_text()
    context.close()
