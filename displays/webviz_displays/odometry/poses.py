"""Checks of the poses of odometry."""

from __future__ import annotations

from math import dist
from typing import NamedTuple

import numpy as np

from webviz.data import messages
from webviz.data.rotations import angle_between
from webviz_displays.odometry.covariance import LARGEST
from webviz_displays.shared import pose_history
from webviz_displays.shared.pose_history import UNIT_TOLERANCE


def fault(message: messages.Odometry) -> str:
    """Return a sentence why a pose cannot be drawn, "" if it can."""
    if problem := pose_history.fault(message.pose.pose):
        return problem
    q = message.pose.pose.orientation
    square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w
    if square == 0.0:
        return "The orientation is all zeros. The publisher must set it (w = 1 for no rotation)."
    if abs(square - 1.0) >= UNIT_TOLERANCE:
        return (
            f"The orientation ({q.x:g}, {q.y:g}, {q.z:g}, {q.w:g}) is not normalised: "
            f"its squared length is {square:g} instead of 1."
        )
    return ""


class TrailPlace(NamedTuple):
    """A pose, as far as it decides on the poses that are kept after it.

    Args:
        position: metres.
        wxyz: quaternion.
        is_sound: whether the covariance is, where covariances are shown.
    """

    position: tuple[float, float, float]
    wxyz: tuple[float, float, float, float]
    is_sound: bool


def place_of(message: messages.Odometry, *, with_covariance: bool) -> TrailPlace:
    """Return the place of a pose."""
    p, q = message.pose.pose.position, message.pose.pose.orientation
    is_known_sound = not with_covariance or is_sound(message)
    return TrailPlace((p.x, p.y, p.z), (q.w, q.x, q.y, q.z), is_known_sound)


def has_moved(new: TrailPlace, last: TrailPlace, distance: float, angle: float) -> bool:
    """Return whether a pose is at least this far (m) or turned this much (rad) from the last."""
    if dist(new.position, last.position) >= distance:
        return True
    return angle_between(new.wxyz, last.wxyz) >= angle


def is_sound(message: messages.Odometry) -> bool:
    """Return whether the covariance of a pose is finite, of a sensible size, nowhere negative."""
    entries = message.pose.covariance
    return bool(np.abs(entries).max() <= LARGEST and entries[::7].min() >= 0)
