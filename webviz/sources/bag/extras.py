"""Messages that a bag lacks: a map from a file, a static transform."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import numpy.typing as npt

from webviz.api.errors import Error
from webviz.api.offer import Publisher
from webviz.data.map_file import MapFileError, read_map
from webviz.data.messages import encode
from webviz.data.recordings import RecordedChannel
from webviz.data.recordings.latched import TF
from webviz.sources.bag.computed import ComputedFile
from webviz.sources.bag.file import BagChannel

MAP_TYPE = "nav_msgs/msg/OccupancyGrid"
MAP_FRAME = "map"
MAP_TOPIC = "/map"


class ExtraError(Error):
    """A map or transform cannot be used."""


class Extra(msgspec.Struct, frozen=True):
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


def extras_file(extras: Sequence[Extra], start_ns: int) -> ComputedFile:
    """Return messages as a file of a bag, all at the time of recording of its start."""
    by_channel: dict[BagChannel, tuple[npt.NDArray[np.int64], Callable[[int], bytes]]] = {}
    topics = dict.fromkeys((extra.topic, extra.type) for extra in extras)
    for topic, type_name in topics:
        own = [extra for extra in extras if (extra.topic, extra.type) == (topic, type_name)]
        recorded = RecordedChannel(topic, type_name, "cdr", "", "")
        publishers = tuple(extra.publisher for extra in own)
        channel = BagChannel(topic, type_name, publishers, len(own), recorded)
        times = np.full(len(own), start_ns, np.int64)
        by_channel[channel] = times, [extra.cdr for extra in own].__getitem__
    return ComputedFile(by_channel)


def map_of_file(path: Path) -> Extra:
    """Return the map of a YAML file and its image, as map_server publishes it.

    Raises:
        ExtraError: a file is missing or invalid.
    """
    try:
        map_file = read_map(path)
    except MapFileError as error:
        raise ExtraError(str(error)) from error
    height, width = map_file.cells.shape
    x, y, yaw = map_file.origin
    message = {
        "header": {"frame_id": MAP_FRAME},
        "info": {
            "resolution": map_file.resolution,
            "width": width,
            "height": height,
            "origin": {
                "position": {"x": x, "y": y},
                "orientation": _orientation(yaw),
            },
        },
        "data": map_file.cells.reshape(-1),
    }
    return _latched(MAP_TOPIC, MAP_TYPE, message, f"the map {path.name}")


def static_transform(
    parent: str, child: str, x: float, y: float, yaw: float = 0.0, z: float = 0.0
) -> Extra:
    """Return a static transform from a frame to its child, in metres and radians.

    Raises:
        ExtraError: a frame name is empty, both are equal, or a number is not finite.
    """
    if not (parent and child) or parent == child:
        raise ExtraError(f"A transform needs two different frames, not {parent!r} and {child!r}.")
    if not all(map(math.isfinite, (x, y, z, yaw))):
        raise ExtraError(f"The transform from {parent} to {child} is not finite.")
    transform = {
        "header": {"frame_id": parent},
        "child_frame_id": child,
        "transform": {"translation": {"x": x, "y": y, "z": z}, "rotation": _orientation(yaw)},
    }
    return _latched("/tf_static", TF, {"transforms": [transform]}, "the command line")


def _latched(topic: str, type_name: str, message: Mapping[str, Any], who: str) -> Extra:
    publisher = Publisher(who, type_name, "reliable", "transient_local")
    return Extra(topic, type_name, encode(type_name, message), publisher)


def _orientation(yaw: float) -> dict[str, float]:
    return {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
