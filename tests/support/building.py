"""The simulator's building as messages: its map, scans in it, and paths through it."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import webviz_sim
from webviz_sim import lidar
from webviz_sim.pose import Pose2D
from webviz_sim.world import World, load_world

WORLD: World = load_world(Path(webviz_sim.__file__).parent / "worlds/building.yaml")
LIDAR = lidar.LidarSettings(noise=0.0)


def grid(cells: NDArray[np.int8] | None = None) -> dict[str, Any]:
    """The map as a nav_msgs/OccupancyGrid; other cells of the same shape on request."""
    cells = WORLD.cells if cells is None else cells
    height, width = cells.shape
    origin = {"position": {"x": WORLD.origin.x, "y": WORLD.origin.y}, "orientation": {"w": 1.0}}
    info = {"resolution": WORLD.resolution, "width": width, "height": height, "origin": origin}
    return {"info": info, "data": cells.ravel()}


def with_box(x: float, y: float, edge: float) -> World:
    """The building with a box that its map does not have, around a point of the map frame."""
    rows, columns = np.indices(WORLD.cells.shape)
    cells = np.column_stack([columns.ravel(), rows.ravel()]).astype(np.float64) + 0.5
    middles = WORLD.to_map(cells)
    in_box = (np.abs(middles - (x, y)) < edge / 2).all(axis=1).reshape(WORLD.cells.shape)
    occupied = np.where(in_box, 100, WORLD.cells).astype(np.int8)
    return World(occupied, WORLD.resolution, WORLD.origin)


def scan(laser: Pose2D, world: World = WORLD, range_min: float = LIDAR.range_min) -> dict[str, Any]:
    """Return the scan of a laser there, as a sensor_msgs/LaserScan."""
    random = np.random.default_rng(0)
    settings = replace(LIDAR, range_min=range_min)
    measured = lidar.scan(world, laser, laser, settings, random)
    return {
        "angle_min": -math.pi,
        "angle_max": math.pi - math.tau / LIDAR.beams,
        "angle_increment": math.tau / LIDAR.beams,
        "range_min": range_min,
        "range_max": LIDAR.range_max,
        "ranges": measured.ranges,
        "intensities": measured.intensities,
    }


def path(points: Any) -> dict[str, Any]:
    """A nav_msgs/Path along points (N, 2) of its frame, each pose towards the next point."""
    points = np.asarray(points, float)
    yaws = np.arctan2(*np.diff(points, axis=0).T[::-1])
    yaws = np.append(yaws, yaws[-1])
    poses = [
        {
            "pose": {
                "position": {"x": x, "y": y},
                "orientation": {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)},
            }
        }
        for (x, y), yaw in zip(points.tolist(), yaws.tolist(), strict=True)
    ]
    return {"poses": poses}
