"""Zenoh routers that do not answer."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class ZenohRouter(Check):
    """Zenoh router missing.

    The middleware is rmw_zenoh_cpp, and no router listens where this machine connects to.

    Why:
        rmw_zenoh discovers nodes through its router. Without one, nodes that do not know each
        other's address never meet.

    Repair:
        Start the router, or name that of another machine in `ZENOH_CONFIG_OVERRIDE`:

            ros2 run rmw_zenoh_cpp rmw_zenohd
    """

    id = "ENV011"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each router that does not answer."""
        routers = observation.environment.zenoh_routers if observation.environment else {}
        for router, problem in routers.items():
            if problem:
                yield self.found(
                    f"No Zenoh router answers at {router}.",
                    "Start the router, or correct its address in ZENOH_CONFIG_OVERRIDE.",
                    subject=router,
                    severity=Severity.ERROR,
                    evidence={"router": router, "problem": problem},
                    command="ros2 run rmw_zenoh_cpp rmw_zenohd",
                    explains=observation.undiscovered(),
                )
