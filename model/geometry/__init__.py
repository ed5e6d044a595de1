"""Shapes, masks and outlines; continuous coordinates throughout."""
