"""Bridges as the frame loop, the doctor and the command line meet them."""

from __future__ import annotations

import json

import pytest
from bridges import foxglove_server
from waiting import until

from webviz.shell.cli import main

BROKEN = "NET007"


def test_the_doctor_examines_a_robot_behind_a_bridge(capsys: pytest.CaptureFixture[str]) -> None:
    ids: set[str] = set()

    def has_found() -> bool:
        """Return whether there was time for findings, which a busy machine may not have."""
        main(["doctor", "--connect", server.url, "--json", "--seconds", "6"])
        report = json.loads(capsys.readouterr().out)
        ids.update(finding["id"] for finding in report["findings"])
        return "TF003" in ids or "GRAPH008" in ids  # of the data, as with ROS

    with foxglove_server() as server:
        until(has_found)
    assert not any(id.startswith(("ENV", "SHM", "NET")) for id in ids)


@pytest.mark.parametrize("seconds", ["2.5", "1.0"])
def test_the_doctor_finds_that_a_bridge_is_not_there(
    seconds: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Also in less than the two rounds that a finding takes, as on a busy machine."""
    with foxglove_server() as server:
        url = server.url
    assert main(["doctor", "--connect", url, "--json", "--seconds", seconds]) == 3
    report = json.loads(capsys.readouterr().out)
    (finding,) = [each for each in report["findings"] if each["id"] == BROKEN]
    assert finding["cause"].startswith(f"{url} is not connected. Nothing listens on 127.0.0.1:")


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (["--connect", "ws://robot", "--bag", "x.mcap"], "Give either --bag or --connect."),
        (["doctor", "--connect", "ws://r", "--bag", "x.mcap"], "Give either --bag or --connect."),
        (["record", "--connect-headers", "x"], "--connect-headers needs --connect."),
        (["frames", "--connect", "robot:8765"], "'robot:8765' is not the address of a bridge."),
        (
            ["frames", "--connect", "ws://r", "--ros-args", "-p", "use_sim_time:=true"],
            "is not supported with a bridge",
        ),
    ],
)
def test_wrong_arguments_are_explained(
    arguments: list[str], error: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) in (1, 2)
    assert error in capsys.readouterr().err
