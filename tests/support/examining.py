"""Findings of viewers under test."""

from __future__ import annotations

import math
from collections.abc import Sequence

from webviz import Finding, Severity
from webviz.shell.testing.live import LiveViewer
from webviz.shell.testing.source import SECOND
from webviz.shell.testing.stage import Stage

ROUNDS = 3
"""Two in a row make a finding; one may have begun before."""


def by_key(findings: Sequence[Finding]) -> dict[str, Finding]:
    """Findings that are more than notes in their order, by id and subject."""
    worse = [each for each in findings if each.severity > Severity.NOTE]
    return {f"{each.id} {each.subject}".strip(): each for each in worse}


def live_findings(viewer: LiveViewer) -> dict[str, Finding]:
    """The findings of a live viewer."""
    return by_key(viewer.viewer.snapshot().findings)


def examined(stage: Stage, seconds: float = 1.1) -> dict[str, Finding]:
    """The findings of a viewer after some rounds, between which time passes."""
    doctor = stage.viewer.doctor
    doctor.slice_s = math.inf
    until = doctor.rounds + ROUNDS
    while doctor.rounds < until:
        stage.clock += seconds
        stage.source.now += round(seconds * SECOND)
        stage.turn()
    return by_key(stage.viewer.snapshot().findings)


def display(viewer: Stage | LiveViewer, name: str) -> str:
    """The id of a display."""
    return next(row.id for row in viewer.viewer.snapshot().rows if row.name == name)
