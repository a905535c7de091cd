"""Bags that are played together, as if they were one."""

from __future__ import annotations

import contextlib
import heapq
import itertools
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Protocol

from webviz.data.recordings.recording import Counts, TimeParts
from webviz.data.words import counted
from webviz.sources.bag.extras import Extra, extras_file
from webviz.sources.bag.file import BagChannel, BagFile
from webviz.sources.history import Recorded

DAY_NS = 86_400_000_000_000


class MergedFile(Protocol):
    """One of several files that are played together; see `BagFile`."""

    name: str
    """Name for people, "" for messages that are in no file."""
    start_ns: int
    end_ns: int
    channels: tuple[BagChannel, ...]
    skipped: dict[str, str]

    @property
    def warnings(self) -> Sequence[str]:
        """Sentences on damage."""
        ...

    def messages(
        self, channels: Collection[BagChannel], start_ns: int, end_ns: int | None = None
    ) -> Iterator[Recorded]:
        """Messages of channels by time, both ends included."""
        ...

    def newest(self, channels: Collection[BagChannel], end_ns: int) -> Iterator[Recorded]:
        """Messages of channels until a time, the newest first."""
        ...

    def newest_stamps(self, channels: Collection[BagChannel], end_ns: int) -> Iterator[int]:
        """Return the times of `newest`."""
        ...

    def is_used(self, channel: BagChannel) -> bool:
        """Return whether a channel has messages, or may have."""
        ...

    def histogram(self, parts: TimeParts) -> dict[str, Counts]:
        """Count the messages of each topic."""
        ...

    def close(self) -> None:
        """Close the file."""
        ...


class BagFiles:
    """One or several bags, merged by time of recording.

    Args:
        paths: of files or folders, at least one; each is read once.
        others: further ones, which are open; closed with these.
        extras: messages that they lack, latched from their start on.

    Raises:
        BagError: one cannot be read.
    """

    def __init__(
        self,
        paths: Sequence[Path],
        others: Sequence[MergedFile] = (),
        extras: Sequence[Extra] = (),
    ) -> None:
        with contextlib.ExitStack() as stack:
            self._files: list[MergedFile] = []
            for path in {path.resolve(): path for path in paths}.values():
                self._files.append(BagFile(path))
                stack.callback(self._files[-1].close)
            for other in others:
                self._files.append(other)
                stack.callback(other.close)
            self._stack = stack.pop_all()
        files = self._files
        self.names = tuple(file.name for file in files if file.name)
        self.start_ns = min(file.start_ns for file in files)
        self.end_ns = max(file.end_ns for file in files)
        if extras:
            files.insert(0, extras_file(extras, self.start_ns))
        self.topics = {channel.topic for file in files for channel in file.channels}
        self.topics.update(topic for file in files for topic in file.skipped)
        self.channels = tuple(channel for file in files for channel in file.channels)
        self._used = {c.topic for file in files for c in file.channels if file.is_used(c)}
        self._conflict = self._conflicting_types()
        self._gap = self._gap_between()

    @property
    def skipped(self) -> Mapping[str, str]:
        """Return why the messages of a topic cannot be read, by topic."""
        return {topic: why for file in self._files for topic, why in file.skipped.items()}

    @property
    def warnings(self) -> list[str]:
        """Return sentences on what is missing, unusual or damaged so far."""
        own = [warning for file in self._files for warning in file.warnings]
        return [*own, *filter(None, [self._conflict, self._gap])]

    def messages(
        self, channels: Collection[BagChannel], start_ns: int, end_ns: int | None = None
    ) -> Iterator[Recorded]:
        """Return the messages of channels by time of recording, both ends included.

        Raises:
            BagError: a file can no longer be read.
        """
        until_ns = self.end_ns if end_ns is None else end_ns
        streams = [file.messages(own, start_ns, until_ns) for file, own in self._by_file(channels)]
        return streams[0] if len(streams) == 1 else heapq.merge(*streams, key=_stamp)

    def newest(self, channels: Collection[BagChannel], end_ns: int) -> Iterator[Recorded]:
        """Return the messages of channels until a time of recording, the newest first.

        Raises:
            BagError: a file can no longer be read.
        """
        streams = [file.newest(own, end_ns) for file, own in self._by_file(channels)]
        return streams[0] if len(streams) == 1 else heapq.merge(*streams, key=_stamp, reverse=True)

    def newest_stamps(self, channels: Collection[BagChannel], end_ns: int) -> Iterator[int]:
        """Return the times of `newest`, without reading the messages.

        Raises:
            BagError: a file can no longer be read.
        """
        streams = [file.newest_stamps(own, end_ns) for file, own in self._by_file(channels)]
        return heapq.merge(*streams, reverse=True)

    def _by_file(
        self, channels: Collection[BagChannel]
    ) -> Iterator[tuple[MergedFile, Sequence[BagChannel]]]:
        """Yield the files that have some of the channels, and which."""
        chosen = frozenset(channels)
        for file in self._files:
            if own := [channel for channel in file.channels if channel in chosen]:
                yield file, own

    def is_used(self, topic: str) -> bool:
        """Return whether a topic has messages, or may have."""
        return topic in self._used

    def histogram(self, count: int) -> Mapping[str, Sequence[int]]:
        """Count the messages of each topic in equal parts of the span, from any thread."""
        parts = TimeParts(self.start_ns, self.end_ns, count)
        histogram: dict[str, Counts] = {}
        for file in self._files:
            for topic, own in file.histogram(parts).items():
                histogram[topic] = histogram[topic] + own if topic in histogram else own
        return {topic: counts.tolist() for topic, counts in histogram.items() if counts.any()}

    def close(self) -> None:
        """Close all files."""
        self._stack.close()

    def _gap_between(self) -> str:
        """Return a sentence on bags that lie far apart, "" without any."""
        files = sorted(filter(_name, self._files), key=lambda file: file.start_ns)
        for before, after in itertools.pairwise(files):
            days = (after.start_ns - before.end_ns) / DAY_NS
            if days > 1:
                return (
                    f"{after.name} begins {days:.0f} days after {before.name} ends, with "
                    "nothing in between: play them one by one, or select a span of the timeline."
                )
        return ""

    def _conflicting_types(self) -> str:
        """Return a sentence on topics whose type differs between bags, "" without any."""
        types: dict[str, dict[str, str]] = {}
        for file in filter(_name, self._files):
            for channel in file.channels:
                types.setdefault(channel.topic, {}).setdefault(channel.type, file.name)
        conflicts = {topic: names for topic, names in types.items() if len(set(names.values())) > 1}
        if not conflicts:
            return ""
        topic, names = next(iter(conflicts.items()))
        where = " and ".join(f"{type_name} in {name}" for type_name, name in names.items())
        others = len(conflicts) - 1
        verb = "does" if others == 1 else "do"
        more = f", and so {verb} {counted(others, 'more topic')}" if others else ""
        return f"{topic} differs between the bags, {where}{more}: a display reads one type only."


def _name(file: MergedFile) -> str:
    return file.name


def _stamp(recorded: Recorded) -> int:
    return recorded.stamp_ns
