"""Caps found by brightness and shape alone, without a network: methods that need no weights."""
