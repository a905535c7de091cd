"""Views: how a camera looks at the scene, as RViz has them."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec


class View(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The camera: RViz's Orbit view, in metres and radians."""

    type: Literal["Orbit"] = "Orbit"
    distance: Annotated[float, msgspec.Meta(gt=0, le=1e6)] = 10.0
    yaw: float = 0.785398
    pitch: Annotated[float, msgspec.Meta(ge=-1.5698, le=1.5698)] = 0.785398
    focal_point: tuple[float, float, float] = (0.0, 0.0, 0.0)
