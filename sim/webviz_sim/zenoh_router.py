"""A Zenoh router of its own process: `python -m webviz_sim.zenoh_router`.

It prints the endpoint on which it listens, and ends when its standard input closes.
"""

import socket
import sys

from webviz_sim.zenoh_wire import open_session


def main() -> int:
    """Run the router on a free port of this machine."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    endpoint = f"tcp/127.0.0.1:{port}"
    session = open_session("router", endpoint)
    print(endpoint, flush=True)
    sys.stdin.buffer.read()
    session.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
