"""The lights of a scene."""

from __future__ import annotations

import math

import viser


def add_lights(scene: viser.SceneApi) -> None:
    """Adds an ambient light for plain colours, which `shade.js` then shades.

    viser's lights are too bright without tone mapping, and its image-based lighting stalls browsers
    without a GPU for seconds.
    """
    scene.configure_environment_map(None)
    scene.configure_default_lights(False, cast_shadow=False)
    scene.add_light_ambient("/lights/ambient", intensity=math.pi)
