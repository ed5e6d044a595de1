"""Benchmarks in a real browser, a Chromium that playwright drives (the extra ``bench``)."""
