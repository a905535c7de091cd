"""Handles that browsers drag: controls, and the events of people.

A display that has some is `Draggable` (`webviz.api.capabilities`). Pages follow a drag at their
own frame rate, with the rules of `Control`, and report it as drags.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import msgspec

from webviz.api.nodes import Pose

Mode = Literal[
    "none",
    "menu",
    "button",
    "move_axis",
    "move_plane",
    "rotate_axis",
    "move_rotate",
    "move_3d",
    "rotate_3d",
    "move_rotate_3d",
]
"""Effect of a drag: the modes of visualization_msgs/InteractiveMarkerControl, in its order."""

Facing = Literal["inherit", "fixed", "view_facing"]
"""Orientation of a control: with the handle, independent of it, or towards the camera."""

Wxyz = tuple[float, float, float, float]
Position = tuple[float, float, float]


@dataclass(frozen=True)
class Control:
    """A part of a handle that can be dragged.

    Its nodes have keys that begin with `c<index>/`, where `index` is its place in the handle. They
    are in the group of the handle or, if it is turned apart from it, in one with the key
    `<handle>.<index>` or, if it faces the camera, `<handle>.<index>v`. Pages turn the latter, so
    that its x axis points away from the camera and its z axis up; the same holds for
    `<handle>.title`.

    Args:
        name: as the server of the handle knows it.
        mode: what a drag does.
        facing: how it is turned.
        wxyz: its orientation in the handle. Its x axis is what it moves along or turns about, and
            the normal of the plane that it moves in.
        is_always_visible: whether it is shown while another tool than Interact is active.
        help: what it does, for people.
        turned: angle about its axis by which it has been turned so far, in radians.
    """

    name: str
    mode: Mode
    facing: Facing = "inherit"
    wxyz: Wxyz = (1.0, 0.0, 0.0, 0.0)
    is_always_visible: bool = False
    help: str = ""
    turned: float = 0.0


@dataclass(frozen=True)
class MenuEntry:
    """An entry of the menu of a handle.

    Args:
        id: for `Drag.entry`.
        title: as shown.
        is_checked: None for an entry without a check box.
        refusal: why it cannot be chosen, a sentence; "" if it can.
        entries: of its submenu; an entry that has some cannot be chosen itself.
    """

    id: int
    title: str
    is_checked: bool | None = None
    refusal: str = ""
    entries: tuple[MenuEntry, ...] = ()


@dataclass(frozen=True)
class Handle:
    """Something in the scene that browsers drag, by a key of the display, `m` and a number.

    Its nodes are in the group with this key (`Context.follow`), at its pose in `frame`; there is at
    least one, if only without content.

    Args:
        name: as shown.
        frame: that its pose is relative to, None for the fixed frame.
        controls: its parts.
        menu: of its context menu, () for none.
        aids: whether the axis of a drag is drawn.
        refusal: why it cannot be moved, a sentence; "" if it can.
    """

    name: str
    frame: str | None
    controls: tuple[Control, ...]
    menu: tuple[MenuEntry, ...] = ()
    aids: bool = False
    refusal: str = ""


DragKind = Literal["press", "move", "hold", "release", "choose"]
"""A button or finger goes down, moves, stays where it is for a while, goes up; or an entry of the
menu is chosen."""


@dataclass(frozen=True)
class Drag:
    """Something that a browser does with a control.

    Args:
        handle: its key.
        control: index of the control.
        kind: what is done.
        pose: of the handle, in its frame; None to leave it.
        turned: see `Control.turned`.
        point: what is under the pointer, in metres in the frame of the handle; None for nothing.
        entry: id of the chosen entry of the menu.
    """

    handle: str
    control: int
    kind: DragKind
    pose: Pose | None = None
    turned: float = 0.0
    point: Position | None = None
    entry: Annotated[int, msgspec.Meta(ge=0, lt=1 << 32)] = 0
