"""Displays of places on the earth as people see them."""

from __future__ import annotations

import io
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import PIL.Image
from waiting import until

from webviz.api.views import Orbit
from webviz.data.geo import Geodetic, TilePlane
from webviz.shell.testing import Harness
from webviz_displays.outdoors import AerialMap, GeoPath, NavSatFix

HERE = Geodetic(48.1, 11.5, 500.0)
ZOOM = 19
EDGE = 64
"""Edge of a tile in pixels."""
FIELDS = np.array([(86, 125, 70), (122, 140, 80), (150, 137, 96), (70, 108, 62)], np.uint8)
ROAD = (190, 188, 182)


def tile(x: int, y: int) -> bytes:
    """Fields with roads between them, which go on in the next tile."""
    rows, columns = np.indices((EDGE, EDGE)) + np.array([y * EDGE, x * EDGE])[:, None, None]
    field = (columns + rows // 3) // 90 * 7 + (rows - columns // 5) // 70 * 3
    cells = FIELDS[field % len(FIELDS)]
    cells[((columns + rows // 3) % 180 < 6) | ((rows - columns // 5) % 140 < 6)] = ROAD
    file = io.BytesIO()
    PIL.Image.fromarray(cells).save(file, "PNG")
    return file.getvalue()


def offset(east: float, north: float) -> dict[str, float]:
    """A place some metres from HERE."""
    degree = 111_200.0
    longitude = HERE.longitude + east / degree / math.cos(math.radians(HERE.latitude))
    return {"latitude": HERE.latitude + north / degree, "longitude": longitude, "altitude": 500.0}


def test_each_display_has_a_picture_of_its_own(
    webviz_harness: Callable[..., Harness], tmp_path: Path
) -> None:
    for x, y in TilePlane(HERE, ZOOM).around(1):
        path = tmp_path / f"{ZOOM}/{x}/{y}.png"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(tile(x, y))
    displays = (
        AerialMap(object_uri=str(tmp_path), zoom=ZOOM, blocks=1, alpha=1.0, enabled=False),
        GeoPath(enabled=False),
        NavSatFix(radius=1.5, enabled=False),
    )
    view = Orbit(distance=130, yaw=-1.4, pitch=0.9)
    harness = webviz_harness(*displays, view=view)
    harness.transform("map", "gps")
    for display in displays:
        name = type(display).__name__
        harness.set("enabled", True, name)
        harness.settle()
        for step in range(12):
            values = offset(5.0 * step - 55.0, 12.0 * math.sin(0.4 * step))
            fix = values | {
                "position_covariance": [16.0, 6.0, 0, 6.0, 9.0, 0, 0, 0, 25.0],
                "position_covariance_type": 3,
            }
            harness.publish("/gps/fix", "sensor_msgs/msg/NavSatFix", fix, frame="gps")
            harness.settle()
        corners = [(0, 5), (20, 10), (45, -5), (40, -40), (-20, -45)]
        path = {"poses": [{"pose": {"position": offset(*each)}} for each in corners]}
        harness.publish("/geo_path", "geographic_msgs/msg/GeoPath", path)
        harness.wait_until_drawn(name)
        until(lambda name=name: "Loading" not in harness.status(name).text, turn=harness.settle)
        folder = {"AerialMap": "aerial_map", "GeoPath": "geo_path", "NavSatFix": "nav_sat_fix"}[
            name
        ]
        harness.check_picture(f"{folder}/default")
        if name != "AerialMap":
            harness.set("enabled", False, name)
