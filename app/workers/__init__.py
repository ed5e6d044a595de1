"""Processes that compute for the server, so that the one which answers everybody never does."""
