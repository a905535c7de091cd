"""The panel RvizVisualToolsGui: steps programs that use rviz_visual_tools, such as tutorials."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Annotated

from webviz.api.declared import Prop
from webviz.api.panel import Panel, Send, Ui
from webviz.api.status import Level, Status
from webviz.commands import Publish

BUTTONS = (
    ("Next", 1, "Let the program that waits take its next step."),
    ("Continue", 2, "Take all further steps without waiting."),
    ("Break", 3, "Sent as in RViz; rviz_visual_tools itself ignores it."),
    ("Stop", 4, "Sent as in RViz; rviz_visual_tools itself ignores it."),
)
"""Name, index among the buttons of the message, and what it does."""
COUNT = 9
"""Buttons of the message."""
JOY = "sensor_msgs/msg/Joy"


class RvizVisualToolsGui(Panel):
    """Buttons that let a program go on which waits for a prompt of rviz_visual_tools."""

    title = "Visual Tools"
    rviz = "rviz_visual_tools/RvizVisualToolsGui"
    rviz_tool = "rviz_visual_tools/KeyTool"
    opens = "side"
    icon = "step"

    topic: Annotated[str, Prop(help="Topic of the buttons.")] = "/rviz_visual_tools_gui"

    def build(self, ui: Ui, send: Send) -> None:
        """Four buttons, which are also commands; X presses Next."""
        self.send = send
        self.outcome = Status(Level.OK, "")
        for label, index, hint in BUTTONS:
            press = functools.partial(self._press, index)
            ui.button(label, press, hint, width=1 / len(BUTTONS))
            ui.command(f"Visual Tools: {label}", press, "x" if label == "Next" else "")
        self.result = ui.area()

    def publications(self) -> Mapping[str, str]:
        """Return the buttons."""
        return {self.topic: JOY}

    def show(self) -> None:
        """Say why the newest press had no effect, if so."""
        self.result.text(self.outcome.text if self.outcome.level > Level.OK else "")

    def _press(self, index: int, browser: int | None) -> None:
        buttons = [int(each == index) for each in range(COUNT)]
        self.send(Publish(self.topic, JOY, {"buttons": buttons}, report=self._report), browser)

    def _report(self, outcome: Status) -> None:
        self.outcome = outcome
