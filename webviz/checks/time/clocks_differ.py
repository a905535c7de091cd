"""Transforms of another clock."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from webviz.api.check import Check
from webviz.api.finding import Finding, Symptom
from webviz.api.observation import Observation
from webviz.checks.time.offsets import LateLinks, off_together
from webviz.data.transforms.clocks import clock_problem, is_off
from webviz.data.transforms.reasons import YEAR_NS, Kind, in_words
from webviz.data.transforms.tree import ancestors
from webviz.data.words import listed

OF_LINKS = Kind.AHEAD, Kind.BEHIND, Kind.NO_DATA, Kind.CLOCKS
"""Reasons why a frame behind such a transform has no pose."""
NAMED = 3


class ClocksDiffer(Check):
    """Clocks of transforms differ.

    Transforms are stamped with a time that differs from that of webviz: by seconds, or by a steady
    third of a second while data is on time or off by as much.

    Why:
        Data and transforms of different clocks do not meet: the data waits for transforms that come
        too late or came long ago.

    Repair:
        Synchronise the clocks of the machines (chrony, NTP), or follow the time of a bag that is
        replayed with `--clock`.
    """

    id = "TIME010"

    def __init__(self) -> None:
        self._late = LateLinks()

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if so."""
        late, together_ns = self._late.update(observation), off_together(observation)
        clock = "the time of the bag" if observation.is_recorded else "the clock of this computer"
        explains = observation.symptom("Clocks")
        problem = clock_problem(observation.buffer, observation.now_ns, observation.is_recorded)
        # Where data has the time of this computer, webviz need not follow another: TIME011.
        links = [
            observation.buffer.tree.caches.get(reason.link)
            for _, reason in observation.unplaced(Kind.CLOCKS)
        ]
        is_mixed = any(link is not None and link.newest_stamp < YEAR_NS for link in links)
        if problem and explains and not is_mixed:
            unconverted = [
                symptom
                for symptom, reason in observation.unplaced(*OF_LINKS)
                if is_off(observation.buffer, reason.frame, observation.now_ns)
            ]
            yield self.found(
                problem.cause,
                problem.remedy,
                evidence={"status": str(problem)},
                command="chronyc tracking",
                explains=(*explains, *unconverted, *observation.off_map()),
            )
        elif together_ns is not None:
            side = "behind" if together_ns > 0 else "ahead of"
            yield self._steady(
                f"All data and transforms are stamped {in_words(together_ns)} {side} {clock}.",
                together_ns,
                observation.off_map(),
            )
        elif late and not explains:
            names = listed([f'"{child}"' for child in late], NAMED)
            worst_ns = max(late.values())
            tree = observation.buffer.tree
            delayed = (
                symptom
                for display, each in observation.inputs()
                if late.keys() & {*ancestors(tree, each.frame)}
                for symptom in display.symptom("Transform")
            )
            yield self._steady(
                f"The transforms of {names} are stamped {in_words(worst_ns)} behind {clock}, the "
                "data is not.",
                worst_ns,
                (*delayed, *observation.off_map()),
            )

    def _steady(self, cause: str, delay_ns: int, explains: Sequence[Symptom] = ()) -> Finding:
        return self.found(
            cause,
            "Synchronise the clocks of the machines (chrony, NTP), and look for what delays "
            "them if they agree.",
            evidence={"delay_s": round(delay_ns / 1e9, 3)},
            command="chronyc tracking",
            explains=(*explains,),
        )
