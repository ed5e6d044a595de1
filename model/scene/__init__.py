"""The renderer of beds whose hidden outlines are known."""
