"""The panel Diagnostics: what nodes report on /diagnostics and /diagnostics_agg, as a tree."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

import msgspec

from webviz.api.declared import Prop
from webviz.api.offer import Offer
from webviz.api.panel import Panel, Send, Ui
from webviz.data.names import readable
from webviz.data.words import counted
from webviz.engine.state import PanelTimes

ARRAY = "diagnostic_msgs/msg/DiagnosticArray"
STALE = 3
"""Level of diagnostic_msgs/msg/DiagnosticStatus, above OK, WARN and ERROR."""
MAX_STATUSES = 5000
"""Statuses that are kept; of more, those that came last are ignored."""
PER_PART = 20
"""Statuses that pages receive at once."""
MAX_VALUES = 40
"""Values of a status."""
MAX_NAME, MAX_MESSAGE, MAX_KEY, MAX_VALUE = 200, 300, 60, 120
"""Characters of each."""
NS_PER_S = 1e9


class _DeviceStatus(msgspec.Struct):
    """A status.

    Args:
        row: as pages receive it, with its level as reported.
        received_ns: ROS time of the newest report.
        is_stale: whether it was shown as stale.
    """

    row: dict[str, Any]
    received_ns: int
    is_stale: bool = False


class Diagnostics(Panel):
    """Reports of nodes about themselves, the worst first."""

    icon = "check"
    opens = "below"
    module = "diagnostics.js"

    topic: Annotated[str, Prop(help="Topic of the diagnostics.")] = "/diagnostics"
    aggregated: Annotated[str, Prop(help="Topic of the aggregator; empty for none.")] = (
        "/diagnostics_agg"
    )
    stale_after: Annotated[
        float, Prop(gt=0, le=3600, unit="s", help="Time without a report after which it is stale.")
    ] = 5.0

    def __post_init__(self) -> None:
        """Begin without statuses."""
        self.problems: dict[str, str] = {}
        self.start_over()

    def build(self, ui: Ui, send: Send) -> None:
        """Show the tree."""
        self.tree = ui.widget("diagnostics", {}, lambda value, browser: None)

    def subscriptions(self) -> Mapping[str, str]:
        """Both topics."""
        return dict.fromkeys(self._topics(), ARRAY)

    def start_over(self) -> None:
        """Forget all statuses."""
        self.devices: dict[tuple[str, str], _DeviceStatus] = {}
        self.parts: list[dict[str, Any] | None] = []
        self.places: dict[tuple[str, str], int] = {}
        self.ignored = 0

    def take(self, topic: str, message: Any, received_ns: int) -> None:
        """Take the statuses of a report."""
        self.problems.pop(topic, None)
        self.ignored = 0
        for status in message.status:
            name = readable(status.name[:MAX_NAME]) or "(no name)"
            key = topic, name
            if key not in self.devices:
                if len(self.devices) >= MAX_STATUSES:
                    self.ignored += 1
                    continue
                self.places[key] = len(self.devices)
                if len(self.devices) % PER_PART == 0:
                    self.parts.append(None)
            self.devices[key] = _DeviceStatus(
                {
                    "path": list(_path(topic, name, is_aggregated=topic == self.aggregated)),
                    "level": min(int(status.level), STALE),
                    "message": readable(status.message[:MAX_MESSAGE]),
                    "hardware": readable(status.hardware_id[:MAX_NAME]),
                    "values": [
                        [readable(each.key[:MAX_KEY]), readable(each.value[:MAX_VALUE])]
                        for each in status.values[:MAX_VALUES]
                    ],
                    "at": received_ns / NS_PER_S,
                },
                received_ns,
            )
            self.parts[self.places[key] // PER_PART] = None

    def refuse(self, topic: str, reason: str) -> None:
        """Show why a message cannot be read."""
        self.problems[topic] = reason

    def show(self, clock: PanelTimes, offers: Mapping[str, Offer]) -> None:
        """Show the tree, and why there is none."""
        oldest_ns = clock.ros_ns - self.stale_after * NS_PER_S
        for key, each in self.devices.items():
            is_stale = each.received_ns < oldest_ns
            if is_stale != each.is_stale:
                each.is_stale = is_stale
                self.parts[self.places[key] // PER_PART] = None
        if None in self.parts:
            rows = [
                {**each.row, "level": STALE} if each.is_stale else each.row
                for each in self.devices.values()
            ]
            self.parts = [
                part or {"statuses": rows[at * PER_PART : (at + 1) * PER_PART]}
                for at, part in enumerate(self.parts)
            ]
        parts = {str(at): part for at, part in enumerate(self.parts) if part is not None}
        values = {"parts": len(parts), "problem": self._problem(offers)}
        self.tree.show(values, parts)

    def _problem(self, offers: Mapping[str, Offer]) -> str:
        for problem in self.problems.values():
            return problem
        if self.ignored:
            limit = f"the limit is {MAX_STATUSES}. Publish fewer."
            return f"{counted(self.ignored, 'diagnostic')} not shown; {limit}"
        if not self.devices and not any(topic in offers for topic in self._topics()):
            return f"No publisher on {' or '.join(self._topics())}. Start a diagnostic updater."
        return "" if self.devices else "No message yet."

    def _topics(self) -> list[str]:
        topics = dict.fromkeys((self.topic, self.aggregated))
        return [topic for topic in topics if topic.startswith("/")]


def _path(topic: str, name: str, *, is_aggregated: bool) -> Iterator[str]:
    """Yield the names from the root of the tree: split at slashes, or at `node: task`."""
    yield topic
    if is_aggregated:
        yield from [part for part in name.split("/") if part][:16] or [name]
        return
    node, separator, task = name.partition(": ")
    yield node
    if separator:
        yield task
