"""Messages shown as text."""

from __future__ import annotations

import numpy as np
import pytest

from webviz.data.messages import (
    FrameTransform,
    Header,
    JointState,
    LaserScan,
    OccupancyGrid,
    Path,
    PoseStampedSequence,
    String,
    TFMessage,
    Time,
    message_class,
    to_text,
)
from webviz.data.messages.definitions import DEFINITIONS


def test_a_message_is_shown_field_by_field_in_the_order_of_its_definition():
    text = to_text(JointState(Header(Time(5, 7), "base"), ["left", "right"], np.array([0.5, -1])))
    assert text == (
        "header:\n  stamp:\n    sec: 5\n    nanosec: 7\n  frame_id: 'base'\n"
        "name:\n- 'left'\n- 'right'\nposition: [0.5, -1]\nvelocity: []\neffort: []"
    )


def test_long_arrays_are_cut_and_their_size_is_said():
    text = to_text(LaserScan(ranges=np.arange(720, dtype=np.float32)))
    assert "ranges: [0, 1, 2, 3, 4, 5, ... (720 float32)]" in text.splitlines()


def test_long_strings_are_cut_and_stay_on_one_line():
    (line,) = to_text(String("<robot>\n" * 1000)).splitlines()
    assert line.endswith("... (8000 characters)")
    assert len(line) < 200


def test_transforms_are_shown_one_by_one_and_cut_after_ten():
    transform = FrameTransform("map", "odom", 12, (1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0))
    lines = to_text(TFMessage([transform] * 25)).splitlines()
    assert lines[1:4] == ["- parent: 'map'", "  child: 'odom'", "  stamp_ns: 12"]
    assert lines.count("- parent: 'map'") == 10
    assert lines[-1] == "- ... (25 in all)"


def test_poses_of_a_path_are_shown_as_ros_shows_them():
    poses = PoseStampedSequence(np.ones((1, 3)), np.ones((1, 4)), np.array([10**9]), ["map"])
    lines = to_text(Path(poses=poses)).splitlines()
    assert "- header:" in lines
    assert "    stamp:" in lines
    assert "      x: 1" in lines


@pytest.mark.parametrize("max_lines", [1, 5, 100])
def test_text_is_never_longer_than_asked(max_lines):
    poses = PoseStampedSequence(
        np.ones((500, 3)), np.ones((500, 4)), np.ones(500, np.int64), ["map"] * 500
    )
    lines = to_text(Path(poses=poses), max_lines).splitlines()
    assert len(lines) == max_lines
    assert lines[-1] == "..."


@pytest.mark.parametrize("name", ["visualization_msgs/msg/MarkerArray", *DEFINITIONS])
def test_any_message_can_be_shown(name):
    assert to_text(message_class(name)())


def test_numbers_keep_millimetres_at_utm_coordinates():
    grid = OccupancyGrid()
    assert "resolution: 0" in to_text(grid)
    assert "position: [4649776.12]" in to_text(JointState(position=np.array([4649776.12])))
