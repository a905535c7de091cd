"""The base of panels that show one message path."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any

from webviz.api.declared import Prop
from webviz.api.offer import Offer
from webviz.api.panel import Panel, Send, Ui
from webviz.commands import SetPanelProperty
from webviz.engine.state import PanelTab
from webviz.panels.reading import PathReading, id_of, subscribed, types_of

NOTHING = ""


class PathPanel(Panel):
    """A panel with one message path, and the fields to choose it."""

    path: Annotated[
        str,
        Prop(help="Message path, such as /odom.pose.pose.position or /diagnostics.status[:]."),
    ] = ""

    def __post_init__(self) -> None:
        """Without values."""
        self.id = ""
        self.types: Mapping[str, str] = {}
        self.reading = PathReading("")
        self.found: list[Any] = []
        """The values in the newest message."""
        self.revision = 0
        """Number of messages, so that unchanged values are not made anew."""

    def build_path(self, ui: Ui, send: Send) -> None:
        """Add the topic and the path."""
        self.send = send
        self.topics = ui.choice("Topic", NOTHING, self._set, "Topic whose messages are shown.")
        self.field = ui.field("Message path", self.path, self._set, "Topic, fields and filters.")

    def subscriptions(self) -> Mapping[str, str]:
        """Return the topic of the path."""
        return subscribed([self.reading], self.types)

    def take(self, topic: str, message: Any) -> None:
        """Read the values of a message."""
        if topic == self.reading.topic:
            self.found = self.reading.values(message)
            self.revision += 1

    def refuse(self, topic: str, reason: str) -> None:
        """Show why a message cannot be read."""
        self.reading.problem = reason

    def start_over(self) -> None:
        """Forget the values."""
        self.found = []
        self.revision += 1
        self.reading = PathReading(self.path)

    def follow(self, offers: Mapping[str, Offer], panels: Sequence[PanelTab]) -> str:
        """Follow the properties and topics; return why there is nothing to show."""
        self.id = id_of(self, panels)
        self.types = types_of(offers)
        if self.reading.text != self.path:
            self.start_over()
        self.topics.offer([NOTHING, *sorted(self.types)], self.reading.topic)
        self.field.show(self.path)
        return self.reading.explanation(self.types)

    def _set(self, path: str, browser: int | None) -> None:
        self.send(SetPanelProperty(self.id, "path", path), browser)
