"""Zenoh as the doctor and the command line meet it."""

from __future__ import annotations

import json

import pytest
from waiting import until
from zenoh_robot import ZenohRobot, ZenohRouter, free_port

from webviz.shell.cli import main

STRING = "std_msgs/msg/String"


def test_the_doctor_finds_that_there_is_no_router(capsys: pytest.CaptureFixture[str]) -> None:
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    assert main(["doctor", "--connect", endpoint, "--json", "--seconds", "2.5"]) == 3
    report = json.loads(capsys.readouterr().out)
    (finding,) = [each for each in report["findings"] if each["id"] == "NET007"]
    assert finding["cause"].startswith(
        f"{endpoint} is not connected. Nothing listens on 127.0.0.1:"
    )
    assert finding["command"] == "ros2 run rmw_zenoh_cpp rmw_zenohd"


def test_the_doctor_finds_the_domain_of_the_robot(
    router: ZenohRouter,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "0")
    robot = ZenohRobot(router.endpoint, domain=7)
    causes: dict[str, tuple[str, str]] = {}

    def is_found() -> bool:
        main(["doctor", "--connect", router.endpoint, "--json", "--seconds", "6"])
        for each in json.loads(capsys.readouterr().out)["findings"]:
            causes[each["id"]] = each["cause"], each["remedy"]
        return "NET014" in causes

    until(is_found)
    assert causes["NET014"] == (
        "ROS_DOMAIN_ID 0 has no nodes on this network, but 7 has 1 node.",
        "Start webviz with ROS_DOMAIN_ID=7.",
    )
    assert "NET008" not in causes
    robot.close()


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (["frames", "--connect", "tcp/robot"], "'tcp/robot' is not an address of Zenoh."),
        (["frames", "--connect", "none.json5"], "none.json5 with the config of Zenoh is not a"),
        (
            ["frames", "--connect", "tcp/r:1", "--ros-args", "-p", "use_sim_time:=true"],
            "is not supported with Zenoh",
        ),
    ],
)
def test_wrong_arguments_are_explained(
    arguments: list[str], error: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) in (1, 2)
    assert error in capsys.readouterr().err
