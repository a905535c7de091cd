"""Middleware that is not installed."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class MiddlewareMissing(Check):
    """Middleware is not installed.

    RMW_IMPLEMENTATION names a middleware whose library is not found.

    Why:
        ROS loads the library when a program starts, and ends the program without it.

    Repair:
        Install it and source ROS, or remove the variable to use the default:

            sudo apt install ros-$ROS_DISTRO-rmw-cyclonedds-cpp
    """

    id = "ENV006"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        environment = observation.environment
        middleware = environment.variables.get("RMW_IMPLEMENTATION", "") if environment else ""
        if (
            not environment
            or not middleware
            or middleware in (environment.middlewares or (middleware,))
        ):
            return
        package = middleware.replace("_", "-")
        yield self.found(
            f"The middleware {middleware} is not installed.",
            "Install it, or remove RMW_IMPLEMENTATION to use the default.",
            subject=middleware,
            severity=Severity.ERROR,
            evidence={
                "RMW_IMPLEMENTATION": middleware,
                "installed": tuple(environment.middlewares),
            },
            command=f"sudo apt install ros-$ROS_DISTRO-{package}",
        )
