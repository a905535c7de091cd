"""Findings of the doctor, for its panel and the badge of the toolbar."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import msgspec

from webviz.api.check import CheckText
from webviz.api.check_registry import known_checks
from webviz.api.finding import ChangeDisplay, Fact, Finding, HideDisplays, Severity, TryYaw
from webviz.api.status import Level, OtherFixedFrame, Status
from webviz.engine.forms import brief
from webviz.engine.parts.status_lines import RemedyButton, button, remedy_of
from webviz.engine.store import PageStore

NS_PER_S = 1e9
LEVELS = {Severity.NOTE: "ok", Severity.WARNING: "warn", Severity.ERROR: "error"}


class ExplainedStatus(msgspec.Struct, frozen=True):
    """A status that a finding explains.

    Args:
        display: its id; "" for the viewer as a whole.
        status: key of the status.
        name: of the display; "" for the viewer as a whole.
    """

    display: str
    status: str
    name: str


class ShownFinding(msgspec.Struct, frozen=True):
    """A finding, see `webviz.api.finding.Finding`.

    Args:
        level: "ok" for a note, "warn" or "error".
        since: when it was first seen, in seconds since 1970; None while time is unknown.
        evidence: what was observed, pairs of a name and a value.
        began: when it was first seen in the recording or in the memory of live topics, in seconds
            since 1970 and from the start; None without one.
        explains: the statuses that follow from it.
        button: that repairs it, None if none does.
        why, repair: paragraphs of the documentation of its check.
    """

    id: str
    subject: str
    level: str
    cause: str
    since: float | None
    evidence: Sequence[tuple[str, str]]
    began: tuple[float, float] | None
    proof: str
    remedy: str
    command: str
    explains: Sequence[ExplainedStatus]
    button: RemedyButton | None
    why: Sequence[str]
    repair: Sequence[str]


class FindingsStore(PageStore, frozen=True):
    """The findings, the one to repair first at the beginning.

    Args:
        examined: when that was, in whole seconds since 1970; None before the first examination.
    """

    all: Sequence[ShownFinding]
    examined: int | None = None


def findings_store(
    findings: Sequence[Finding], names: Mapping[str, str], start_s: float, examined_ns: int
) -> FindingsStore:
    """Return findings as pages show them.

    Args:
        findings: of the last round.
        names: of displays by id.
        start_s: of the recording, in seconds since 1970.
        examined_ns: ROS time of that round, 0 before the first.
    """
    examined = int(examined_ns / NS_PER_S) if examined_ns else None
    return FindingsStore([_finding(each, names, start_s) for each in findings], examined)


def _finding(finding: Finding, names: Mapping[str, str], start_s: float) -> ShownFinding:
    why, repair = _texts(finding.id)
    began_s = finding.began_s
    return ShownFinding(
        id=finding.id,
        subject=brief(finding.subject),
        level=LEVELS[finding.severity],
        cause=brief(finding.cause),
        since=round(finding.first_ns / NS_PER_S, 3) if finding.first_ns else None,
        evidence=[
            (name.replace("_", " "), brief(_fact(v))) for name, v in finding.evidence.items()
        ],
        began=None if began_s is None else (round(start_s + began_s, 3), round(began_s, 3)),
        proof=brief(finding.proof),
        remedy=brief(finding.remedy),
        command=brief(finding.command),
        explains=[
            ExplainedStatus(display, brief(status), brief(names.get(display, "")))
            for display, status in finding.explains
        ],
        button=_button(finding),
        why=why,
        repair=repair,
    )


def _fact(value: Fact) -> str:
    """Return a piece of evidence in words."""
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, tuple):
        return ", ".join(value) or "none"
    return {None: "unknown", "": "none", True: "yes", False: "no"}.get(value, str(value))


def _button(finding: Finding) -> RemedyButton | None:
    """Return the button that repairs or shows it."""
    match finding.button:
        case None:
            return None
        case ChangeDisplay(display, remedy):
            return remedy_of(Status(Level.WARN, "", remedy), display)
        case HideDisplays(displays) as hide:
            hidden = {"path": "enabled", "value": False}
            return button(hide.label, "SetProperty", *({"display": id} | hidden for id in displays))
        case TryYaw(frame, yaw) as trial:
            return button(trial.label, "TryFrame", {"frame": frame, "yaw": yaw})
        case OtherFixedFrame() as other:
            return remedy_of(Status(Level.WARN, "", other), "")


def _texts(id: str) -> tuple[Sequence[str], Sequence[str]]:
    """Return why a check matters, and how to repair what it finds."""
    for check in known_checks():
        if check.id == id:
            text = CheckText(check)
            return text.why, text.repair
    return (), ()
