"""The panel Log: messages that nodes log to /rosout."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Collection, Mapping
from typing import Annotated, Any, Literal

from webviz.api.declared import Prop
from webviz.api.lookback import Lookback
from webviz.api.offer import Offer
from webviz.api.panel import Panel, Send, Ui
from webviz.data.names import readable
from webviz.engine.state import PanelTimes
from webviz.panels.seeking import seek_to
from webviz.sources.past_state import PlaybackState

LOG, ROS_1_LOG = "rcl_interfaces/msg/Log", "rosgraph_msgs/msg/Log"
ROS_1_LEVELS = {1: 10, 2: 20, 4: 30, 8: 40, 16: 50}
"""Levels of rosgraph_msgs/Log, and those of rcl_interfaces/msg/Log."""
PER_CHUNK = 200
"""Lines that pages receive at once."""
MAX_CHUNK_CHARACTERS = 50_000
MAX_CHARACTERS = 20_000_000
"""Largest number of characters of all lines; the oldest are discarded."""
MAX_TEXT, MAX_NAME = 4000, 200
"""Characters of a text, and of a node, file or function."""
AFTER_SEEK = 2000
"""Lines before a time that are read after a seek."""

Line = tuple[float, int, str, str, str]
"""Stamp in seconds, level, node, text, and file, line and function."""


class Log(Panel):
    """Messages that nodes log, with filters by level, node and text."""

    icon = "list"
    opens = "below"
    always_reads = True
    module = "log.js"

    topic: Annotated[str, Prop(help="Topic of the log.")] = "/rosout"
    level: Annotated[
        Literal["Debug", "Info", "Warn", "Error", "Fatal"],
        Prop(help="Lowest level that is shown at first; each page can choose another."),
    ] = "Info"
    nodes: Annotated[str, Prop(help="Part of the names of nodes that are shown at first.")] = ""
    text: Annotated[str, Prop(help="Part of the texts that are shown at first.")] = ""
    lines: Annotated[int, Prop(ge=100, le=100_000, help="Lines that are kept.")] = 100_000

    def __post_init__(self) -> None:
        """Begin without lines."""
        self.type = LOG
        self.problem = ""
        self.filled = ""
        """The topic of which it was given what is remembered."""
        self.past: set[Line] = set()
        """Lines of it, which publishers may repeat."""
        self.clock = PanelTimes()
        self.playback: PlaybackState | None = None
        self.lock = threading.Lock()
        self.beginnings = 0
        """Counts how often all lines were forgotten."""
        self.clear()

    def clear(self) -> None:
        """Forget all lines."""
        with self.lock:
            self.chunks: deque[dict[str, Any]] = deque()
            self.open: list[Line] = []
            self.times: deque[list[int]] = deque([[]])
            self.sizes: deque[int] = deque([0])
            self.size = 0
            self.first = 0
            self.columns: dict[str, Any] | None = None

    def build(self, ui: Ui, send: Send) -> None:
        """Show the lines, which the page filters."""
        self.send = send
        self.list = ui.widget("log", {}, self.use)

    def subscriptions(self) -> Mapping[str, str]:
        """Return the log."""
        return {self.topic: self.type} if self.topic.startswith("/") else {}

    def lookback(self, topic: str) -> Lookback:
        """Return the last lines."""
        return Lookback(count=AFTER_SEEK)

    def begun(self) -> Collection[str]:
        """Return the topic once there is one."""
        begun = self.subscriptions().keys() - {self.filled}
        self.filled = self.topic
        return begun

    def take(self, topic: str, message: Any, received_ns: int, *, is_past: bool = False) -> None:
        """Add a line, unless it is remembered and was added already, or a publisher repeats it."""
        line = self._line(message)
        if line not in self.past:
            self.add(line, received_ns)
            if is_past:
                self.past.add(line)
        elif not is_past:
            self.past.remove(line)

    def _line(self, message: Any) -> Line:
        is_ros_1 = self.type == ROS_1_LOG
        stamp = message.header.stamp if is_ros_1 else message.stamp
        level = ROS_1_LEVELS.get(message.level, 20) if is_ros_1 else int(message.level)
        file = readable(message.file[:MAX_NAME])
        place = f"{file}:{message.line}" if file else ""
        function = readable(message.function[:MAX_NAME])
        self.problem = ""
        return (
            round(stamp.ns / 1e9, 6),
            level,
            readable(message.name[:MAX_NAME]),
            message.msg[:MAX_TEXT],
            f"{place} {function}".strip(),
        )

    def add(self, line: Line, received_ns: int) -> None:
        """Add a line, and forget the oldest ones if there are too many."""
        with self.lock:
            self.open.append(line)
            self.times[-1].append(received_ns)
            size = len(line[2]) + len(line[3]) + len(line[4])
            self.size += size
            self.sizes[-1] += size
            self.columns = None
            if len(self.open) == PER_CHUNK or self.sizes[-1] > MAX_CHUNK_CHARACTERS:
                self.chunks.append(_columns(self.open))
                self.open = []
                self.times.append([])
                self.sizes.append(0)
            most = max(1, self.lines // PER_CHUNK)
            while self.chunks and (len(self.chunks) > most or self.size > MAX_CHARACTERS):
                self.chunks.popleft()
                self.times.popleft()
                self.size -= self.sizes.popleft()
                self.first += 1

    def refuse(self, topic: str, reason: str) -> None:
        """Show why a message cannot be read."""
        self.problem = reason

    def start_over(self) -> None:
        """Forget all lines."""
        self.past.clear()
        self.beginnings += 1
        self.clear()

    def show(
        self, offers: Mapping[str, Offer], clock: PanelTimes, playback: PlaybackState | None = None
    ) -> None:
        """Show the lines, and why there are none."""
        self.clock, self.playback = clock, playback
        offer = offers.get(self.topic)
        types = [each.type for each in offer.publishers] if offer else []
        self.type = ROS_1_LOG if ROS_1_LOG in types and LOG not in types else LOG
        with self.lock:
            self.columns = self.columns or _columns(self.open)
            numbers = range(self.first, self.first + len(self.chunks) + 1)
            total = sum(map(len, self.times))
            parts = dict(zip(map(str, numbers), [*self.chunks, self.columns], strict=True))
        problem = self.problem
        if not types and len(parts) == 1 and not self.open:
            problem = f"No publisher on {self.topic}. Start a node, or choose another topic."
        values: dict[str, Any] = {"chunks": [numbers.start, numbers.stop], "problem": problem}
        values |= {"total": total, "beginnings": self.beginnings}
        values |= {"level": self.level, "nodes": self.nodes, "text": self.text}
        self.list.show(values, parts)

    def use(self, value: Any, browser: int | None) -> None:
        """Go to the time of a line: the number of its chunk and its place there."""
        chunk, place = value
        with self.lock:
            times = self.times[chunk - self.first] if chunk >= self.first else []
            received_ns = times[place]
        self.send(seek_to(self.playback, self.clock, received_ns), browser)


def _columns(lines: list[Line]) -> dict[str, Any]:
    stamps, levels, names, texts, places = zip(*lines, strict=True) if lines else ((),) * 5
    return {
        "stamps": stamps,
        "levels": levels,
        "names": names,
        "texts": texts,
        "places": places,
    }
