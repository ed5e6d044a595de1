"""The review as a page that needs no server."""
