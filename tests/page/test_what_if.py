"""The numbers of a frame that is tried, in the page."""

from __future__ import annotations

import math

import pytest
from msgspec.structs import replace
from playwright.sync_api import expect

from tests.page.conftest import Tab
from webviz.commands import MoveFrame
from webviz.features.what_if import WhatIfStore

POSE = (0.3, 0.0, 0.2, 0.0, 0.0, math.radians(30.0))
TRIED = WhatIfStore("laser", "base_link", POSE, (), "<origin/>", "ros2 run", None)


@pytest.fixture
def trial(tab: Tab) -> Tab:
    """The tab while a frame is tried."""
    tab.loop.show(what_if=TRIED)
    tab.turn()
    return tab


def test_numbers_are_shown_with_units_and_degrees(trial: Tab) -> None:
    card = trial.page.get_by_role("region", name="What if")
    expect(card.get_by_role("spinbutton", name="x", exact=True)).to_have_value("0.3")
    expect(card.get_by_role("spinbutton", name="yaw")).to_have_value("0.523599")
    expect(card).to_contain_text("rad (30°)")
    trial.loop.show(what_if=replace(TRIED, pose=(*POSE[:5], 0.0)))
    trial.turn()
    expect(card.get_by_role("spinbutton", name="yaw")).to_have_value("0")


def test_a_number_is_typed_in_degrees(trial: Tab) -> None:
    yaw = trial.page.get_by_role("spinbutton", name="yaw")
    yaw.fill("90°")
    yaw.press("Enter")
    trial.wait_for_command(MoveFrame(*POSE[:5], 1.57079632679))  # to 12 digits
    roll = trial.page.get_by_role("spinbutton", name="roll")
    roll.fill("much")
    roll.press("Enter")
    card = trial.page.get_by_role("region", name="What if")
    expect(card.get_by_role("alert")).to_contain_text("is not a number")


def test_arrow_keys_move_the_frame(trial: Tab) -> None:
    x = trial.page.get_by_role("spinbutton", name="x", exact=True)
    x.press("ArrowUp")
    trial.wait_for_command(MoveFrame(0.31, *POSE[1:]))
