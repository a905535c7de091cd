"""A fault that is provoked, and what the doctor must say of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from tests.doctor_trial.robot import TrialRobot
from webviz.shell.doctor.report import DoctorReport, ReportedFinding


def changed(name: str, **changes: Any) -> Callable[[TrialRobot], None]:
    """Return what changes fields of a stream."""

    def change(robot: TrialRobot) -> None:
        robot.streams[name] = replace(robot[name], **changes)

    return change


@dataclass(frozen=True)
class Provocation:
    """A fault.

    Args:
        name: of the fault.
        id: of the finding that must come first and be the only one above a note.
        remedy: a part of its remedy, its command, or its cause.
        change: makes the robot faulty; None leaves it well.
        is_recorded: whether the doctor examines a bag of it.
        here, there: variables of the environment of webviz and of the robot.
        shell: commands that are run before in the namespaces of both.
        apart: commands that are run before in a mount namespace of the robot alone.
        options: of `webviz doctor`.
        seconds: of the examination.
        is_alone: whether the doctor runs without a robot.
        files: that are written into the working folder before, by name.
    """

    name: str
    id: str
    remedy: str
    change: Callable[[TrialRobot], object] | None = None
    is_recorded: bool = False
    here: Mapping[str, str] = field(default_factory=dict)
    there: Mapping[str, str] = field(default_factory=dict)
    shell: str = ""
    apart: str = ""
    options: Sequence[str] = ()
    seconds: float = 12.0
    is_alone: bool = False
    files: Mapping[str, str] = field(default_factory=dict)

    def robot(self) -> TrialRobot:
        """Return the faulty robot."""
        robot = TrialRobot()
        if self.change is not None:
            self.change(robot)
        return robot

    def problem(self, report: DoctorReport) -> str:
        """Return why the report does not name the fault, "" if it does."""
        relevant = [f for f in report.findings if f.severity != "note" or f.id == self.id]
        if not self.id:
            return "" if not relevant else f"not well: {_named(relevant)}"
        if not relevant:
            return "nothing is named"
        if relevant[0].id != self.id:
            return f"first is {_named(relevant)}"
        if len(relevant) > 1:
            return f"more than one: {_named(relevant)}"
        text = f"{relevant[0].remedy} {relevant[0].command} {relevant[0].cause}"
        return "" if self.remedy in text else f"another remedy: {relevant[0].remedy}"


def _named(findings: Sequence[ReportedFinding]) -> str:
    return ", ".join(f"{each.id} {each.subject}".strip() for each in findings)


def written(folder: Path, files: Mapping[str, str]) -> None:
    """Write files into a folder."""
    for name, text in files.items():
        (folder / name).write_text(text)
