"""Evaluation of predictions: masks, centres."""
