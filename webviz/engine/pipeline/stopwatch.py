"""The times that RViz's panel "Time" shows."""

from __future__ import annotations

import time

from webviz.engine.state import Clock


class Stopwatch:
    """Counts ROS time and wall time since it was started."""

    def __init__(self) -> None:
        self.start()

    def start(self) -> None:
        """Count from now on."""
        self._ros_ns = 0
        self._wall_s = time.time()

    def clock(self, ros_ns: int, is_paused: bool) -> Clock:
        """The times now.

        Args:
            ros_ns: ROS time, 0 while it is not known.
            is_paused: whether somebody let it stand still.
        """
        self._ros_ns = self._ros_ns or ros_ns
        wall_s = time.time()
        return Clock(ros_ns, ros_ns - self._ros_ns, wall_s, wall_s - self._wall_s, is_paused)
