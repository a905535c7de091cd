"""The groups of the scene that show an interactive marker."""

from __future__ import annotations

import itertools
from collections.abc import Set

import msgspec
import numpy as np
from msgspec.structs import replace

from webviz import Axes, Context, Frames, Group, Instances, Labels, Level, Node, Pose, compose
from webviz.data.messages.markers import Content, Marker, MarkerSequence
from webviz.data.rotations import conjugate, from_axis_angle, matrices, multiply_many
from webviz.data.transforms.geometry import REACH_M
from webviz_displays.interactive_markers.completion import CompleteControl
from webviz_displays.interactive_markers.tracked import Place, Tracked
from webviz_displays.markers.assets import Assets
from webviz_displays.markers.batch import MarkerBatch, batch_of
from webviz_displays.markers.faults import faults_of, is_valid
from webviz_displays.markers.nodes import nodes_of
from webviz_displays.shared.geometry import inverse
from webviz_urdf import LoadRequest

TITLE_AT = 1.4
TITLE_HEIGHT = 0.15
AXES_RADIUS = 0.025
"""Half of what RViz2 calls the radius of these axes, since it is the diameter of their cylinders.

Sizes are multiples of the scale of the marker."""
LETTER = 0.5
"""Width of a letter, as a multiple of its height."""
TITLE = "title"
"""Ends the key of the group with the title."""


class MarkerLook(msgspec.Struct, frozen=True):
    """Properties of everything drawn besides controls.

    Args:
        titles, axes: whether they are.
        is_transparent: whether controls are as transparent as the server says; else opaque.
    """

    titles: bool
    axes: bool
    is_transparent: bool


class ShownMarker:
    """The groups of one interactive marker, made anew only if something changes.

    Args:
        assets: the files that its shapes name.
    """

    def __init__(self, assets: Assets) -> None:
        self.transform_error: str = ""
        """Reason why a shape has no transform, a sentence."""
        self.fault: str = ""
        """Reason why a shape cannot be drawn wherever it is, a sentence."""
        self.requests: set[LoadRequest] = set()
        """The files that its shapes name."""
        self.drawn_in = 0
        """Number of the drawing in which its groups were made."""
        self._assets = assets
        self._of: object = None
        self._tried: int = 0
        """Version of the transforms when a lost shape was looked for."""
        self._parts: tuple[CompleteControl, ...] = ()
        self._nodes: list[dict[str, Node]] = []
        self._look: MarkerLook | None = None
        self._pinned: dict[tuple[int, int], Pose] = {}
        self._groups: dict[str, Group] = {}

    def forget(self, arrived: Set[LoadRequest]) -> None:
        """Be made anew if one of its files has been loaded."""
        if not arrived.isdisjoint(self.requests):
            self._of = self._look = None

    def is_current(self, marker: Tracked, place: Place, look: MarkerLook, frames: Frames) -> bool:
        """Return whether its groups need not be made anew."""
        is_same = self._of == (marker.version, place, look)
        return is_same and not (self.transform_error and self._tried != frames.buffer.version)

    def show(self, ctx: Context) -> None:
        """Add the groups to a context as they were made."""
        ctx.groups.update(self._groups)

    def draw(self, marker: Tracked, place: Place, look: MarkerLook, ctx: Context) -> None:
        """Make the groups anew, and add them to a context."""
        self._of, self._tried = (marker.version, place, look), ctx.frames.buffer.version
        before = len(ctx.groups)
        self._make(marker, place, look, ctx)
        added = len(ctx.groups) - before
        self._groups = dict(itertools.islice(reversed(ctx.groups.items()), added))

    def _make(self, marker: Tracked, place: Place, look: MarkerLook, ctx: Context) -> None:
        completed = marker.content
        if self._parts is not completed.parts or self._look != look or self.transform_error:
            self._renew(marker, place, look, ctx.frames)
        whole = self._group(ctx, place, marker.key, place.pose.wxyz)
        whole.lines(f"place/{marker.key}", (), (0, 0, 0))  # for pages, even if it is empty
        for index, (part, nodes) in enumerate(zip(completed.parts, self._nodes, strict=True)):
            group = whole
            if has_own_group(part):
                wxyz = orientation(part, place.pose, marker.turned.get(part.control.name, 0.0))
                key = f"{marker.key}.{index}{'v' * (part.control.facing == 'view_facing')}"
                group = self._group(ctx, place, key, wxyz)
            group.nodes.update(nodes)
        if look.axes:
            zero, unit = np.zeros((1, 3), np.float32), np.array([(1, 0, 0, 0)], np.float32)
            whole.add(
                f"axes/{marker.key}",
                Axes(zero, unit, completed.scale, AXES_RADIUS * completed.scale),
            )
        if look.titles and completed.description:
            title = self._group(ctx, place, f"{marker.key}.{TITLE}", (1.0, 0.0, 0.0, 0.0))
            at = np.array([(0.0, 0.0, TITLE_AT * completed.scale)], np.float32)
            title.add(
                f"{TITLE}/{marker.key}",
                Labels(at, (completed.description,), TITLE_HEIGHT * abs(completed.scale)),
            )

    def _group(
        self, ctx: Context, place: Place, key: str, wxyz: tuple[float, float, float, float]
    ) -> Group:
        offset = Pose(place.pose.position, wxyz)
        return ctx.follow(place.frame, offset=offset, is_rigid=True, key=key)

    def _renew(self, marker: Tracked, place: Place, look: MarkerLook, frames: Frames) -> None:
        parts = marker.content.parts
        if self._parts is not parts:
            self._pinned.clear()
        self._parts, self._look, self.transform_error, self.fault = parts, look, "", ""
        self._nodes = []
        self.requests = set()
        for index, part in enumerate(parts):
            batch = self._placed(index, part, marker, place, frames)
            if not look.is_transparent:
                batch = _opaque(batch)
            files, missing, named = self._assets.of(batch)
            self.requests |= named
            for _, level, text in (*missing, *faults_of(batch)):
                # Invisible shapes that can be dragged are deliberate.
                if level is Level.ERROR and not self.fault:
                    self.fault = f"Control '{part.control.name}': {text}"
            nodes = nodes_of(batch, files)
            if part.control.mode != "none" and (batch.types == Marker.TEXT_VIEW_FACING).any():
                nodes["drag"] = _around_texts(batch)
            whose = f"c{index}/{marker.key}"
            self._nodes.append({f"{whose}/{key}": node for key, node in nodes.items()})

    def _placed(
        self, index: int, part: CompleteControl, marker: Tracked, place: Place, frames: Frames
    ) -> MarkerBatch:
        """Return the shapes in the coordinates of their group.

        Those in their own frame are pinned.
        """
        shapes = part.shapes
        batch = batch_of(shapes)
        numbers = np.column_stack((shapes.positions, shapes.orientations, shapes.scales))
        with np.errstate(invalid="ignore"):
            is_fine = np.all(np.abs(numbers) <= REACH_M, axis=1) & is_valid(shapes)
        named = [row for row, frame in enumerate(shapes.frame_ids) if frame]
        positions, wxyzs = batch.positions.copy(), batch.wxyzs.copy()
        for row in (row for row in named if is_fine[row]):
            own = Pose(tuple(positions[row].tolist()), tuple(wxyzs[row].tolist()))
            pinned = self._pinned.get((index, row)) or self._pin(
                marker, part, place, frames, shapes, row
            )
            if pinned is None:
                is_fine[row] = False
                continue
            self._pinned[index, row] = pinned
            pose = compose(pinned, own)
            positions[row], wxyzs[row] = pose.position, pose.wxyz
        if part.control.facing == "view_facing" and has_own_group(part):
            # Pages turn the axes of the control to the camera.
            positions = positions @ matrices(part.control.wxyz)
            wxyzs = multiply_many(conjugate(part.control.wxyz), wxyzs)
        return replace(batch, positions=positions, wxyzs=wxyzs).only(np.flatnonzero(is_fine))

    def _pin(
        self,
        marker: Tracked,
        part: CompleteControl,
        place: Place,
        frames: Frames,
        shapes: MarkerSequence,
        row: int,
    ) -> Pose | None:
        """Return the frame of a shape in the coordinates of its control."""
        frame, stamp_ns = shapes.frame_ids[row].removeprefix("/"), int(shapes.stamps_ns[row])
        at, base = frames.at(frame, stamp_ns), frames.latest(place.frame)
        if at is None or base is None:
            self.transform_error = frames.why_not(frame, stamp_ns)
            return None
        wxyz = orientation(part, place.pose, marker.turned.get(part.control.name, 0.0))
        return compose(inverse(compose(base, Pose(place.pose.position, wxyz))), at)


def has_own_group(part: CompleteControl) -> bool:
    """Return whether the shapes of a control are turned apart from the marker."""
    facing = part.control.facing
    return facing == "fixed" or (facing == "view_facing" and not part.is_independent)


def orientation(
    part: CompleteControl, pose: Pose, turned: float
) -> tuple[float, float, float, float]:
    """Return the orientation of a control's group in its marker; pages turn it to the camera."""
    if part.control.facing == "fixed":
        x, y, z = matrices(part.control.wxyz)[:, 0].tolist()
        return from_axis_angle((x, y, z), turned)
    return (1.0, 0.0, 0.0, 0.0) if has_own_group(part) else pose.wxyz


def _around_texts(batch: MarkerBatch) -> Instances:
    """Invisible balls around texts, since browsers cannot hit letters."""
    rows = np.flatnonzero(batch.types == Marker.TEXT_VIEW_FACING)
    heights = batch.scales[rows, 2]
    lengths = [max(map(len, batch.contents[row].text.split("\n"))) for row in rows.tolist()]
    widths = np.maximum(LETTER * heights * lengths, heights)
    sizes = np.column_stack((widths, widths, heights)).astype(np.float32)
    xyz = batch.positions[rows].astype(np.float32)
    return Instances(xyz, np.abs(sizes), (0, 0, 0), "sphere", opacity=0.0)


def _opaque(batch: MarkerBatch) -> MarkerBatch:
    """Shapes without transparency, but for those that are invisible."""

    def solid(content: Content) -> Content:
        return msgspec.structs.replace(content, colors=_solid(content.colors))

    contents = [solid(each) if len(each.colors) else each for each in batch.contents]
    return replace(batch, colors=_solid(batch.colors), contents=contents)


def _solid(colors: np.ndarray) -> np.ndarray:
    alpha = np.where(colors[:, 3] > 0.0, np.float32(1.0), colors[:, 3])
    return np.column_stack((colors[:, :3], alpha)).astype(np.float32)
