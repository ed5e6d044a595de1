"""How good predictions are: masks, centres."""
