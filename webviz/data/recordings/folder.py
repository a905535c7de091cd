"""Folders of rosbag2: files that follow each other, and metadata.yaml."""

from __future__ import annotations

import contextlib
import heapq
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from msgspec.structs import replace

from webviz.data.recordings.metadata import METADATA, read_metadata
from webviz.data.recordings.opening import open_file
from webviz.data.recordings.recording import (
    END_MISSING,
    Counts,
    Losses,
    RecordedChannel,
    RecordedMessage,
    Recording,
    RecordingError,
    TimeParts,
)

ENDINGS = (".mcap", ".db3", ".zstd", ".zst")
"""Endings of files that are read if metadata.yaml misnames all."""


class FolderRecording:
    """The messages of a rosbag2 folder: file by file, merged where their times overlap.

    Args:
        path: of the folder.

    Raises:
        RecordingError: its metadata are broken, or no file of it can be read.
        OSError: it cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self._losses = Losses("message", "skipped")
        if (path / METADATA).is_file():
            names = read_metadata(path)
        else:
            names = [file.name for file in _files_in(path)]
            self._losses.notes.append(
                f"{path.name} has no {METADATA}: it is still being recorded, or its recorder was "
                f"interrupted. Reading {', '.join(names)}."
            )
        with contextlib.ExitStack() as stack:
            self._files = self._opened(self._existing(path, names), stack)
            self._stack = stack.pop_all()
        parts = self._files.values()
        channels = (channel for part in parts for channel in part.channels)
        self.channels = tuple(dict.fromkeys(channels))
        files = [_File(*part.span_ns, part) for part in parts if part.span_ns]
        self._runs = _overlapping(files)
        self.span_ns = None
        if files:
            self.span_ns = min(f.start_ns for f in files), max(f.end_ns for f in files)

    @property
    def losses(self) -> Losses:
        """Losses of the folder and of each file; reading finds more."""
        within = {name: part.losses for name, part in self._files.items()}
        own_losses = [
            END_MISSING if losses.is_unfinished else f"in {name} {text}"
            for name, losses in within.items()
            if (text := str(losses))
        ]
        notes = [note for losses in within.values() for note in losses.notes]
        return replace(
            self._losses,
            others=[*self._losses.others, *own_losses],
            notes=[*self._losses.notes, *notes],
        )

    def messages(
        self, channels: Collection[RecordedChannel], start_ns: int, end_ns: int
    ) -> Iterator[RecordedMessage]:
        """`Recording.messages`."""
        for run in self._runs:
            if run[0].start_ns <= end_ns and any(start_ns <= file.end_ns for file in run):
                streams = [file.part.messages(channels, start_ns, end_ns) for file in run]
                yield from heapq.merge(*streams, key=_stamp)

    def newest(
        self, channels: Collection[RecordedChannel], end_ns: int
    ) -> Iterator[RecordedMessage]:
        """`Recording.newest`."""
        for run in reversed(self._runs):
            if run[0].start_ns <= end_ns:
                streams = [file.part.newest(channels, end_ns) for file in run]
                yield from heapq.merge(*streams, key=_stamp, reverse=True)

    def newest_stamps(self, channels: Collection[RecordedChannel], end_ns: int) -> Iterator[int]:
        """`Recording.newest_stamps`."""
        for run in reversed(self._runs):
            if run[0].start_ns <= end_ns:
                streams = [file.part.newest_stamps(channels, end_ns) for file in run]
                yield from heapq.merge(*streams, reverse=True)

    @property
    def used(self) -> frozenset[RecordedChannel]:
        """`Recording.used`."""
        return frozenset(c for part in self._files.values() for c in part.used)

    def histogram(self, parts: TimeParts) -> dict[RecordedChannel, Counts]:
        """`Recording.histogram`."""
        histogram: dict[RecordedChannel, Counts] = {}
        for file in self._files.values():
            for channel, counts in file.histogram(parts).items():
                histogram[channel] = histogram[channel] + counts if channel in histogram else counts
        return histogram

    def close(self) -> None:
        """Close all files."""
        self._stack.close()

    def _existing(self, folder: Path, names: Sequence[str]) -> list[Path]:
        """Return the files to read."""
        files = [folder / name for name in names]
        existing = [file for file in files if file.exists()]
        missing = ", ".join(file.name for file in files if file not in existing)
        if not existing:
            existing = sorted(file for file in folder.iterdir() if file.suffix in ENDINGS)
        if not existing:
            raise RecordingError(
                f"{folder} lacks the files that {METADATA} names ({missing}): copy them there, or "
                f"run `ros2 bag reindex {folder}`."
            )
        if missing:
            read = ", ".join(file.name for file in existing)
            self._losses.notes.append(
                f"{missing}, named by {METADATA}, is missing. Reading {read}."
            )
        return existing

    def _opened(self, files: Sequence[Path], stack: contextlib.ExitStack) -> dict[str, Recording]:
        parts: dict[str, Recording] = {}
        errors: list[RecordingError] = []
        for file in files:
            try:
                part = open_file(file)
            except RecordingError as error:
                errors.append(error)
                self._losses.notes.append(str(error).replace(str(file), file.name))
                self._losses.others.append(f"{file.name} cannot be read")
            else:
                stack.callback(part.close)
                parts[file.name] = part
        if not parts:
            raise errors[0]
        return parts


class _File(NamedTuple):
    """A file and the times of its first and last message."""

    start_ns: int
    end_ns: int
    part: Recording


def _overlapping(files: Sequence[_File]) -> list[list[_File]]:
    """Group files by time: those of a group overlap, and groups follow each other."""
    runs: list[list[_File]] = []
    for file in sorted(files, key=lambda file: file.start_ns):
        if runs and file.start_ns < max(before.end_ns for before in runs[-1]):
            runs[-1].append(file)
        else:
            runs.append([file])
    return runs


def _stamp(entry: RecordedMessage) -> int:
    return entry.stamp_ns


def _files_in(folder: Path) -> list[Path]:
    """Return the files that may be parts of a bag.

    Raises:
        RecordingError: there are none.
    """
    recordings = sorted(file for file in folder.iterdir() if file.suffix in ENDINGS)
    if recordings:
        return recordings
    raise RecordingError(
        f"{folder} is not a bag: it has no {METADATA}, MCAP or db3 file. Give an MCAP or db3 file, "
        "or a rosbag2 folder."
    )
