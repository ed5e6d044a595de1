"""Open tabs: which image each shows, and edits on their way to the store."""
