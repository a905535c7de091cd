"""Plans of worlds in SVG, drawn as a browser draws them: what is dark becomes a wall."""

import math
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]
from numpy.typing import NDArray
from PIL import Image, ImageDraw
from svg.path import parse_path
from svg.path.parser import InvalidPathError
from svg.path.path import Close, Line, Move

from webviz_sim.plan_style import INITIAL, Style, restyled, transform

MAX_BYTES = 1_000_000
MAX_CELLS = 4_000_000
MAX_DRAWN = 300_000_000  # cells that all shapes together may cover
FAR = 100.0  # times the larger edge of the plan; nothing is that far outside
CURVE = 24  # points of a curve

_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}
_LENGTH = re.compile(r"\s*([0-9.eE+-]+)\s*([a-z%]*)\s*")
_IGNORED = {"defs", "desc", "metadata", "namedview", "symbol", "text", "title"}
_GROUPS = {"svg", "g", "a"}

Points = NDArray[np.float64]
"""Shape (n, 2), x to the right and y down."""


class PlanError(ValueError):
    """A plan cannot be drawn; the text says why, without a full stop."""


def draw(path: Path, resolution: float) -> NDArray[np.float64]:
    """Return the picture of a plan.

    Painted are `line`, `rect`, `circle`, `ellipse`, `polyline`, `polygon` and `path`, with colours,
    widths of strokes and transforms, in the order of the file, on white. Strokes are at least a
    cell wide. Texts are ignored.

    Args:
        path: The file. Its `width` (or `height`) has a unit, and its `viewBox` says how many user
            units that is.
        resolution: Edge of a pixel in metres.

    Returns:
        Shape (height, width), 0 black to 1 white, top row first.

    Raises:
        PlanError: The file is not an SVG, too large, or has something that is unsupported.
        OSError: The file cannot be read.
    """
    root = _parse(path)
    left, top, width, height, scale = _frame(root)
    zoom = scale / resolution
    if not (width * zoom) * (height * zoom) <= MAX_CELLS or zoom == 0.0:
        raise PlanError(
            f"it is {width * scale:.0f} m x {height * scale:.0f} m large, "
            f"more than {MAX_CELLS * resolution**2:g} m²"
        )
    columns, rows = (math.ceil(edge * zoom) for edge in (width, height))
    to_pixels = np.array([[zoom, 0.0, -left * zoom], [0.0, zoom, -top * zoom], [0.0, 0.0, 1.0]])
    canvas = _Canvas(columns, rows)
    with np.errstate(all="ignore"):  # what is not finite is refused by the canvas
        for outlines, style in _shapes(root, INITIAL, to_pixels):
            canvas.paint(outlines, style)
    return np.asarray(canvas.image, dtype=np.float64) / 255.0


class _Canvas:
    """A picture in shades of grey."""

    def __init__(self, columns: int, rows: int):
        self.image = Image.new("L", (columns, rows), 255)
        self._drawn = 0

    def paint(self, outlines: list[tuple[Points, bool]], style: Style) -> None:
        """Fill outlines, of which each may be closed, and draw along them."""
        for points, _ in outlines:
            if not np.abs(points).max(initial=0.0) < FAR * max(self.image.size):
                raise PlanError("a shape is far outside of the viewBox")
        if style.fill is not None:
            closed = [points for points, _ in outlines if len(points) > 2]
            self._fill(closed, style.fill, style.is_even_odd)
        if style.stroke is not None:
            pen = ImageDraw.Draw(self.image)
            for points, is_closed in outlines:
                line = np.vstack([points, points[:2]]) if is_closed else points
                width = max(1, round(style.width))
                self._count(len(line) * (width**2 + max(self.image.size)))
                flat = line.ravel().tolist()
                pen.line(flat, fill=style.stroke, width=width, joint="curve" if width > 2 else None)

    def _fill(self, outlines: list[Points], shade: int, is_even_odd: bool) -> None:
        """Fill by one of SVG's rules, exactly for outlines that do not cross themselves."""
        if not outlines:
            return
        every = np.vstack(outlines)
        low = np.maximum(np.floor(every.min(axis=0)), 0.0).astype(int)
        high = np.minimum(np.ceil(every.max(axis=0)) + 1.0, self.image.size).astype(int)
        size = tuple((high - low).tolist())
        if min(size) <= 0:
            return
        winding = np.zeros(size[::-1], dtype=np.int32)
        for points in outlines:
            self._count(math.prod(size) + len(points))
            mask = Image.new("1", size)
            ImageDraw.Draw(mask).polygon((points - low).ravel().tolist(), fill=1)
            x, y = points.T
            is_clockwise = np.dot(x, np.roll(y, -1)) > np.dot(y, np.roll(x, -1))
            winding += np.where(np.asarray(mask), 1 if is_clockwise else -1, 0)
        inside = winding % 2 != 0 if is_even_odd else winding != 0
        self.image.paste(shade, tuple(low.tolist()), Image.fromarray(inside))

    def _count(self, cells: int) -> None:
        """Refuse what takes too long to draw."""
        self._drawn += cells
        if self._drawn > MAX_DRAWN:
            raise PlanError("it takes too long to draw: simplify it")


def _parse(path: Path) -> etree._Element:
    if path.stat().st_size > MAX_BYTES:
        raise PlanError(f"the file is larger than {MAX_BYTES // 1_000_000} MB")
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, remove_comments=True
    )
    try:
        root = etree.fromstring(path.read_bytes(), parser)
    except etree.XMLSyntaxError as error:
        raise PlanError(f"it is not XML: {' '.join(str(error).split())[:200]}") from None
    declarations = root.getroottree().docinfo.internalDTD
    if declarations is not None and any(True for _ in declarations.iterentities()):
        raise PlanError("it declares XML entities, which are not expanded")
    if _tag(root) != "svg":
        raise PlanError(f"its root element is <{_tag(root)}>, not <svg>")
    return root


def _frame(root: etree._Element) -> tuple[float, float, float, float, float]:
    """Return the viewBox, and the metres of a user unit."""
    box = _numbers(root.get("viewBox", ""))
    if len(box) != 4 or min(box[2:]) <= 0.0:
        raise PlanError("viewBox must be four numbers, such as 0 0 12 8")
    scales = []
    for name, units in (("width", box[2]), ("height", box[3])):
        match = _LENGTH.fullmatch(root.get(name, ""))
        if match and match[2] in _METRES and (length := _number(match[1])) > 0.0:
            scales.append(length * _METRES[match[2]] / units)
        elif root.get(name) is not None:
            raise PlanError(
                f"{name} must be a length in {', '.join(_METRES)}, such as 12m, "
                f"not {root.get(name)[:40]}"
            )
    if not scales:
        raise PlanError("width must be a length, such as 12m")
    if abs(scales[0] - scales[-1]) > 0.01 * scales[0]:
        raise PlanError("width and height do not have the shape of the viewBox")
    return box[0], box[1], box[2], box[3], scales[0]


def _shapes(
    element: etree._Element, style: Style, matrix: NDArray[np.float64]
) -> Iterator[tuple[list[tuple[Points, bool]], Style]]:
    """Yield the outlines of the shapes in an element, in pixels, each with its style.

    Args:
        element: A group or a shape.
        style: That it inherits.
        matrix: Shape (3, 3), from its parent's coordinates to pixels.
    """
    tag = _tag(element)
    try:
        style = restyled(style, element)
        matrix = matrix @ transform(element.get("transform", ""))
    except ValueError as error:
        raise PlanError(f"<{tag}> in line {element.sourceline}: {error}") from None
    if style.is_hidden or tag in _IGNORED:
        return
    if tag in _GROUPS and (element.getparent() is None or tag != "svg"):
        for child in element.iterchildren(etree.Element):
            yield from _shapes(child, style, matrix)
        return
    if tag == "style" and not (element.text or "").strip():
        return
    outlines = [
        (points @ matrix[:2, :2].T + matrix[:2, 2], is_closed)
        for points, is_closed in _outlines(element, tag)
        if len(points)
    ]
    zoom = math.sqrt(abs(np.linalg.det(matrix[:2, :2])))
    width = style.width * zoom
    if not style.is_invisible:
        yield outlines, style._replace(width=width if width < MAX_CELLS else MAX_CELLS)


def _outlines(element: etree._Element, tag: str) -> Iterator[tuple[Points, bool]]:
    """Yield the outlines of a shape in its own coordinates, and whether they are closed."""
    at = {name: _number(element.get(name, "0")) for name in _ATTRIBUTES.get(tag, ())}
    if tag == "line":
        yield np.array([[at["x1"], at["y1"]], [at["x2"], at["y2"]]]), False
    elif tag == "rect":
        corner, size = np.array([at["x"], at["y"]]), np.array([at["width"], at["height"]])
        yield corner + size * [[0, 0], [1, 0], [1, 1], [0, 1]], True
    elif tag in ("circle", "ellipse"):
        radii = [at.get("rx", at.get("r")), at.get("ry", at.get("r"))]
        angles = np.arange(2 * CURVE) * math.pi / CURVE
        circle = np.column_stack([np.cos(angles), np.sin(angles)])
        yield np.array([at["cx"], at["cy"]]) + circle * radii, True
    elif tag in ("polyline", "polygon"):
        numbers = _numbers(element.get("points", ""))
        if len(numbers) % 2:
            raise PlanError(f"<{tag}> in line {element.sourceline}: points must be pairs")
        yield np.reshape(numbers, (-1, 2)), tag == "polygon"
    elif tag == "path":
        yield from _path(element)
    else:
        raise PlanError(f"<{tag}> in line {element.sourceline} is unsupported")


def _path(element: etree._Element) -> Iterator[tuple[Points, bool]]:
    try:
        segments = parse_path(element.get("d", ""))
        steps = np.arange(1, CURVE + 1) / CURVE
        points: list[complex] = []
        for segment in segments:
            if isinstance(segment, Move):
                if points:
                    yield _planar(points), False
                points = [segment.end]
            elif isinstance(segment, Close):
                yield _planar(points), True
                points = [segment.end]
            elif isinstance(segment, Line):
                points.append(segment.end)
            else:
                points += [segment.point(step) for step in steps.tolist()]
    except (InvalidPathError, ArithmeticError, ValueError, IndexError) as error:
        reason = " ".join(str(error).split())[:80]
        raise PlanError(f"<path> in line {element.sourceline}: {reason}") from None
    if len(points) > 1:
        yield _planar(points), False


def _planar(points: list[complex]) -> Points:
    values = np.array(points, dtype=np.complex128)
    return np.column_stack([values.real, values.imag])


def _tag(element: etree._Element) -> str:
    return etree.QName(element).localname


_ATTRIBUTES = {
    "line": ("x1", "y1", "x2", "y2"),
    "rect": ("x", "y", "width", "height"),
    "circle": ("cx", "cy", "r"),
    "ellipse": ("cx", "cy", "rx", "ry"),
}


def _numbers(text: str) -> list[float]:
    return [_number(word) for word in text.replace(",", " ").split()]


def _number(text: str) -> float:
    """Return a finite number in user units.

    Raises:
        PlanError: It is not.
    """
    try:
        value = float(text.strip().removesuffix("px"))
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise PlanError(f"expected a number, not {text[:40]!r}")
    return value
