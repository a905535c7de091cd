"""The context that a display draws on.

A `Context` exists for one call of a hook and collects nodes, their placement and statuses. The
framework compares them with those of the previous call and updates the scene.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from webviz.api import nodes
from webviz.api.frames import Frames, is_placeable
from webviz.api.nodes import Ids, Node, Pose, Rgb, Shape, Solid
from webviz.api.status import LOADING, Level, OtherFixedFrame, Remedy, Status
from webviz.data.transforms.geometry import REACH_M
from webviz.data.transforms.reasons import Explanation

When = Literal["latest", "now"]
"""The latest common time of a frame and the fixed frame, or the viewer's current time."""


@dataclass(frozen=True)
class Placement:
    """The placement of a group of nodes.

    Args:
        frame: frame id; None is the fixed frame.
        when: time of the transform to the fixed frame.
        offset: pose of the group in `frame`.
        keep_last: without a transform, stay at the last pose instead of being hidden.
        interval_s: minimum time between moves; 0 moves on every turn of the frame loop.
        is_rigid: the group keeps its own pose in the fixed frame, too, where otherwise the nodes
            are sent in coordinates of that frame; for what browsers move.
    """

    frame: str | None = None
    when: When = "latest"
    offset: Pose = Pose()
    keep_last: bool = False
    interval_s: float = 0.0
    is_rigid: bool = False


@dataclass(frozen=True)
class ColorScale:
    """Range of values that colours stand for.

    Args:
        label: what the values are, such as "intensity" or "x (m)".
        low, high: the values of the first and the last colour.
        colors: evenly spaced in between.
    """

    label: str
    low: float
    high: float
    colors: tuple[Rgb, ...]


class Group:
    """Nodes that move together, each under a key of its own."""

    def __init__(self, placement: Placement) -> None:
        self.placement = placement
        self.is_tinted = False
        """True once the nodes have the look of their robot."""
        self.nodes: dict[str, Node] = {}
        self.poses: dict[str, Pose] = {}

    def add(self, key: str, node: Node, pose: Pose | None = None) -> None:
        """Draw a node at a pose in the coordinates of the group.

        Raises:
            TypeError: it is not a node of `webviz.api.nodes`.
            ValueError: the pose is not finite or out of reach.
        """
        if not isinstance(node, Node):
            raise TypeError(f"{key!r} is not a node: {node!r:.80}")
        if pose is not None:
            self.poses[key] = _checked(pose, key)
        self.nodes[key] = node

    def points(
        self,
        key: str,
        xyz: ArrayLike,
        colors: ArrayLike | Rgb,
        size: float,
        shape: Literal["square", "circle"] = "square",
        ids: Ids | None = None,
        thins: bool = False,
        opacity: float = 1.0,
        plane: nodes.Plane | None = None,
    ) -> None:
        """Draw points; see `webviz.api.nodes.Points`."""
        self.nodes[key] = nodes.Points(
            _f32(xyz, 3), _colors(colors), size, shape, ids, thins, opacity, plane
        )

    def lines(
        self,
        key: str,
        segments: ArrayLike,
        colors: ArrayLike | Rgb | None,
        width: float = 1.0,
        unit: Literal["px", "m"] = "px",
        ids: Ids | None = None,
        opacity: float = 1.0,
    ) -> None:
        """Draw independent segments; see `webviz.api.nodes.Lines`."""
        rgba = None if colors is None else _colors(colors)
        self.nodes[key] = nodes.Lines(_f32(segments, 2, 3), rgba, width, unit, ids, opacity)

    def strip(
        self,
        key: str,
        xyz: ArrayLike,
        color: Rgb,
        width: float = 1.0,
        unit: Literal["px", "m"] = "px",
        ids: Ids | None = None,
        opacity: float = 1.0,
    ) -> None:
        """Draw one line through points, float (N, 3), with an id for each segment."""
        points = _f32(xyz, 3)
        segments = np.stack([points[:-1], points[1:]], axis=1)
        self.nodes[key] = nodes.Lines(segments, color, width, unit, ids, opacity)

    def arrows(
        self,
        key: str,
        segments: ArrayLike,
        colors: ArrayLike | Rgb,
        shaft_radius: float,
        head_radius: float,
        head_length: float,
        ids: Ids | None = None,
    ) -> None:
        """Draw arrows from tails to tips; see `webviz.api.nodes.Arrows`."""
        self.nodes[key] = nodes.Arrows(
            _f32(segments, 2, 3), _colors(colors), shaft_radius, head_radius, head_length, ids
        )

    def axes(
        self,
        key: str,
        positions: ArrayLike,
        wxyzs: ArrayLike,
        length: float,
        radius: float,
        ids: Ids | None = None,
    ) -> None:
        """Draw coordinate axes; see `webviz.api.nodes.Axes`."""
        self.nodes[key] = nodes.Axes(_f32(positions, 3), _f32(wxyzs, 4), length, radius, ids)

    def labels(
        self,
        key: str,
        positions: ArrayLike,
        texts: tuple[str, ...],
        height: float,
        below: bool = False,
        colors: ArrayLike | Rgb | None = None,
        ids: Ids | None = None,
    ) -> None:
        """Draw texts; see `webviz.api.nodes.Labels`."""
        xyz = _f32(positions, 3)
        rgba = None if colors is None else _colors(colors)
        self.nodes[key] = nodes.Labels(xyz, texts, height, below, rgba, ids)

    def instances(
        self,
        key: str,
        shape: Solid | Shape,
        positions: ArrayLike,
        scales: ArrayLike,
        colors: ArrayLike | Rgb,
        wxyzs: ArrayLike | None = None,
        opacity: float | NDArray[np.float32] = 1.0,
        is_data: bool = False,
        ids: Ids | None = None,
    ) -> None:
        """Draw many solids; `scales` may be one size for all. See `webviz.api.nodes.Instances`."""
        xyz = _f32(positions, 3)
        sizes = np.asarray(scales, np.float32)
        if sizes.shape != xyz.shape:
            sizes = np.broadcast_to(sizes, xyz.shape)
        sizes = np.ascontiguousarray(sizes)
        turns = None if wxyzs is None else _f32(wxyzs, 4)
        self.nodes[key] = nodes.Instances(
            xyz, sizes, _colors(colors), shape, turns, opacity, is_data, ids
        )

    def image(
        self,
        key: str,
        cells: NDArray[np.uint8],
        width: float,
        height: float,
        layer: int = 0,
        palette: NDArray[np.uint8] | None = None,
    ) -> None:
        """Draw a flat picture; see `webviz.api.nodes.Image`."""
        self.nodes[key] = nodes.Image(cells, width, height, layer, palette)


class Background(Protocol):
    """Runs slow work in a thread."""

    def __call__(
        self,
        key: object,
        fn: Callable[..., Any],
        *args: Any,
        stop: Callable[[], None] | None = None,
    ) -> Any:
        """Return the result of `fn(*args)`, None until it is ready.

        `stop` makes `fn` end early; it is called from any thread once the result is not needed.
        """
        ...


class Context(Group):
    """Collects the nodes and statuses of one call of a hook.

    Nodes added to the context itself are placed in the frame of the sample at its stamp (`draw`) or
    in the fixed frame (`draw_all`, `tick`); those of `follow` move with a frame.

    Args:
        frames: the current transforms, fixed frame and time.
        background: see `Background`.
        state: kept between calls; see `Display.new_state`.
        placement: of the context's own nodes.
        order: place of the display in the list; later displays are drawn on top.
        share_of_points: how many points the display may show if it has a number of them, by what
            browsers draw fast enough; to be called in `depends`.
    """

    def __init__(
        self,
        frames: Frames,
        background: Background,
        state: Any,
        placement: Placement = Placement(),
        order: int = 0,
        share_of_points: Callable[[int], int] = lambda count: nodes.POINTS_HELD,
    ) -> None:
        super().__init__(placement)
        self.share_of_points = share_of_points
        self.order = order
        self.frames = frames
        self.background = background
        self.state = state
        self.groups: dict[str, Group] = {}
        """Made by `follow`. The context is not among them: what refers to itself stays in memory,
        with all that it draws, until the garbage collector looks for cycles."""
        self.statuses: dict[str, Status] = {}
        self.color_scale: ColorScale | None = None
        """Color scale for the legend in the scene; set it to say which values colours stand for."""
        self.attribution = ""
        """Whom to credit for what is drawn, such as the makers of a map; shown over the scene."""
        self.is_unfinished = False
        """Set it if the rest is drawn in later turns of the frame loop; the next comes soon."""
        self.offered: dict[str, Mapping[str, int]] = {}
        """Names that switches offer, by the name of their property, and how many things have
        each."""

    def follow(
        self,
        frame: str | None,
        *,
        when: When = "latest",
        offset: Pose = Pose(),
        keep_last: bool = False,
        interval_s: float = 0.0,
        is_rigid: bool = False,
        key: str = "",
    ) -> Group:
        """Return a group of nodes that moves with a frame; see `Placement`.

        Args:
            frame: frame id; None or "" is the fixed frame.
            when, offset, keep_last, interval_s, is_rigid: see `Placement`.
            key: distinguishes groups of one frame.

        Raises:
            ValueError: the offset is not finite or out of reach.
        """
        _checked(offset, f"{frame or 'the fixed frame'} {key}".rstrip())
        frame = self.frames.named(frame) if frame else None
        placement = Placement(frame, when, offset, keep_last, interval_s, is_rigid)
        return self.groups.setdefault(f"{frame or ''}|{key}", Group(placement))

    def ok(self, key: str, text: str) -> None:
        """Report that all is well."""
        self.statuses[key] = Status(Level.OK, text)

    def loading(self, text: str) -> None:
        """Report that files or threads are at work, which is neither good nor bad."""
        self.statuses[LOADING] = Status(Level.IDLE, text)

    def warn(
        self,
        key: str,
        text: str,
        remedy: Remedy | OtherFixedFrame | None = None,
        reason: Explanation | None = None,
    ) -> None:
        """Report a warning; `remedy` is a change that would help, and a button of the page.

        Args:
            key: of the status.
            text: a sentence with cause and remedy.
            remedy: see `webviz.Status`.
            reason: why a frame has no pose, if that is the cause.
        """
        self.statuses[key] = Status(Level.WARN, text, remedy, reason)

    def error(
        self,
        key: str,
        text: str,
        remedy: Remedy | OtherFixedFrame | None = None,
        reason: Explanation | None = None,
    ) -> None:
        """Report an error; its arguments are those of `warn`."""
        self.statuses[key] = Status(Level.ERROR, text, remedy, reason)


def _checked(pose: Pose, what: str) -> Pose:
    if not is_placeable(pose):
        x, y, z = pose.position
        text = f"The position ({x:.3g}, {y:.3g}, {z:.3g}) m or the orientation of {what!r}"
        raise ValueError(f"{text} is not finite, or farther than {REACH_M:.0e} m.")
    return pose


def _f32(values: ArrayLike, *shape: int) -> NDArray[np.float32]:
    return np.ascontiguousarray(values, dtype=np.float32).reshape(-1, *shape)


def _colors(colors: ArrayLike | Rgb) -> NDArray[np.uint8] | Rgb:
    if isinstance(colors, tuple) and len(colors) == 3 and all(isinstance(c, int) for c in colors):
        return colors  # pyright: ignore[reportReturnType]
    return np.ascontiguousarray(colors, dtype=np.uint8)
