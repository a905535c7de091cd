"""Findings of the doctor: one cause, with its evidence, its remedy and the statuses it explains."""

from __future__ import annotations

import enum
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from webviz.api.status import OtherFixedFrame, Remedy

Fact = str | int | float | bool | None | tuple[str, ...]
"""A piece of evidence, as JSON has it."""


class CauseLevel(enum.Enum):
    """The nine levels of causes, from those that affect most to those that affect least.

    The value begins the ids of the checks on that level.
    """

    MACHINE = "ENV"
    NETWORK = "NET"
    MIDDLEWARE = "SHM"
    GRAPH = "GRAPH"
    TIME = "TIME"
    FRAMES = "TF"
    DATA = "DATA"
    VIEW = "VIEW"
    BROWSER = "WEB"

    @property
    def title(self) -> str:
        """Its name in sentences."""
        return self.name.lower()

    @property
    def place(self) -> int:
        """Its place among the levels; causes come before their symptoms."""
        return list(CauseLevel).index(self)

    @staticmethod
    def of(id: str) -> CauseLevel:
        """Return the level that the id of a check names.

        Raises:
            ValueError: it names none.
        """
        return CauseLevel(id.rstrip("0123456789"))


class Severity(enum.IntEnum):
    """The severity of a finding.

    A NOTE is worth knowing and breaks nothing yet. With a WARNING, something is wrong or missing;
    with an ERROR, nothing can be shown of what it explains.
    """

    NOTE = 0
    WARNING = 1
    ERROR = 2


class Symptom(NamedTuple):
    """A status that a finding explains.

    Args:
        display: its id; "" for the viewer as a whole.
        status: key of the status.
    """

    display: str
    status: str


class ChangeDisplay(NamedTuple):
    """A change of a display that is a remedy.

    Args:
        display: its id.
        remedy: the property and the value to give it.
    """

    display: str
    remedy: Remedy

    @property
    def label(self) -> str:
        """Label of the button that makes the change."""
        return self.remedy.label


class HideDisplays(NamedTuple):
    """Displays that draw nothing, which a click hides.

    Args:
        displays: their ids.
    """

    displays: tuple[str, ...]

    @property
    def label(self) -> str:
        """Label of the button that hides the displays."""
        count = len(self.displays)
        return "Hide it" if count == 1 else "Hide both" if count == 2 else f"Hide all {count}"


class TryYaw(NamedTuple):
    """A static frame that a click tries in another yaw, as "What if" does; nothing is published.

    Args:
        frame: its id.
        yaw: rotation about its own z axis, in radians.
    """

    frame: str
    yaw: float

    @property
    def label(self) -> str:
        """Label of the button that tries the remedy."""
        return "Show me"


Button = ChangeDisplay | HideDisplays | OtherFixedFrame | TryYaw
"""The change that a click on the button of a finding makes."""


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One cause that a check has found.

    Args:
        id: of the check, such as GRAPH003.
        cause: one sentence.
        remedy: what to do, a sentence.
        proof: what was measured, a sentence; "" if the cause says it all.
        subject: the topic, frame, display or device it is about; a check has one finding for each.
        severity: whether anything is broken by it.
        evidence: what was observed, by name.
        command: to type in a terminal, "" if none repairs it.
        button: a change of the viewer that repairs it or shows it, None if none does.
        explains: the statuses that follow from it.
        causes: level of the symptoms that it comes before, if that affects more than its own; time
            that stands still is the cause of silent topics.
        first_ns, last_ns: ROS time when it was first and last seen; 0 while unknown.
        began_s: position in the recording, or in the memory of live topics, when it was first seen;
            None without one.
    """

    id: str
    cause: str
    remedy: str
    proof: str = ""
    subject: str = ""
    severity: Severity = Severity.WARNING
    evidence: Mapping[str, Fact] = field(default_factory=dict)
    command: str = ""
    button: Button | None = None
    explains: tuple[Symptom, ...] = ()
    causes: CauseLevel | None = None
    first_ns: int = field(default=0, compare=False)
    last_ns: int = field(default=0, compare=False)
    began_s: float | None = field(default=None, compare=False)

    @property
    def level(self) -> CauseLevel:
        """The level of the cause."""
        return CauseLevel.of(self.id)


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
        former = merged.get(key)
        explains = tuple(dict.fromkeys((*(former.explains if former else ()), *finding.explains)))
        merged[key] = replace(former or finding, explains=explains)
    in_order: list[Finding] = []
    explained: set[Symptom] = set()
    for finding in sorted(merged.values(), key=_place):
        symptoms = {*finding.explains} - SUMMARIES
        if symptoms and explained.issuperset(symptoms):
            continue
        in_order.append(finding)
        explained |= symptoms
    return tuple(in_order)


def _place(finding: Finding) -> tuple[bool, int, bool, bool, str, int, str]:
    is_note, level = finding.severity is Severity.NOTE, finding.causes or finding.level
    is_milder = level is CauseLevel.MACHINE and finding.severity is not Severity.ERROR
    symptoms = len(finding.explains)
    is_symptom = finding.causes is None
    return is_note, level.place, is_symptom, is_milder, finding.id, -symptoms, finding.subject
