"""RViz's panel "Time"."""

from __future__ import annotations

import time

from webviz.api.panel import Panel, Send, Ui
from webviz.engine.commands import Pause, Reset
from webviz.engine.state import Clock, State

EVERY_S = 0.5


class Time(Panel):
    """ROS time and wall time, pause and reset."""

    place = 30

    def build(self, ui: Ui, send: Send) -> None:
        """Two buttons above a table."""
        self._is_paused = False
        self._next = 0.0

        def toggle(browser: int | None) -> None:
            send(Pause(not self._is_paused), browser)

        self._pause = ui.button("Pause", toggle, "Freeze the scene.", width=0.5)
        hint = "Clear all transforms and messages (R)"
        ui.button("Reset", lambda browser: send(Reset(), browser), hint, width=0.5)
        self._table = ui.area()
        ui.command("Pause or resume", toggle, icon="player-pause")

    def show(self, state: State) -> None:
        """Show the time, some times a second."""
        clock = state.clock
        if clock.is_paused == self._is_paused and time.monotonic() < self._next:
            return
        self._next = time.monotonic() + EVERY_S
        self._is_paused = clock.is_paused
        self._table.table(times(clock))
        self._pause.label = "Resume" if clock.is_paused else "Pause"


def times(clock: Clock) -> tuple[tuple[str, str], ...]:
    """The four times of RViz, in seconds."""
    return (
        ("ROS Time", seconds(clock.ros_ns) if clock.ros_ns else "not known yet"),
        ("ROS Elapsed", seconds(clock.ros_elapsed_ns)),
        ("Wall Time", f"{clock.wall_s:.2f}"),
        ("Wall Elapsed", f"{clock.wall_elapsed_s:.2f}"),
    )


def seconds(ns: int) -> str:
    """Nanoseconds as seconds with two decimals, cut as a clock does."""
    sign, hundredths = ("-" if ns < 0 else ""), abs(ns) // 10_000_000
    return f"{sign}{hundredths // 100}.{hundredths % 100:02d}"
