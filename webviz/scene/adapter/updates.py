"""Updates of nodes: messages that are packed quickly."""

from __future__ import annotations

from typing import Any

import numpy as np
from viser import _messages as wire
from viser.infra._messages import _prepare_for_serialization as prepared

_PLAIN = {str, bytes, float, int, bool, type(None)}
"""Types of values that msgpack takes as they are; what viser does to find out takes longer."""


class UpdateMessage(wire.SceneNodeUpdateMessage, include_in_scene_serialization=True):
    """Assigns properties of a node; most of its bytes are arrays, which need no preparation."""

    def as_serializable_dict(
        self, binary_buffers: list[memoryview] | None = None
    ) -> dict[str, Any]:
        """As viser packs it, under the name of viser's class."""
        updates = {name: _packed(value, binary_buffers) for name, value in self.updates.items()}
        type_ = "SceneNodeUpdateMessage"
        return {"name": self.name, "updates": updates, "owner": self.owner, "type": type_}


def _packed(value: Any, buffers: list[memoryview] | None) -> Any:
    if type(value) in _PLAIN:
        return value
    if buffers is None or not isinstance(value, np.ndarray):
        return prepared(value, Any, buffers)
    buffers.append(np.ascontiguousarray(value).data)
    return {"__binary_index": len(buffers) - 1, "dtype": value.dtype.str}
