"""Services, parameters and goals over Zenoh, used in the page of a real browser."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import playwright.sync_api as playwright
import pytest
from pages import COARSE
from waiting import until
from zenoh_robot import ZenohRobot

import webviz
from webviz.data.messages import interfaces
from webviz.shell.pictures.browser import Page
from webviz.sources.zenoh.source import ZenohSource

SPIN = "own_zenoh_msgs/action/Spin"
SPIN_TEXT = """float32 target_yaw
---
builtin_interfaces/Duration total_elapsed_time
---
float32 angular_distance_traveled
"""
SET_BOOL = "std_srvs/srv/SetBool"
CONFIG = """\
version: 1
publish: [/light, /spin, /robot/set_parameters]
displays: []
panels:
- {type: ServiceCall, service: /light}
- {type: Parameters, editable: [/robot]}
- {type: ActionGoal, action: /spin}
"""
DOUBLE = 3
"""Kind of a parameter in rcl_interfaces/msg/ParameterType."""


@pytest.fixture
def page(
    source: ZenohSource, robot: ZenohRobot, browser: playwright.Browser, tmp_path: Path
) -> Iterator[Page]:
    """The page of a viewer over Zenoh."""
    interfaces.action(SPIN, SPIN_TEXT)
    config = tmp_path / "robot.yaml"
    config.write_text(CONFIG)
    with webviz.Viewer(config, port=0, source=source) as viewer:
        page = Page(browser, viewer.url, 1100, 800, resolution=COARSE)
        yield page
        assert page.errors == []
        page.close()


def show_panel(page: Page, name: str) -> None:
    head = page.tab.get_by_role("tab", name=name, exact=True)
    page.wait_for(lambda: head.count() == 1, name)
    head.click()


def press(page: Page, name: str) -> None:
    """Press a button as soon as it can be pressed."""
    button = page.tab.get_by_role("button", name=name, exact=True)
    page.wait_for(lambda: button.count() == 1 and button.is_enabled(), name)
    button.click()


def is_shown(page: Page, text: str) -> Callable[[], bool]:
    return lambda: text in page.tab.inner_text("body")


def enter(page: Page, field: str, text: str) -> None:
    box = page.tab.get_by_role("textbox", name=field, exact=True)
    page.wait_for(lambda: box.count() == 1, field)
    box.fill(text)
    box.press("Enter")


def test_a_service_is_called(page: Page, robot: ZenohRobot) -> None:
    requests: list[bool] = []

    def answer(request: Any) -> dict[str, Any]:
        requests.append(request.data)
        return {"success": True, "message": "The lamp is on."}

    robot.service("/light", SET_BOOL, answer)
    show_panel(page, "Service call")
    enter(page, "data", "true")
    press(page, "Call")
    page.wait_for(is_shown(page, "The lamp is on."), "the response")
    assert requests == [True]


def test_parameters_are_listed_and_set(page: Page, robot: ZenohRobot) -> None:
    values = {"max_speed": 0.5, "max_turn": 1.25}
    service = "rcl_interfaces/srv/"

    def get(request: Any) -> dict[str, Any]:
        return {"values": [{"type": DOUBLE, "double_value": values[n]} for n in request.names]}

    def describe(request: Any) -> dict[str, Any]:
        return {"descriptors": [{"name": n, "type": DOUBLE} for n in request.names]}

    def put(request: Any) -> dict[str, Any]:
        results = []
        for each in request.parameters:
            is_slow = each.value.double_value <= 2.0
            if is_slow:
                values[each.name] = each.value.double_value
            results.append({"successful": is_slow, "reason": "" if is_slow else "Too fast."})
        return {"results": results}

    for name, kind, answer in (
        ("list", "ListParameters", lambda _: {"result": {"names": [*values]}}),
        ("get", "GetParameters", get),
        ("describe", "DescribeParameters", describe),
        ("set", "SetParameters", put),
    ):
        robot.service(f"/robot/{name}_parameters", service + kind, answer)
    robot.publisher("/parameter_events", "rcl_interfaces/msg/ParameterEvent")
    show_panel(page, "Parameters")
    choice = page.tab.get_by_role("combobox", name="Node", exact=True)
    page.wait_for(lambda: choice.count() == 1, "the nodes")

    def has_parameters() -> bool:
        choice.fill("/robot")
        choice.press("Enter")
        return page.tab.get_by_role("textbox", name="max_turn", exact=True).count() == 1

    page.wait_for(has_parameters, "the parameters")
    field = page.tab.get_by_role("textbox", name="max_speed", exact=True)
    assert field.input_value() == "0.5"
    enter(page, "max_speed", "1.5")
    page.wait_for(lambda: values["max_speed"] == 1.5, "the value in the node")
    field.blur()
    page.wait_for(lambda: field.input_value() == "1.5", "the value of the node")
    enter(page, "max_speed", "9")
    page.wait_for(is_shown(page, "Too fast."), "the refusal")
    assert values == {"max_speed": 1.5, "max_turn": 1.25}


@pytest.mark.parametrize("is_cancelled", [False, True])
def test_a_goal_with_feedback_ends(page: Page, robot: ZenohRobot, is_cancelled: bool) -> None:
    is_over = threading.Event()

    def run(goal: Any, feedback: Callable[..., None]) -> dict[str, Any]:
        distance = 0.0
        while not is_over.wait(0.1) and distance < 100.0:
            distance += 0.25
            feedback(angular_distance_traveled=distance)
        return {"total_elapsed_time": {"sec": 3}}

    calls = robot.action("/spin", SPIN, run, is_over.set)
    show_panel(page, "Action goal")
    enter(page, "target_yaw", "1.5")
    press(page, "Send goal")
    card = page.tab.locator(".wv-goal")
    page.wait_for(lambda: card.count() == 1, "the goal")
    page.wait_for(lambda: "angular_distance_traveled" in card.inner_text(), "feedback")
    if is_cancelled:
        card.get_by_role("button", name="Cancel", exact=True).click()
        page.wait_for(lambda: "ancel" in card.locator(".wv-goal-text").inner_text(), "its end")
    else:
        is_over.set()
        page.wait_for(lambda: "ucceeded" in card.locator(".wv-goal-text").inner_text(), "its end")
    until(lambda: calls == {"send_goal": 1, "cancel_goal": int(is_cancelled), "get_result": 1})
