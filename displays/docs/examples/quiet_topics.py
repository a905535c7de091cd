"""A panel of your own: `webviz --plugin quiet_topics.py`."""

from collections.abc import Mapping

from webviz import Panel, Send, Traffic, Ui
from webviz.commands import InspectTopic


class QuietTopics(Panel):
    """The subscribed topics without messages."""

    title = "Quiet topics"

    def build(self, ui: Ui, send: Send) -> None:
        """Add a sentence, a table and a button; called once."""
        self.sentence = ui.area()
        self.topics = ui.area()
        ui.button("Stop inspecting topics", lambda browser: send(InspectTopic(""), browser))

    def show(self, traffic: Mapping[str, Traffic]) -> None:
        """Show what the parameters name; called a few times per second."""
        quiet = [name for name, measured in traffic.items() if measured.rate_hz == 0.0]
        self.sentence.text("" if quiet else "All subscribed topics have messages.")
        self.topics.table([(name, "no messages") for name in sorted(quiet)])
