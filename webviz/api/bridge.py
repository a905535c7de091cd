"""Bridges, which carry the topics of robots over a network."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class BridgeParameters:
    """Parameters that a bridge has beside those that nodes tell themselves.

    Args:
        nodes: full names of the nodes, sorted.
        changes: how often it has told that values have changed.
    """

    nodes: tuple[str, ...] = ()
    changes: int = 0


@dataclass(frozen=True)
class Bridge:
    """A bridge and the link to it, as they are now.

    Args:
        name: address of the bridge without credentials, such as ws://robot:8765.
        protocol: that it speaks, such as "Foxglove"; "" until it was connected.
        is_up: whether it is connected and answers.
        was_up: whether it ever was.
        problem: why it is down, a sentence; "" if it is up.
        remedy: what to do about the problem, a sentence.
        remarks: sentences about an open link: warnings of the bridge, lost messages.
        limits: sentences on what the bridge does not pass on.
        round_trip_s: of the last answer, None before one.
        robot: whose topics it carries, "" if they have no namespace of their own.
        clock_s: by how much its clock is ahead of this machine's, which is corrected; 0 if it is
            not, or by less than can be measured.
        parameters: the nodes whose parameters it has.
        doubled: full names of topics of its robot that others publish, too, sorted.
    """

    name: str
    protocol: str = ""
    is_up: bool = False
    was_up: bool = False
    problem: str = ""
    remedy: str = ""
    remarks: tuple[str, ...] = ()
    limits: tuple[str, ...] = ()
    round_trip_s: float | None = None
    robot: str = ""
    clock_s: float = 0.0
    parameters: BridgeParameters = BridgeParameters()
    doubled: tuple[str, ...] = ()

    @property
    def title(self) -> str:
        """Its name in lists: of the robot, or its address."""
        return self.robot or self.name
