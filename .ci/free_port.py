"""Prints a port nobody listens on just now."""

import socket
import sys

with socket.create_server(("127.0.0.1", 0)) as listening:
    sys.stdout.write(f"{listening.getsockname()[1]}\n")
