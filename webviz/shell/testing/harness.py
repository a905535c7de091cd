"""A viewer without ROS, for tests that control every message and the time."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from typing import Any

from webviz import commands
from webviz.api.finding import Finding
from webviz.api.panel import Panel
from webviz.api.status import Status
from webviz.api.tool import Position
from webviz.commands import AddPanel, OpenPanels
from webviz.engine.commands import PROGRAM, Command, Sender
from webviz.engine.loop import FrameLoop
from webviz.engine.parts.panels import PanelsPart
from webviz.files.config import Config
from webviz.page.recorded_ui import RecordedUi
from webviz.shell.testing.pictures import SnapshotFixture
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.shell.testing.source import SECOND, HandFedSource
from webviz.shell.testing.viewer_under_test import ViewerUnderTest
from webviz.shell.testing.watched import WatchedViewer


class OpenedPanel:
    """A panel whose widgets can be read and used.

    Args:
        cls: of the panel.
        do: carries out a command of a browser.
        viewer: that has it.
        values: of its properties, for panels that are added on request.
    """

    def __init__(
        self,
        cls: type[Panel],
        do: Callable[[Command, Sender], object],
        viewer: FrameLoop,
        **values: Any,
    ) -> None:
        self._do = do
        self._viewer = viewer
        if cls.opens != "at start":
            do(AddPanel(cls.__name__, values), Sender(None))
        do(OpenPanels(frozenset({cls.__name__})), Sender(None))
        tabs = viewer.get(PanelsPart).tabs()
        self.panel = next(tab.panel for tab in tabs if type(tab.panel) is cls)
        self.ui = RecordedUi()
        self.panel.build(self.ui, self.send)
        self.show()

    def send(self, command: Command, browser: int | None = None) -> None:
        """Send a command, as the panel does."""
        self._do(command, Sender(browser))

    def show(self) -> None:
        """Let it show the current state."""
        self._viewer.call(self._show).result()

    def _show(self) -> None:
        self._viewer.update()
        self._viewer.get(PanelsPart).show(self.panel)

    def widget(self, label: str) -> Any:
        """Return the widget with a label."""
        return next(w for w in self.ui.widgets.values() if w.values.get("label") == label)

    def use(self, label: str, value: Any = None, browser: int | None = None) -> None:
        """Press a button, or edit a field."""
        self.widget(label).use(value, browser)
        self.show()

    def text(self) -> str:
        """All texts and tables, after it has shown the current state."""
        self.show()
        areas = (w.values for w in self.ui.widgets.values() if w.values["kind"] == "area")
        return " ".join(map(str, areas))


__tracebackhide__ = True  # failures are shown where the test calls

LOADING_S = 60.0
"""Time in seconds for the meshes of large robots."""
ROUNDS = 4
"""Number of rounds of the doctor: two in a row make a finding, one may be under way, and messages
may wait."""


class Harness(ViewerUnderTest):
    """A viewer that only runs in `turn`, one turn of its frame loop.

    Args:
        config: to show.
        scene: to draw in.
        snapshot: takes pictures of the scene.
    """

    def __init__(self, config: Config, scene: RecordingScene, snapshot: SnapshotFixture) -> None:
        self.graph = RememberingGraph()
        """All that the viewer sent."""
        self.source = HandFedSource(graph=self.graph)
        self.clock = 1000.0
        """Monotonic time in seconds, for the ages of messages."""
        viewer = WatchedViewer(config, self.source, scene, clock=lambda: self.clock)
        super().__init__(viewer, scene, snapshot)
        self.turn()

    def close(self) -> None:
        """Stop the displays."""
        self.viewer.close()

    def publish_bytes(self, topic: str, type_name: str, cdr: bytes) -> None:
        """Publish a serialised message; it is drawn in the next turn."""
        self.source.put(topic, type_name, cdr)

    def now_ns(self) -> int:
        """ROS time, which is `source.now`."""
        return self.source.now

    def turn(self) -> None:
        """One turn of the frame loop."""
        self.viewer.turn()

    def settle(self) -> None:
        """Turn until all displays have loaded."""
        deadline = time.monotonic() + LOADING_S
        self.turn()
        while self.viewer.is_busy():
            assert time.monotonic() < deadline, "A display is still loading."
            time.sleep(0.02)
            self.turn()

    def wait_until_drawn(self, display: str) -> None:
        """Turn until a display has drawn its messages.

        Raises:
            AssertionError: it draws nothing; the message has its status.
        """
        self.settle()
        if not self.is_drawn(display):
            raise AssertionError(f"{display} draws nothing. {self.status(display).text}")

    # Tools, panels and checks

    @property
    def published(self) -> list[tuple[str, Any]]:
        """Topic and message of all that tools and panels published."""
        return [(advertisement.topic, message) for advertisement, message in self.graph.published]

    def use_tool(self, tool: str, *points: Position, yaw: float = 0.0) -> list[Status]:
        """Make a gesture with a tool.

        Args:
            tool: its name.
            points: of the gesture, in metres in the fixed frame.
            yaw: of a pose, in radians.

        Returns:
            What the tool reports.
        """
        reported: list[Status] = []
        self.do(commands.UseTool(tool, points, yaw, report=reported.append))
        return reported

    def open_panel(self, panel: type[Panel], **values: Any) -> OpenedPanel:
        """Open a panel; the values of its properties if it is added on request."""
        return OpenedPanel(panel, self.do, self.viewer, **values)

    def do(self, command: Command, sender: Sender = PROGRAM) -> str:
        """Carry out a command, and return its answer.

        Raises:
            webviz.engine.requests.Refused: it was refused.
        """
        answer = self.viewer.enqueue(command, sender)
        deadline = time.monotonic() + LOADING_S
        self.turn()
        while not answer.done():
            assert time.monotonic() < deadline, f"{command} is not answered."
            time.sleep(0.005)  # files are read in another thread
            self.turn()
        return answer.result(0)

    def findings(
        self, seconds: float = 1.1, publish: Callable[[], object] = lambda: None
    ) -> Sequence[Finding]:
        """Return the findings of the doctor after some rounds.

        Args:
            seconds: that pass between two turns, also in ROS time.
            publish: called before each turn.
        """
        doctor = self.viewer.doctor
        doctor.slice_s = math.inf
        until, state = doctor.rounds + ROUNDS, self.state()
        while doctor.rounds < until:
            self.clock += seconds
            self.source.now += round(seconds * SECOND)
            publish()
            self.turn()
            state = self.state()
        return state.findings

    def _catch_up(self) -> None:
        self.turn()
