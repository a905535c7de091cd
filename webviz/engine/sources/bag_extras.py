"""Messages that a bag lacks: a map from a file, a static transform."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from pathlib import Path

from webviz.api.errors import Error
from webviz.engine.sources.source import Publisher
from webviz_sim.world import WorldError, load_world

MAP_TYPE = "nav_msgs/msg/OccupancyGrid"
TF_TYPE = "tf2_msgs/msg/TFMessage"
MAP_FRAME = "map"
MAP_TOPIC = "/map"


class ExtraError(Error):
    """A map or transform cannot be used."""


@dataclass(frozen=True)
class Extra:
    """One latched message.

    Args:
        topic: full name.
        type: message type.
        cdr: the serialised message.
        publisher: shown as its publisher.
    """

    topic: str
    type: str
    cdr: bytes
    publisher: Publisher


def map_of_file(path: Path) -> Extra:
    """The map of a YAML file and its image, as map_server publishes it.

    Raises:
        ExtraError: a file is missing or invalid.
    """
    try:
        world = load_world(path)
    except WorldError as error:
        raise ExtraError(str(error)) from error
    height, width = world.cells.shape
    cdr = _Cdr()
    cdr.header(MAP_FRAME)
    cdr.pack("iIfII", 0, 0, world.resolution, width, height)
    cdr.pose((world.origin.x, world.origin.y, 0.0), world.origin.yaw)
    cdr.pack("I", world.cells.size)
    cdr.data += world.cells.tobytes()
    return _latched(MAP_TOPIC, MAP_TYPE, cdr, f"the map {path.name}")


def static_transform(
    parent: str, child: str, x: float, y: float, yaw: float = 0.0, z: float = 0.0
) -> Extra:
    """A static transform from a frame to its child, in metres and radians.

    Raises:
        ExtraError: a frame name is empty, both are equal, or a number is not finite.
    """
    if not (parent and child) or parent == child:
        raise ExtraError(f"A transform needs two different frames, not {parent!r} and {child!r}.")
    if not all(map(math.isfinite, (x, y, z, yaw))):
        raise ExtraError(f"The transform from {parent} to {child} is not finite.")
    cdr = _Cdr()
    cdr.pack("I", 1)
    cdr.header(parent)
    cdr.string(child)
    cdr.pose((x, y, z), yaw)
    return _latched("/tf_static", TF_TYPE, cdr, "the command line")


def _latched(topic: str, type_name: str, cdr: _Cdr, who: str) -> Extra:
    publisher = Publisher(who, type_name, "reliable", "transient_local")
    return Extra(topic, type_name, bytes(cdr.data), publisher)


class _Cdr:
    """Serialises a message, little-endian."""

    def __init__(self) -> None:
        self.data = bytearray(b"\x00\x01\x00\x00")

    def pack(self, formats: str, *values: float) -> None:
        """Append numbers, each aligned to its size."""
        for each, value in zip(formats, values, strict=True):
            size = struct.calcsize(each)
            self.data += bytes(-(len(self.data) - 4) % size)
            self.data += struct.pack(f"<{each}", value)

    def string(self, text: str) -> None:
        """Append a string."""
        encoded = text.encode() + b"\0"
        self.pack("I", len(encoded))
        self.data += encoded

    def header(self, frame: str) -> None:
        """Append a std_msgs/Header with the stamp 0, for all times."""
        self.pack("iI", 0, 0)
        self.string(frame)

    def pose(self, position: tuple[float, float, float], yaw: float) -> None:
        """Append a position and an orientation."""
        self.pack("ddddddd", *position, 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))
