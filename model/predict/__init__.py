"""From a photo to outlines: weights, tiles, overlap resolution, level lines."""
