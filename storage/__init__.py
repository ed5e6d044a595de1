"""What is kept: projects, images, caps, edits."""
