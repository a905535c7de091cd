"""The order of findings: causes before symptoms, and one finding for one cause."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from webviz.api.finding import CauseLevel, Finding, Severity, Symptom

SUMMARIES = {Symptom("", "Transforms")}
"""Statuses that sum up several causes, so that one cause does not explain the others."""


def ordered(findings: Iterable[Finding]) -> Sequence[Finding]:
    """Return the findings to show, the one to repair first at the beginning.

    Findings of one check about one subject become one. Of the others, those on a level that affects
    more come first, or those that cause the symptoms on such a level; notes, which break nothing,
    come last, and errors of this machine, with which ROS does not start, before its warnings. A
    finding that explains no status but those of the ones before it is a symptom of these, and left
    out.
    """
    merged: dict[tuple[str, str], Finding] = {}
    for finding in findings:
        key = finding.id, finding.subject
        known = merged.get(key)
        explains = tuple(dict.fromkeys((*(known.explains if known else ()), *finding.explains)))
        merged[key] = replace(known or finding, explains=explains)
    shown: list[Finding] = []
    explained: set[Symptom] = set()
    for finding in sorted(merged.values(), key=_place):
        symptoms = {*finding.explains} - SUMMARIES
        if symptoms and explained.issuperset(symptoms):
            continue
        shown.append(finding)
        explained |= symptoms
    return tuple(shown)


def _place(finding: Finding) -> tuple[bool, int, bool, bool, str, int, str]:
    is_note, level = finding.severity is Severity.NOTE, finding.causes or finding.level
    is_milder = level is CauseLevel.MACHINE and finding.severity is not Severity.ERROR
    symptoms = len(finding.explains)
    is_symptom = finding.causes is None
    return is_note, level.place, is_symptom, is_milder, finding.id, -symptoms, finding.subject
