"""The time, as something that pages count by themselves."""

from __future__ import annotations

from webviz.engine.state import State
from webviz.engine.store import PageStore


class ClockStore(PageStore, frozen=True):
    """The times, in seconds.

    Args:
        pace: ROS time, wall time of the same moment, and how fast ROS time runs from there.
        began: both times at the start or the last reset.
        is_known: whether there is a ROS time.
        is_paused, is_simulated: see `webviz.engine.state.PanelTimes`.
        hz: rate of /clock to two digits.
    """

    pace: tuple[float, float, float]
    began: tuple[float, float]
    is_known: bool
    is_paused: bool
    is_simulated: bool
    hz: float


def clock(state: State, _: str) -> ClockStore:
    """ROS time and wall time; changes only if one of them does not go on as before."""
    clock = state.clock
    clock_rate = clock.clock_rate
    return ClockStore(
        pace=(clock_rate.ros_ns / 1e9, clock_rate.wall_s, clock_rate.rate),
        began=(
            round((clock.ros_ns - clock.ros_elapsed_ns) / 1e9, 3),
            round(clock.wall_s - clock.wall_elapsed_s, 3),
        ),
        is_known=clock.ros_ns != 0,
        is_paused=clock.is_paused,
        is_simulated=clock.is_simulated,
        hz=float(f"{clock.clock_hz:.2g}"),
    )
