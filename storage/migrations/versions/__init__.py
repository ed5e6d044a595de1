"""One upgrade a module."""
