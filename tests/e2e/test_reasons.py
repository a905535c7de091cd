"""Every reason why a message has no place: provoked over DDS, read on the page, seen to clear."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import pytest
from displays_panel import GLOBAL_OPTIONS, DisplaysPanel
from pages import COARSE

from webviz.shell.pictures.browser import Page

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from robot import TF, Robot, Scan, transforms

SECOND = 1_000_000_000
ROWS = ("Unseen", "Trees", "Ahead", "Old", "Clocks", "Nameless", "Queue", "Slash", "Far")
OK = "Transform: Transform OK"


@pytest.fixture(scope="module")
def robot(ros_env: dict[str, str]) -> Iterator[Robot]:
    """Drives in "map" all the time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        robot = Robot(int(ros_env["ROS_DOMAIN_ID"]))
    robot.links = {("map", "odom"): 0.0, ("odom", "base_link"): 0.0}
    yield robot
    robot.close()


@pytest.fixture(scope="module")
def page(robot: Robot, view: Callable[..., Page]) -> Page:
    """A viewer with a display for each reason."""
    rows = [f"- {{type: LaserScan, name: {row}, topic: /{row.lower()}}}" for row in ROWS]
    rows += ["- {type: TF, show_names: true}", "- {type: Axes, reference_frame: out}"]
    config = "\n".join(["fixed_frame: map", "displays:", *rows, ""])
    return view(config, height=900, resolution=COARSE)


def select(page: Page, row: str) -> None:
    DisplaysPanel(page).select(row)


def wait_for(page: Page, *words: str) -> None:
    DisplaysPanel(page).wait_for(*words)


def wait_until_ok(page: Page, *gone: str) -> None:
    """Wait until the transform is there, and the sentence is not."""
    side = DisplaysPanel(page)
    side.wait_for(OK)
    assert not [words for words in gone if words in side.text()]


def test_an_unknown_frame_is_reported_with_the_nearest_name(robot: Robot, page: Page) -> None:
    robot.scans["/unseen"] = Scan("base_lnk")
    select(page, "Unseen")
    wait_for(page, 'Frame "base_lnk" does not exist. Did you mean "base_link"?')
    robot.links["base_link", "base_lnk"] = 0.0
    wait_until_ok(page, "does not exist")


def test_two_trees_are_reported_by_their_roots(robot: Robot, page: Page) -> None:
    robot.links["world", "drone"] = 0.0
    robot.scans["/trees"] = Scan("drone")
    select(page, "Trees")
    wait_for(
        page,
        '"drone" and "map" are in two trees that no transform connects: one has the root "world", '
        'the other "map".',
    )
    robot.links["map", "world"] = 0.0
    wait_until_ok(page, "two trees")


def test_a_stamp_ahead_of_the_newest_transform_names_the_link_that_lags(
    robot: Robot, page: Page
) -> None:
    now_ns = time.time_ns()
    robot.publish(
        "/tf",
        TF,
        transforms(
            ("base_link", "arm", now_ns - 100_000_000, 1.0), ("base_link", "arm", now_ns, 1.0)
        ),
    )
    robot.scan("/ahead", "arm", now_ns)  # until the topic is connected
    select(page, "Ahead")
    wait_for(page, "/robot (reliable, volatile)")
    robot.scan("/ahead", "arm", now_ns + 83_000_000)
    wait_for(
        page,
        'The stamp is 83 ms ahead of the newest transform "base_link" → "arm" (from /robot), which '
        "has stopped",
    )
    robot.links["base_link", "arm"] = 0.0
    wait_until_ok(page, "83 ms")


def test_the_status_of_a_stamp_older_than_the_cache_gives_the_difference(
    robot: Robot, page: Page
) -> None:
    now_ns = time.time_ns()
    history = [("map", "beacon", now_ns - i * SECOND, 1.0) for i in range(12, 0, -1)]
    robot.publish("/tf", TF, transforms(*history))
    robot.links["map", "beacon"] = 0.0
    robot.scans["/old"] = Scan("beacon", -15.0)
    select(page, "Old")
    wait_for(
        page,
        's older than the oldest transform kept of "map" → "beacon"',
        "10 s are kept. The data arrives too late",
    )
    robot.scans["/old"] = Scan("beacon")
    wait_until_ok(page, "too late")


def test_wall_time_against_simulated_time_is_recognised(robot: Robot, page: Page) -> None:
    robot.scans["/clocks"] = Scan("base_link", stamp_ns=12_500_000_000)
    select(page, "Clocks")
    wait_for(
        page,
        "Two clocks: the data (12.5 s) is stamped with simulated time or time since boot",
        "Set use_sim_time alike on all nodes",
    )
    robot.scans["/clocks"] = Scan("base_link")
    wait_until_ok(page, "Two clocks")


def test_an_empty_frame_id_is_named(robot: Robot, page: Page) -> None:
    robot.scans["/nameless"] = Scan("")
    select(page, "Nameless")
    wait_for(page, "The frame_id is empty. The publisher must name the frame")
    robot.scans["/nameless"] = Scan("base_link")
    wait_until_ok(page, "frame_id is empty")


def test_the_status_of_a_queue_that_overflows_gives_a_sufficient_size(
    robot: Robot, page: Page
) -> None:
    robot.links["base_link", "camera"] = -0.9
    robot.scans["/queue"] = Scan("camera")
    select(page, "Queue")
    wait_for(
        page,
        "The queue of 10 messages is full before their transforms arrive, which are",
        "raise the filter size to",
        "messages were given up",
    )
    robot.links["base_link", "camera"] = 0.0
    wait_until_ok(page, "The queue of 10")


def test_a_leading_slash_is_tolerated(robot: Robot, page: Page) -> None:
    robot.scans["/slash"] = Scan("/base_link")
    select(page, "Slash")
    wait_until_ok(page)


def test_links_that_compose_to_infinity_end_nothing_and_are_named(robot: Robot, page: Page) -> None:
    select(page, "Far")
    stamp_ns = time.time_ns()
    links = [("map", "far", stamp_ns, 1e308), ("far", "out", stamp_ns, 1e308)]
    robot.publish("/tf", TF, transforms(*links))
    robot.scans["/far"] = Scan("out", stamp_ns=stamp_ns)
    robot.scans["/slash"] = Scan("/base_link")
    wait_for(
        page,
        '"out" is more than 1e+12 m from "map", too far to draw. The longest link on the way '
        'is "map" → "far" with 1e+308 m.',
    )
    select(page, "Slash")
    wait_until_ok(page)


def test_a_fixed_frame_that_does_not_exist_is_typed_and_kept_with_the_reason(
    robot: Robot, page: Page
) -> None:
    side = DisplaysPanel(page)
    side.select(GLOBAL_OPTIONS)
    field = side.field("fixed_frame")
    field.fill("mapp")
    field.press("Enter")
    side.wait_for('Fixed frame "mapp" does not exist. Did you mean "map"?')
    assert field.input_value() == "mapp"
    field.fill("map")
    field.press("Enter")
    side.wait_for("Fixed Frame: OK")
