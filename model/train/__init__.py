"""Training: data, recipe, loop, checkpoints."""
