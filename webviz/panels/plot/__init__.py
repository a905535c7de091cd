"""The panel Plot: numbers of messages over time."""

from __future__ import annotations

import time
from collections.abc import Collection, Mapping, Sequence
from typing import Annotated, Any, Literal

import msgspec

from webviz.api.chart import Curve
from webviz.api.declared import Prop
from webviz.api.lookback import Lookback
from webviz.api.offer import Offer
from webviz.api.panel import Panel, Send, Ui
from webviz.commands import SetPanelProperty
from webviz.data.messages.paths import numeric_paths
from webviz.engine.state import PanelTab, PanelTimes
from webviz.panels.field_chooser import FieldChooser
from webviz.panels.plot.series import Series
from webviz.panels.reading import id_of, types_of
from webviz.panels.seeking import NS_PER_S, seek_to
from webviz.sources.past_state import PlaybackState

__all__ = ["Plot"]

MAX_CURVES = 16
MAX_AXES = 4
"""Axes at the right that one curve has for itself."""
CLOSED_S = 1.5
"""Time in seconds without messages and calls of `show` after which no page shows the plot."""


class Plot(Panel):
    """Numbers of any messages over time, read while the panel is open."""

    icon = "pulse"
    opens = "below"

    curves: Annotated[
        list[str],
        Prop(
            help="Message paths of numbers, such as /odom.twist.twist.linear.x, "
            "/joint_states.position[left_wheel] or /odom.pose.pose.orientation.@yaw."
        ),
    ] = msgspec.field(default_factory=list)
    right: Annotated[
        list[str], Prop(help="Those of the curves whose values are on the axis at the right.")
    ] = msgspec.field(default_factory=list)
    own_axis: Annotated[
        list[str], Prop(help="Those of the curves that have an axis of their own at the right.")
    ] = msgspec.field(default_factory=list)
    units: Annotated[
        dict[str, str],
        Prop(help="Units of values by message path, where the type of the messages states none."),
    ] = msgspec.field(default_factory=dict)
    across: Annotated[
        str,
        Prop(
            help="Message path that the curves are drawn over instead of time, such as "
            "/odom.pose.pose.position.x."
        ),
    ] = ""
    window: Annotated[float, Prop(gt=0, le=3600, unit="s", help="Time that is shown.")] = 30.0
    time: Annotated[
        Literal["Received", "Header Stamp"],
        Prop(help="Time of a value; messages without a header have only that of their arrival."),
    ] = "Received"

    def __post_init__(self) -> None:
        """Begin without values."""
        self.id = ""
        self.clock = PanelTimes()
        self.playback: PlaybackState | None = None
        self.series: dict[str, Series] = {}
        self.types: Mapping[str, str] = {}
        self.chooser = FieldChooser(numeric_paths, self._add)
        self.active_s = 0.0
        self.unfilled: set[str] = set()
        """Topics of curves that began, or rested while no page showed them."""

    def build(self, ui: Ui, send: Send) -> None:
        """Show the chart, and what adds a curve."""
        self.send = send
        self.chart = ui.chart(self._remove, self._seek)
        self.chooser.build(ui, "curve")
        self.note = ui.area()

    def subscriptions(self) -> Mapping[str, str]:
        """Return the topics of the curves, and the one whose fields are offered."""
        topics = {each.topic for each in self.series.values()} | {self.chooser.topic}
        return {topic: self.types[topic] for topic in topics if topic in self.types}

    def lookback(self, topic: str) -> Lookback:
        """Return the messages of the window."""
        return Lookback(seconds=self.window)

    def take(self, topic: str, message: Any, received_ns: int, *, is_past: bool = False) -> None:
        """Add a value to each curve of a topic; one of the past to those that are not as far."""
        by_stamp = self.time == "Header Stamp"
        if not is_past:
            self.active_s = time.monotonic()
            self.chooser.take(topic, message)
        for each in self.series.values():
            if each.topic == topic and (
                not is_past or each.is_behind(message, received_ns, by_stamp=by_stamp)
            ):
                each.add(message, received_ns, by_stamp=by_stamp)

    def begun(self) -> Collection[str]:
        """Return the topics of new curves."""
        begun, self.unfilled = self.unfilled, set()
        return begun

    def refuse(self, topic: str, reason: str) -> None:
        """Note why a curve has no values."""
        for each in self.series.values():
            if each.topic == topic:
                each.problem = reason

    def start_over(self) -> None:
        """Forget all values."""
        for each in self.series.values():
            each.clear()

    def show(
        self,
        offers: Mapping[str, Offer],
        clock: PanelTimes,
        panels: Sequence[PanelTab],
        playback: PlaybackState | None = None,
    ) -> None:
        """Show the curves, and what can be added."""
        now = time.monotonic()
        if now - self.active_s > CLOSED_S:
            for each in self.series.values():
                each.history.gap()
                self.unfilled.add(each.topic)
        self.active_s = now
        self.clock, self.playback = clock, playback
        self.id = id_of(self, panels)
        self.types = types_of(offers)
        self._follow()
        self.chooser.offer(self.types)
        ends = [each.history.newest[0] for each in self.series.values() if each.history.newest]
        now_s = clock.ros_ns / 1e9
        if self.time == "Header Stamp" or not now_s:
            now_s = max(ends, default=now_s)
        axes = self._axes()
        curves = [
            Curve(
                name,
                each.history.chunks(),
                each.explanation(self.types),
                axes.get(name, 0),
                self.units.get(name) or each.unit(self.types),
            )
            for name, each in self.series.items()
        ]
        self.chart.show(curves, self.window, now_s, self.across)
        if not self.curves:
            self.note.text("Add a field with +, or drag one here from Topics.")
        else:
            more = len(self.curves) - MAX_CURVES
            self.note.text(f"Only the first {MAX_CURVES} curves are shown." if more > 0 else "")

    def _follow(self) -> None:
        """Have the curves that the properties name, with the values of those that stay."""
        how, before = (self.window, self.time), self.series
        self.series = {
            text: former
            if (former := self.series.get(text)) and former.how == how
            else Series(text, how, former)
            for text in list(dict.fromkeys([*self._across(), *self.curves]))[:MAX_CURVES]
        }
        new = (each for text, each in self.series.items() if text not in before)
        self.unfilled |= {each.topic for each in new}

    def _axes(self) -> Mapping[str, int]:
        """Return the axes at the right by curve: the shared one is innermost."""
        own = [name for name in self.series if name in self.own_axis][:MAX_AXES]
        return dict.fromkeys(self.right, 1) | {name: 2 + i for i, name in enumerate(own)}

    def _across(self) -> list[str]:
        return [self.across] if self.across else []

    def _add(self, path: str, browser: int | None) -> None:
        if path not in self.curves:
            self._set([*self.curves, path], browser)

    def _remove(self, name: str, browser: int | None) -> None:
        if name == self.across:
            self.send(SetPanelProperty(self.id, "across", ""), browser)
        if name in self.curves:
            self._set([each for each in self.curves if each != name], browser)

    def _seek(self, time_s: float, browser: int | None) -> None:
        at_ns = round(time_s * NS_PER_S)
        if (playback := self.playback) is not None:
            first_ns = playback.start_ns + round(playback.first_s * NS_PER_S)
            at_ns = max(first_ns, min(at_ns, playback.end_ns))
        self.send(seek_to(self.playback, self.clock, at_ns), browser)

    def _set(self, curves: list[str], browser: int | None) -> None:
        self.send(SetPanelProperty(self.id, "curves", curves), browser)
