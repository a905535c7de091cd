"""Contradictions between displays: scans beside the walls of the map, paths through obstacles."""

from __future__ import annotations

import math
import time
from collections.abc import Collection
from typing import NamedTuple

import numpy as np

from webviz.api.consistency import Fit, MapFit, OccupiedCells, RobotPath, ScanPoints
from webviz.api.frames import compose, is_placeable, to_pose
from webviz.api.nodes import Pose
from webviz.api.status import Level, Measurement, Status
from webviz.data.rotations import conjugate, from_rpy, matrices
from webviz.data.transforms import TransformException
from webviz.data.transforms.reasons import in_words
from webviz.engine.parts.alignment import Correction, align, distances
from webviz.engine.parts.display_list import DisplayList
from webviz.engine.parts.part import PartContext
from webviz.engine.parts.scan_fit import C128, NEAR_M, OCCUPIED, POINTS, fit, in_the_way, thinned
from webviz.engine.pipeline import Runner

EVERY_S = 1.0
"""Interval of the consistency check."""
SOON_S = 0.15
"""Interval while a frame is dragged."""
ON_MAP, ON_WAY = "Map", "Obstacles"
"""Keys of the statuses of scans and of paths."""
LEVEL = math.cos(math.radians(6.0))
"""A scanner that is tilted by more sees floors and ceilings."""
FIND_REACH_M = 20.0
"""Distance of the points of a scan that are aligned with the map."""
FEWEST_ALIGNED = 40
FEWEST = 3
"""Points that make an obstacle."""
OLD_S = 3.0
"""Age of a path whose planner seems to have stopped."""


class Aligned(NamedTuple):
    """The pose of a sensor with which its scan lies on walls.

    Args:
        before, after: its pose in the frame of the map, as it is and as it would be.
        map_frame: id of that frame.
        stamp_ns: of the scan.
    """

    before: Pose
    after: Pose
    map_frame: str
    stamp_ns: int


class ConsistencyCheck:
    """Compares what displays know of where things are, while browsers are connected.

    Args:
        context: has transforms and time.
        displays: what is compared, and gets the statuses.
    """

    def __init__(self, context: PartContext, displays: DisplayList) -> None:
        self._context = context
        self._displays = displays
        self._next = 0.0, 0.0
        self._compared_s = 0.0
        self.fits: dict[str, MapFit] = {}
        """Fits of laser scans to the map, by id of their display."""
        self.blocked: dict[str, int] = {}
        """Points of scans on paths, by id of the display of the path."""

    def update(self) -> None:
        """Compare again when it is time, of a recording or, while it is paused, of waiting."""
        now = self._context.clock(), time.monotonic()
        if now[0] < self._next[0] and now[1] < self._next[1]:
            return
        self._next = now[0] + EVERY_S, now[1] + EVERY_S
        self._compared_s = now[1]
        for runner in self._displays.runners():
            for key in (ON_MAP, ON_WAY):
                runner.external_statuses.pop(key, None)
        self.fits, self.blocked = {}, {}
        if self._context.is_watched():
            self._compare()

    def hurry(self) -> None:
        """Compare soon: a frame has moved."""
        self._next = self._next[0], self._compared_s + SOON_S

    def aligned(self, frames: Collection[str]) -> Aligned | None:
        """Align the scan of one of these frames with a map.

        Returns:
            Where the scan would lie on walls; None without scan or map.
        """
        scans: list[ScanPoints] = []
        maps: list[OccupiedCells] = []
        for runner in self._displays.active():
            match runner.consistency_input(self._context.frames):
                case ScanPoints() as scan if scan.frame in frames:
                    scans.append(scan)
                case OccupiedCells() as cells:
                    maps.append(cells)
        for scan in sorted(scans, key=lambda each: -len(each.xyz)):
            for cells in maps:
                if aligned := self._aligned(scan, cells):
                    return aligned
        return None

    def _aligned(self, scan: ScanPoints, cells: OccupiedCells) -> Aligned | None:
        placed = self._placed(scan, cells.frame, cells.origin)
        if placed is None:
            return None
        laser, _, points = placed
        far = np.abs(points)
        points = thinned(points[(far > NEAR_M) & (far < FIND_REACH_M)], POINTS)
        if len(points) < FEWEST_ALIGNED:
            return None
        resolution = cells.resolution
        reach = math.ceil((float(np.abs(points).max()) + 2.0) / resolution)
        column, row = math.floor(laser.real / resolution), math.floor(laser.imag / resolution)
        corner = complex(column - reach, row - reach) * resolution
        window = cells.window(row - reach, column - reach, 2 * reach, 2 * reach)
        field = distances(window >= OCCUPIED, resolution)
        best = align(field, resolution, laser - corner, points)
        pose = to_pose(self._context.buffer.lookup(cells.frame, scan.frame, scan.stamp_ns))
        return Aligned(pose, _corrected(pose, cells.origin, best), cells.frame, scan.stamp_ns)

    def _compare(self) -> None:
        scans: list[tuple[Runner, ScanPoints]] = []
        paths: list[tuple[Runner, RobotPath]] = []
        maps: list[OccupiedCells] = []
        for runner in self._displays.active():
            match runner.consistency_input(self._context.frames):
                case ScanPoints() as scan:
                    scans.append((runner, scan))
                case RobotPath() as path:
                    paths.append((runner, path))
                case OccupiedCells() as cells:
                    maps.append(cells)
        trusted: list[ScanPoints] = []
        fits = [self._on_map(scan, maps) for _, scan in scans]
        is_placed = any(result and result[0].is_good for result in fits)
        for (runner, scan), result in zip(scans, fits, strict=True):
            if result is not None:
                runner.external_statuses[ON_MAP] = _status(*result, scan, is_placed)
                best, cells = result
                self.fits[runner.id] = MapFit(best, scan.frame, cells.topic, cells.frame, is_placed)
            if result is None or result[0].is_good:
                trusted.append(scan)
        for runner, path in paths:
            if (count := sum(self._in_the_way(scan, path) for scan in trusted)) >= FEWEST:
                age_s = (self._context.now_ns - path.received_ns) / 1e9
                self.blocked[runner.id] = count
                values = (Measurement("points", count), Measurement("age", round(age_s, 1), "s"))
                runner.external_statuses[ON_WAY] = Status(
                    Level.WARN, _blocked(count, age_s), values=values
                )

    def _on_map(
        self, scan: ScanPoints, maps: list[OccupiedCells]
    ) -> tuple[Fit, OccupiedCells] | None:
        """Return the fit of a scan to the best map; None if it is unknown."""
        results: list[tuple[Fit, OccupiedCells]] = []
        for cells in maps:
            if placed := self._placed(scan, cells.frame, cells.origin):
                result = fit(*placed, cells.resolution, cells.window)
                results += [(result, cells)] if result else []
        return max(results, key=lambda each: each[0].share, default=None)

    def _in_the_way(self, scan: ScanPoints, path: RobotPath) -> int:
        placed = self._placed(scan, path.frame, Pose())
        if placed is None:
            return 0
        laser, _, points = placed
        return in_the_way(laser, points, path.xyz[:, 0] + 1j * path.xyz[:, 1])

    def _placed(
        self, scan: ScanPoints, frame: str, origin: Pose
    ) -> tuple[complex, float, C128] | None:
        """Return the sensor, its heading, and its points relative to it, in the plane of `origin`.

        Returns None without a transform, or if the sensor is tilted out of that plane.
        """
        try:
            pose = to_pose(self._context.buffer.lookup(frame, scan.frame, scan.stamp_ns))
        except TransformException:
            return None
        back = tuple(conjugate(origin.wxyz).tolist())
        x, y, z = origin.position
        pose = compose(compose(Pose(wxyz=back), Pose((-x, -y, -z))), pose)
        turn = matrices(pose.wxyz)
        if not is_placeable(pose) or abs(turn[2, 2]) < LEVEL:
            return None
        xy = scan.xyz @ turn[:2].T
        laser, points = complex(*pose.position[:2]), xy[:, 0] + 1j * xy[:, 1]
        return laser, math.atan2(turn[1, 0], turn[0, 0]), points


def _corrected(pose: Pose, origin: Pose, by: Correction) -> Pose:
    """Return the pose of a sensor in a map's frame, corrected in the plane of its cells."""
    back = tuple(conjugate(origin.wxyz).tolist())
    x, y, z = origin.position
    on_map = compose(compose(Pose(wxyz=back), Pose((-x, -y, -z))), pose)
    px, py, pz = on_map.position
    turned = compose(Pose(wxyz=from_rpy(0.0, 0.0, by.turn)), Pose(wxyz=on_map.wxyz)).wxyz
    moved = Pose((px + by.shift.real, py + by.shift.imag, pz), turned)
    return compose(origin, moved)


def _status(best: Fit, cells: OccupiedCells, scan: ScanPoints, is_placed: bool) -> Status:
    """Say how well a scan fits; with `is_placed`, another shows that the robot is in place."""
    measured = f"{best.share:.0%} of {best.points} points lie on walls of {cells.topic}"
    values = (Measurement("share", round(best.share, 2)), Measurement("points", best.points))
    if best.is_good:
        return Status(Level.OK, f"{measured}.", values=values)
    measured, level = f"Only {measured}", Level.WARN
    if best.turn is not None:
        values += (Measurement("rotation", best.turn, "rad"),)
        text = (
            f"{measured}; rotating '{scan.frame}' by {math.degrees(best.turn):.0f}° would match "
            f"{best.cured:.0%}. Check the yaw of '{scan.frame}' on the robot, then the "
            "localisation."
        )
    elif best.shift is not None:
        x, y = best.shift
        values += (Measurement("shift x", x, "m"), Measurement("shift y", y, "m"))
        measured = f"{measured}; a shift by ({x:.1f}, {y:.1f}) m would match {best.cured:.0%}."
        text = (
            f"{measured} Another scan fits, so the robot is in place: check the transform of "
            f"'{scan.frame}'."
            if is_placed
            else f"{measured} The robot is misplaced: give a 2D Pose Estimate, or check what "
            f"publishes the transform from '{cells.frame}'."
        )
    elif best.is_mirrored:
        text = (
            f"{measured}; mirroring would match {best.cured:.0%}. The laser is upside down: give "
            f"'{scan.frame}' a roll of 180° on the robot."
        )
    elif is_placed:  # such as a scan that is computed, or of what the map leaves out
        text, level = f"{measured}. Another scan fits, so the robot is in place.", Level.OK
    else:
        text = (
            f"{measured}. The robot is misplaced, its laser's transform is wrong, or this is the "
            "map of another place."
        )
    return Status(level, text, values=values)


def _blocked(count: int, age_s: float) -> str:
    """Return a sentence on a path that leads through obstacles."""
    text = f"The path leads through {count} points of the laser scan"
    if age_s > OLD_S:
        return (
            f"{text} and is {in_words(round(age_s * 1e9))} old: the planner has not replanned "
            "since. Check that it still runs."
        )
    return (
        f"{text}: the planner does not know this obstacle. Check that its costmap subscribes to "
        "the scan."
    )
