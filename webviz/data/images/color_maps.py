"""Colours for measurements, as evenly spaced stops."""

from __future__ import annotations

Rgb = tuple[int, int, int]


def _stops(hexes: str) -> tuple[Rgb, ...]:
    return tuple((int(h[:2], 16), int(h[2:4], 16), int(h[4:], 16)) for h in hexes.split())


COLOR_MAPS: dict[str, tuple[Rgb, ...]] = {
    "Grey": ((0, 0, 0), (255, 255, 255)),
    # A. Mikhailov, "Turbo, an improved rainbow colormap for visualization", 2019
    "Turbo": _stops(
        "30123b 4145ab 4675ed 39a2fc 1bcfd4 24eca6 61fc6c a4fc3b d1e834 f3c63a fe9b2d f36315 "
        "d93806 b11901 7a0402"
    ),
    # N. Smith and S. van der Walt, the default of matplotlib
    "Viridis": _stops("440154 482878 3e4989 31688e 26828e 1f9e89 35b779 6ece58 b5de2b fde725"),
    # As RViz colours clouds
    "Rainbow": _stops("ff0000 ffff00 00ff00 00ffff 0000ff ff00ff"),
}
"""Colours of each map from the lowest to the highest value."""
