"""ROS of another Python."""

from __future__ import annotations

import re
from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

VERSION = re.compile(r"/python(3\.\d+)/(?:site|dist)-packages/?$")

OLDEST = 3, 11
"""The oldest Python that webviz runs on; ROS Humble's is 3.10."""


class OtherPython(Check):
    """ROS for another version of Python.

    The workspaces that are sourced have packages for another version of Python than the one that
    runs.

    Why:
        Compiled packages, such as rclpy and messages, load in one version only. A virtual
        environment or conda often brings another Python than the distribution of ROS.

    Repair:
        Create the virtual environment with the Python of ROS:

            python3.12 -m venv --system-site-packages .venv
    """

    id = "ENV015"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such machine."""
        if (environment := observation.environment) is None:
            return
        versions = {}
        for entry in environment.variables.get("PYTHONPATH", "").split(":"):
            if version := VERSION.search(entry):
                versions[version[1]] = entry
        if not versions or environment.python in versions:
            return
        version, entry = next(iter(versions.items()))
        is_supported = tuple(map(int, version.split("."))) >= OLDEST
        yield self.found(
            f"ROS for Python {version} is sourced, but Python {environment.python} runs.",
            f"Run webviz with Python {version}, or source a ROS for Python {environment.python}."
            if is_supported
            else f"webviz needs Python {OLDEST[0]}.{OLDEST[1]} or newer: start it with its own ROS "
            "in a terminal in which no ROS is sourced, or connect it to a bridge.",
            evidence={"python": environment.python, "PYTHONPATH": entry},
            command=f"python{version} -m venv --system-site-packages .venv" if is_supported else "",
        )
