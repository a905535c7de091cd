"""The cameras of browsers: where they begin, and where they are moved to."""

from __future__ import annotations

import math

import numpy as np
import viser

from webviz.views import View

FIELD_OF_VIEW = math.pi / 4
"""Vertical; RViz's, which comes from Ogre."""


def set_view(server: viser.ViserServer, view: View) -> None:
    """Let browsers that join begin with RViz's Orbit view.

    The camera stands at `distance` from the focal point, in the direction of yaw and pitch.
    """
    camera = server.initial_camera
    camera.look_at = view.focal_point
    camera.position = _position(view)
    camera.up = (0.0, 0.0, 1.0)
    camera.fov = FIELD_OF_VIEW


def move_cameras(server: viser.ViserServer, view: View) -> None:
    """Move the camera of every browser that looks now to where `set_view` would have begun."""
    for client in server.get_clients().values():
        with client.atomic():
            client.camera.position = _position(view)
            client.camera.look_at = view.focal_point


def _position(view: View) -> np.ndarray:
    direction = (
        math.cos(view.yaw) * math.cos(view.pitch),
        math.sin(view.yaw) * math.cos(view.pitch),
        math.sin(view.pitch),
    )
    return np.array(view.focal_point) + view.distance * np.array(direction)
