"""A panel of one's own: `webviz --plugin quiet_topics.py`."""

from webviz import Panel, Send, State, Ui
from webviz.commands import InspectTopic


class QuietTopics(Panel):
    """The topics that webviz listens to and that are silent."""

    title = "Quiet topics"

    def build(self, ui: Ui, send: Send) -> None:
        """Add a sentence, a table and a button; called once."""
        self.said = ui.area()
        self.topics = ui.area()
        ui.button("Look into none", lambda browser: send(InspectTopic(""), browser))

    def show(self, state: State) -> None:
        """Show the viewer as it is; called some times a second."""
        quiet = [name for name, traffic in state.traffic.items() if traffic.rate_hz == 0.0]
        self.said.text("" if quiet else "Every topic that is shown has messages.")
        self.topics.table([(name, "no messages") for name in sorted(quiet)])
