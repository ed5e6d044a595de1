"""Mask R-CNN and YOLACT, which the paper's Tables 2 and 3 hold beside its own network, in plain PyTorch."""
