"""RViz's "Global Options" and "Global Status"."""

from __future__ import annotations

from typing import Any

import viser

from webviz.api.panel import Send
from webviz.edges.gui.control import TYPING_S, Choice, Control
from webviz.edges.gui.text import StatusLines
from webviz.engine.commands import SetBackground, SetFixedFrame, SetFrameRate
from webviz.engine.state import State

MIN_HZ, MAX_HZ = 1.0, 240.0


class GlobalOptions:
    """The fixed frame, the background and the frame rate, and what holds for the whole viewer.

    Args:
        gui: viser's GUI; the widgets go into the tab that is open.
        send: takes commands, from any thread.
    """

    def __init__(self, gui: viser.GuiApi, send: Send) -> None:
        with gui.add_folder("Global Options"):
            self._fixed_frame = Choice(
                gui,
                "Fixed Frame",
                "",
                lambda frame, browser: send(SetFixedFrame(frame), browser),
                "The frame that everything is drawn in. Choose one, or type any name.",
                free=True,
            )
            background: Any = gui.add_rgb("Background", (0, 0, 0), hint="Colour of the background.")
            self._background = Control(
                background,
                lambda color, browser: send(SetBackground(color), browser),
                decode=tuple,
            )
            rate = gui.add_number(
                "Frame Rate",
                MAX_HZ,
                min=MIN_HZ,
                max=MAX_HZ,
                step=1.0,
                hint="Maximum number of scene updates per second.",
            )
            self._frame_rate = Control(
                rate,
                lambda hz, browser: send(SetFrameRate(float(hz)), browser),
                wait=TYPING_S,
            )
            self._statuses = StatusLines(gui)

    def update(self, state: State) -> None:
        """Show the viewer as it is."""
        self._fixed_frame.offer(state.frames, state.fixed_frame)
        self._fixed_frame.show(state.fixed_frame)
        self._background.show(state.settings.background)
        self._frame_rate.show(state.settings.frame_rate)
        self._statuses.show(state.statuses)
