"""One file a format that others read or write."""
