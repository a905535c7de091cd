"""The recorded drive of a TurtleBot 4 through a corridor, with data that are not kept here."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

DATA = Path(__file__).parents[3] / "shared/data"
BAG = DATA / "bags/macfirst_floor_take_2"
MAP = DATA / "maps/mac_1st_floor_final.pgm"
RESOLUTION, ORIGIN = 0.03, (-1.12, -39.4)
"""Resolution and origin of the map, in metres, as its .yaml says."""
START = (-0.27, 0.045, 0.0), (0.0, 0.0, 0.0341, 0.9994)
"""Pose in the map at which the odometry began, found by fitting the first scan to the walls."""

needs_bag = pytest.mark.skipif(not BAG.exists(), reason="the bag of the TurtleBot 4 is not here")
needs_map = pytest.mark.skipif(not MAP.exists(), reason="the map of the corridor is not here")


def messages(*topics: str) -> Iterator[tuple[str, str, int, bytes]]:
    """Topic, type, time of arrival and bytes of what the bag holds, in order."""
    with AnyReader([BAG], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        connections = [c for c in reader.connections if c.topic in topics]
        for connection, time_ns, data in reader.messages(connections):
            yield connection.topic, connection.msgtype, time_ns, bytes(data)
