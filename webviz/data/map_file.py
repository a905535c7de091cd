"""Occupancy grids in files: an image and its YAML, read as by nav2's map_server."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from webviz.data.plain_yaml import YamlDocumentError, YamlLimits, read_plain
from webviz.data.words import shortened

OCCUPIED, FREE, UNKNOWN = 100, 0, -1
LIMITS = YamlLimits(values=1000, characters=1 << 16, depth=16)
"""Limits of the yaml file of a map."""
MAX_SHOWN, MAX_PATH = 60, 200
"""Characters of a value, and of the path of an image, in an error."""


class MapFileError(ValueError):
    """A map cannot be read; the text is one sentence that says why."""


class MapFile(msgspec.Struct, frozen=True):
    """The content of a map's files."""

    cells: NDArray[np.int8]
    """Shape (height, width): 0 free to 100 occupied, -1 unknown; row 0 is at the origin."""
    resolution: float
    """Edge of a cell in metres."""
    origin: tuple[float, float, float]
    """The outer corner of cell (0, 0) in the map frame: x and y in metres, yaw in radians."""


def read_map(path: Path) -> MapFile:
    """Read a map as nav2's map_server does (nav2_map_server/src/map_io.cpp, Jazzy).

    Args:
        path: The yaml file; `image` in it is relative to the yaml's folder.

    Raises:
        MapFileError: A file is missing or unreadable, or an entry is missing or invalid.
    """
    try:
        with path.open(encoding="utf-8") as file:
            entries = read_plain(file.read(LIMITS.characters + 1), LIMITS)
    except OSError as error:
        raise MapFileError(f"Cannot read the map {path}: {error.strerror}.") from None
    except YamlDocumentError as error:
        raise MapFileError(error.sentence(f"The map {path}")) from None
    except UnicodeDecodeError:
        raise MapFileError(f"The map {path} is not valid YAML.") from None
    if not isinstance(entries, dict):
        raise MapFileError(f"Invalid map {path}: expected the keys image, resolution and origin.")
    try:
        return _read(entries, path.parent)
    except MapFileError as error:
        raise MapFileError(f"Invalid map {path}: {error}.") from None


def _read(entries: dict[str, Any], folder: Path) -> MapFile:
    resolution = _number(entries, "resolution")
    if resolution <= 0:
        raise MapFileError(f"resolution must be above 0, not {resolution:g}")
    origin = entries.get("origin")
    if not (isinstance(origin, list) and len(origin) == 3 and all(map(_finite, origin))):
        raise MapFileError(
            f"origin must be three finite numbers (x, y, yaw), not {_excerpt(origin)}"
        )
    image = entries.get("image")
    if not isinstance(image, str) or not image:
        raise MapFileError("image must name a file")
    mode = entries.get("mode", "trinary")
    if mode not in ("trinary", "scale", "raw"):
        raise MapFileError(f"mode must be trinary, scale or raw, not {_excerpt(mode)}")
    shade, alpha = _load_image(folder / image)
    cells = _occupancy(
        shade,
        alpha,
        mode=mode,
        negate=_flag(entries, "negate"),
        occupied_thresh=_number(entries, "occupied_thresh"),
        free_thresh=_number(entries, "free_thresh"),
    )
    x, y, yaw = map(float, origin)
    # Image rows run down, grid rows up.
    return MapFile(np.ascontiguousarray(cells[::-1]), resolution, (x, y, yaw))


def _occupancy(
    shade: NDArray[np.float64],
    alpha: NDArray[np.float64] | None,
    *,
    mode: str,
    negate: bool,
    occupied_thresh: float,
    free_thresh: float,
) -> NDArray[np.int8]:
    """Return the occupancies that map_server computes from an image.

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
    """Return the mean of the colours and the alpha of each pixel, both 0 to 1, top row first."""
    try:
        with Image.open(path) as image:
            if image.mode.startswith("I"):  # 16 bits of grey
                return np.asarray(image, dtype=np.float64) / 65535.0, None
            has_alpha = "A" in image.getbands() or "transparency" in image.info
            pixels = np.asarray(image.convert("RGBA"), dtype=np.float64)
    except FileNotFoundError:
        raise MapFileError(f"its image {_excerpt(path, MAX_PATH)} does not exist") from None
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        raise MapFileError(f"its image {_excerpt(path, MAX_PATH)} cannot be read") from None
    # Divided once, as by map_server: a mean of quotients is off by a bit, which decides ties of .5.
    shade = pixels[..., :3].mean(axis=-1) / 255.0
    return shade, pixels[..., 3] / 255.0 if has_alpha else None


def _excerpt(value: Any, most: int = MAX_SHOWN) -> str:
    return shortened(str(value), most)


def _finite(value: Any) -> bool:
    return type(value) in (int, float) and math.isfinite(value)


def _number(entries: dict[str, Any], key: str) -> float:
    if key not in entries:
        raise MapFileError(f"{key} is missing")
    if not _finite(entries[key]):
        raise MapFileError(f"{key} must be a finite number, not {_excerpt(entries[key])}")
    return float(entries[key])


def _flag(entries: dict[str, Any], key: str) -> bool:
    """Return a boolean from an integer or a YAML 1.1 boolean, as map_server accepts them."""
    value = entries.get(key)
    if isinstance(value, int):
        return bool(value)
    if isinstance(value, str) and value.lower() in ("yes", "on", "y", "no", "off", "n"):
        return value.lower() in ("yes", "on", "y")
    raise MapFileError(f"{key} must be 0 or 1, not {_excerpt(value)}")
