"""Rules of the config that are violated."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class ViolatedRule(Check):
    """Rule violated.

    A rule of the config (`watch:`) or of the command line (`webviz test --rule`) does not hold.

    Why:
        A limit has been set for this value, such as the share of a laser scan that lies on the
        walls of the map.

    Repair:
        Find out why the value is out of its limit. In the black box, the recording of the last
        minute shows what led to it.
    """

    id = "DATA012"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each rule that has been violated for long enough."""
        for verdict in observation.verdicts:
            rule = verdict.rule
            if verdict.is_violated and verdict.value is not None:
                yield self.found(
                    f"{rule.about} is {rule.text_of(verdict.value)}, expected {rule.expectation}.",
                    "Find out what led to it, or change the rule.",
                    subject=rule.text,
                    evidence={"rule": rule.text, "value": verdict.value, "limit": rule.limit},
                )
