"""Daemons of the command line that see another graph."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class StaleDaemon(Check):
    """Stale daemon of ros2.

    The daemon of the `ros2` command runs with other settings of discovery than this program.

    Why:
        `ros2 topic list` asks a daemon that was started once and keeps the settings of that time,
        so that the command line sees other nodes than the viewer does.

    Repair:
        Stop it; it restarts automatically:

            ros2 daemon stop
    """

    id = "ENV013"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such daemon."""
        for setting, value in (
            observation.environment.daemon if observation.environment else {}
        ).items():
            own = (
                observation.environment.variables.get(setting, "")
                if observation.environment
                else ""
            )
            yield self.found(
                f"The daemon of ros2 runs with {setting}={value or 'unset'}, this program with "
                f"{own or 'unset'}.",
                "Stop the daemon; it restarts automatically.",
                subject=setting,
                severity=Severity.NOTE,
                evidence={"daemon": value, "here": own},
                command="ros2 daemon stop",
            )
