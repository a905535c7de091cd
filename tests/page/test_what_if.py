"""The numbers of a frame that is tried, in the page."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest
from playwright.sync_api import Locator, expect

from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.commands import MoveFrame, TryFrame
from webviz.data.rotations import to_rpy, w_first
from webviz.shell.testing.messages import stamped_transform, turned

POSE = (0.3, 0.0, 0.2, 0.0, 0.0, math.radians(30.0))


@pytest.fixture
def trial(viewer: PageBench, viewer_tab: ViewerTab) -> ViewerTab:
    """The tab while a frame is tried."""
    mounted = stamped_transform("base_link", "laser", 0, POSE[:3], turned(yaw=POSE[5]))
    viewer.publish("/tf_static", "tf2_msgs/msg/TFMessage", {"transforms": [mounted]})
    viewer.turn()
    viewer.do(TryFrame("laser"))
    viewer_tab.wait_for(card(viewer_tab).is_visible)
    return viewer_tab


def card(tab: ViewerTab) -> Locator:
    return tab.page.get_by_role("region", name="What if")


def number(tab: ViewerTab, name: str) -> Locator:
    return card(tab).get_by_role("spinbutton", name=name, exact=True)


def pose(viewer: PageBench) -> Sequence[float]:
    """The pose of the frame: x, y, z in metres, and roll, pitch, yaw in radians."""
    transform = viewer.viewer.context.buffer.lookup("base_link", "laser", 0)
    return (*transform.translation, *to_rpy(tuple(w_first(transform.rotation))))


def wait_for_pose(tab: ViewerTab, *expected: float) -> None:
    tab.wait_for(lambda: pose(tab.viewer) == pytest.approx(expected, abs=1e-9))


def test_numbers_are_shown_with_units_and_degrees(viewer: PageBench, trial: ViewerTab) -> None:
    expect(number(trial, "x")).to_have_value("0.3")
    expect(number(trial, "yaw")).to_have_value("0.523599")
    expect(card(trial)).to_contain_text("rad (30°)")
    viewer.do(MoveFrame(*POSE[:5], 0.0))
    expect(number(trial, "yaw")).to_have_value("0")


def test_a_number_is_typed_in_degrees(viewer: PageBench, trial: ViewerTab) -> None:
    yaw = number(trial, "yaw")
    yaw.fill("90°")
    yaw.press("Enter")
    wait_for_pose(trial, *POSE[:5], math.pi / 2)
    (command,) = viewer.commands
    assert isinstance(command, MoveFrame)
    assert command.yaw == 1.57079632679  # to 12 digits
    roll = number(trial, "roll")
    roll.fill("much")
    roll.press("Enter")
    expect(card(trial).get_by_role("alert")).to_contain_text("is not a number")
    assert viewer.commands == [command]


def test_arrow_keys_move_the_frame(trial: ViewerTab) -> None:
    number(trial, "x").press("ArrowUp")
    wait_for_pose(trial, 0.31, *POSE[1:])
