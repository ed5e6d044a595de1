"""Benchmarks anybody can run again: ``fairyring bench``.

Those of the editor and the store need playwright and a Chromium.
"""
