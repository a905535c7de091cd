"""A fault of a robot's description, which a simulated robot publishes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed", exc_type=ImportError)

from examining import live_findings
from robots import DEMO

from webviz.api.finding import CauseLevel
from webviz.shell.doctor.examination import ROUNDS
from webviz.shell.testing.live import LiveViewer
from webviz_displays.tf import TF

CAMERA = """
<link name="camera_link"/><link name="camera_optical_frame"/>
<joint name="camera" type="fixed"><parent link="base_link"/><child link="camera_link"/></joint>
<joint name="optical" type="fixed"><origin rpy="{rpy}"/>
<parent link="camera_link"/><child link="camera_optical_frame"/></joint>
</robot>"""


@pytest.mark.parametrize(
    ("rpy", "ids"), [("0 0 0", ["TF025 camera_optical_frame"]), ("-1.5708 0 -1.5708", [])]
)
def test_an_optical_frame_of_a_description(
    webviz_viewer: Callable[..., LiveViewer], tmp_path: Path, rpy: str, ids: list[str]
) -> None:
    urdf = tmp_path / "robot.urdf"
    urdf.write_text(DEMO.read_text().replace("</robot>", CAMERA.format(rpy=rpy)))
    viewer = webviz_viewer(TF(), simulator={"robot": str(urdf)}, fixed_frame="map")
    viewer.wait_for(lambda: "camera_optical_frame" in viewer.viewer.snapshot().frames)
    doctor = viewer.viewer.doctor
    rounds = doctor.rounds
    viewer.wait_for(lambda: doctor.rounds >= rounds + ROUNDS)
    assert [*live_findings(viewer, CauseLevel.FRAMES)] == ids
