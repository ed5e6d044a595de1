"""What holds for all tests."""

import os

# As the command does: servers, browsers and networks of tests share the cores. Read when PyTorch is imported.
os.environ.setdefault("OMP_WAIT_POLICY", "PASSIVE")
