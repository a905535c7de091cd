"""Versions of ROS of two machines."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation

LONG_RECORDS = frozenset({"foxy", "galactic", "humble"})
"""Distributions whose records of nodes have identifiers of 24 bytes; Iron and later, of 16."""


class DistributionsDiffer(Check):
    """Distributions differ.

    This machine and its peer run different distributions of ROS.

    Why:
        Over DDS, topics, services and actions match by name and by the name of their type. Fields
        of some types changed between distributions, such as those of `sensor_msgs/Range` after
        Humble; webviz fills in what a message lacks, other programs may misread it. Foxy, Galactic
        and Humble describe their nodes in another format than Iron and later, which therefore list
        topics and services of these, but not their nodes, nor parameters by node. With Zenoh, type
        hashes have to be equal as well, and Humble has none.

    Repair:
        Use the same distribution on both machines, such as in a container. If that is impossible,
        run a bridge on the robot, which needs no ROS on this machine:

            sudo apt install ros-$ROS_DISTRO-foxglove-bridge
            ros2 launch foxglove_bridge foxglove_bridge_launch.xml
    """

    id = "ENV023"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        ends = observation.ends
        if ends is None:
            return
        ours = {*ends.here.settings("ROS_DISTRO")} - {""} or {*ends.here.distributions}
        theirs = {*ends.there.settings("ROS_DISTRO")} - {""} or {*ends.there.distributions}
        if ours and theirs and not ours & theirs:
            our, their = (", ".join(sorted(each)) for each in (ours, theirs))
            lists = _list_each_other(ours, theirs)
            yield self.found(
                f"This machine runs {our}, {ends.there.host} runs {their}.",
                "If services or actions fail, use the same distribution on both machines."
                if lists
                else "Nodes are not listed across them; topics arrive. For the names of nodes and "
                f"their parameters, run a bridge on {ends.there.host}.",
                subject=ends.there.host,
                severity=Severity.NOTE,
                evidence={
                    "here": our,
                    "there": their,
                    "topics": "work; types that changed are filled in by webviz only",
                    "services and actions": "work if their types did not change",
                    "nodes and parameters": "as within one distribution"
                    if lists
                    else "not listed: records of nodes have another format",
                },
            )


def _list_each_other(ours: Collection[str], theirs: Collection[str]) -> bool:
    """Return whether records of nodes have the same format on both sides, as far as known."""
    return len({name in LONG_RECORDS for name in (*ours, *theirs)}) == 1
