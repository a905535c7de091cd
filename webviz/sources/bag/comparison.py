"""A second run beside a bag: its topics in a namespace of their own, and moved in time."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import closing
from pathlib import Path
from typing import Literal

import msgspec
import numpy as np
import numpy.typing as npt
from msgspec.structs import replace

from webviz.api.errors import Error
from webviz.api.offer import Publisher
from webviz.data.messages import MessageError, decode, definition
from webviz.data.messages.paths import FieldPath
from webviz.data.messages.stamps import shifted
from webviz.data.recordings import RecordedChannel
from webviz.data.recordings.latched import TF
from webviz.data.recordings.recording import Counts, TimeParts
from webviz.data.transforms.geometry import IDENTITY, PoseTuple, compose
from webviz.sources.bag.computed import ComputedFile
from webviz.sources.bag.file import BagChannel, BagFile
from webviz.sources.bag.files import BagFiles
from webviz.sources.bag.time import BagTime
from webviz.sources.history import Recorded

NAMESPACE = "ghost"
ROOT = f"/{NAMESPACE}"
DISTANCE, DIFFERENCE = f"{ROOT}/distance", f"{ROOT}/difference"
FLOAT = "std_msgs/msg/Float64"
BASES = ("base_link", "base_footprint", "base")
"""Frames of a robot that tell where it is, by preference."""
SAMPLE_S = 0.1
"""Time in seconds between two poses of a path."""
MAX_SAMPLES = 200_000
STEP_S = 0.5
"""Step in seconds of the offsets that are tried."""
MAX_STEPS = 20_000
OVERLAP = 0.3
"""Share of the shorter path that must lie beside the other for an offset to count."""

Align = Literal["stamp", "start", "path"]
Floats = npt.NDArray[np.float64]


class ComparisonRun(msgspec.Struct, frozen=True):
    """A second run to show beside a bag.

    Args:
        path: of its bag.
        align: "stamp" keeps its times, "start" lets both begin together, "path" moves it to where
            the robots are closest; or seconds to add to the times of "start".
        difference: a message path of a number, such as /odom.twist.twist.linear.x, "" for none.
    """

    path: Path
    align: Align | float = "start"
    difference: str = ""


class ComparisonFile(BagFile):
    """A bag whose topics are in the namespace `ghost`, and whose times are moved.

    Args:
        path: of the file or folder.
        offset_ns: added to times of recording.
        stamps_ns: added to the stamps in messages.
    """

    def __init__(self, path: Path, offset_ns: int, stamps_ns: int) -> None:
        self._offset_ns = offset_ns
        self._stamps_ns = stamps_ns
        super().__init__(path)
        self.start_ns += offset_ns
        self.end_ns += offset_ns
        self.channels = tuple(
            replace(channel, topic=ROOT + channel.topic) for channel in self.channels
        )
        self.skipped = {ROOT + topic: why for topic, why in self.skipped.items()}

    def messages(
        self, channels: Collection[BagChannel], start_ns: int, end_ns: int | None = None
    ) -> Iterator[Recorded]:
        """See `BagFile.messages`."""
        by_ns = self._offset_ns
        until_ns = self.end_ns if end_ns is None else end_ns
        return map(self._moved, super().messages(channels, start_ns - by_ns, until_ns - by_ns))

    def newest(self, channels: Collection[BagChannel], end_ns: int) -> Iterator[Recorded]:
        """See `BagFile.newest`."""
        return map(self._moved, super().newest(channels, end_ns - self._offset_ns))

    def newest_stamps(self, channels: Collection[BagChannel], end_ns: int) -> Iterator[int]:
        """See `BagFile.newest_stamps`."""
        by_ns = self._offset_ns
        return (each + by_ns for each in super().newest_stamps(channels, end_ns - by_ns))

    def histogram(self, parts: TimeParts) -> dict[str, Counts]:
        """See `BagFile.histogram`."""
        by_ns = self._offset_ns
        moved = TimeParts(parts.start_ns - by_ns, parts.end_ns - by_ns, parts.count)
        return super().histogram(moved)

    def _moved(self, recorded: Recorded) -> Recorded:
        cdr = shifted(recorded.type, recorded.cdr, self._stamps_ns, recorded.types)
        return recorded._replace(cdr=cdr, stamp_ns=recorded.stamp_ns + self._offset_ns)


def comparison_files(
    paths: Sequence[Path], comparison: ComparisonRun
) -> list[ComparisonFile | ComputedFile]:
    """Return the second run as files to merge with a bag, and numbers that compare both.

    Args:
        paths: of the bag.
        comparison: the second run.

    Raises:
        Error: a bag cannot be read, or the paths of the robots are unknown.
    """
    with closing(BagFiles(paths)) as own, closing(BagFiles([comparison.path])) as other:
        here, there = Track.of(own), Track.of(other)
        offset_ns = _offset_ns(own, other, here, there, comparison.align)
        ros_ns = _ros_offset_ns(other) - _ros_offset_ns(own)
        numbers_by_topic: dict[str, tuple[npt.NDArray[np.int64], Floats]] = {}
        if here is not None and there is not None and here.root == there.root:
            distance = np.hypot(*(here.xy - there.at(here.times - offset_ns)).T)
            _add(numbers_by_topic, DISTANCE, here.times, distance)
        if comparison.difference:
            times, values = _numbers(own, comparison.difference)
            other_times, other_values = _numbers(other, comparison.difference)
            there_values = _interpolated(times - offset_ns, other_times, other_values)
            _add(numbers_by_topic, DIFFERENCE, times, values - there_values)
    numbers = [_numbers_file(numbers_by_topic)] if numbers_by_topic else []
    return [ComparisonFile(comparison.path, offset_ns, offset_ns + ros_ns), *numbers]


class Track(msgspec.Struct, frozen=True):
    """The path of a robot.

    Args:
        root: frame at the root of its transforms.
        times: of recording, in ns, increasing.
        xy: (N, 2), in metres in that frame.
    """

    root: str
    times: npt.NDArray[np.int64]
    xy: Floats

    @staticmethod
    def of(files: BagFiles) -> Track | None:
        """Return the path in a bag, None if there is no frame of a robot."""
        channels = [c for c in files.channels if c.type == TF and c.topic in ("/tf", "/tf_static")]
        links: dict[str, tuple[str, PoseTuple]] = {}
        times: list[int] = []
        places: list[tuple[str, str, float, float]] = []
        for recorded in files.messages(channels, files.start_ns):
            _learn(links, recorded)
            if times and recorded.stamp_ns - times[-1] < SAMPLE_S * 1e9:
                continue
            place = _place(links)
            if place is not None and len(times) < MAX_SAMPLES:
                times.append(recorded.stamp_ns)
                places.append(place)
        if not places:
            return None
        kind = places[-1][:2]  # frames may become known one by one
        indices = [n for n, each in enumerate(places) if each[:2] == kind]
        xy = np.array([places[n][2:] for n in indices], float)
        return Track(kind[0], np.array([times[n] for n in indices], np.int64), xy)

    def at(self, times: npt.NDArray[np.int64]) -> Floats:
        """Positions at other times, (N, 2); NaN outside of the path."""
        columns = [_interpolated(times, self.times, self.xy[:, axis]) for axis in (0, 1)]
        return np.stack(columns, axis=1)


def _learn(links: dict[str, tuple[str, PoseTuple]], recorded: Recorded) -> None:
    try:
        message = decode(TF, recorded.cdr)
    except MessageError:
        return
    for each in message.transforms:
        pose = (*each.translation, *each.rotation)
        if all(map(math.isfinite, pose)):
            links[each.child.lstrip("/")] = each.parent.lstrip("/"), pose


def _place(links: dict[str, tuple[str, PoseTuple]]) -> tuple[str, str, float, float] | None:
    """Return the root, the frame of the robot, and its position in the root."""
    frame = next((name for name in BASES if name in links), None)
    if frame is None:
        return None
    pose, root, visited = IDENTITY, frame, {frame}
    while root in links:
        root, link = links[root]
        if root in visited:
            return None
        visited.add(root)
        pose = compose(link, pose)
    return root, frame, pose[0], pose[1]


def _offset_ns(
    own: BagFiles, other: BagFiles, here: Track | None, there: Track | None, align: Align | float
) -> int:
    """Time to add to the second run."""
    if align == "stamp":
        return 0
    start_ns = own.start_ns - other.start_ns
    if align == "start":
        return start_ns
    if align != "path":
        return start_ns + round(align * 1e9)
    if here is None or there is None:
        raise Error(
            f"The paths of the robots are unknown, since there is no frame {' or '.join(BASES)}. "
            "Align by start, or give seconds."
        )
    return int(here.times[0] - there.times[0]) + round(_closest(here, there) * 1e9)


def _closest(here: Track, there: Track) -> float:
    """Seconds that the second path begins after the first where both are closest."""
    a, b = here.times[0], there.times[0]
    times, other_times = (here.times - a) / 1e9, (there.times - b) / 1e9
    lengths = times[-1], other_times[-1]
    step = max(STEP_S, (lengths[0] + lengths[1]) / MAX_STEPS)
    thin = max(1, len(times) // 2000)
    times, xy = times[::thin], here.xy[::thin]
    coarse = np.arange(-lengths[1], lengths[0] + step, step)
    best = _best(coarse, times, xy, other_times, there.xy, min(lengths))
    fine = best + np.arange(-step, step + SAMPLE_S / 2, SAMPLE_S)
    return _best(fine, times, xy, other_times, there.xy, min(lengths))


def _best(
    offsets: Floats, times: Floats, xy: Floats, other_times: Floats, other_xy: Floats, least: float
) -> float:
    """Return the offset with the least mean distance, of those with enough overlap."""
    best, least_m = 0.0, math.inf
    needed = max(2, round(OVERLAP * least / max(1e-9, times[-1]) * len(times)))
    for offset in offsets:
        at = times - offset
        inside = (at >= 0) & (at <= other_times[-1])
        if inside.sum() < needed:
            continue
        dx, dy = (
            np.interp(at[inside], other_times, other_xy[:, n]) - xy[inside, n] for n in (0, 1)
        )
        mean = float(np.hypot(dx, dy).mean())
        # Of equal ones, such as while both stand, the one next to the start.
        if mean < least_m - 1e-9 or (mean < least_m + 1e-9 and abs(offset) < abs(best)):
            best, least_m = float(offset), mean
    return best


def _ros_offset_ns(files: BagFiles) -> int:
    """Time of recording minus ROS time."""
    return files.start_ns - BagTime(files).at(files.start_ns)


def _numbers(files: BagFiles, path: str) -> tuple[npt.NDArray[np.int64], Floats]:
    """Return times of recording and values of a number.

    Raises:
        Error: it has no values.
    """
    topic, _, field = path.partition(".")
    channels = [channel for channel in files.channels if channel.topic == topic]
    times: list[int] = []
    values: list[float] = []
    try:
        read = FieldPath(field)
        for recorded in files.messages(channels, files.start_ns):
            if len(times) >= MAX_SAMPLES:
                break
            message = decode(recorded.type, recorded.cdr, recorded.types)
            value = read.number(message)
            times.append(recorded.stamp_ns)
            values.append(value)
    except MessageError as error:
        raise Error(f"Cannot read {path}: {str(error).rstrip('.')}.") from error
    if not times:
        raise Error(f"{', '.join(files.names)} has no messages on {topic}. Choose another number.")
    return np.array(times, np.int64), np.array(values, float)


def _interpolated(
    at: npt.NDArray[np.int64], times: npt.NDArray[np.int64], values: Floats
) -> Floats:
    """Values at other times; NaN outside."""
    start = times[0]
    return np.interp(
        (at - start) / 1e9, (times - start) / 1e9, values, left=math.nan, right=math.nan
    )


def _add(
    series: dict[str, tuple[npt.NDArray[np.int64], Floats]],
    topic: str,
    times: npt.NDArray[np.int64],
    values: Floats,
) -> None:
    """Add the numbers that are known, if any."""
    is_finite = np.isfinite(values)
    if is_finite.any():
        series[topic] = times[is_finite], values[is_finite]


def _numbers_file(series: dict[str, tuple[npt.NDArray[np.int64], Floats]]) -> ComputedFile:
    """Return times of recording and numbers by topic as a file of a bag."""

    def serialized(values: Floats) -> Callable[[int], bytes]:
        return lambda number: b"\0\1\0\0" + struct.pack("<d", values[number])

    return ComputedFile(
        {
            _number_channel(topic): (times, serialized(values))
            for topic, (times, values) in series.items()
        }
    )


def _number_channel(topic: str) -> BagChannel:
    recorded = RecordedChannel(topic, FLOAT, "cdr", definition(FLOAT), "")
    publishers = (Publisher("webviz", FLOAT, "reliable", "volatile"),)
    return BagChannel(topic, FLOAT, publishers, 1, recorded)
