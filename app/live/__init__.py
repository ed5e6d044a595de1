"""The sessions of open browser tabs: the image each shows, and its edits on their way to the store."""
