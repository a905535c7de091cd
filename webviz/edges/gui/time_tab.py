"""RViz's panel "Time"."""

from __future__ import annotations

import time
from collections.abc import Callable

import viser

from webviz.edges.gui.style import row_style
from webviz.engine.commands import Command, Pause, Reset
from webviz.engine.state import Clock, State

EVERY_S = 0.5


class TimeTab:
    """ROS time and wall time, pause and reset.

    Args:
        gui: viser's GUI; the widgets go into the tab that is open.
        enqueue: takes commands, from any thread.
    """

    def __init__(self, gui: viser.GuiApi, enqueue: Callable[[Command], None]) -> None:
        self._is_paused = False
        self._next = 0.0
        self._enqueue = enqueue
        gui.add_html(row_style("time", (12, 12)))
        self._pause = gui.add_button("Pause", color="gray", hint="Let the picture stand still.")
        reset = gui.add_button("Reset", color="gray", hint="Forget transforms and messages: R")
        self._table = gui.add_html("")
        self._pause.on_click(lambda _: self.toggle())
        reset.on_click(lambda _: enqueue(Reset()))

    def update(self, state: State) -> None:
        """Show the time, some times a second."""
        clock = state.clock
        if clock.is_paused == self._is_paused and time.monotonic() < self._next:
            return
        self._next = time.monotonic() + EVERY_S
        self._is_paused = clock.is_paused
        self._table.content = clock_html(clock)
        self._pause.label = "Resume" if clock.is_paused else "Pause"

    def toggle(self) -> None:
        """Let time stand still, or go on."""
        self._enqueue(Pause(not self._is_paused))


def clock_html(clock: Clock) -> str:
    """The four times of RViz, in seconds."""
    rows = (
        ("ROS Time", seconds(clock.ros_ns) if clock.ros_ns else "not known yet"),
        ("ROS Elapsed", seconds(clock.ros_elapsed_ns)),
        ("Wall Time", f"{clock.wall_s:.2f}"),
        ("Wall Elapsed", f"{clock.wall_elapsed_s:.2f}"),
    )
    cells = "".join(f"<tr><td>{name}</td><td>{value}</td></tr>" for name, value in rows)
    return f'<table class="webviz-table">{cells}</table>'


def seconds(ns: int) -> str:
    """Nanoseconds as seconds with two decimals, cut as a clock does."""
    sign, hundredths = ("-" if ns < 0 else ""), abs(ns) // 10_000_000
    return f"{sign}{hundredths // 100}.{hundredths % 100:02d}"
