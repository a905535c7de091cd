"""One message, or one set of synchronized messages, as a display gets it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from webviz.api.nodes import Pose


@dataclass(frozen=True, eq=False)
class Sample:
    """A decoded message and where and when it belongs.

    Args:
        message: as `webviz.data.messages.decode` gives it, or what the display's `fold` made of it.
        frame: frame id of its header, "" if it has none.
        stamp_ns: of its header, 0 if it has none.
        received_ns: ROS time of arrival.
        number: counts the messages of the input from 0.
        pose: of `frame` in the fixed frame at the stamp.
        input: name of the input, that is of the property with its topic.
        synced: the samples of the other inputs of its `Sync`, by input.
    """

    message: Any
    frame: str
    stamp_ns: int
    received_ns: int
    number: int
    pose: Pose
    input: str
    synced: Mapping[str, Sample] = field(default_factory=dict)
