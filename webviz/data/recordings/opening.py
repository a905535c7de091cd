"""Files by what they contain, whatever their name ends with."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection, Iterator
from pathlib import Path

from webviz.data.lfs import is_lfs
from webviz.data.recordings.mcap import McapRecording
from webviz.data.recordings.mcap_records import MAGIC
from webviz.data.recordings.recording import (
    Counts,
    Losses,
    RecordedChannel,
    RecordedMessage,
    Recording,
    RecordingError,
    TimeParts,
)
from webviz.data.recordings.ros1 import Ros1Recording
from webviz.data.recordings.unpacking import MARKS, unpack_file
from webviz.data.working_folder import working_folder

SQLITE = b"SQLite format 3\0"
ROS_1 = b"#ROSBAG V"
_LOOKED_AT = 512


def _sqlite(path: Path) -> Recording:
    from webviz.data.recordings.sqlite import SqliteRecording  # here, as SQLite takes 1 MB

    return SqliteRecording(path)


CONTAINERS: dict[str, Callable[[Path], Recording]] = {
    "mcap": McapRecording,
    "sqlite": _sqlite,
    "ros1": Ros1Recording,
}


def open_file(path: Path) -> Recording:
    """Open a file, unpacked to a temporary folder if it is compressed as a whole.

    Raises:
        RecordingError: it is not a recording, or not readable at all.
        OSError: it cannot be read.
    """
    kind = _kind(path)
    return CONTAINERS[kind](path) if kind in CONTAINERS else _Unpacked(path, kind)


def _kind(path: Path) -> str:
    """Container or compression of a file, by its first bytes."""
    if not path.is_file():
        raise RecordingError(f"{path} is not a file. Give an MCAP or db3 file.")
    with path.open("rb") as file:
        head = file.read(_LOOKED_AT)
        size = file.seek(0, 2)
        file.seek(max(0, size - len(MAGIC)))
        tail = file.read()
    if MAGIC in (head[: len(MAGIC)], tail):
        return "mcap"
    if head.startswith(SQLITE):
        return "sqlite"
    if head.startswith(ROS_1):
        return "ros1"
    for mark, compression in MARKS.items():
        if head.startswith(mark):
            return compression
    raise RecordingError(_other(path, head))


def _other(path: Path, head: bytes) -> str:
    """Return what a file is that is not a recording of ROS 2."""
    if not head:
        return f"{path} is empty (0 bytes). Copy it again, or choose another bag."
    if is_lfs(head):
        return f"{path} is a Git LFS pointer, not the bag itself: run `git lfs pull`."
    what = "not a bag"
    with contextlib.suppress(UnicodeDecodeError):
        # A character may be cut off at the end.
        text = head[:-3].decode() if len(head) == _LOOKED_AT else head.decode()
        what = "a text, not a bag" if "\0" not in text else what
    return f"{path} is {what}. Give an MCAP or db3 file, or a rosbag2 folder."


class _Unpacked:
    """A recording in a file that is compressed as a whole.

    Args:
        path: of the file.
        compression: of it.

    Raises:
        RecordingError, OSError: as `open_file`.
    """

    def __init__(self, path: Path, compression: str) -> None:
        with contextlib.ExitStack() as stack:
            folder = stack.enter_context(working_folder("webviz-bag-"))
            file, fault = unpack_file(path, compression, folder)
            try:
                inner = CONTAINERS[_kind(file)](file)
            except KeyError:
                raise RecordingError(f"{path} is compressed twice: unpack it first.") from None
            except RecordingError as error:
                reason = str(error).replace(str(file), str(path))
                raise RecordingError(f"{reason} ({fault}.)" if fault else reason) from error
            stack.callback(inner.close)
            self._inner = inner
            self._stack = stack.pop_all()
        self.channels: tuple[RecordedChannel, ...] = inner.channels
        self.span_ns = inner.span_ns
        self.losses: Losses = inner.losses
        if fault:
            self.losses.others.insert(0, fault)

    def messages(
        self, channels: Collection[RecordedChannel], start_ns: int, end_ns: int
    ) -> Iterator[RecordedMessage]:
        """`Recording.messages`."""
        return self._inner.messages(channels, start_ns, end_ns)

    def newest(
        self, channels: Collection[RecordedChannel], end_ns: int
    ) -> Iterator[RecordedMessage]:
        """`Recording.newest`."""
        return self._inner.newest(channels, end_ns)

    def newest_stamps(self, channels: Collection[RecordedChannel], end_ns: int) -> Iterator[int]:
        """`Recording.newest_stamps`."""
        return self._inner.newest_stamps(channels, end_ns)

    @property
    def used(self) -> frozenset[RecordedChannel]:
        """`Recording.used`."""
        return self._inner.used

    def histogram(self, parts: TimeParts) -> dict[RecordedChannel, Counts]:
        """`Recording.histogram`."""
        return self._inner.histogram(parts)

    def close(self) -> None:
        """Close the file and remove it."""
        self._stack.close()
