"""Nodes: what displays draw, as plain data.

A node is a frozen description in the coordinates of its frame (metres, x forward, y left, z up).
Displays make nodes, tests read them, and `webviz.scene` turns them into messages of viser.
Arrays must not be changed once they are part of a node.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, field, fields
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from webviz.api.pictures import Mark, OverlayCamera, Picture

F32 = NDArray[np.float32]
U8 = NDArray[np.uint8]
Ids = NDArray[Any]
"""Ids of the items of a node when selected: the `Hit.id` of `Display.inspect`."""
Rgb = tuple[int, int, int]
Solid = Literal["box", "sphere", "cylinder", "cone", "square"]
"""Shapes of size 1 around the origin; the square has no height."""
Plane = tuple[float, float, float, float]
"""a, b, c, d of the plane ax + by + cz + d = 0, with (a, b, c) of length 1: the sum is the distance
of a point from it."""

POINTS_HELD = 400_000
"""Number of points a browser draws fast enough, until it has measured it."""

POINTS_PER_BLOCK = 1 << 15
"""Number of points in a block of `Points` that browsers may thin."""

_COMPARED = 1 << 16
"""Bytes of arrays per comparison."""


class _Node:
    """Equality by content, so that only changes are sent."""

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        if type(self) is not type(other):
            return NotImplemented
        return all(
            same(getattr(self, name), getattr(other, name)) for name in _compared(type(self))
        )

    __hash__ = None  # pyright: ignore[reportAssignmentType]


@functools.cache
def _compared(kind: type[Any]) -> tuple[str, ...]:
    """Names of the fields of a class of nodes that count when nodes are compared."""
    return tuple(each.name for each in fields(kind) if each.compare)


def same(a: object, b: object) -> bool:
    """Return whether two values are equal; of arrays, byte by byte up to the first difference."""
    if a is b:
        return True
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        if a.shape != b.shape or a.dtype != b.dtype:
            return False
        if a.nbytes <= _COMPARED:  # most, without steps of their own
            return a.tobytes() == b.tobytes()  # a tenth of the time of numpy's comparison
        rows = max(1, _COMPARED * len(a) // a.nbytes)
        parts = (slice(i, i + rows) for i in range(0, len(a), rows))
        return all(a[part].tobytes() == b[part].tobytes() for part in parts)
    return not isinstance(a, np.ndarray) and not isinstance(b, np.ndarray) and a == b


@dataclass(frozen=True, eq=False)
class Points(_Node):
    """Squares or discs that face the camera, unlit and in exact colours.

    Args:
        xyz: float32 (N, 3), metres; finite.
        colors: uint8 (N, 3), or one colour for all.
        size: edge or diameter in metres.
        shape: outline of each point.
        ids: (N,), such as the index of each in the message; None numbers them from 0.
        thins: whether browsers may draw only some of them, fewer of those that are far away: all of
            the first block of `POINTS_PER_BLOCK`, and the first points of each further block,
            which must stand for all of the block.
        opacity: 0 to 1, drawn in steps of 1/255.
        plane: `size` is that of a point at 1 m from this plane and grows with the distance, as
            pixels of a depth image do; None if all points have the same.
    """

    xyz: F32
    colors: U8 | Rgb
    size: float
    shape: Literal["square", "circle"] = "square"
    ids: Ids | None = field(default=None, compare=False)
    thins: bool = False
    opacity: float = 1.0
    plane: Plane | None = None


@dataclass(frozen=True, eq=False)
class Lines(_Node):
    """Independent line segments.

    Args:
        segments: float32 (N, 2, 3), metres; finite.
        colors: uint8 (N, 2, 3), or one colour for all; None is the grey of grids, which contrasts
            with the theme of each page.
        width: in `unit`.
        unit: "px" is constant on the screen, "m" in the world.
        ids: (N,), such as the index of each in the message; None numbers them from 0.
        opacity: 0 to 1, drawn in steps of 1/255.
    """

    segments: F32
    colors: U8 | Rgb | None
    width: float = 1.0
    unit: Literal["px", "m"] = "px"
    ids: Ids | None = field(default=None, compare=False)
    opacity: float = 1.0


@dataclass(frozen=True, eq=False)
class Arrows(_Node):
    """Arrows of one thickness.

    Args:
        segments: float32 (N, 2, 3), tail and tip of each arrow in metres; finite.
        colors: uint8 (N, 3), or one colour for all.
        shaft_radius, head_radius, head_length: metres.
        ids: (N,), such as the index of each in the message; None numbers them from 0.
    """

    segments: F32
    colors: U8 | Rgb
    shaft_radius: float
    head_radius: float
    head_length: float
    ids: Ids | None = field(default=None, compare=False)


@dataclass(frozen=True, eq=False)
class Axes(_Node):
    """Coordinate axes, red x, green y, blue z.

    Args:
        positions: float32 (N, 3), metres.
        wxyzs: float32 (N, 4), unit quaternions with w first, as viser has them.
        length, radius: metres.
        ids: (N,), such as the index of each in the message; None numbers them from 0.
    """

    positions: F32
    wxyzs: F32
    length: float
    radius: float
    ids: Ids | None = field(default=None, compare=False)


@dataclass(frozen=True, eq=False)
class Labels(_Node):
    """Texts that face the camera, with an outline in the contrary brightness.

    Args:
        positions: float32 (N, 3), metres.
        texts: one for each position.
        height: of a line, metres; that of capitals is 0.6 of it, as in RViz.
        below: whether texts are below their positions on the screen, instead of centred.
        colors: uint8 (N, 3), or one colour for all, drawn in 32 steps per channel; None contrasts
            with the theme of each page.
        ids: (N,), such as the index of each in the message; None numbers them from 0.
        opacity: 0 to 1, drawn in steps of 1/4, of which 1/4 is the least.
    """

    positions: F32
    texts: tuple[str, ...]
    height: float
    below: bool = False
    colors: U8 | Rgb | None = None
    ids: Ids | None = field(default=None, compare=False)
    opacity: float = 1.0


@dataclass(frozen=True, eq=False)
class Mesh(_Node):
    """A triangle mesh of one colour, or of one for each vertex; lit, unless it is flat.

    Args:
        vertices: float32 (N, 3), metres.
        faces: uint32 (M, 3), counter-clockwise seen from outside.
        color: of the whole mesh.
        opacity: 0 to 1.
        ids: (M,), what each face is selected by; None if the mesh is one thing.
        colors: RGBA of the vertices, uint8 (N, 4), instead of `color` and `opacity`; both sides of
            all faces are shown.
        is_flat: whether it is a sheet in its exact `color`, which covers lines in its plane.
    """

    vertices: F32
    faces: NDArray[np.uint32]
    color: Rgb
    opacity: float = 1.0
    ids: Ids | None = None
    colors: U8 | None = None
    is_flat: bool = False


@dataclass(frozen=True, eq=False)
class Shape:
    """A triangle mesh that `Instances` repeat; equal only to itself.

    Args:
        vertices: float32 (N, 3); the scales of instances multiply them.
        faces: uint32 (M, 3), counter-clockwise seen from outside.
    """

    vertices: F32
    faces: NDArray[np.uint32]


@dataclass(frozen=True, eq=False)
class Instances(_Node):
    """Many lit solids, drawn as one.

    Opaque solids are the cheapest; use opacities for what seldom changes.

    Args:
        positions: float32 (N, 3), centres, metres.
        scales: float32 (N, 3), extents along x, y and z, metres; cylinders and cones are along z.
            Those of a `Shape` are positive factors.
        colors: uint8 (N, 3), or one colour for all.
        shape: of all solids.
        wxyzs: float32 (N, 4), unit quaternions with w first; None means not rotated.
        opacity: 0 to 1, float32 (N,) or one for all.
        is_data: whether they are shaded as the points of RViz's clouds, whose colours are data:
            spheres hardly, boxes with a fixed brightness of each side, squares not at all.
        ids: (N,), such as the index of each in the message; None numbers them from 0.
    """

    positions: F32
    scales: F32
    colors: U8 | Rgb
    shape: Solid | Shape = "box"
    wxyzs: F32 | None = None
    opacity: float | F32 = 1.0
    is_data: bool = False
    ids: Ids | None = field(default=None, compare=False)


@dataclass(frozen=True, eq=False)
class Models(_Node):
    """Many copies of a glTF model, drawn as one.

    Args:
        positions: float32 (N, 3), metres.
        wxyzs: float32 (N, 4), unit quaternions with w first.
        scales: float32 (N, 3), factors along x, y and z.
        data: binary glTF with one mesh of one material, whose node has no transform.
        ids: (N,), such as the index of each in the message; None numbers them from 0.
    """

    positions: F32
    wxyzs: F32
    scales: F32
    data: bytes
    ids: Ids | None = field(default=None, compare=False)


@dataclass(frozen=True, eq=False)
class Glb(_Node):
    """A binary glTF: a mesh with its own materials and textures."""

    data: bytes


@dataclass(frozen=True, eq=False)
class Image(_Node):
    """A flat picture in the x-y plane, unlit, with sharp cells (nearest filtering).

    Args:
        cells: RGBA, uint8 (H, W, 4), or rows of `palette`, uint8 (H, W), which is smaller. As
            in an occupancy grid, row 0 lies along y = 0, column 0 at x = 0.
        width, height: extent along x and y in metres; the corner of cell (0, 0) is the origin.
        layer: of images in one plane, higher layers are drawn on top.
        palette: RGBA, uint8 (256, 4).
    """

    cells: U8
    width: float
    height: float
    layer: int = 0
    palette: U8 | None = None

    @property
    def rgba(self) -> U8:
        """The colours of all cells, uint8 (H, W, 4)."""
        return self.cells if self.palette is None else self.palette[self.cells]


@dataclass(frozen=True, eq=False)
class Pane(_Node):
    """A picture beside the scene; a display has one pane at most.

    Args:
        picture: of one message.
        stamp_ns: of its message, 0 if it has none.
        order: see `Context.order`.
        camera: that took the picture, if the scene is drawn with it.
        marks: figures over the picture, of which later ones lie on top.
    """

    picture: Picture
    stamp_ns: int = 0
    order: int = 0
    camera: OverlayCamera | None = None
    marks: tuple[Mark, ...] = ()


Node = Points | Lines | Arrows | Axes | Labels | Mesh | Instances | Models | Glb | Image | Pane


def has_content(node: Node) -> bool:
    """Return whether a node has any content."""
    if isinstance(node, Pane):
        return True
    content = getattr(node, fields(node)[0].name)
    return len(content) > 0


@dataclass(frozen=True)
class Pose:
    """A pose: `position` (x, y, z) in metres, `wxyz` a unit quaternion."""

    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    wxyz: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
