"""Colours of the scene that each page takes from its theme, since the scene is shared."""

from __future__ import annotations

from typing import TypedDict

from webviz.api.nodes import Rgb


class Scheme(TypedDict):
    """Colours of one theme: behind the scene, and of texts and grids without a colour."""

    background: Rgb
    text: Rgb
    grid: Rgb


SCHEMES = {
    "dark": Scheme(background=(48, 48, 48), text=(255, 255, 255), grid=(160, 160, 164)),
    "light": Scheme(background=(214, 219, 225), text=(20, 22, 26), grid=(84, 88, 96)),
}
"""Colours by theme. Dark is RViz's; light is dark enough for data in RViz's white, yellow and
green."""

BACKGROUND: Rgb = SCHEMES["dark"]["background"]
"""Background of pictures, unless the config has another."""

TEXT_CODE = (31, 30, 31)
"""Steps of 32 per channel in which texts have their colours: that of the theme."""
