"""Driving beside the frame loop, with a graph that remembers what is published."""

from __future__ import annotations

import itertools
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import pytest
from bench import Bench, Benches
from several import several
from waiting import until

from webviz.api.vehicle import STILL, Velocity
from webviz.commands import Load, SetToolProperty, Undo
from webviz.engine.driving import DrivingAnswer, VelocityControllers
from webviz.engine.driving.velocity_controller import PERIOD_S, TAIL
from webviz.features.driving import Driving
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.shell.testing.source import HandFedSource
from webviz.sources import Advertisement, NotConnected, RestrictedGraph, Rights
from webviz.tools.teleop import Teleop

TWIST, ODOMETRY = "geometry_msgs/msg/Twist", "nav_msgs/msg/Odometry"
CMD_VEL = Advertisement("/cmd_vel", TWIST, depth=1)
AHEAD = Velocity(linear=1.0)
PATIENCE_S = 60.0


class HeldControl:
    """Holds something on a page, with heartbeats from a thread of its own."""

    def __init__(self, b: Bench, browser: int, share: Velocity = AHEAD) -> None:
        self._set_point = teleop(b), browser, share
        self._steer = b.viewer.controllers.steer
        self._let_go = threading.Event()
        self._thread = threading.Thread(target=self._hold)
        self._thread.start()

    def _hold(self) -> None:
        while not self._let_go.wait(0.01):
            self._steer(*self._set_point, time.monotonic())

    def vanish(self) -> None:
        """Send nothing more."""
        self._let_go.set()
        self._thread.join()


HeldControls = Callable[..., HeldControl]


class Controllers:
    """The velocity controllers of one vehicle, without a viewer."""

    def __init__(self) -> None:
        self.graph, self.allowed = RememberingGraph(), ["/cmd_vel"]
        self.publications = 0
        self.fault: Exception | None = None
        """Raised where a command is made."""
        self.outcome: Exception | None = None
        """Outcome of publishing a command."""
        publish = self.graph.publish

        def publish_or_fail(advertisement: Advertisement, cdr: bytes) -> Future[int]:
            if self.outcome is None:
                return publish(advertisement, cdr)
            failed: Future[int] = Future()
            failed.set_exception(self.outcome)
            return failed

        self.graph.publish = publish_or_fail
        source = HandFedSource(graph=self.graph)  # pyright: ignore[reportArgumentType]
        self.controllers = VelocityControllers(
            RestrictedGraph(source, Rights(), lambda: tuple(self.allowed)), lambda: 0
        )
        self.equip()

    def equip(self) -> None:
        vehicle = Teleop().vehicle

        def message(velocity: Velocity, now_ns: int) -> Mapping[str, Any]:
            self.publications += 1
            if self.fault is not None:
                raise self.fault
            return vehicle.message(velocity, now_ns)

        self.controllers.equip({"tool": (replace(vehicle, message=message), CMD_VEL)})

    def steer(self, share: Velocity) -> DrivingAnswer:
        return self.controllers.steer("tool", 1, share, time.monotonic())

    @property
    def speeds(self) -> list[float]:
        return [twist.linear.x for _, twist in self.graph.published]


@pytest.fixture
def lone() -> Iterator[Controllers]:
    lone = Controllers()
    yield lone
    lone.controllers.close()


@pytest.fixture
def b(bench: Benches) -> Bench:
    return bench(graph=RememberingGraph())


@pytest.fixture
def hold(b: Bench) -> Iterator[HeldControls]:
    with several(
        lambda browser=1, share=AHEAD: HeldControl(b, browser, share), HeldControl.vanish
    ) as hold:
        yield hold


def teleop(b: Bench) -> str:
    """The id of the tool; another one after a config was opened."""
    return next(button.id for button in b.states[-1].tools if button.name == "Teleop")


def steer(b: Bench, tool: str, browser: int, share: Velocity) -> DrivingAnswer:
    """The answer to a set-point of a browser that has just received something."""
    return b.viewer.controllers.steer(tool, browser, share, time.monotonic())


def speeds(b: Bench) -> list[float]:
    return [
        twist.linear.x for advertisement, twist in b.graph.published if advertisement == CMD_VEL
    ]


def stands(b: Bench) -> bool:
    """Return whether a drive ended with zeros, and nothing more."""
    ended = speeds(b)
    return ended[-TAIL:] == [0.0] * TAIL and ended[-TAIL - 1] > 0.0


def advertised(b: Bench) -> set[Advertisement]:
    b.turn(keep_up=True)
    return {
        advertisement
        for advertisement in b.graph.advertised
        if advertisement.type.startswith(TWIST)
    }


def test_commands_are_published_without_the_frame_loop_until_the_page_is_silent(
    b: Bench, hold: HeldControls
) -> None:
    hand = hold()
    until(lambda: speeds(b)[-1:] == [0.5])  # no turn of the loop since the press
    hand.vanish()
    until(lambda: stands(b))
    advertisements = {advertisement for advertisement, _ in b.graph.published}
    assert advertisements == {CMD_VEL}
    (angular, lateral) = b.graph.published[0][1].angular.z, b.graph.published[0][1]
    assert (angular, lateral.linear.y) == (0.0, 0.0)


def test_a_silent_driver_is_stopped_between_two_commands(
    b: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.engine.driving.velocity_controllers.PERIOD_S", 3600.0)
    steer(b, teleop(b), 1, AHEAD)
    until(lambda: speeds(b)[-1:] == [0.0])
    assert len(speeds(b)) <= 3


def test_nothing_is_advertised_without_a_driver(b: Bench, hold: HeldControls) -> None:
    assert advertised(b) == set()
    assert "/odom" not in b.source.subscriptions
    assert steer(b, teleop(b), 1, STILL).driver is None
    assert advertised(b) == {CMD_VEL}
    assert b.source.subscriptions["/odom"].type == ODOMETRY
    time.sleep(2 * PERIOD_S)
    assert b.graph.published == []
    until(lambda: advertised(b) == set())


@pytest.mark.parametrize(
    ("change", "goes_on"),
    [
        (lambda b: b.do(SetToolProperty("Teleop", "topic.name", "/other")), True),
        (lambda b: b.do(SetToolProperty("Teleop", "message", "TwistStamped")), True),
        (lambda b: b.do(Load("displays: []\ntools: []\n", "x.yaml")), False),
        (lambda b: b.do(Load("publish: []\ntools: [{type: Teleop}]\n", "x.yaml")), False),
        (lambda b: b.viewer.stop(), False),
        (lambda b: b.viewer.close(), False),
    ],
    ids=[
        "other topic",
        "other type",
        "tool removed",
        "narrowed",
        "viewer told to stop",
        "viewer closed",
    ],
)
def test_the_robot_stops_when_its_tool_changes_or_the_viewer_ends(
    b: Bench, hold: HeldControls, change: Callable[[Any], object], goes_on: bool
) -> None:
    tool = teleop(b)
    hand = hold()
    until(lambda: speeds(b)[-1:] == [0.5])
    change(b)
    until(lambda: stands(b))
    # What is still held was not meant for another robot.
    assert {advertisement for advertisement, _ in b.graph.published} == {CMD_VEL}
    hand.vanish()
    steer(b, tool, 1, STILL)
    assert (steer(b, tool, 1, AHEAD).driver == 1) == goes_on


def test_stopping_the_viewer_stops_the_robot_at_once(b: Bench, hold: HeldControls) -> None:
    hold()
    until(lambda: speeds(b)[-1:] == [0.5])
    b.viewer.stop()
    before = len(speeds(b))
    until(lambda: stands(b))
    assert sum(speed != 0.0 for speed in speeds(b)[before:]) <= 1  # which was on its way


def test_a_command_that_could_not_be_published_in_time_is_not_published_late(
    b: Bench, hold: HeldControls, caplog: pytest.LogCaptureFixture
) -> None:
    messages: list[Future[int]] = []

    def publish(advertisement: Advertisement, cdr: bytes) -> Future[int]:
        messages.append(Future())
        return messages[-1]

    b.graph.publish = publish
    hand = hold()
    until(lambda: len(messages) > 1)
    hand.vanish()
    until(lambda: not b.viewer.controllers.is_moving())
    until(lambda: all(each.cancelled() for each in messages[:-1]))
    assert not messages[-1].cancelled()
    messages[-1].set_result(1)
    assert caplog.records == []
    assert steer(b, teleop(b), 1, STILL).problem == ""


def test_closing_a_viewer_waits_until_its_last_commands_are_published(
    b: Bench, hold: HeldControls, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.engine.driving.velocity_controllers.ENDING_S", PATIENCE_S)
    publish, publications = b.graph.publish, list[Future[int]]()

    def publish_slowly(advertisement: Advertisement, cdr: bytes) -> int:
        time.sleep(0.1)  # a slow network
        return publish(advertisement, cdr).result()

    def begin(advertisement: Advertisement, cdr: bytes) -> Future[int]:
        publications.append(network.submit(publish_slowly, advertisement, cdr))
        return publications[-1]

    hold()
    until(lambda: speeds(b)[-1:] == [0.5])
    with ThreadPoolExecutor(1) as network:
        b.graph.publish = begin
        b.viewer.close()
        assert publications[-1].done()
    assert speeds(b)[-1] == 0.0


@pytest.mark.parametrize("way", [AHEAD, Velocity(linear=-1.0)], ids=["ahead", "back"])
def test_only_zeros_pass_a_list_that_was_narrowed(lone: Controllers, way: Velocity) -> None:
    lone.steer(way)
    until(lambda: lone.speeds)
    lone.allowed.clear()
    before = len(lone.speeds)
    until(lambda: not lone.controllers.is_moving())
    late = lone.speeds[before:]
    assert sum(speed != 0.0 for speed in late) <= 1  # which was on its way
    assert lone.speeds[-TAIL:] == [0.0] * TAIL


def test_a_topic_gets_another_type_once_its_vehicle_has_stopped(lone: Controllers) -> None:
    lone.steer(AHEAD)
    until(lambda: lone.speeds)
    stamped = Advertisement("/cmd_vel", f"{TWIST}Stamped")
    lone.controllers.equip({"tool": (Teleop().vehicle, stamped)})
    until(lambda: lone.steer(STILL) and lone.controllers.advertisements())
    assert lone.controllers.stopping() == set()
    lone.steer(STILL)
    assert lone.controllers.advertisements() == {stamped}


@pytest.mark.parametrize(
    ("change", "seconds"), [(0.1, 0.02), (0.0, 0.05)], ids=["changing", "steady"]
)
def test_commands_keep_a_distance_in_time(lone: Controllers, change: float, seconds: float) -> None:
    start = time.monotonic()
    for number in itertools.count():
        lone.steer(Velocity(linear=0.5 + change * (number % 2)))
        if len(lone.speeds) >= 6:
            break
    assert time.monotonic() - start >= 5 * seconds


def test_the_zeros_of_the_end_do_not_wait_for_their_turn(
    lone: Controllers, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.engine.driving.velocity_controllers.PERIOD_S", 3600.0)
    lone.steer(AHEAD)
    until(lambda: lone.speeds)
    lone.controllers.stop()
    until(lambda: lone.speeds[-TAIL:] == [0.0] * TAIL)


def test_closing_waits_until_the_last_commands_are_published(lone: Controllers) -> None:
    publications: list[Future[int]] = []

    def publish_later(advertisement: Advertisement, cdr: bytes) -> Future[int]:
        publications.append(node.submit(publish_slowly, advertisement, cdr))
        return publications[-1]

    def publish_slowly(advertisement: Advertisement, cdr: bytes) -> int:
        time.sleep(0.1)
        return publish_now(advertisement, cdr).result()

    publish_now = lone.graph.publish

    lone.graph.publish = publish_later
    with ThreadPoolExecutor(max_workers=1) as node:
        lone.steer(AHEAD)
        until(lambda: publications)
        lone.controllers.close()
        assert publications[-1].done()


def test_a_command_that_fails_is_reported_until_one_succeeds(
    lone: Controllers, caplog: pytest.LogCaptureFixture
) -> None:
    def problem() -> str:
        return lone.steer(AHEAD).problem

    lone.fault = ValueError("no wheels")
    until(lambda: problem() == "No command could be made: no wheels")
    until(lambda: lone.publications > 3)
    assert len(caplog.records) == 1
    lone.fault = None
    until(lambda: lone.speeds and not problem())
    lone.outcome = NotConnected("The node is gone.")
    until(lambda: problem() == "The node is gone.")
    lone.controllers.equip({})
    lone.equip()
    assert lone.controllers.steer("tool", 2, STILL, None).problem == ""


def test_a_robot_speeds_up_from_standstill_after_a_broken_link(lone: Controllers) -> None:
    def hold_until(condition: Callable[[], object]) -> None:
        until(lambda: lone.steer(AHEAD) and condition())

    hold_until(lambda: lone.speeds and lone.speeds[-1] == 0.5)
    lone.outcome = NotConnected("The link to the bridge broke.")
    publications = lone.publications
    hold_until(lambda: lone.publications > publications + 3)
    before = len(lone.speeds)
    lone.outcome = None
    hold_until(lambda: len(lone.speeds) > before)
    assert lone.speeds[before] <= 2 * PERIOD_S * Teleop().acceleration


def test_undo_of_a_property_changes_the_limits_of_the_next_moment(
    b: Bench, hold: HeldControls
) -> None:
    b.do(SetToolProperty("Teleop", "linear", 0.123))  # which no step of a ramp to 0.5 meets
    hold()
    until(lambda: speeds(b)[-1:] == [0.123])
    b.do(Undo())
    until(lambda: speeds(b)[-1:] == [0.5])


def test_a_second_driver_sees_who_has_control_also_through_another_tool(
    b: Bench, hold: HeldControls
) -> None:
    b.do(Load("tools: [{type: Teleop}, {type: Teleop, name: Slow, linear: 0.1}]\n", "x.yaml"))
    first = hold(browser=7)
    until(lambda: speeds(b)[-1:] == [0.5])
    other = next(button.id for button in b.states[-1].tools if button.name == "Slow")
    assert [steer(b, tool, 8, AHEAD).driver for tool in (teleop(b), other)] == [7, 7]
    assert b.viewer.controllers.drivers() == {teleop(b): 7}
    first.vanish()
    until(lambda: steer(b, other, 8, AHEAD).driver == 8)
    until(lambda: speeds(b)[-1:] == [0.0])


def test_vehicles_on_different_topics_have_drivers_of_their_own(
    b: Bench, hold: HeldControls
) -> None:
    others = "{type: Teleop, name: A, topic: /a}, {type: Teleop, name: Z, topic: /z}"
    b.do(Load(f"tools: [{{type: Teleop}}, {others}]\n", "x.yaml"))
    hold(browser=7)
    until(lambda: speeds(b)[-1:] == [0.5])
    tools = [button.id for button in b.states[-1].tools if button.name in ("A", "Z")]
    assert [steer(b, tool, 8, AHEAD).driver for tool in tools] == [8, 8]


def test_a_page_is_given_the_reason_why_commands_have_no_receiver(
    b: Bench, hold: HeldControls
) -> None:
    assert "no valid topic, or no longer exists" in steer(b, "tool99", 1, AHEAD).problem
    b.graph.subscriptions = 0
    hold()
    unheard = "No subscription to /cmd_vel as Twist. "
    until(lambda: unheard in steer(b, teleop(b), 2, STILL).problem)
    b.graph.subscriptions = 1
    until(lambda: steer(b, teleop(b), 2, STILL).problem == "")


def test_a_read_only_source_gives_nobody_control_with_the_reason(bench: Benches) -> None:
    b = bench()
    answer = steer(b, teleop(b), 1, AHEAD)
    assert (answer.driver, answer.problem) == (None, "This source can only be read.")


def test_the_readout_is_the_robots_own_velocity(b: Bench) -> None:
    def readout() -> Driving:
        steer(b, teleop(b), 1, STILL)
        b.turn(keep_up=True)
        return b.states[-1].driving[teleop(b)]

    remedy = "Choose another topic of odometry in the panel Tools."
    assert readout() == Driving(problem=f"No publisher on /odom. {remedy}")
    for x, y, z, expected in (
        (0.3, 0.0, -0.25, Driving(None, 0.3, -0.25)),
        (-0.3, 0.4, 0.0, Driving(None, 0.5, 0.0)),
        (-0.4, 0.3, -0.001, Driving(None, -0.5, 0.0)),
    ):
        twist = {"linear": {"x": x, "y": y}, "angular": {"z": z}}
        b.publish("/odom", ODOMETRY, {"twist": {"twist": twist}})
        assert readout() == expected
    b.publish("/odom", ODOMETRY, {"twist": {"twist": {"linear": {"x": float("nan")}}}})
    assert readout().problem == "/odom has velocities that are not finite. Correct its publisher."
    b.source.put("/odom", ODOMETRY, b"\0\1\0\0")
    b.turn()
    assert readout().problem.startswith("/odom cannot be read: Not a nav_msgs/msg/Odometry")
    b.clock += 0.9
    assert readout().problem.startswith("/odom cannot be read")
    b.clock += 1.1
    assert readout() == Driving(problem=f"No message on /odom. {remedy}")
