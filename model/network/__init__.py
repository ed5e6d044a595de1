"""PR-SOLOv2: layers, losses, decoding."""
