"""The panel Publish: a message on any topic that may be published, once or at a rate."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from typing import Annotated, Any

from webviz.api.declared import Prop
from webviz.api.errors import Error
from webviz.api.offer import Offer
from webviz.api.panel import Send, Ui
from webviz.api.status import Level, Status
from webviz.commands import Publish
from webviz.engine.state import PanelTab
from webviz.panels.sending import SendingPanel

MAX_RATE_HZ = 10.0
"""Panels are shown a few times a second, and publish then."""
PAUSE_S = 2.0
"""A panel that no page has shown for this long stops publishing."""


class PublishMessage(SendingPanel):
    """A message that is published on a topic, once or at a rate while the tab is open."""

    title = "Publish"
    icon = "upload"
    target = "topic"

    topic: Annotated[str, Prop(help="Topic to publish on.")] = ""
    message_type: Annotated[str, Prop(help="Message type; empty for that of the topic.")] = ""
    rate: Annotated[
        float, Prop(ge=0, le=MAX_RATE_HZ, unit="Hz", help="Messages per second while it repeats.")
    ] = 1.0

    def build(self, ui: Ui, send: Send) -> None:
        """Show the form."""
        self.build_form(ui, send)
        self.is_repeating = False
        self.sender: int | None = None
        self.next_s = self.shown_s = 0.0

    def publications(self) -> Mapping[str, str]:
        """Return the topic."""
        type_ = self.message_type or self.type_shown
        return {self.topic: type_} if self.topic.startswith("/") and type_ else {}

    def show(
        self,
        offers: Mapping[str, Offer],
        topics: Mapping[str, Sequence[str]],
        panels: Sequence[PanelTab],
    ) -> None:
        """Show the form, and publish if it is time."""
        # A topic that is published by hand, such as /cmd_vel, often has subscriptions only.
        read = {
            topic: tuple(each.type for each in offer.readers)
            for topic, offer in offers.items()
            if offer.readers
        }
        types = topics.get(self.topic) or read.get(self.topic, ())
        type_ = self.message_type or (types[0] if types else "")
        now_s = time.monotonic()
        if now_s - self.shown_s > PAUSE_S:
            self.is_repeating = False
        self.shown_s = now_s
        if self.is_repeating and now_s >= self.next_s:
            self.next_s = now_s + (1.0 / self.rate if self.rate > 0 else math.inf)
            self._publish_or_stop()
        named = {name for name, of_topic in topics.items() if of_topic} | read.keys()
        about = type_ or "Nothing publishes or reads this topic. Enter its type in Properties."
        use = f"publish on {self.topic}"
        form = {"verb": "Publish", "use": use, "name": self.topic, "label": "Topic"}
        repeating = {"names": sorted(named)[:2000], "repeats": self.is_repeating, "rate": self.rate}
        self.show_form(panels, type_, {**form, "about": about, **repeating})

    def act(self, value: Any, browser: int | None) -> None:
        """Publish once, or begin or end to repeat."""
        self.sender = browser
        if "repeat" in value:
            if not value["repeat"]:
                self.is_repeating = False
                return
            self.values()
            self.is_repeating, self.next_s = True, 0.0
        else:
            self._publish()

    def _publish_or_stop(self) -> None:
        try:
            self._publish()
        except Error as error:
            self.report(Status(Level.ERROR, str(error)))

    def _publish(self) -> None:
        values = self.values()
        message = Publish(self.topic, self.type_shown, values, report=self.report)
        self.send(message, self.sender)

    def report(self, outcome: Status) -> None:
        """Show what became of a message; none is repeated after an error."""
        if outcome.level is Level.ERROR:
            self.is_repeating = False
        super().report(outcome)
