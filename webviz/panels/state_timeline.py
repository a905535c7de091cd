"""The panel State timeline: when values changed."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Mapping, Sequence
from typing import Annotated, Any

import msgspec

from webviz.api.declared import Prop
from webviz.api.lookback import Lookback
from webviz.api.offer import Offer
from webviz.api.panel import Panel, Send, Ui
from webviz.commands import SetPanelProperty
from webviz.data.messages.paths import as_number, leaf_paths
from webviz.data.messages.value_names import named
from webviz.data.names import readable
from webviz.engine.state import PanelTab, PanelTimes
from webviz.panels.field_chooser import FieldChooser
from webviz.panels.reading import PathReading, id_of, subscribed, types_of
from webviz.panels.seeking import seek_to
from webviz.sources.past_state import PlaybackState

MAX_PATHS = 16
MAX_CHANGES = 1000
"""Changes of a value that are kept."""
MAX_TEXT = 60
NS_PER_S = 1e9


class _Track:
    """The changes of one value.

    Args:
        text: its message path.
    """

    def __init__(self, text: str) -> None:
        self.reading = PathReading(text)
        self.changes: deque[tuple[float, str]] = deque(maxlen=MAX_CHANGES)

    def add(self, message: Any, at_s: float) -> None:
        """Take the value of a message; nothing if a filter finds none."""
        values = self.reading.values(message)
        if not values:
            return
        names = self.reading.value_names(message)
        text = ", ".join(named(each, names) or _text(each) for each in values[:10])[:MAX_TEXT]
        if self.changes and at_s < self.changes[-1][0]:
            self.changes.clear()
        if not self.changes or self.changes[-1][1] != text:
            self.changes.append((at_s, text))


class StateTimeline(Panel):
    """Values as bands over time, a colour for each state."""

    title = "State timeline"
    icon = "clock"
    opens = "below"
    module = "state_timeline.js"

    paths: Annotated[
        list[str],
        Prop(help="Message paths of states, such as /robot_mode.mode or /battery.status."),
    ] = msgspec.field(default_factory=list)
    window: Annotated[float, Prop(gt=0, le=86400, unit="s", help="Time that is shown.")] = 60.0

    def __post_init__(self) -> None:
        """Begin without changes."""
        self.id = ""
        self.types: Mapping[str, str] = {}
        self.chooser = FieldChooser(leaf_paths, self._add)
        self.tracks: dict[str, _Track] = {}
        self.unfilled: set[str] = set()
        """Topics of tracks that began."""
        self.clock = PanelTimes()
        self.playback: PlaybackState | None = None

    def build(self, ui: Ui, send: Send) -> None:
        """Show the bands, and what adds one."""
        self.send = send
        self.bands = ui.widget("states", {}, self.use)
        self.chooser.build(ui, "band")

    def subscriptions(self) -> Mapping[str, str]:
        """Return the topics of all paths."""
        subscriptions = subscribed((track.reading for track in self.tracks.values()), self.types)
        offered = self.chooser.topic
        return (
            {**subscriptions, offered: self.types[offered]}
            if offered in self.types
            else subscriptions
        )

    def lookback(self, topic: str) -> Lookback:
        """Return the messages of the window."""
        return Lookback(seconds=self.window)

    def take(self, topic: str, message: Any, received_ns: int, *, is_past: bool = False) -> None:
        """Note what has changed, or had changed before."""
        at_s = received_ns / NS_PER_S
        if not is_past:
            self.chooser.take(topic, message)
        for track in self.tracks.values():
            is_behind = not track.changes or track.changes[-1][0] < at_s
            if track.reading.topic == topic and (is_behind or not is_past):
                track.add(message, at_s)

    def begun(self) -> Collection[str]:
        """Return the topics of new bands."""
        begun, self.unfilled = self.unfilled, set()
        return begun

    def refuse(self, topic: str, reason: str) -> None:
        """Show why a message cannot be read."""
        for track in self.tracks.values():
            if track.reading.topic == topic:
                track.reading.problem = reason

    def start_over(self) -> None:
        """Forget all changes."""
        self.tracks = {text: _Track(text) for text in self.tracks}

    def show(
        self,
        offers: Mapping[str, Offer],
        clock: PanelTimes,
        panels: Sequence[PanelTab],
        playback: PlaybackState | None = None,
    ) -> None:
        """Show the bands."""
        self.clock, self.playback = clock, playback
        self.id = id_of(self, panels)
        self.types = types_of(offers)
        self.chooser.offer(self.types)
        texts = list(dict.fromkeys(self.paths))[:MAX_PATHS]
        before = self.tracks
        self.tracks = {text: before.get(text) or _Track(text) for text in texts}
        new = (track for text, track in self.tracks.items() if text not in before)
        self.unfilled |= {track.reading.topic for track in new}
        now_s = clock.ros_ns / NS_PER_S
        start_s = now_s - self.window
        for track in self.tracks.values():
            while len(track.changes) > 1 and track.changes[1][0] < start_s:
                track.changes.popleft()
        tracks = [
            {
                "name": text,
                "problem": track.reading.explanation(self.types),
                "times": [at_s for at_s, _ in track.changes],
                "states": [state for _, state in track.changes],
            }
            for text, track in self.tracks.items()
        ]
        self.bands.show({"start": start_s, "end": now_s, "tracks": tracks})

    def use(self, value: Any, browser: int | None) -> None:
        """Remove a band, or go to a time in seconds."""
        if isinstance(value, str):
            self._set([path for path in self.paths if path != value], browser)
        else:
            self.send(seek_to(self.playback, self.clock, round(float(value) * NS_PER_S)), browser)

    def _add(self, path: str, browser: int | None) -> None:
        if path not in self.paths:
            self._set([*self.paths, path], browser)

    def _set(self, paths: list[str], browser: int | None) -> None:
        self.send(SetPanelProperty(self.id, "paths", paths), browser)


def _text(value: Any) -> str:
    number = as_number(value)
    text = str(value)[:MAX_TEXT] if number is None else f"{number:g}"
    return readable(("true" if value else "false") if isinstance(value, bool) else text)
