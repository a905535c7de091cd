"""Robots, or their lasers, at the wrong place in the map."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import NamedTuple

from webviz.api.check import Check
from webviz.api.consistency import MapFit
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.data.rotations import to_rpy
from webviz.data.transforms import TransformException

TURNED_RAD = math.radians(30.0)
"""Turn of the robot after which a shift of the laser has turned along, and one of the robot not."""
STEADY_M = 0.15
"""Distance in metres by which a shift that stays may vary."""
MAX_SHIFTS = 30
"""Rounds whose shifts are compared, about one a second."""
FEWEST = 3
"""Shifts that show a laser which is so little off that its scan fits in some rounds."""


class _Shift(NamedTuple):
    """Metres along the axes of the map, x + iy, and the yaw of the laser there in rad."""

    shift: complex
    yaw: float


class RobotMisplaced(Check):
    """Robot is misplaced.

    A laser scan does not fit the map, and would fit if the robot, or its laser, were elsewhere.

    Why:
        Localisation has a wrong idea of where the robot is, so that it plans through walls. If the
        shift turns with the robot, the laser is mounted elsewhere than its transform says.

    Repair:
        Give AMCL the pose of the robot with the tool 2D Pose Estimate; or correct where the laser
        is mounted in the robot description.
    """

    id = "DATA003"

    def __init__(self) -> None:
        self._shifts: dict[str, list[_Shift | None]] = {}
        """Shifts in the last rounds by frame of the laser, None for one in which its scan fits."""

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such scan."""
        before, self._shifts = self._shifts, {}
        for display in observation.displays:
            if (scan_fit := display.fit) is None:
                continue
            rounds = self._shifts[scan_fit.frame] = before.get(scan_fit.frame, [])[-MAX_SHIFTS:]
            rounds.append(_shift(observation, scan_fit))
            shifts = [each for each in rounds if each]
            off = _of_laser(shifts)
            is_off_now = not scan_fit.fit.is_good and scan_fit.fit.shift is not None
            if not is_off_now and (off is None or len(shifts) < FEWEST):
                continue
            if off is not None:
                cause = (
                    f"The scan of '{scan_fit.frame}' is off by ({off.real:.2f}, {off.imag:.2f}) m "
                    "in its own frame wherever it looks: the laser is misplaced on the robot."
                )
            elif scan_fit.is_placed:
                cause = f"The scan of '{scan_fit.frame}' is not at the walls: it is misplaced."
            else:
                cause = (
                    f"The scan of '{scan_fit.frame}' is not at the walls: the robot is misplaced."
                )
            yield self.found(
                cause,
                f"Correct the transform of '{scan_fit.frame}'."
                if scan_fit.is_placed or off is not None
                else "Give the pose of the robot with the tool 2D Pose Estimate. If the scan is "
                "off in another direction after a turn, correct the transform of its laser.",
                subject=display.display.name,
                proof=scan_fit.proof,
                evidence={"share": scan_fit.fit.share, "cured": scan_fit.fit.cured},
                explains=display.symptom("Map"),
            )


def _shift(observation: Observation, map_fit: MapFit) -> _Shift | None:
    """Return the shift with which a scan would fit, None without one."""
    shift = None if map_fit.fit.is_good else map_fit.fit.shift
    try:
        pose = observation.buffer.lookup(map_fit.map_frame, map_fit.frame, 0)
    except TransformException:
        return None
    x, y, z, w = pose.rotation
    return shift and _Shift(complex(*shift), to_rpy((w, x, y, z))[2])


def _of_laser(shifts: list[_Shift]) -> complex | None:
    """Return the shift in the frame of the laser if it stays there, and turns in the map."""
    turns = [math.remainder(each.yaw - shifts[0].yaw, math.tau) for each in shifts]
    if not turns or max(turns) - min(turns) < TURNED_RAD:
        return None
    own = [each.shift * cmath.rect(1.0, -each.yaw) for each in shifts]
    middle = sum(own) / len(own)
    of_map = sum(each.shift for each in shifts) / len(shifts)
    apart = max(abs(each - middle) for each in own)
    apart_in_map = max(abs(each.shift - of_map) for each in shifts)
    return middle if apart < STEADY_M and apart < apart_in_map / 2 else None
