"""The examples in the documentation do what they say."""

from __future__ import annotations

import json
import re
import runpy
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import gallery
import numpy as np
import PIL.Image
import pytest
from bags import strings
from bench import Bench, Benches

import webviz
from webviz.api import registry
from webviz.api.check_registry import register_checks
from webviz.api.display import Display
from webviz.api.nodes import Instances, Lines
from webviz.api.status import Status
from webviz.commands import Load, Refresh, UseTool
from webviz.data.messages import decode, encode, register
from webviz.engine.pipeline.plugins import load
from webviz.shell.testing.messages import header
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz_displays.odometry import Odometry

EXAMPLES = Path(__file__).parents[3] / "displays/docs/examples"
T = 100_000_000_000


@pytest.fixture
def camera_view() -> Iterator[type[Display]]:
    path = EXAMPLES / "camera_view.py"
    cls = load(path)["CameraView"]
    assert issubclass(cls, Display)
    yield cls
    registry.register(str(path), {})


def publish(bench: Bench, stamp_ns: int, focal_length: float, *names: str) -> None:
    """An image of 640 x 480 pixels, its calibration, or both."""
    at = {"header": header("camera", stamp_ns), "width": 640, "height": 480}
    if "image" in names:
        bench.publish("/camera/image_raw", "sensor_msgs/msg/Image", at)
    if "info" in names:
        k = [focal_length, 0.0, 320.0, 0.0, focal_length, 240.0, 0.0, 0.0, 1.0]
        bench.publish("/camera/camera_info", "sensor_msgs/msg/CameraInfo", {**at, "k": k})


def test_camera_view_draws_an_image_with_the_calibration_of_its_stamp(
    bench: Benches, camera_view: type[Display]
) -> None:
    b = bench(camera_view(name="Camera"))
    b.transform("map", "camera", T, static=True)
    publish(b, T, 320.0, "image", "info")
    publish(b, T + 1, 640.0, "image")
    b.turn()
    _, rays = b.nodes(Lines)
    sides = [(-1, -0.75), (1, -0.75), (1, 0.75), (-1, 0.75)]
    np.testing.assert_allclose(rays.segments[:, 1], [(*side, 1) for side in sides])
    b.clock += 1.1
    level, text = b.statuses()["Sync"]
    assert level == "WARN"
    assert text.startswith(
        "Waiting for a CameraInfo on /camera/camera_info with the stamp of the Image on "
        "/camera/image_raw, 100.000 s."
    )


def test_camera_view_reports_a_camera_without_calibration(
    bench: Benches, camera_view: type[Display]
) -> None:
    b = bench(camera_view(name="Camera"))
    b.transform("map", "camera", T, static=True)
    publish(b, T, 0.0, "image", "info")
    b.turn()
    text = "The CameraInfo has no focal length. Calibrate the camera."
    assert b.statuses()["Camera"] == ("ERROR", text)


POINT = """\
std_msgs/Header header
float64 x
float64 y
"""


@pytest.mark.parametrize(
    ("x", "expected"),
    [
        (1.5, ("OK", "Showing (1.5, 2).")),
        (-1.0, ("WARN", "x is negative: -1.")),
        (np.inf, ("ERROR", "The coordinates are not finite numbers. Fix the publisher.")),
    ],
)
def test_the_display_of_rviz_tutorial_shows_a_point_in_its_frame(
    bench: Benches, x: float, expected: tuple[str, str]
) -> None:
    path = EXAMPLES / "point_2d.py"
    cls = load(path)["PointDisplay"]
    assert issubclass(cls, Display)
    try:
        register("rviz_plugin_tutorial_msgs/msg/Point2D", POINT)
        b = bench(cls(name="Point"))
        b.transform("map", "robot", T, static=True)
        point = {"header": header("robot", T), "x": x, "y": 2.0}
        b.publish("/point", "rviz_plugin_tutorial_msgs/msg/Point2D", point)
        b.turn()
        assert b.statuses()["Point"] == expected
        keys = {key for key, _, _ in b.scene.visible()}
        assert keys == (set() if expected[0] == "ERROR" else {"point"})
        if keys:
            (node,) = b.nodes(Instances)
            np.testing.assert_array_equal(node.positions, [(x, 2.0, 0.0)])
    finally:
        registry.register(str(path), {})


def test_spawn_turtle_is_a_tool_that_calls_a_service_with_the_clicked_point(bench: Benches) -> None:
    path = EXAMPLES / "spawn_turtle.py"
    statuses: list[Status] = []
    try:
        load(path)
        b = bench()
        graph = b.source.graph = RememberingGraph()
        for _ in range(2):
            b.viewer.enqueue(UseTool("Spawn Turtle", ((1.0, 2.0, 0.0),), report=statuses.append))
            b.turn()
            graph.responses["/spawn"] = encode("turtlesim/srv/Spawn_Response", {"name": "turtle2"})
        b.do(Load("publish: [/goal_pose]\n", "x.yaml"))
        b.viewer.enqueue(UseTool("Spawn Turtle", ((1.0, 2.0, 0.0),), report=statuses.append))
        (button,) = (tool for tool in b.do(Refresh()).tools if tool.name == "Spawn Turtle")
    finally:
        registry.register(str(path), {})
    _, (service, type_, request) = graph.requests
    assert (service, type_) == ("/spawn", "turtlesim/srv/Spawn")
    spawn = decode("turtlesim/srv/Spawn_Request", request)
    assert (spawn.x, spawn.y, spawn.theta, spawn.name) == (1.0, 2.0, 0.0, "")
    assert [status.text for status in statuses] == [
        "No node offers /spawn. Start one.",
        "Spawned turtle2.",
        "/spawn is not in the list `publish` of this config. Add it to the file.",
    ]
    assert button.refusal == statuses[-1].text


def test_every_example_is_listed() -> None:
    listed = (EXAMPLES / "README.md").read_text()
    assert all(f"[{path.name}]({path.name})" in listed for path in EXAMPLES.glob("*.py"))


def test_examples_that_show_something_in_the_scene_have_their_pictures() -> None:
    pictures = re.findall(r"\(pictures/(\w+)\.webp\)", (EXAMPLES / "README.md").read_text())
    assert sorted(pictures) == sorted(path.stem for path in gallery.PLUGINS)
    for name in pictures:
        with PIL.Image.open(gallery.PICTURES / f"{name}.webp") as picture:
            assert picture.size == gallery.THUMBNAIL, "run tests/support/gallery.py"


@pytest.mark.parametrize(
    ("speed", "expected"),
    [(1.0, None), (1.8, "The robot drives at 1.8 m/s; the limit is 1.5 m/s.")],
)
def test_speeding_is_a_check_of_odometry(
    webviz_harness: Callable[..., Any], speed: float, expected: str | None
) -> None:
    path = EXAMPLES / "speeding.py"
    try:
        load(path)
        harness = webviz_harness(Odometry(), fixed_frame="odom")
        harness.transform("map", "odom")

        def drive() -> None:
            twist = {"twist": {"linear": {"x": speed}}}
            harness.publish("/odom", "nav_msgs/msg/Odometry", {"twist": twist}, frame="odom")

        findings = {each.id: each.cause for each in harness.findings(publish=drive)}
        assert findings.get("DATA901") == expected
    finally:
        register_checks(str(path), [])


def test_the_test_for_ci_passes(webviz_harness: Callable[..., Any]) -> None:
    namespace = runpy.run_path(str(EXAMPLES / "test_lidar.py"))
    namespace["test_a_scan_is_drawn_where_the_laser_is"](webviz_harness)


def test_the_notebook_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = strings(*range(10)).write(tmp_path / "bag")
    next(folder.glob("*.mcap")).rename(tmp_path / "run.mcap")
    monkeypatch.chdir(tmp_path)
    cells = json.loads((EXAMPLES / "bag.ipynb").read_text())["cells"]
    scope: dict[str, Any] = {}
    for cell in cells:
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), scope)
    assert isinstance(scope["viewer"], webviz.Viewer)


def test_examples_are_short() -> None:
    for path in EXAMPLES.glob("*.*"):
        assert path.suffix == ".md" or len(path.read_text().splitlines()) < 60, path.name
