"""The base of panels that show one message path."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Annotated, Any

from webviz.api.declared import Prop
from webviz.api.lookback import Lookback
from webviz.api.offer import Offer
from webviz.api.panel import Panel, Send, Ui
from webviz.commands import SetPanelProperty
from webviz.data.messages.value_names import NO_NAMES, ValueNames
from webviz.engine.state import PanelTab
from webviz.panels.reading import PathReading, id_of, subscribed, types_of

MAX_TOPICS = 2000


class PathPanel(Panel):
    """A panel with one message path, which is chosen in its head."""

    path: Annotated[
        str,
        Prop(help="Message path, such as /odom.pose.pose.position or /diagnostics.status[:]."),
    ] = ""

    def __post_init__(self) -> None:
        """Begin without values."""
        self.id = ""
        self.types: Mapping[str, str] = {}
        self.reading = PathReading("")
        self.filled: PathReading | None = None
        """The last one that was given what is remembered."""
        self.values: list[Any] = []
        """The values in the newest message."""
        self.names: ValueNames = NO_NAMES
        """Their names, where the type of the message has some."""
        self.revision = 0
        """Number of messages, so that unchanged values are not made anew."""

    def build_path(self, ui: Ui, send: Send) -> None:
        """Add the field of the path to the head of the panel."""
        self.send = send
        self.chooser = ui.widget("path", {"path": self.path, "topics": []}, self._set)

    def subscriptions(self) -> Mapping[str, str]:
        """Return the topic of the path."""
        return subscribed([self.reading], self.types)

    def take(self, topic: str, message: Any, *, is_past: bool = False) -> None:
        """Read the values of a message; of one of the past only if there is no newer one."""
        if topic == self.reading.topic and not (is_past and self.values):
            self.values = self.reading.values(message)
            self.names = self.reading.value_names(message)
            self.revision += 1

    def begun(self) -> Collection[str]:
        """Return the topic while it has no values."""
        topic = self.reading.topic
        is_new = self.filled is not self.reading and topic in self.types
        if is_new:
            self.filled = self.reading
        return {topic} if is_new else ()

    def lookback(self, topic: str) -> Lookback:
        """Return the newest message."""
        return Lookback(count=1)

    def refuse(self, topic: str, reason: str) -> None:
        """Show why a message cannot be read."""
        self.reading.problem = reason

    def start_over(self) -> None:
        """Forget the values."""
        self.values = []
        self.revision += 1
        self.reading = PathReading(self.path)

    def follow(self, offers: Mapping[str, Offer], panels: Sequence[PanelTab]) -> str:
        """Follow the properties and topics; return why there is nothing to show."""
        self.id = id_of(self, panels)
        self.types = types_of(offers)
        if self.reading.text != self.path:
            self.start_over()
        self.chooser.show({"path": self.path, "topics": sorted(self.types)[:MAX_TOPICS]})
        return self.reading.explanation(self.types)

    def _set(self, path: Any, browser: int | None) -> None:
        self.send(SetPanelProperty(self.id, "path", path), browser)
