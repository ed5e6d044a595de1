"""Geometry, contours, network, renderer, evaluation; nothing of the app or the store."""
