"""Benchmarks in a real browser; these need playwright and a Chromium."""
