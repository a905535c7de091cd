"""Painting of SVG shapes: inherited properties and transforms."""

import math
import re
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import ImageColor

_STEP = re.compile(r"\s*(\w+)\s*\(([^()]*)\)\s*,?")


class Style(NamedTuple):
    """The properties that count here (https://www.w3.org/TR/SVG2/styling.html)."""

    fill: int | None
    """Shade, 0 black to 255 white; None paints nothing."""
    stroke: int | None
    width: float
    """Of the stroke, in user units."""
    is_even_odd: bool
    """The rule by which outlines inside of others are holes."""
    is_invisible: bool
    """Itself; parts of a group may be visible."""
    is_hidden: bool
    """With all its parts."""


INITIAL = Style(0, None, 1.0, False, False, False)


def restyled(style: Style, element: Any) -> Style:
    """Return the style of an element, given that of its parent.

    Raises:
        ValueError: A colour or number is invalid; the text says which.
    """
    said = dict(element.attrib)
    for declaration in element.get("style", "").split(";"):
        name, _, value = declaration.partition(":")
        said[name.strip()] = value.removesuffix("!important").strip()
    changes: dict[str, Any] = {
        name: _shade(said[name], getattr(style, name))
        for name in ("fill", "stroke")
        if name in said
    }
    for name in ("fill", "stroke"):
        if _is_clear(said.get(f"{name}-opacity")):
            changes[name] = None
    if "stroke-width" in said:
        changes["width"] = _positive(said["stroke-width"].removesuffix("px"))
    if "fill-rule" in said:
        changes["is_even_odd"] = said["fill-rule"] == "evenodd"
    if "visibility" in said:
        changes["is_invisible"] = said["visibility"] in ("hidden", "collapse")
    is_hidden = said.get("display") == "none" or _is_clear(said.get("opacity"))
    return style._replace(**changes, is_hidden=is_hidden)


def transform(text: str) -> NDArray[np.float64]:
    """Return the matrix (3, 3) of a `transform` (w3.org/TR/css-transforms-1/#svg-transform).

    Raises:
        ValueError: It is invalid.
    """
    matrix, at = np.eye(3), 0
    while at < len(text.rstrip()):
        match = _STEP.match(text, at)
        try:
            numbers = list(map(float, match[2].replace(",", " ").split())) if match else [math.nan]
        except ValueError:
            numbers = [math.nan]
        step = _step(match[1], numbers) if match and np.isfinite(numbers).all() else None
        if match is None or step is None:
            raise ValueError(f"invalid transform {text[:40]}")
        matrix, at = matrix @ step, match.end()
    return matrix


def _step(name: str, numbers: list[float]) -> NDArray[np.float64] | None:
    """One function of a transform; None if it is unknown."""
    matrix = np.eye(3)
    match name, numbers:
        case "matrix", [_, _, _, _, _, _]:
            matrix[:2] = np.reshape(numbers, (3, 2)).T
        case "translate", [x, *rest] if len(rest) < 2:
            matrix[:2, 2] = x, rest[0] if rest else 0.0
        case "scale", [x, *rest] if len(rest) < 2:
            matrix[[0, 1], [0, 1]] = x, rest[0] if rest else x
        case "rotate", [degrees, *centre] if len(centre) in (0, 2):
            cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
            matrix[:2, :2] = [[cos, -sin], [sin, cos]]
            if centre:
                matrix[:2, 2] = centre - matrix[:2, :2] @ centre
        case "skewX", [degrees]:
            matrix[0, 1] = math.tan(math.radians(degrees))
        case "skewY", [degrees]:
            matrix[1, 0] = math.tan(math.radians(degrees))
        case _:
            return None
    return matrix


def _shade(colour: str, inherited: int | None) -> int | None:
    """Return the mean of a colour's channels, as map_server has it.

    None for what is not painted.
    """
    match colour.strip().lower():
        case "none" | "transparent":
            return None
        case "inherit":
            return inherited
        case "currentcolor" | "context-fill" | "context-stroke":
            return 0
    try:
        red, green, blue, *alpha = ImageColor.getrgb(colour.strip())
    except ValueError:
        raise ValueError(f"unsupported colour {colour[:40]}") from None
    return None if alpha and alpha[0] == 0 else (red + green + blue) // 3


def _is_clear(opacity: str | None) -> bool:
    return opacity is not None and _positive(opacity.strip().removesuffix("%")) == 0.0


def _positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 <= value < math.inf:
        raise ValueError(f"expected a number, at least 0, not {text[:40]!r}")
    return value
