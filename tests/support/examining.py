"""Findings of viewers under test."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from webviz import Finding, Severity
from webviz.api.finding import CauseLevel
from webviz.shell.testing.harness import Harness
from webviz.shell.testing.live import LiveViewer
from webviz.shell.testing.source import SECOND

ROUNDS = 4
"""Two in a row make a finding; one may be under way, and messages have to wait for a while."""


def by_key(findings: Sequence[Finding], level: CauseLevel) -> dict[str, Finding]:
    """Findings on a level that are more than notes in their order, by id and subject."""
    worse = [each for each in findings if each.severity > Severity.NOTE and each.level is level]
    return {f"{each.id} {each.subject}".strip(): each for each in worse}


def live_findings(viewer: LiveViewer, level: CauseLevel) -> dict[str, Finding]:
    """The findings of a live viewer on one level."""
    return by_key(viewer.viewer.snapshot().findings, level)


def examined(
    stage: Harness,
    level: CauseLevel,
    seconds: float = 1.1,
    publish: Callable[[], object] = lambda: None,
) -> dict[str, Finding]:
    """The findings of a viewer on one level after some rounds.

    Args:
        stage: the viewer.
        level: of the causes.
        seconds: that pass between two turns.
        publish: called before each turn.
    """
    doctor = stage.viewer.doctor
    doctor.slice_s = math.inf
    until, state = doctor.rounds + ROUNDS, stage.viewer.snapshot()
    while doctor.rounds < until:
        stage.clock += seconds
        stage.source.now += round(seconds * SECOND)
        publish()
        stage.turn()
        state = stage.viewer.snapshot()
    return by_key(state.findings, level)


def display(viewer: Harness | LiveViewer, name: str) -> str:
    """The id of a display."""
    return next(row.id for row in viewer.viewer.snapshot().rows if row.name == name)
