"""The one port that browsers talk to, in front of viser."""
