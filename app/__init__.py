"""What people touch: commands, server, panel."""
