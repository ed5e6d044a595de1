"""What is known of an image's caps: whole outlines, neighbours, comparison. No socket, no HTML."""
