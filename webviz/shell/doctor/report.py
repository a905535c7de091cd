"""Reports of the doctor: for people, and as JSON."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any

import msgspec

from webviz.api.finding import Fact, Finding, Severity
from webviz.api.status import Level, Measurement, Status
from webviz.data.names import readable
from webviz.data.words import counted
from webviz.engine.parts.display_rows import problems
from webviz.engine.state import Row

WIDTH = 90
COLORS = {"error": "31;1", "warning": "33;1", "note": "36", "id": "1", "faint": "2", "ok": "32;1"}
"""Codes of ANSI terminals."""
UNFINISHED = (
    "This machine is busy, or --seconds is short: there was too little time to check topics, "
    "transforms and data. Repeat the command with --seconds 30."
)
LEVELS = {Level.ERROR: "error", Level.WARN: "warning"}
Meta = msgspec.Meta


class ReportedStatus(msgspec.Struct):
    """A status of a display, or of the viewer as a whole."""

    display: Annotated[str, Meta(description='Name of the display; "" for the whole viewer.')]
    status: Annotated[str, Meta(description="Name of the status.")]
    text: Annotated[str, Meta(description="Text of the status.")] = ""
    level: Annotated[str, Meta(description='"error" or "warning"; "" if it no longer exists.')] = ""
    values: Annotated[
        Sequence[Measurement], Meta(description="Measured values, more exact than in the text.")
    ] = ()
    finding: Annotated[
        str, Meta(description='Id of the first finding that explains it; "" for none.')
    ] = ""


class ReportedFinding(msgspec.Struct, kw_only=True):
    """A cause with its evidence and its remedy."""

    id: Annotated[str, Meta(description="Of the check; `webviz doctor --explain ID` explains it.")]
    level: Annotated[str, Meta(description="Level of the cause, such as network or frames.")]
    severity: Annotated[str, Meta(description="error, warning or note; a note breaks nothing.")]
    subject: Annotated[str, Meta(description="The topic, frame or device that it is about.")]
    cause: Annotated[str, Meta(description="One sentence.")]
    proof: Annotated[str, Meta(description='Sentence with the measurement; "" for none.')] = ""
    remedy: Annotated[str, Meta(description="Sentence with the remedy.")]
    command: Annotated[str, Meta(description='Command for a terminal; "" for none.')]
    evidence: Annotated[Mapping[str, Fact], Meta(description="Observed values, by name.")]
    explains: Annotated[
        Sequence[ReportedStatus], Meta(description="The statuses that follow from it.")
    ]
    first: Annotated[float, Meta(description="ROS time when it was first seen in s; 0: unknown.")]
    last: Annotated[float, Meta(description="ROS time when it was last seen in s; 0: unknown.")]


class DoctorReport(msgspec.Struct, kw_only=True):
    """The report of an examination."""

    version: Annotated[int, Meta(description="Of this format; 1.")] = 1
    source: Annotated[str, Meta(description='"live", or the path of the bag.')]
    checks: Annotated[int, Meta(description="Number of checks that were run.")]
    displays: Annotated[int, Meta(description="Number of displays that were examined.")]
    findings: Annotated[
        Sequence[ReportedFinding], Meta(description="The one to repair first comes first.")
    ]
    statuses: Annotated[
        Sequence[ReportedStatus],
        Meta(description="All warnings and errors, each with the finding that explains it."),
    ] = ()
    unexplained: Annotated[
        Sequence[ReportedStatus],
        Meta(description="Warnings and errors of displays that no finding explains."),
    ]
    unfinished: Annotated[
        bool,
        Meta(description="Whether there was too little time for the checks of live topics."),
    ] = False

    @property
    def is_well(self) -> bool:
        """Return whether no finding is more than a note, and each error is explained by one."""
        return all(each.severity == "note" for each in self.findings) and not any(
            each.level == LEVELS[Level.ERROR] for each in self.unexplained
        )

    @property
    def is_unknown(self) -> bool:
        """Return whether nothing was found, in too little time to find anything."""
        return self.unfinished and self.is_well


def report_of(
    source: str,
    rows: Sequence[Row],
    general: Mapping[str, Status],
    findings: Sequence[Finding],
    checks: int,
) -> DoctorReport:
    """Make a report.

    Args:
        source: "live", or the path of a bag.
        rows, general: displays and statuses of the viewer at the end.
        findings: in their order.
        checks: number of checks that were run.
    """
    bad = problems(general, rows)
    rows = [row for row in rows if row.type != "Group"]
    names = {row.id: row.name for row in rows}
    statuses = {("", key): status for key, status in general.items()}
    statuses |= {(row.id, key): status for row in rows for key, status in row.statuses.items()}

    def reported(place: tuple[str, str]) -> ReportedStatus:
        status = statuses.get(place)
        name = names.get(place[0], "")
        if status is None:
            return ReportedStatus(name, place[1], finding=causes.get(place, ""))
        level = LEVELS.get(status.level, "")
        return ReportedStatus(
            name, place[1], status.text, level, status.values, causes.get(place, "")
        )

    causes = {
        (symptom.display, symptom.status): finding.id
        for finding in reversed(findings)
        for symptom in finding.explains
    }
    return DoctorReport(
        source=source,
        checks=checks,
        displays=len(rows),
        findings=[
            ReportedFinding(
                id=each.id,
                level=each.level.title,
                severity=each.severity.name.lower(),
                subject=each.subject,
                cause=each.cause,
                proof=each.proof,
                remedy=each.remedy,
                command=each.command,
                evidence=dict(each.evidence),
                explains=[reported(symptom) for symptom in each.explains],
                first=each.first_ns / 1e9,
                last=each.last_ns / 1e9,
            )
            for each in findings
        ],
        statuses=[reported(place) for place in bad],
        unexplained=[reported(place) for place in bad if place not in causes],
    )


def schema_text() -> str:
    """Return the JSON Schema of reports."""
    schema = msgspec.json.schema(DoctorReport)
    for definition in schema["$defs"].values():
        # msgspec before 0.23 keeps the indentation of docstrings.
        if "description" in definition:
            definition["description"] = inspect.cleandoc(definition["description"])
    return msgspec.json.format(msgspec.json.encode(schema), indent=2).decode() + "\n"


def to_json(report: DoctorReport) -> str:
    """Return the report as JSON."""
    return msgspec.json.format(msgspec.json.encode(report), indent=2).decode()


def to_text(report: DoctorReport, is_colored: bool) -> str:
    """Return the report for a person.

    Args:
        report: the report.
        is_colored: whether the terminal knows ANSI colours.
    """
    readable_report = msgspec.convert(_readable(msgspec.to_builtins(report)), DoctorReport)
    return "\n".join(_lines(readable_report, is_colored))


def _readable(value: Any) -> Any:
    """Return plain values with each text in one line."""
    if isinstance(value, dict):
        return {key: _readable(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_readable(each) for each in value]
    return readable(value) if isinstance(value, str) else value


def _lines(report: DoctorReport, is_colored: bool) -> Iterator[str]:
    def paint(text: str, color: str) -> str:
        return f"\x1b[{COLORS[color]}m{text}\x1b[0m" if is_colored else text

    for finding in report.findings:
        head = f"{paint(finding.severity, finding.severity)}[{paint(finding.id, 'id')}]"
        yield f"{head}: {finding.cause}"
        if finding.proof:
            yield from _wrapped("  measured: ", finding.proof)
        yield from _wrapped("  help: ", finding.remedy)
        if finding.command:
            yield f"        $ {finding.command}"
        for status in finding.explains:
            where = status.display or "viewer"
            yield paint(f"  explains: {where}, {status.status}", "faint")
        yield ""
    unexplained = () if report.unfinished else report.unexplained
    for status in unexplained:
        where = f"{status.display or 'viewer'}, {status.status}: "
        yield from _wrapped(f"{paint('status', 'faint')}: {where}", status.text)
    if unexplained:
        yield ""
    if report.unfinished:
        yield from _wrapped(f"{paint('unfinished', 'warning')}: ", UNFINISHED)
        yield ""
    severe = sum(finding.severity != Severity.NOTE.name.lower() for finding in report.findings)
    scope = f"{counted(report.checks, 'check')}, {counted(report.displays, 'display')}"
    if severe:
        first = next(each.id for each in report.findings)
        yield f"{counted(severe, 'finding')} ({scope}). More: webviz doctor --explain {first}"
    elif unexplained:
        errors = sum(each.level == LEVELS[Level.ERROR] for each in report.unexplained)
        lacking = (
            counted(errors, "error") if errors else counted(len(report.unexplained), "warning")
        )
        yield f"No finding explains {lacking} above ({scope})."
    elif not report.unfinished:
        yield f"{paint('All is well', 'ok')} ({scope})."


def _wrapped(lead: str, text: str) -> Sequence[str]:
    return textwrap.wrap(text, WIDTH, initial_indent=lead, subsequent_indent="        ") or [lead]
