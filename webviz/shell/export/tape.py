"""The tape: frames of a run, in chunks that can each be shown by themselves."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import msgspec

from webviz.scene.adapter.tape import SceneChange, SceneMessage
from webviz.server.sending.outbox import BULK_BYTES
from webviz.shell.export.chunks import ExportChunk
from webviz.shell.export.limit import MAX_EVERY, SizeLimit
from webviz.shell.export.stores import VALUES, Changes

KEYFRAME_S = 5.0
"""Seconds of the run in one chunk: what a seek has to unpack."""
CHUNK_BYTES = 8 << 20
"""Size of a chunk before compression, from which on the next one begins."""
MAX_KNOWN = 100_000
"""Values that are recognised when they come again."""


class ExportFrame(msgspec.Struct, frozen=True):
    """A moment of a run.

    Args:
        at_s: seconds from the start of the file.
        ros_s: ROS time in seconds.
        scene: changes of the scene since the frame before.
        stores: changes of the stores.
        pictures: new pictures of panes by display as pages receive them, None if one is gone; and
            whether it can be shown without those before.
    """

    at_s: float
    ros_s: float
    scene: SceneChange
    stores: Changes
    pictures: Mapping[str, tuple[bytes, bool] | None]


class ChunkIndex(msgspec.Struct, frozen=True):
    """Facts about a chunk for the page before it unpacks it.

    Args:
        times: of its frames in seconds.
        message, value, picture: numbers of the first of each.
    """

    times: Sequence[float]
    message: int
    value: int
    picture: int


class ExportWriter:
    """Collects frames, and hands each chunk on as soon as it is complete.

    Args:
        write: takes a packed chunk, and returns the size of the file with it.
        limit: of the file.
        used: size of the file now.
    """

    def __init__(self, write: Callable[[bytes], int], limit: SizeLimit, used: int) -> None:
        self._write = write
        self._limit = limit
        self._used = used
        self._by_key: dict[str, int] = {}
        """Numbers of the newest messages of the server, of those that may be left out."""
        self._versions: dict[str, int] = {}
        self.index: list[ChunkIndex] = []
        self._messages = self._values = self._pictures = 0
        self._numbers: dict[int, int] = {}
        """Numbers of the messages that the scene consists of, by the numbers that the server gave
        them."""
        self._stores: dict[tuple[str, str], int] = {}
        self._value_numbers: dict[bytes, int] = {}
        self._panes: dict[str, list[int]] = {}
        self._left_out: set[str] = set()
        self._chunk: ExportChunk | None = None
        self._times: list[float] = []

    def add(self, frame: ExportFrame) -> None:
        """Add the next frame."""
        chunk = self._chunk
        if chunk is not None:
            is_long = frame.at_s - self._times[0] >= KEYFRAME_S - 1e-6
            if is_long or chunk.size > CHUNK_BYTES:
                self._pack(chunk, frame.at_s)
        is_key = self._chunk is None
        chunk = self._chunk = self._chunk or ExportChunk(
            self._messages, self._values, self._pictures
        )
        added, removed = self._add_scene(chunk, frame.scene)
        values = self._add_values(chunk, frame.stores)
        pictures = self._add_pictures(chunk, frame.pictures)
        self._times.append(frame.at_s)
        if is_key:
            chunk.start = self._start()
            added, removed, values, pictures = [], [], [], []
        chunk.frames.append([frame.at_s, frame.ros_s, added, removed, values, pictures])

    def finish(self) -> None:
        """Hand on the last chunk."""
        chunk = self._chunk
        if chunk is not None:
            self._pack(chunk, self._times[-1])

    def _pack(self, chunk: ExportChunk, until_s: float) -> None:
        first = chunk.first_message, chunk.first_value, chunk.first_picture
        first_s, limit = self._times[0], self._limit
        self.index.append(ChunkIndex(self._times, *first))
        self._chunk, self._times = None, []
        room = limit.room(self._used, first_s, until_s)
        packed = chunk.packed(limit.every)
        while len(packed) > room and chunk.has_clouds and limit.every < MAX_EVERY:
            limit.every *= 2
            packed = chunk.packed(limit.every)
        limit.adapt(len(packed), room, first_s, until_s)
        self._used = self._write(packed)

    def _add_scene(self, chunk: ExportChunk, change: SceneChange) -> tuple[list[int], list[int]]:
        added: list[int] = []
        messages = [message for message in change.added if not self._is_left_out(message)]
        removed = [
            self._numbers.pop(number) for number in change.removals if number in self._numbers
        ]
        for message in messages:
            chunk.add_message(message)
            self._numbers[message.number] = self._messages
            added.append(self._messages)
            self._messages += 1
        return added, removed

    def _is_left_out(self, message: SceneMessage) -> bool:
        """Return whether the version before is shown instead of a message, since both are large."""
        if message.phase or sum(each.nbytes for each in message.buffers) <= BULK_BYTES:
            return False
        before = self._by_key.get(message.key)
        self._by_key[message.key] = message.number
        former = None if before is None else self._numbers.get(before)
        if before is None or former is None or not self._is_skipped(message.key):
            return False
        self._numbers[message.number] = self._numbers.pop(before)
        return True

    def _is_skipped(self, key: str) -> bool:
        count = self._versions[key] = self._versions.get(key, 0) + 1
        return count % self._limit.skip != 0

    def _add_values(self, chunk: ExportChunk, changes: Changes) -> list[Any]:
        entries: list[Any] = []
        for (store, key), value in changes.items():
            if value is None or (store.startswith(VALUES) and self._limit.is_exceeded):
                self._stores.pop((store, key), None)
                entries.append([store, key, -1])
                continue
            number = self._number(chunk, f"{store} {key}", value)
            self._stores[store, key] = number
            entries.append([store, key, number])
        return entries

    def _number(self, chunk: ExportChunk, kind: str, value: msgspec.Raw) -> int:
        encoded = bytes(value)
        if (index := self._value_numbers.get(encoded)) is not None:
            return index
        if len(self._value_numbers) >= MAX_KNOWN:
            self._value_numbers.clear()
        number = self._value_numbers[encoded] = self._values
        self._values += 1
        chunk.add_value(kind, value)
        return number

    def _add_pictures(
        self, chunk: ExportChunk, pictures: Mapping[str, tuple[bytes, bool] | None]
    ) -> list[Any]:
        entries: list[Any] = []
        for display, picture in pictures.items():
            if picture is None:
                self._panes.pop(display, None)
                self._left_out.discard(display)
                entries.append([display, []])
                continue
            data, is_whole = picture
            if is_whole and display in self._panes:
                if self._is_skipped(f"picture of {display}"):
                    self._left_out.add(display)
                else:
                    self._left_out.discard(display)
            if display in self._left_out:  # also what goes on from a picture that is not there
                continue
            chunk.add_picture(data)
            before = [] if is_whole else self._panes.get(display, [])
            self._panes[display] = [*before, self._pictures]
            entries.append([display, self._panes[display]])
            self._pictures += 1
        return entries

    def _start(self) -> Mapping[str, Any]:
        stores: dict[str, dict[str, int]] = {}
        for (store, key), number in self._stores.items():
            stores.setdefault(store, {})[key] = number
        return {"scene": sorted(self._numbers.values()), "stores": stores, "panes": self._panes}
