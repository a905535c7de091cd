"""Interactive markers of every kind: the scene that tutorials of ROS show."""

from __future__ import annotations

import math
from typing import Any

from geometry_msgs.msg import Quaternion
from visualization_msgs.msg import (
    InteractiveMarker,
    InteractiveMarkerControl,
    Marker,
    MenuEntry,
)

Control = InteractiveMarkerControl
FRAME = "base_link"
HALF = math.sqrt(0.5)
ALONG_X = Quaternion(w=HALF, x=HALF)
ALONG_Y = Quaternion(w=HALF, z=HALF)
ALONG_Z = Quaternion(w=HALF, y=HALF)
"""Rotation from the x axis of a control to that axis, or to its opposite."""


def box(scale: float) -> Marker:
    """A grey box, somewhat smaller than its marker."""
    marker = Marker(type=Marker.CUBE)
    size, color = marker.scale, marker.color
    size.x = size.y = size.z = 0.45 * scale
    color.r = color.g = color.b = 0.5
    color.a = 1.0
    return marker


def marker(name: str, x: float, y: float, frame: str = FRAME) -> InteractiveMarker:
    """A marker without controls, that moves with its frame."""
    message = InteractiveMarker(name=name, description=name.replace("_", " "), scale=1.0)
    message.header.frame_id = frame
    message.pose.position.x, message.pose.position.y = x, y
    return message


def add(message: InteractiveMarker, mode: int, *, shapes: bool = False, **fields: Any) -> Control:
    """Add a control to a marker, with a box or with generated handles."""
    control = Control(interaction_mode=mode, **fields)
    if shapes:
        control.markers = [box(message.scale)]
        control.always_visible = True
    message.controls = [*message.controls, control]
    return control


def rings(message: InteractiveMarker, orientation_mode: int) -> None:
    """Add rings and arrows for all three axes."""
    for way, quaternion in (("x", ALONG_X), ("z", ALONG_Z), ("y", ALONG_Y)):
        for verb, mode in (("rotate", Control.ROTATE_AXIS), ("move", Control.MOVE_AXIS)):
            control = add(message, mode, name=f"{verb}_{way}", orientation=quaternion)
            control.orientation_mode = orientation_mode


def basic_controls() -> list[InteractiveMarker]:
    """Thirteen markers, three metres apart."""
    messages = []
    kinds = (
        (Control.NONE, True, Control.FIXED, (-3.0, 3.0)),
        (Control.NONE, True, Control.INHERIT, (0.0, 3.0)),
        (Control.MOVE_3D, False, Control.INHERIT, (3.0, 3.0)),
        (Control.ROTATE_3D, True, Control.INHERIT, (-3.0, 0.0)),
        (Control.MOVE_ROTATE_3D, True, Control.INHERIT, (0.0, 0.0)),
    )
    for index, (mode, has_rings, turned, (x, y)) in enumerate(kinds):
        six = marker(f"simple_{index}", x, y)
        add(six, mode, shapes=True)
        if has_rings:
            rings(six, turned)
        messages.append(six)

    odd = marker("random_axes", 3.0, 0.0)
    add(odd, Control.NONE, shapes=True)
    for quaternion in (Quaternion(w=0.9, x=0.3, y=0.2, z=0.1), Quaternion(w=0.2, x=-0.5, y=0.8)):
        add(odd, Control.ROTATE_AXIS, orientation=quaternion)
        add(odd, Control.MOVE_AXIS, orientation=quaternion)
    messages.append(odd)

    facing = marker("view_facing", -3.0, -3.0)
    add(facing, Control.ROTATE_AXIS, orientation_mode=Control.VIEW_FACING)
    move_plane = add(facing, Control.MOVE_PLANE, shapes=True, name="move")
    move_plane.orientation_mode, move_plane.independent_marker_orientation = (
        Control.VIEW_FACING,
        True,
    )
    messages.append(facing)

    flying = marker("quadrocopter", 0.0, -3.0)
    add(flying, Control.MOVE_ROTATE, shapes=True, orientation=ALONG_Z)
    add(flying, Control.MOVE_AXIS, orientation=ALONG_Z)
    messages.append(flying)

    chess = marker("chess_piece", 3.0, -3.0)
    add(chess, Control.MOVE_PLANE, shapes=True, orientation=ALONG_Z)
    add(chess, Control.MOVE_PLANE, orientation=ALONG_Z)
    messages.append(chess)

    head = marker("pan_tilt", -3.0, -6.0)
    add(head, Control.NONE, shapes=True)
    add(head, Control.ROTATE_AXIS, orientation=ALONG_Z, orientation_mode=Control.FIXED)
    add(head, Control.ROTATE_AXIS, orientation=ALONG_Y)
    messages.append(head)

    moving = marker("moving", 0.0, -6.0, frame="moving_frame")
    add(moving, Control.ROTATE_AXIS, orientation=ALONG_X)
    add(moving, Control.MOVE_PLANE, shapes=True, orientation=ALONG_Z)
    messages.append(moving)

    menu = marker("menu", 3.0, -6.0)
    add(menu, Control.MENU, shapes=True, name="menu_only_control")
    menu.menu_entries = [
        MenuEntry(id=1, parent_id=0, title="First Entry"),
        MenuEntry(id=2, parent_id=0, title="[x] Second Entry"),
        MenuEntry(id=3, parent_id=0, title="Submenu"),
        MenuEntry(id=4, parent_id=3, title="[ ] First Subentry"),
        MenuEntry(id=5, parent_id=3, title="Format the disk", command="rm", command_type=1),
    ]
    messages.append(menu)

    button = marker("button", 0.0, -9.0)
    add(button, Control.BUTTON, shapes=True, name="button_control")
    messages.append(button)
    return messages
