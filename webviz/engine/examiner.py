"""The port to the doctor, by which other rooms and features ask for causes behind statuses."""

from __future__ import annotations

import abc
import time
from collections.abc import Sequence

from webviz.api.environment import Environment
from webviz.api.finding import Finding
from webviz.api.rule import Rule, Verdict
from webviz.engine.parts.part import Part, PartContext
from webviz.sources.past_state import Event

SLICE_S = 0.001
"""Time for checks in one turn; the one that exceeds it still ends."""


class Examiner(Part, abc.ABC):
    """Examines a viewer in rounds; a viewer without one finds nothing.

    Args:
        context: shared by all parts.
    """

    name = "Doctor"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self.slice_s = SLICE_S
        """Time for checks in one turn."""
        self.listening_since_s = time.monotonic()
        """Monotonic time since which the graph is looked at."""
        self.environment: Environment | None = None
        """This machine, None until it was looked at."""
        self.rules: Sequence[Rule] = ()
        """Rules to judge besides those of the config; nothing is saved when one does not hold."""
        self.verdicts: Sequence[Verdict] = ()
        """Verdicts of all rules, in the last round."""
        self.rounds = 0
        """Number of completed rounds."""
        self.findings: Sequence[Finding] = ()
        """Findings of the last round, the one to repair first at the beginning."""
        self.events: Sequence[Event] = ()
        """Times when findings began, as far as the recording was shown; each is noted once."""

    @property
    @abc.abstractmethod
    def is_graph_found(self) -> bool:
        """Return whether other nodes were found, or had the time to be."""

    @abc.abstractmethod
    def is_settled(self) -> bool:
        """Return whether two rounds have examined all that is wrong, and agree on it."""

    @abc.abstractmethod
    def ask(self) -> None:
        """Examine for some seconds even if no browser is connected; thread-safe."""

    @abc.abstractmethod
    def hasten(self) -> None:
        """Let the next round begin at once."""
