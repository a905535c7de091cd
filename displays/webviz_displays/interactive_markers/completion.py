"""Interactive markers as their servers mean them: what they leave out is filled in.

Rules and sizes are those of interactive_markers' tools.cpp, which clients of ROS apply as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, get_args

import msgspec
import numpy as np

from webviz import Pose
from webviz.api.handles import Control, Facing, MenuEntry, Mode
from webviz.data.messages.markers import Marker, MarkerSequence
from webviz.data.rotations import normalized
from webviz.data.transforms.geometry import REACH_M
from webviz.data.words import counted, joined, shortened
from webviz_displays.interactive_markers.handles import handles_of
from webviz_displays.interactive_markers.menus import menu_of
from webviz_displays.markers.contents import detached, size_of
from webviz_displays.markers.faults import is_valid

MODES: tuple[Mode, ...] = get_args(Mode)
FACINGS: tuple[Facing, ...] = get_args(Facing)
"""Names of facings in the order of the constants of visualization_msgs/InteractiveMarkerControl."""
MAX_CONTROLS = 200
MAX_SHAPES = 2000
"""Markers of a control."""
MAX_POINTS = 100_000
"""Points of the markers of a control together."""
MAX_NAME = 1000
"""Characters of the names of markers, controls and frames, which feedback repeats as they are."""
MAX_TEXT = 10_000
"""Characters of a marker of text; browsers draw each of them as two triangles."""
MAX_TITLE = 1000
"""Characters shown of a description."""
MAX_LABEL = 60
"""Characters of a name in a status."""

FAR = "Its pose or scale is not finite, or too large. Correct the server."

Wxyz = tuple[float, float, float, float]


class CompleteControl(msgspec.Struct, frozen=True, eq=False):
    """A control with all that it needs.

    Args:
        control: with a name that is unique in its marker.
        is_independent: whether its shapes keep the orientation of the marker.
        shapes: to draw.
    """

    control: Control
    is_independent: bool
    shapes: MarkerSequence


class Completed(msgspec.Struct, frozen=True, eq=False):
    """An interactive marker with all that it needs.

    Args:
        name: unique on its server.
        frame, stamp_ns: of its header.
        pose: in that frame.
        description: its title.
        scale: size of generated handles.
        parts: its controls.
        menu: its entries.
        size: of the lists, texts and files of its shapes, in bytes.
        problems: what is wrong with it, in sentences.
    """

    name: str
    frame: str
    stamp_ns: int
    pose: Pose
    description: str
    scale: float
    parts: tuple[CompleteControl, ...]
    menu: tuple[MenuEntry, ...]
    size: int
    problems: tuple[str, ...]


class RefusedMarker(msgspec.Struct, frozen=True):
    """An interactive marker that cannot be shown.

    Args:
        name: the beginning of one that is too long.
        reason: a sentence.
    """

    name: str
    reason: str


def completed(message: Any) -> Completed | RefusedMarker:
    """Complete a visualization_msgs/InteractiveMarker, or say why it cannot be shown."""
    name, frame = str(message.name), str(message.header.frame_id).removeprefix("/")
    for what, text in (("name", name), ("frame id", frame)):
        if len(text) > MAX_NAME:
            long = f"Its {what} has {len(text)} characters; the limit is {MAX_NAME}."
            return RefusedMarker(name[:MAX_NAME], f"{long} Correct the server.")
    pose, scale = pose_of(message.pose), float(message.scale)
    if pose is None or not abs(scale) <= REACH_M:
        return RefusedMarker(name, FAR)
    scale = scale or 1.0
    description = str(message.description)
    menu, problems = menu_of(message.menu_entries)
    if len(description) > MAX_TITLE:
        problems.append(
            f"Only {MAX_TITLE} of the {len(description)} characters of its title are shown."
        )
    parts = _parts(message.controls, scale, problems)
    return Completed(
        name=name,
        frame=frame,
        stamp_ns=message.header.stamp_ns,
        pose=pose,
        description=description[:MAX_TITLE],
        scale=scale,
        parts=parts,
        menu=menu,
        size=sum(size_of(each) for part in parts for each in part.shapes.contents),
        problems=tuple(problems),
    )


def pose_of(message: Any) -> Pose | None:
    """Return a geometry_msgs/Pose with a unit quaternion.

    None if it is not finite, or out of reach.

    A quaternion of length zero becomes the identity.
    """
    at, wxyz = message.position, _wxyz(message.orientation)
    position = float(at.x), float(at.y), float(at.z)
    if wxyz is None or not all(abs(value) <= REACH_M for value in position):
        return None
    return Pose(position, wxyz)


def unique_names(names: Sequence[str]) -> Iterator[str]:
    """Names, of which repeated ones get `_u0`, `_u1` and so on; feedback has them like that."""
    used: set[str] = set()
    count = 0
    for name in names:
        unique = name
        while unique in used:
            unique = f"{name}_u{count}"
            count += 1
        used.add(unique)
        yield unique


class _Invalid(Exception):
    """Fault of a control, as the sentence that follows its name."""


def _parts(
    controls: Sequence[Any], scale: float, problems: list[str]
) -> tuple[CompleteControl, ...]:
    """Complete controls, and add what is wrong with them to the problems of their marker."""
    if len(controls) > MAX_CONTROLS:
        problems.append(f"Only {MAX_CONTROLS} of {len(controls)} controls are shown.")
        controls = controls[:MAX_CONTROLS]
    parts = []
    for name, control in zip(unique_names([str(c.name) for c in controls]), controls, strict=True):
        label = shortened(name, MAX_LABEL)
        try:
            part = _part(name, control, scale)
        except _Invalid as error:
            problems.append(joined(f"Control '{label}' {error}", "Correct the server."))
            continue
        parts.append(part)
        if count := int(np.count_nonzero(~is_valid(part.shapes))):
            problems.append(
                f"Control '{label}' has {counted(count, 'marker')} that cannot be drawn: "
                "not finite, or too large. Correct the server."
            )
    return tuple(parts)


def _part(name: str, control: Any, scale: float) -> CompleteControl:
    if len(name) > MAX_NAME:
        raise _Invalid(f"has a name of {len(name)} characters; the limit is {MAX_NAME}.")
    wxyz = _wxyz(control.orientation)
    if wxyz is None:
        raise _Invalid("has an orientation that is not finite.")
    if control.interaction_mode >= len(MODES):
        raise _Invalid(f"has an unknown interaction mode, {control.interaction_mode}.")
    if control.orientation_mode >= len(FACINGS):
        raise _Invalid(f"has an unknown orientation mode, {control.orientation_mode}.")
    mode, facing = MODES[control.interaction_mode], FACINGS[control.orientation_mode]
    is_independent = bool(control.independent_marker_orientation)
    shapes, help = control.markers, str(control.description)[:MAX_TITLE]
    if not len(shapes):
        shapes = MarkerSequence.of(handles_of(mode, wxyz, scale, help))
        if mode == "menu":
            facing, is_independent = "view_facing", False
    _check_size(shapes)
    completed = Control(
        name=name,
        mode=mode,
        facing=facing,
        wxyz=wxyz,
        is_always_visible=bool(control.always_visible),
        help=help,
    )
    return CompleteControl(completed, is_independent, _with_sizes(shapes))


def _check_size(shapes: MarkerSequence) -> None:
    if len(shapes) > MAX_SHAPES:
        raise _Invalid(f"has {len(shapes)} markers; the limit is {MAX_SHAPES}.")
    if (points := sum(len(each.points) for each in shapes.contents)) > MAX_POINTS:
        raise _Invalid(f"has {points} points; the limit is {MAX_POINTS}.")
    if (letters := max((len(each.text) for each in shapes.contents), default=0)) > MAX_TEXT:
        raise _Invalid(f"has a text of {letters} characters; the limit is {MAX_TEXT}.")


def _with_sizes(shapes: MarkerSequence) -> MarkerSequence:
    """Shapes whose sizes of zero are one, but for the heads of arrows, where zero has a meaning.

    They do not keep the message alive, of which they may be a small part.
    """
    is_zero = shapes.scales == 0.0
    has_points = np.array([len(each.points) == 2 for each in shapes.contents], bool)
    is_zero[(shapes.types == Marker.ARROW) & has_points, 2] = False
    return replace(
        shapes,
        scales=np.where(is_zero, 1.0, shapes.scales),
        contents=[detached(each) for each in shapes.contents],
    )


def _wxyz(quaternion: Any) -> Wxyz | None:
    """Return a unit quaternion, None if it is not finite.

    Of length zero it becomes the identity.
    """
    wxyz = quaternion.w, quaternion.x, quaternion.y, quaternion.z
    if not all(abs(value) <= REACH_M for value in wxyz):  # whose squares are finite, too
        return None
    ((w, x, y, z),) = normalized([wxyz])[0].tolist()
    return w, x, y, z
