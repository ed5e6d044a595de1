"""Benchmarks anybody can run again: ``fairyring bench``. The editor's needs playwright and a Chromium."""
