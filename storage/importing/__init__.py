"""Taking photos and labels in."""
