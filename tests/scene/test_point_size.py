"""A point is as large as its display says."""

from __future__ import annotations

import math

import numpy as np
import playwright.sync_api as playwright
import pytest

from webviz.api.nodes import Points
from webviz.api.views import Orbit
from webviz.shell.pictures.studio import Studio


@pytest.mark.parametrize("height", [200, 400])
def test_a_point_has_its_edge_in_metres(browser: playwright.Browser, height: int) -> None:
    studio = Studio(browser, 300, height)
    try:
        studio.look(Orbit(distance=4.0))
        studio.scene.upsert("g", "point", Points(np.zeros((1, 3), np.float32), (255, 0, 0), 0.5))
        studio.scene.flush()
        red = studio.capture()[..., 0] > 150
    finally:
        studio.close()
    pixels_per_metre = height / 2 / math.tan(math.pi / 8) / 4.0
    for along in (0, 1):
        assert np.ptp(np.nonzero(red)[along]) + 1 == pytest.approx(0.5 * pixels_per_metre, abs=1)
