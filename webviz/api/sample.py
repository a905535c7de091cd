"""Samples: decoded messages with their poses, for displays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol, runtime_checkable

from webviz.api.nodes import Pose


@dataclass(frozen=True, eq=False)
class Sample:
    """A decoded message with its pose, or a set of synchronized messages.

    Args:
        message: decoded by `webviz.data.messages.decode`, or the result of the display's `fold`.
        frame: frame id of its header, "" if it has none.
        stamp_ns: of its header, 0 if it has none.
        received_ns: ROS time of arrival.
        number: of the message on its input, from 0.
        pose: of `frame` in the fixed frame at the stamp.
        input: name of the input: the property with its topic.
        synced: samples of the other inputs of the `Sync`, by input.
        type: of the message.
    """

    message: Any
    frame: str
    stamp_ns: int
    received_ns: int
    number: int
    pose: Pose
    input: str
    synced: Mapping[str, Sample] = field(default_factory=dict)
    type: str = ""


@runtime_checkable
class KeepsNewest(Protocol):
    """A result of a display's `fold` that has kept a message as it came."""

    @property
    def newest(self) -> Sample | None:
        """The newest of them, for the checks of the doctor; None without one."""
        ...
