"""The messages of a scene as they change, for a recording that is played without a server."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import msgspec
import viser
from viser import _messages as wire
from viser.infra._infra import ClientId
from viser.infra._messages import Message

TAPE = ClientId(-1)
"""Client in place of a browser: messages that it has not read are kept."""
NOT_RECORDED = (wire.RunJavascriptMessage,)
"""Scripts, which a file does not need and should not contain."""


class SceneMessage(msgspec.Struct, frozen=True):
    """A message of the scene.

    Args:
        number: messages are applied in this order.
        key: a newer message with the same key replaces this one.
        node: name of the node that it is about, "" for the scene as a whole.
        phase: "create", "remove", or "" for a change.
        content: fields by name; arrays are placeholders with "__binary_index" and "dtype".
        buffers: the arrays.
    """

    number: int
    key: str
    node: str
    phase: str
    content: Mapping[str, Any]
    buffers: Sequence[memoryview]


class SceneChange(msgspec.Struct, frozen=True):
    """Messages that came, and numbers of those that a browser that joins would not get any more."""

    added: Sequence[SceneMessage]
    removals: Collection[int]


class SceneRecorder:
    """Reads the messages that a browser would receive.

    Args:
        server: of the scene.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._buffer = server._websock_server.get_message_buffer()
        self._live: dict[int, None] = {}
        self._cursor = -1
        self._buffer.generator_cursors[TAPE] = self._cursor

    def take(self) -> SceneChange:
        """Return the changes since the last call."""
        with self._buffer.buffer_lock:
            live = dict(self._buffer.message_from_id)
            self._cursor = self._buffer.message_counter - 1
            self._buffer.generator_cursors[TAPE] = self._cursor
        new = {n: m for n, m in live.items() if n not in self._live}
        removed = self._live.keys() - live.keys()
        for number in removed:
            del self._live[number]
        self._live |= dict.fromkeys(new)
        added = [
            _message(number, message)
            for number, message in new.items()
            if not isinstance(message, NOT_RECORDED)
        ]
        return SceneChange(added, removed)

    def close(self) -> None:
        """Let go of the messages."""
        self._buffer.generator_cursors.pop(TAPE, None)


def _message(number: int, message: Message) -> SceneMessage:
    buffers: list[memoryview] = []
    content = message.as_serializable_dict(buffers)
    phase = message.lifecycle_phase if message.lifecycle_phase in ("create", "remove") else ""
    return SceneMessage(
        number, message.redundancy_key(), _node(message), phase or "", content, buffers
    )


def _node(message: Message) -> str:
    if message.entity_type == "scene" and message.entity_id_field is not None:
        return getattr(message, message.entity_id_field)
    kind, name = message.entity_state_key() or ("", "")
    return name if kind == "scene" else ""
