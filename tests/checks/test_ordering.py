"""The order in which the doctor shows findings."""

from __future__ import annotations

import pytest

from webviz.api.finding import CauseLevel, Finding, Severity, Symptom, ordered

SCAN, MAP, SUM = Symptom("scan", "Topic"), Symptom("map", "Topic"), Symptom("", "Transforms")
NOTE, WARNING, ERROR = Severity
TIME = CauseLevel.TIME


def finding(
    id: str,
    *explains: Symptom,
    subject: str = "",
    severity: Severity = WARNING,
    causes: CauseLevel | None = None,
) -> Finding:
    return Finding(
        id=id,
        cause=f"{id} {subject}.",
        remedy="Repair it.",
        subject=subject,
        severity=severity,
        explains=explains,
        causes=causes,
    )


@pytest.mark.parametrize(
    ("findings", "first"),
    [
        ([finding("TF002"), finding("ENV003")], "ENV003"),
        ([finding("ENV003", severity=NOTE), finding("WEB001")], "WEB001"),
        ([finding("TF001"), finding("DATA001", causes=TIME)], "DATA001"),
        ([finding("TIME001"), finding("DATA001", causes=TIME)], "DATA001"),
        ([finding("ENV001"), finding("ENV002", severity=ERROR)], "ENV002"),
        ([finding("TF002", severity=ERROR), finding("TF001")], "TF001"),
        ([finding("TF002"), finding("TF001")], "TF001"),
        ([finding("DATA001"), finding("DATA001", MAP, subject="z")], "DATA001 z"),
        ([finding("DATA001", MAP, SCAN, subject="b"), finding("DATA001", SUM)], "DATA001 b"),
        ([finding("DATA001", subject="b"), finding("DATA001", subject="a")], "DATA001 a"),
    ],
    ids=[
        *("level", "a note", "a cause of a level", "a cause before its symptoms", "an error here"),
        *("an error elsewhere", "id", "more symptoms", "most symptoms", "subject"),
    ],
)
def test_findings_that_affect_most_come_first(findings: list[Finding], first: str) -> None:
    for each in (findings, findings[::-1]):
        results = ordered(each)
        assert len(results) == 2
        assert f"{results[0].id} {results[0].subject}".strip() == first


def test_findings_of_one_check_about_one_subject_are_one() -> None:
    (one,) = ordered([finding("TF001", SCAN, MAP), finding("TF001", MAP, SUM)])
    assert one.explains == (SCAN, MAP, SUM)
    assert len(ordered([finding("TF001", subject="a"), finding("TF001", subject="b")])) == 2


def test_a_finding_that_explains_nothing_more_is_a_symptom() -> None:
    cause, other = finding("NET001", SCAN, SUM), finding("TIME001", MAP)
    both = finding("DATA001", SCAN, MAP)
    assert ordered([both, other, cause]) == (cause, other)
    assert ordered([both, cause]) == (cause, both), "one status is not explained"
    silent, summed = finding("VIEW001"), finding("VIEW002", SUM)
    assert ordered([summed, silent, cause]) == (cause, silent, summed), "neither is a symptom"
