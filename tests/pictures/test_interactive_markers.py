"""Interactive markers as people see them."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from webviz.api.views import Orbit
from webviz.shell.testing import LiveViewer
from webviz_displays.grid import Grid
from webviz_displays.interactive_markers import InteractiveMarkers

pytest.importorskip("rclpy", reason="a live viewer needs rclpy")

from basic_controls import basic_controls
from marker_server import MarkerServer

VIEW = Orbit(distance=15.0, yaw=0.6, pitch=0.7, focal_point=(0.5, -2.5, 0.0))


def test_controls_have_arrows_rings_boxes_and_titles(
    webviz_viewer: Callable[..., LiveViewer], webviz_domain: int
) -> None:
    markers = InteractiveMarkers(interactive_markers_namespace="/basic")
    viewer = webviz_viewer(markers, Grid(), view=VIEW, fixed_frame="base_link")
    server = MarkerServer("/basic", webviz_domain, basic_controls())
    server.transform("base_link", "moving_frame", 0.5, 0.0, 0.0)
    viewer.wait_for(lambda: "c0/m13/box" in viewer.nodes("InteractiveMarkers"), "all markers")
    viewer.wait_for(lambda: "c1/m11/box" in viewer.nodes("InteractiveMarkers"), "the moving one")
    viewer.check_picture("interactive_markers/default")
    server.close()
