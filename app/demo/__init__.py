"""The demo project: rendered beds, and what the shipped weights see in them; made in one go or in several."""
