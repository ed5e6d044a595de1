"""Whole outlines and centres from visible masks (the paper's section 5, and better)."""
