"""Two distributions of ROS at once."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

ROOT = "/opt/ros/"


class TwoDistributions(Check):
    """Two distributions of ROS are sourced.

    AMENT_PREFIX_PATH has folders of two distributions of ROS.

    Why:
        Programs load libraries and message types of both, which fails in odd ways: unknown symbols,
        types that do not match.

    Repair:
        Open a new terminal and source one distribution only. Look for a second `source` in
        `~/.bashrc`.
    """

    id = "ENV009"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        variables = observation.environment.variables if observation.environment else {}
        paths = variables.get("AMENT_PREFIX_PATH", "").split(":")
        names = sorted({path.split("/")[3] for path in paths if path.startswith(ROOT)})
        if len(names) > 1:
            yield self.found(
                f"The distributions {' and '.join(names)} of ROS are sourced at once.",
                "Open a new terminal, and source one of them.",
                evidence={"distributions": tuple(names)},
                command="printenv AMENT_PREFIX_PATH",
            )
