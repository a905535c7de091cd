"""The camera with which browsers begin."""

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
    direction = np.array(
        [
            math.cos(view.yaw) * math.cos(view.pitch),
            math.sin(view.yaw) * math.cos(view.pitch),
            math.sin(view.pitch),
        ]
    )
    camera = server.initial_camera
    camera.look_at = view.focal_point
    camera.position = np.array(view.focal_point) + view.distance * direction
    camera.up = (0.0, 0.0, 1.0)
    camera.fov = FIELD_OF_VIEW
