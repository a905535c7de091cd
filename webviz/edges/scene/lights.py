"""The lights of a scene."""

from __future__ import annotations

import math

import viser


def add_lights(scene: viser.SceneApi) -> None:
    """One that shows plain colours, until `shade.js` shades them.

    viser's own lights are too bright without tone mapping, and its image lighting stalls a browser
    without a GPU for seconds.
    """
    scene.configure_environment_map(None)
    scene.configure_default_lights(False, cast_shadow=False)
    scene.add_light_ambient("/lights/ambient", intensity=math.pi)
