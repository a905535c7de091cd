"""A point is as large as its display says."""

from __future__ import annotations

import contextlib
import math

import numpy as np
import playwright.sync_api as playwright
import pytest

from webviz.api.nodes import Points
from webviz.api.views import Orbit
from webviz.shell.pictures.headless_renderer import HeadlessRenderer


def test_a_point_has_its_edge_in_metres(browser: playwright.Browser) -> None:
    with contextlib.closing(HeadlessRenderer(browser, 300, 200)) as renderer:
        renderer.look(Orbit(distance=4.0))
        renderer.scene.upsert("g", "point", Points(np.zeros((1, 3), np.float32), (255, 0, 0), 0.5))
        renderer.scene.flush()
        for height in (200, 400):
            renderer.resize(300, height)
            red = renderer.capture()[..., 0] > 150
            edge = 0.5 * height / 2 / math.tan(math.pi / 8) / 4.0
            for along in (0, 1):
                assert np.ptp(np.nonzero(red)[along]) + 1 == pytest.approx(edge, abs=1)
