"""Writing of rosbag2 folders: files that follow each other, and metadata.yaml."""

from __future__ import annotations

import contextlib
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from webviz.data import plain_yaml
from webviz.data.messages import MessageError, type_hash
from webviz.data.recordings.latched import LatchedMessages
from webviz.data.recordings.mcap_writing import McapFile
from webviz.data.recordings.metadata import INFORMATION, METADATA
from webviz.data.recordings.recording import RecordedChannel, RecordingError

VERSION = 9
"""Version of metadata.yaml, that of ROS 2 Jazzy."""


@dataclass(frozen=True)
class RecordingLimits:
    """Sizes at which a new file begins, and at which old ones are deleted.

    Args:
        file_bytes, file_s: of one file, 0 for no limit.
        total_bytes: of all files; the oldest are deleted. 0 for no limit.
    """

    file_bytes: int = 0
    file_s: float = 0.0
    total_bytes: int = 0


class _Written(msgspec.Struct, frozen=True):
    """A file that is complete."""

    path: Path
    size: int
    counts: dict[RecordedChannel, int]
    span_ns: tuple[int, int]


class RecordingFolder:
    """A new rosbag2 folder of MCAP files.

    Each file begins with the newest message of every publisher that latches, so that it can be
    shown on its own, also once those before it are deleted.

    Args:
        path: of the folder, which must not exist or be empty.
        library: the name of the program, for the headers.
        limits: of the files.

    Raises:
        RecordingError: it cannot be written, here and in the methods; one sentence with a remedy.
            What was written before can be read.
    """

    def __init__(
        self, path: Path, library: str, limits: RecordingLimits = RecordingLimits()
    ) -> None:
        self.path = path
        self.deleted = 0
        """Files deleted to stay within the limit."""
        self.messages = 0
        """Messages written, those deleted again included."""
        self._library = library
        self._limits = limits
        self._number = 0
        self._written: list[_Written] = []
        self._latched = LatchedMessages[tuple[RecordedChannel, bytes]]()
        self._file: McapFile | None = None
        self._last_state = (0, 0, 0)
        try:
            path.mkdir(parents=True, exist_ok=True)
            if any(path.iterdir()):
                raise RecordingError(f"{path} is not empty. Give the name of a new folder.")
            self._file = self._new_file()
        except OSError as error:
            raise self._failed(error) from error

    @property
    def size(self) -> int:
        """Bytes of all files that are there."""
        return sum(file.size for file in self._written) + (self._file.size if self._file else 0)

    def add(self, channel: RecordedChannel, stamp_ns: int, data: bytes, latched: int) -> None:
        """Append a message.

        Args:
            channel: of its topic, type and QoS.
            stamp_ns: time of recording.
            data: the serialised message.
            latched: number of publishers of the topic whose messages late subscribers receive.
        """
        file = self._current()
        try:
            if self._is_full(file, stamp_ns):
                file = self._next_file(file, stamp_ns)
            file.add(channel, stamp_ns, data)
        except OSError as error:
            raise self._failed(error) from error
        self.messages += 1
        self._latched.put(channel.topic, data, (channel, data), latched)

    def flush(self) -> None:
        """Write all messages to the disk, so that none of them is lost with this program."""
        file = self._current()
        try:
            file.flush()
            self._describe()
        except OSError as error:
            raise self._failed(error) from error

    def close(self) -> None:
        """Complete the last file."""
        file, self._file = self._file, None
        if file is None:
            return
        try:
            self._finish(file)
            self._describe()
        except OSError as error:
            file.close(is_whole=False)
            raise self._failed(error) from error

    def _current(self) -> McapFile:
        if self._file is None:
            raise RecordingError(f"The recording {self.path} has ended.")
        return self._file

    def _new_file(self) -> McapFile:
        path = self.path / f"{self.path.name}_{self._number}.mcap"
        self._number += 1
        return McapFile(path, self._library)

    def _is_full(self, file: McapFile, stamp_ns: int) -> bool:
        limits = self._limits
        if file.span_ns is None:
            return False
        is_long = limits.file_s > 0 and stamp_ns - file.span_ns[0] >= limits.file_s * 1e9
        return is_long or 0 < limits.file_bytes <= file.size

    def _next_file(self, file: McapFile, stamp_ns: int) -> McapFile:
        self._finish(file)
        self._file = file = self._new_file()
        for _, (channel, data) in self._latched:
            file.add(channel, stamp_ns, data)
        while self._limits.total_bytes and self._written and self.size > self._limits.total_bytes:
            self._written.pop(0).path.unlink(missing_ok=True)
            self.deleted += 1
        self._describe()
        return file

    def _finish(self, file: McapFile) -> None:
        file.close()
        if file.span_ns is not None:
            self._written.append(_Written(file.path, file.size, file.counts, file.span_ns))
        else:
            file.path.unlink(missing_ok=True)

    def _failed(self, error: OSError) -> RecordingError:
        """Return the error as a sentence; the file that was written is closed."""
        file, self._file = self._file, None
        if file is not None:
            with contextlib.suppress(OSError):
                file.close(is_whole=False)
        reason = os.strerror(error.errno) if error.errno else str(error)
        return RecordingError(
            f"{self.path} cannot be written: {reason}. Choose another folder or disk."
        )

    def _describe(self) -> None:
        """Write metadata.yaml, in place of the one before, if it names other files or topics.

        Its counts are those of that moment until the end; readers of messages do not need them.
        """
        state = len(self._written), self.deleted, len(self._file.counts) if self._file else -1
        if state == self._last_state:
            return
        self._last_state = state
        path = self.path / METADATA
        text = plain_yaml.write({INFORMATION: self._information()})
        new = path.with_suffix(".new")
        new.write_text(text, encoding="utf-8")
        new.replace(path)

    def _information(self) -> dict[str, Any]:
        parts = [(each.path, each.counts, each.span_ns) for each in self._written]
        if self._file is not None and self._file.span_ns is not None:
            parts.append((self._file.path, self._file.counts, self._file.span_ns))
        counts: dict[RecordedChannel, int] = {}
        for _, each, _ in parts:
            for channel, count in each.items():
                counts[channel] = counts.get(channel, 0) + count
        start_ns = min((span[0] for _, _, span in parts), default=0)
        end_ns = max((span[1] for _, _, span in parts), default=0)
        return {
            "version": VERSION,
            "storage_identifier": "mcap",
            "starting_time": {"nanoseconds_since_epoch": start_ns},
            "duration": {"nanoseconds": end_ns - start_ns},
            "message_count": sum(counts.values()),
            "topics_with_message_count": [
                {"topic_metadata": _topic(channel), "message_count": count}
                for channel, count in counts.items()
            ],
            "compression_format": "",
            "compression_mode": "",
            "relative_file_paths": [path.name for path, _, _ in parts],
            "files": [
                {
                    "path": path.name,
                    "starting_time": {"nanoseconds_since_epoch": span[0]},
                    "duration": {"nanoseconds": span[1] - span[0]},
                    "message_count": sum(counts.values()),
                }
                for path, counts, span in parts
            ],
            "custom_data": None,
            "ros_distro": "jazzy",
        }


def _topic(channel: RecordedChannel) -> dict[str, Any]:
    try:
        profiles = plain_yaml.read_plain(channel.profiles) if channel.profiles else []
    except plain_yaml.YamlDocumentError:  # of a bag whose messages are copied
        profiles = []
    return {
        "name": channel.topic,
        "type": channel.type,
        "serialization_format": channel.encoding,
        "offered_qos_profiles": profiles,
        "type_description_hash": _hash(channel.type),
    }


def _hash(type_name: str) -> str:
    try:
        return type_hash(type_name)
    except MessageError:
        return ""
