"""Benchmarks anybody can run again: ``fairyring bench``.

Those of the editor and the store drive a Chromium and need the extra ``bench``.
"""
