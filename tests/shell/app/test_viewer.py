"""A viewer from Python: how it begins and ends, what it shows, and its files."""

from __future__ import annotations

import subprocess
import sys
import threading
import urllib.request
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
from processes import no_thread_left
from refusals import refusal_of
from waiting import until

import webviz
from webviz.api import registry
from webviz.api.views import Orbit, TopDownOrtho
from webviz.commands import Load, Refresh
from webviz.data.messages import encode
from webviz.shell.testing.messages import stamped_transform
from webviz.shell.testing.source import HandFedSource
from webviz.sources import Offer

CONFIG = """\
fixed_frame: odom
displays:
- {type: Grid, name: Floor}
"""


def is_gone(url: str) -> bool:
    """Return whether no server serves a page."""
    try:
        urllib.request.urlopen(url, timeout=60).close()
    except OSError:
        return True
    return False


def test_importing_webviz_imports_neither_viser_nor_rclpy() -> None:
    script = (
        "import sys, webviz; "
        "assert 'Viewer' in dir(webviz); "
        "assert not {'viser', 'rclpy', 'playwright'} & sys.modules.keys()"
    )
    subprocess.run([sys.executable, "-c", script], check=True)


def test_a_name_that_webviz_lacks_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'Viewr'"):
        webviz.Viewr  # noqa: B018  # pyright: ignore[reportAttributeAccessIssue]


def test_a_list_that_allows_everything_is_reported(
    source: HandFedSource, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    config = tmp_path / "lab.yaml"
    config.write_text("version: 1\npublish: [/goal_pose, /*]\n")
    with webviz.Viewer(config, port=0, source=source):
        assert "The pattern /* lets operators publish and call everything." in caplog.text
    caplog.clear()
    with webviz.Viewer(config, port=0, source=source, publish=False):
        assert "The pattern" not in caplog.text


def test_the_page_is_there_as_long_as_the_block(source: HandFedSource) -> None:
    with no_thread_left(), webviz.Viewer(port=0, source=source) as viewer:
        assert b"<html" in urllib.request.urlopen(viewer.url, timeout=60).read(4000)
    assert is_gone(viewer.url)
    viewer.close()  # again is no error


def test_without_a_config_the_usual_displays_are_shown(source: HandFedSource) -> None:
    with webviz.Viewer(port=0, source=source) as viewer:
        names = [display.name for display in viewer.displays]
    assert names == ["Grid", "TF", "RobotModel", "LaserScan", "Map", "Path", "Odometry"]


def test_a_config_opens_in_another_frame(source: HandFedSource, tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text(CONFIG)
    with webviz.Viewer(path, port=0, source=source, fixed_frame="/base") as viewer:
        assert viewer.fixed_frame == "base"
        assert [display.name for display in viewer] == ["Floor"]
        assert viewer.path == str(path)


def test_a_config_that_is_missing_is_refused(source: HandFedSource) -> None:
    sentence = refusal_of(lambda: webviz.Viewer("nowhere.yaml", port=0, source=source))
    assert sentence == "Cannot read nowhere.yaml: No such file or directory."


def test_a_taken_port_is_refused_and_leaves_nothing(viewer: webviz.Viewer) -> None:
    with no_thread_left():
        sentence = refusal_of(lambda: webviz.Viewer(port=viewer.port, source=HandFedSource()))
    assert "is in use" in sentence


def test_after_the_end_everything_is_refused(source: HandFedSource) -> None:
    with webviz.Viewer(port=0, source=source) as viewer:
        grid = viewer["Grid"]
    assert refusal_of(viewer.reset) == "The viewer is closed. Create a new one."
    assert refusal_of(grid.remove) == "The viewer is closed. Create a new one."


def test_a_part_that_hangs_does_not_keep_the_others_from_ending(
    caplog: pytest.LogCaptureFixture,
) -> None:
    hangs, is_stuck, goes_on, closed = (threading.Event() for _ in range(4))

    class Stuck(HandFedSource):
        def offers(self) -> Mapping[str, Offer]:
            if hangs.is_set():
                is_stuck.set()
                goes_on.wait()
            return super().offers()

        def close(self) -> None:
            closed.set()

    viewer = webviz.Viewer(port=0, source=Stuck())
    hangs.set()
    assert is_stuck.wait(60)
    viewer.close()
    assert caplog.records[0].getMessage() == "The frame loop did not close within 1.5 s."
    assert closed.wait(60)
    until(lambda: is_gone(viewer.url))
    goes_on.set()


@pytest.mark.parametrize(
    ("value", "text"), [(3, "`3`"), (None, "nothing"), (b"odom", "`b'odom'`"), (["a"], "`['a']`")]
)
def test_arguments_that_are_not_text_are_refused_in_one_sentence(
    viewer: webviz.Viewer, value: Any, text: str
) -> None:
    def set_frame() -> None:
        viewer.fixed_frame = value

    before = viewer.fixed_frame
    assert refusal_of(set_frame) == f"SetFixedFrame.frame: expected text, got {text}."
    assert refusal_of(lambda: viewer.remove_view(value)).startswith(
        "RemoveView.name: expected text"
    )
    assert refusal_of(lambda: viewer.do(Load(value, "x"))).startswith("Load.text: expected text")
    assert viewer.fixed_frame == before


@pytest.mark.parametrize(("value", "text"), [([1], "`[1]`"), (None, "nothing"), (3, "`3`")])
def test_arguments_that_are_not_paths_are_refused_in_one_sentence(
    viewer: webviz.Viewer, value: Any, text: str
) -> None:
    for method in (viewer.open, viewer.save, viewer.open_recording):
        assert refusal_of(lambda method=method: method(value)) == (
            f"path: expected a path, got {text}."
        )
    assert refusal_of(lambda: viewer.record(value)) == f"folder: expected a path, got {text}."


@pytest.mark.parametrize("value", [[1], b"a", {}])
def test_arguments_that_are_not_numbers_are_refused_in_one_sentence(
    viewer: webviz.Viewer, value: Any
) -> None:
    sentence = f"expected a number, got `{value}`."
    assert refusal_of(lambda: viewer.play(value)) == f"rate: {sentence}"
    assert refusal_of(lambda: viewer.rewind(value)) == f"seconds: {sentence}"
    assert refusal_of(lambda: viewer.save_last(value)) == f"seconds: {sentence}"


def test_waiting_ends_with_stop(viewer: webviz.Viewer) -> None:
    waiting = threading.Thread(target=viewer.wait)
    waiting.start()
    viewer.stop()
    waiting.join(60)
    assert not waiting.is_alive()


def test_global_options_are_set_and_checked(viewer: webviz.Viewer) -> None:
    viewer.fixed_frame = "odom"
    viewer.background = (1, 2, 3)
    viewer.frame_rate = 20.0
    assert (viewer.fixed_frame, viewer.background, viewer.frame_rate) == ("odom", (1, 2, 3), 20.0)

    def make_it_too_bright() -> None:
        viewer.background = (1, 2, 300)

    assert "background[2]" in refusal_of(make_it_too_bright)
    assert viewer.background == (1, 2, 3)


def test_frames_and_topics_are_known(viewer: webviz.Viewer, source: HandFedSource) -> None:
    transform = stamped_transform("map", "base", source.now)
    name = "tf2_msgs/msg/TFMessage"
    source.put("/tf_static", name, encode(name, {"transforms": [transform]}))
    viewer.do(Refresh())
    assert viewer.frames == ("base", "map")
    assert viewer.topics == {"/tf_static": (name,)}
    assert viewer.statuses["Fixed Frame"].level is webviz.Level.OK
    viewer.reset()
    assert viewer.frames == ("base", "map")  # of static transforms


def test_time_stands_still_while_paused(viewer: webviz.Viewer, source: HandFedSource) -> None:
    viewer.pause()
    paused = viewer.state.clock
    source.now += 1_000_000_000
    viewer.do(Refresh())
    assert viewer.state.clock.is_paused
    assert viewer.state.clock.ros_ns == paused.ros_ns
    viewer.resume()
    assert viewer.state.clock.ros_ns == source.now


def test_a_config_is_saved_changed_and_opened_again(viewer: webviz.Viewer, tmp_path: Path) -> None:
    assert refusal_of(viewer.save) == "This config has no file yet. Choose a name."
    viewer.add("Grid", name="Floor")
    path = tmp_path / "floor.yaml"
    assert viewer.save(path) == path
    assert not viewer.is_changed
    viewer["Floor"].cell_size = 2.0
    assert viewer.is_changed
    viewer.open(path)
    assert viewer["Floor"].cell_size == 1.0
    assert not viewer.is_changed
    viewer["Floor"].cell_size = 3.0
    viewer.save()
    assert "cell_size: 3.0" in path.read_text()


def test_a_failed_opening_changes_nothing(viewer: webviz.Viewer, tmp_path: Path) -> None:
    viewer.add("Grid")
    assert "No such file" in refusal_of(lambda: viewer.open(tmp_path / "no.yaml"))
    assert "Grid" in viewer


def test_the_config_is_values_and_text(viewer: webviz.Viewer) -> None:
    viewer.config = CONFIG
    assert viewer.config["displays"] == [{"type": "Grid", "name": "Floor"}]
    assert "fixed_frame: odom" in viewer.config_text
    viewer.config = {"fixed_frame": "map", "displays": [{"type": "Axes"}]}
    assert [display.type for display in viewer] == ["Axes"]

    def set_nonsense() -> None:
        viewer.config = {"fixed_frme": "map"}

    assert "did you mean `fixed_frame`" in refusal_of(set_nonsense)
    assert [display.type for display in viewer] == ["Axes"]


def test_a_display_of_a_plug_in_can_be_added(source: HandFedSource, tmp_path: Path) -> None:
    plugin = tmp_path / "mine.py"
    plugin.write_text("import webviz\nclass Mine(webviz.Display):\n    size: float = 1.0\n")
    try:
        with webviz.Viewer(port=0, source=source, plugins=[plugin]) as viewer:
            assert viewer.add("Mine", size=2.0).size == 2.0
    finally:
        registry.register(str(plugin), {})


def test_a_view_is_assigned_by_value_and_by_name(viewer: webviz.Viewer) -> None:
    above = {"type": "TopDownOrtho", "scale": 50.0}
    viewer.save_view("Above", above)
    viewer.view = {"distance": 3.0}
    assert viewer.view == Orbit(distance=3.0)
    viewer.view = "Above"
    assert viewer.view == viewer.views["Above"] == TopDownOrtho(scale=50.0)
    assert viewer.config["view"].items() >= above.items()

    def look(view: object) -> Callable[[], None]:
        return lambda: setattr(viewer, "view", view)

    assert "did you mean `Above`" in refusal_of(look("Abve"))
    assert refusal_of(look({"type": "Orbit", "distance": -1})).startswith(
        "Invalid view: distance: expected > 0, got -1."
    )
    assert refusal_of(look({"type": "TopDown"})) == (
        "Invalid view: type: "
        "expected Orbit, XYOrbit, ThirdPersonFollower, FPS, FrameAligned or TopDownOrtho, "
        "got `TopDown`."
    )
    viewer.remove_view("Above")
    assert viewer.views == {}
    assert refusal_of(lambda: viewer.save_view("Here")).startswith("No browser is connected")
