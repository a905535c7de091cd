"""ROS of another Python, whose remedy is a Python that webviz runs on."""

from __future__ import annotations

import pytest

from webviz.api.environment import Environment
from webviz.api.observation import Observation
from webviz.checks.machine.other_python import OtherPython
from webviz.data.transforms import TransformBuffer


@pytest.mark.parametrize(
    ("version", "remedy", "command"),
    [
        ("3.12", "Run webviz with Python 3.12, or", "python3.12 -m venv"),
        ("3.10", "webviz needs Python 3.11 or newer: start it with its own ROS", ""),
        ("3.8", "webviz needs Python 3.11 or newer", ""),
    ],
)
def test_the_remedy_is_a_python_that_webviz_runs_on(
    version: str, remedy: str, command: str
) -> None:
    path = f"/opt/ros/some/lib/python{version}/site-packages"
    environment = Environment(variables={"PYTHONPATH": path}, python="3.13")
    observation = Observation(
        now_ns=1,
        fixed_frame="map",
        buffer=TransformBuffer(),
        displays=[],
        environment=environment,
    )
    [finding] = OtherPython().find(observation)
    assert finding.cause == f"ROS for Python {version} is sourced, but Python 3.13 runs."
    assert finding.remedy.startswith(remedy)
    assert finding.command.startswith(command)
    assert bool(finding.command) == bool(command)
