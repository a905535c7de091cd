"""Time a browser needs to join after much was sent, with webviz's server and viser's own.

    python -m side_by_side.join [--messages 10000 1000000 3000000]

Both servers hold what scene B shows, a robot of 60 links and 200 frames. They are sent the messages
that its updates cost them: a node's pose is two messages to viser, and webviz has all axes in one
node. An hour at 50 Hz is 94 million messages for the plain viewer (260 nodes, two setters each) and
22 million for webviz (60 links, axes and arrows). So many take too long to send here; the table has
fewer, and what an hour comes to when time grows with the number as measured.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable

import numpy as np
import viser
from viser import _messages as wire

from side_by_side import viser_wire
from side_by_side.websocket import WebSocket
from webviz.api.nodes import Axes, Pose
from webviz.scene import ViserScene, open_server

FRAMES, LINKS = 200, 60
UNTURNED = np.array([1, 0, 0, 0], np.float32)
HOUR = {"webviz": (2 * LINKS + 2) * 50 * 3600, "plain viser": 2 * (LINKS + FRAMES) * 50 * 3600}
Push = Callable[[], int]
"""One update of everything, and how many messages it took."""


def webviz_scene() -> tuple[viser.ViserServer, Push]:
    """A server of webviz's with its scene."""
    server = open_server(port=0)
    scene = ViserScene(server)
    turn = 0

    def push() -> int:
        nonlocal turn
        turn += 1
        shift = turn * 1e-3
        for link in range(LINKS):
            scene.set_pose(f"link {link}", Pose((link + shift, 0.0, 0.0), (1.0, shift, 0.0, 0.0)))
        positions = np.full((FRAMES, 3), shift, np.float32)
        axes = Axes(positions, np.tile(UNTURNED, (FRAMES, 1)), 0.2, 0.02)
        scene.upsert("frames", "axes", axes)
        before = scene.link.queued_messages
        scene.flush()
        return scene.link.queued_messages - before

    return server, push


def plain_scene() -> tuple[viser.ViserServer, Push]:
    """viser's own server, with a node for each thing."""
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    names = [f"/frame_{i}" for i in range(FRAMES + LINKS)]
    for name in names:
        server.scene.add_frame(name)
    queue = server._websock_server.queue_message
    turn = 0

    def push() -> int:
        # What the setters of a frame queue, without the 60 us that each takes to do so.
        nonlocal turn
        turn += 1
        for name in names:
            queue(wire.SetPositionMessage(name, (turn * 1e-3, 0.0, 0.0)))
            queue(wire.SetOrientationMessage(name, (1.0, turn * 1e-3, 0.0, 0.0)))
        return 2 * len(names)

    return server, push


def join_s(server: viser.ViserServer) -> float:
    """Seconds from connecting to the end of what the server had."""
    start = time.monotonic()
    socket = WebSocket(server.get_port(), f"viser-v{viser.__version__}")
    try:
        while True:
            _, data = socket.receive()
            if any(m["type"] == "ReplayDoneMessage" for m in viser_wire.messages(data)):
                return time.monotonic() - start
    finally:
        socket.close()


def main() -> int:
    """Print a table."""
    parser = argparse.ArgumentParser(prog="side_by_side.join", description=__doc__)
    parser.add_argument("--messages", type=int, nargs="+", default=[10_000, 1_000_000, 3_000_000])
    options = parser.parse_args()
    print(
        "| system | " + " | ".join(f"after {n:,}" for n in options.messages) + " | an hour of B |"
    )
    print("| --- |" + " ---: |" * (len(options.messages) + 1))
    for name, make in (("webviz", webviz_scene), ("plain viser", plain_scene)):
        server, push = make()
        sent, times = 0, []
        for wanted in options.messages:
            while sent < wanted:
                sent += push()
            times.append(min(join_s(server) for _ in range(3)))
        growth, at_once = np.polyfit(options.messages, times, 1)
        hour = at_once + max(growth, 0) * HOUR[name]
        cells = [f"{1000 * t:.0f} ms" for t in times]
        print(f"| {name} | " + " | ".join(cells) + f" | {hour:.2f} s |", flush=True)
        server.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
