"""Checks of the poses of odometry."""

from __future__ import annotations

from math import dist

import numpy as np

from webviz.data import messages
from webviz.data.rotations import angle_between
from webviz_displays.odometry.covariance import LARGEST
from webviz_displays.shared import pose_history
from webviz_displays.shared.pose_history import UNIT_TOLERANCE


def fault(message: messages.Odometry) -> str:
    """A sentence why a pose cannot be drawn, "" if it can."""
    if problem := pose_history.fault(message.pose.pose):
        return problem
    q = message.pose.pose.orientation
    square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w
    if square == 0.0:
        return "The orientation is all zeros. The publisher must set it (w = 1 for no rotation)."
    if abs(square - 1.0) >= UNIT_TOLERANCE:
        return (
            f"The orientation ({q.x:g}, {q.y:g}, {q.z:g}, {q.w:g}) is not normalized: "
            f"its squared length is {square:g} instead of 1."
        )
    return ""


def has_moved(
    new: messages.Odometry, last: messages.Odometry, distance: float, angle: float
) -> bool:
    """Return whether a pose is at least this far (m) or turned this much (rad) from the last."""
    a, b = new.pose.pose, last.pose.pose
    p, q = a.position, b.position
    if dist((p.x, p.y, p.z), (q.x, q.y, q.z)) >= distance:
        return True
    p, q = a.orientation, b.orientation
    return angle_between((p.w, p.x, p.y, p.z), (q.w, q.x, q.y, q.z)) >= angle


def is_sound(message: messages.Odometry) -> bool:
    """Return whether the covariance of a pose is finite, of a sensible size, nowhere negative."""
    entries = message.pose.covariance
    return bool(np.abs(entries).max() <= LARGEST and entries[::7].min() >= 0)
