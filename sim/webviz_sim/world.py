"""The world: an occupancy image and its YAML, read as by nav2's map_server, or an SVG plan."""

import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from ruamel.yaml import YAML, YAMLError

from webviz_sim import plan
from webviz_sim.pose import Pose2D

OCCUPIED, FREE, UNKNOWN = 100, 0, -1

# Occupancies at which a cell counts as occupied or free by map_saver's defaults.
OCCUPIED_FROM, FREE_BELOW = 65, 25
PLAN_RESOLUTION = 0.05  # m, the edge of a plan's cells


class WorldError(ValueError):
    """A world cannot be loaded; the text is one sentence that says why."""


@dataclass(frozen=True)
class World:
    """An occupancy grid, placed in the map frame."""

    cells: NDArray[np.int8]
    """Shape (height, width): 0 free to 100 occupied, -1 unknown; row 0 is at the origin."""
    resolution: float
    """Edge of a cell in metres."""
    origin: Pose2D
    """The outer corner of cell (0, 0) in the map frame; rows run along its y axis."""

    @cached_property
    def occupied(self) -> NDArray[np.bool_]:
        """Shape (height, width): where beams end and the robot cannot be."""
        return self.cells >= OCCUPIED_FROM

    @cached_property
    def traversable(self) -> NDArray[np.bool_]:
        """Shape (height, width): cells that are known to be free."""
        return (self.cells >= FREE) & (self.cells < FREE_BELOW)

    @cached_property
    def _rotation(self) -> NDArray[np.float64]:
        cos, sin = math.cos(self.origin.yaw), math.sin(self.origin.yaw)
        return np.array([[cos, -sin], [sin, cos]])

    def to_grid(self, pose: Pose2D) -> Pose2D:
        """A pose in the map frame converted to the grid's frame, with x and y in cells."""
        local = self.origin.inverse() @ pose
        return Pose2D(local.x / self.resolution, local.y / self.resolution, local.yaw)

    def to_cells(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """The reverse of `to_map`."""
        return (points - (self.origin.x, self.origin.y)) @ self._rotation / self.resolution

    def to_map(self, cells: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points in the map frame, in metres.

        Args:
            cells: Shape (n, 2), x and y in the grid's frame, in cells.

        Returns:
            Shape (n, 2), x and y in metres.
        """
        return cells * self.resolution @ self._rotation.T + (self.origin.x, self.origin.y)

    def clearance(self, pose: Pose2D, reach: float) -> float:
        """Exact distance in metres from a point to the nearest wall, at most `reach`.

        The outside of the grid counts as wall. The pose is in the map frame, its yaw is ignored.
        """
        height, width = self.cells.shape
        x, y, _ = self.to_grid(pose)
        cells = reach / self.resolution
        edge = max(0.0, min(x, y, width - x, height - y))
        left, right = max(0, math.floor(x - cells)), max(0, math.ceil(x + cells))
        low, high = max(0, math.floor(y - cells)), max(0, math.ceil(y + cells))
        rows, columns = np.nonzero(self.occupied[low:high, left:right])
        if len(rows):
            # Distance from a point to a unit square along each axis.
            dx = np.maximum(np.abs(columns + (left + 0.5 - x)) - 0.5, 0.0)
            dy = np.maximum(np.abs(rows + (low + 0.5 - y)) - 0.5, 0.0)
            edge = min(edge, math.sqrt(np.min(dx * dx + dy * dy)))
        return min(edge * self.resolution, reach)


def load_world(path: str | Path) -> World:
    """Reads a map as nav2's map_server does (nav2_map_server/src/map_io.cpp, Jazzy), or a plan.

    Args:
        path: The yaml file; `image` in it is relative to the yaml's folder. A file that ends in
            .svg is a plan, whose lower left corner is the origin of the map.

    Raises:
        WorldError: A file is missing or unreadable, or an entry is missing or invalid.
    """
    path = Path(path)
    if path.suffix.lower() == ".svg":
        return _load_plan(path)
    try:
        entries = YAML(typ="safe", pure=True).load(path.read_text())
    except OSError as error:
        raise WorldError(f"Cannot read the map {path}: {error.strerror}.") from None
    except (YAMLError, UnicodeDecodeError):
        raise WorldError(f"The map {path} is not valid YAML.") from None
    if not isinstance(entries, dict):
        raise WorldError(f"Invalid map {path}: expected the keys image, resolution and origin.")
    try:
        return _read(entries, path.parent)
    except WorldError as error:
        raise WorldError(f"Invalid map {path}: {error}.") from None


def _load_plan(path: Path) -> World:
    try:
        shade = plan.draw(path, PLAN_RESOLUTION)
    except OSError as error:
        raise WorldError(f"Cannot read the plan {path}: {error.strerror}.") from None
    except plan.PlanError as error:
        raise WorldError(f"Invalid plan {path}: {error}.") from None
    # The thresholds of map_saver.
    cells = occupancy(
        shade, None, mode="trinary", negate=False, occupied_thresh=0.65, free_thresh=0.25
    )
    return World(np.ascontiguousarray(cells[::-1]), PLAN_RESOLUTION, Pose2D())


def _read(entries: dict[str, Any], folder: Path) -> World:
    resolution = _number(entries, "resolution")
    if resolution <= 0:
        raise WorldError(f"resolution must be above 0, not {resolution:g}")
    origin = entries.get("origin")
    if not (isinstance(origin, list) and len(origin) == 3 and all(map(_finite, origin))):
        raise WorldError(f"origin must be three finite numbers (x, y, yaw), not {origin}")
    image = entries.get("image")
    if not isinstance(image, str) or not image:
        raise WorldError("image must name a file")
    mode = entries.get("mode", "trinary")
    if mode not in ("trinary", "scale", "raw"):
        raise WorldError(f"mode must be trinary, scale or raw, not {mode}")
    shade, alpha = _load_image(folder / image)
    cells = occupancy(
        shade,
        alpha,
        mode=mode,
        negate=_flag(entries, "negate"),
        occupied_thresh=_number(entries, "occupied_thresh"),
        free_thresh=_number(entries, "free_thresh"),
    )
    # Image rows run down, grid rows up.
    return World(np.ascontiguousarray(cells[::-1]), resolution, Pose2D(*map(float, origin)))


def occupancy(
    shade: NDArray[np.float64],
    alpha: NDArray[np.float64] | None,
    *,
    mode: str,
    negate: bool,
    occupied_thresh: float,
    free_thresh: float,
) -> NDArray[np.int8]:
    """The occupancies that map_server computes from an image.

    Args:
        shade: Shape (height, width), mean of the colour channels, 0 black to 1 white.
        alpha: The same shape, 0 transparent to 1 opaque; None for an image without alpha.
        mode: `trinary`: occupied, free or unknown; alpha counts as a fourth colour channel.
            `scale`: occupancies are proportional between the thresholds; transparent is unknown.
            `raw`: a pixel of 0 to 100 out of 255 is the occupancy, all others are unknown.
        negate: White is occupied and black is free.
        occupied_thresh: Cells above it are occupied, from 0 to 1.
        free_thresh: Cells below it are free, from 0 to 1.

    Returns:
        Shape (height, width), 0 free to 100 occupied, -1 unknown.
    """
    if mode == "raw":
        value = np.floor(shade * 255.0 + 0.5)
        return np.where(value <= OCCUPIED, value, UNKNOWN).astype(np.int8)
    if mode == "trinary" and alpha is not None:
        shade = (3.0 * shade + alpha) / 4.0
    occupied = shade if negate else 1.0 - shade
    if mode == "trinary":
        between = np.full(shade.shape, float(UNKNOWN))
    else:
        span = max(occupied_thresh - free_thresh, np.finfo(float).tiny)
        between = np.rint(np.clip((occupied - free_thresh) / span, 0.0, 1.0) * OCCUPIED)
    is_occupied, is_free = occupied > occupied_thresh, occupied < free_thresh
    cells = np.select([is_occupied, is_free], [OCCUPIED, FREE], between)
    if mode == "scale" and alpha is not None:
        cells = np.where(alpha < 1.0, UNKNOWN, cells)
    return cells.astype(np.int8)


def _load_image(path: Path) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """The mean of the colours and the alpha of each pixel, both 0 to 1, top row first."""
    try:
        with Image.open(path) as image:
            if image.mode.startswith("I"):  # 16 bits of grey
                return np.asarray(image, dtype=np.float64) / 65535.0, None
            has_alpha = "A" in image.getbands() or "transparency" in image.info
            pixels = np.asarray(image.convert("RGBA"), dtype=np.float64)
    except FileNotFoundError:
        raise WorldError(f"its image {path} does not exist") from None
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        raise WorldError(f"its image {path} cannot be read") from None
    # Divided once, as by map_server: a mean of quotients is off by a bit, which decides ties of .5.
    shade = pixels[..., :3].mean(axis=-1) / 255.0
    return shade, pixels[..., 3] / 255.0 if has_alpha else None


def _finite(value: Any) -> bool:
    return type(value) in (int, float) and math.isfinite(value)


def _number(entries: dict[str, Any], key: str) -> float:
    if key not in entries:
        raise WorldError(f"{key} is missing")
    if not _finite(entries[key]):
        raise WorldError(f"{key} must be a finite number, not {entries[key]}")
    return float(entries[key])


def _flag(entries: dict[str, Any], key: str) -> bool:
    """An integer or a YAML 1.1 boolean, as map_server accepts."""
    value = entries.get(key)
    if isinstance(value, int):
        return bool(value)
    if isinstance(value, str) and value.lower() in ("yes", "on", "y", "no", "off", "n"):
        return value.lower() in ("yes", "on", "y")
    raise WorldError(f"{key} must be 0 or 1, not {value}")
