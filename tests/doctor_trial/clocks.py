"""Faults of clocks and stamps."""

from __future__ import annotations

import time
from collections.abc import Callable

from tests.doctor_trial.provocation import Provocation
from tests.doctor_trial.robot import CLOCK, Stream, TrialRobot, Values

SIMULATED_NS = 100_000_000_000
SIM_TIME = ("--ros-args", "-p", "use_sim_time:=true")


def _clock(node: str = "gazebo", rate_hz: float = 50.0) -> Stream:
    def make(_: float, stamp_ns: int) -> Values:
        sec, nanosec = divmod(stamp_ns, 1_000_000_000)
        return {"clock": {"sec": sec, "nanosec": nanosec}}

    return Stream(node, "/clock", CLOCK, make, rate_hz)


def _simulated(pause_s: float = 1e9) -> Callable[[TrialRobot], None]:
    """Return what simulates time, which stands from some moment on."""

    def change(robot: TrialRobot) -> None:
        robot.time_ns = lambda at_s: SIMULATED_NS + round(min(at_s, pause_s) * 1e9)
        robot.streams["clock"] = _clock()

    return change


def _paused(robot: TrialRobot) -> None:
    """Simulated nodes fall silent, and /clock is still published."""
    _simulated(0.5)(robot)
    for name, stream in robot.streams.items():
        if name != "clock" and stream.rate_hz:
            stream.ends_s = 0.0


def _without_clock(robot: TrialRobot) -> None:
    robot.parameters = {each.node: {"use_sim_time": True} for each in robot.streams.values()}
    for stream in robot.streams.values():
        stream.ends_s = 0.0


def _one_waits(robot: TrialRobot) -> None:
    robot.parameters["lidar"] = {"use_sim_time": True}
    robot["scan"].ends_s = 0.0


def _clock_ends(robot: TrialRobot) -> None:
    _simulated()(robot)
    for stream in robot.streams.values():
        if stream.rate_hz:
            stream.ends_s = 6.0
    robot["clock"].ends_s = 6.0
    robot.actions.append((6.0, lambda: robot.leave("gazebo")))


def _two_clocks(robot: TrialRobot) -> None:
    _simulated()(robot)
    other = _clock("player")
    other.ahead_s = 500.0
    robot.streams["other clock"] = other


def _ahead(seconds: float, *names: str) -> Callable[[TrialRobot], None]:
    def change(robot: TrialRobot) -> None:
        for name in names:
            robot[name].ahead_s = seconds

    return change


def _stamped(stamp: Callable[[], int], *names: str) -> Callable[[TrialRobot], None]:
    """Return what gives messages of streams another stamp in ns."""

    def change(robot: TrialRobot) -> None:
        for name in names:
            make = robot[name].make
            robot[name].make = lambda at_s, _, make=make: make(at_s, stamp())

    return change


def _wall_node(robot: TrialRobot) -> None:
    _simulated()(robot)
    _stamped(time.time_ns, "scan")(robot)


def _half_simulated(robot: TrialRobot) -> None:
    """Stamps of transforms are simulated, those of scans are not."""
    _stamped(lambda: SIMULATED_NS + time.monotonic_ns(), "odom", "localisation")(robot)
    _stamped(time.time_ns, "scan")(robot)


def _half_ahead(robot: TrialRobot) -> None:
    for name in STREAMS:
        robot[name].ahead_s += 0.5


STREAMS = "odometry", "odom", "localisation", "wheel", "joints", "scan"
STANDING_NS = time.time_ns()

ALL = [
    Provocation("simulated robot, webviz on wall time", "TIME004", "use_sim_time", _simulated()),
    Provocation("simulator that is paused", "TIME013", "Resume", _paused, options=SIM_TIME),
    Provocation("simulator that is paused, webviz on wall time", "TIME013", "Resume", _paused),
    Provocation(
        "clock that is silent",
        "TIME013",
        "",
        lambda r: (
            _without_clock(r),
            r.streams.update(clock=_clock(rate_hz=1e-3)),
            setattr(r["clock"], "begins_s", 1e3),
        ),
    ),
    Provocation("use_sim_time, and no clock", "TIME001", "simulator", options=SIM_TIME),
    Provocation(
        "all nodes with use_sim_time, and no clock", "TIME014", "use_sim_time", _without_clock
    ),
    Provocation(
        "lidar with use_sim_time, and no clock", "TIME014", "/lidar use_sim_time false", _one_waits
    ),
    Provocation("clock that ends", "TIME002", "", _clock_ends, options=SIM_TIME, seconds=14.0),
    Provocation("two clocks", "TIME003", "", _two_clocks, options=SIM_TIME),
    Provocation("two clocks, webviz on wall time", "TIME003", "", _two_clocks),
    Provocation(
        "lidar on wall time in a simulation",
        "TIME005",
        "use_sim_time",
        _wall_node,
        options=SIM_TIME,
    ),
    Provocation("stamps of zero", "TIME006", "", _stamped(lambda: 0, "scan")),
    Provocation("stamps that stand", "TIME007", "", _stamped(lambda: STANDING_NS, "scan")),
    Provocation("scan in the future", "TIME008", "", _ahead(2.0, "scan")),
    Provocation("scan half a second late", "TIME009", "", _ahead(-0.5, "scan")),
    Provocation("scan 3 s late", "TIME009", "", _ahead(-3.0, "scan")),
    Provocation("scan 30 s late", "TIME009", "", _ahead(-30.0, "scan")),
    Provocation("odometry transform half a second late", "TIME010", "", _ahead(-0.5, "odom")),
    Provocation("odometry transform 5 s late", "TIME010", "", _ahead(-5.0, "odom")),
    Provocation("odometry transform 5 s ahead", "TIME010", "", _ahead(5.0, "odom")),
    Provocation("robot whose clock is half a second late", "TIME010", "", _ahead(-0.5, *STREAMS)),
    Provocation("robot whose clock is half a second ahead", "TIME010", "", _half_ahead),
    Provocation("robot whose clock is an hour late", "TIME010", "", _ahead(-3600.0, *STREAMS)),
    Provocation("robot whose clock is a minute ahead", "TIME010", "", _ahead(60.0, *STREAMS)),
    Provocation("transforms with simulated time, data without", "TIME011", "", _half_simulated),
]
