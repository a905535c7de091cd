"""Content of bug reports."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import msgspec

from webviz.api.errors import Error

VERSION = 1


Stamp = Annotated[int, msgspec.Meta(ge=-(2**63), le=2**63 - 1)]
"""Nanoseconds since 1970."""
Number = Annotated[int, msgspec.Meta(ge=0, le=2**53)]


class ReportError(Error):
    """A bug report cannot be read or written; one sentence with a remedy."""


class StatusEntry(msgspec.Struct, frozen=True):
    """A status of a display, or of the viewer as a whole.

    Args:
        display: its name; "" for the whole viewer.
        status: its key, such as "Map".
        level: "ok", "idle", "warn" or "error".
        text: as it was shown.
        since: when it began, in seconds since 1970; 0 if unknown.
    """

    display: str
    status: str
    level: str
    text: str
    since: float = 0.0


class FindingEntry(msgspec.Struct, frozen=True):
    """A finding of the doctor, with the ROS times in seconds when it was first and last seen."""

    id: str
    severity: str
    subject: str
    cause: str
    remedy: str
    first: float = 0.0
    last: float = 0.0


class ReportedMoment(msgspec.Struct, frozen=True):
    """A warning or error on the timeline, at a time in seconds since 1970."""

    at: float
    level: str
    name: str
    text: str


class ReportedPick(msgspec.Struct, frozen=True):
    """A selected thing.

    Args:
        display: its number in the list of displays.
        group: of its node, after the id of the display.
        key: of its node.
        number: in the node, None for meshes and images.
        at: coordinates in the frame of the node, in metres.
        color: of a point, None if all have the same.
    """

    display: Number
    group: str
    key: str
    number: Number | None
    at: tuple[float, float, float]
    color: tuple[Number, Number, Number] | None = None


class BugReport(msgspec.Struct, frozen=True, kw_only=True):
    """The main part of a report.

    Args:
        version: of this format.
        source: "live", or the name of the bag.
        made: when, in seconds since 1970.
        at_ns: the moment that was shown, as a time of recording in the slice.
        first_ns, last_ns: the first and the last time of recording in the slice.
        has_names: whether names of hosts, users and home folders were kept.
        statuses, findings, moments: what was wrong.
        selection: of the page that made it.
        versions: of programs, by name.
    """

    version: int = VERSION
    source: str
    made: float
    at_ns: Stamp
    first_ns: Stamp
    last_ns: Stamp
    has_names: bool = False
    statuses: tuple[StatusEntry, ...] = ()
    findings: tuple[FindingEntry, ...] = ()
    moments: tuple[ReportedMoment, ...] = ()
    selection: tuple[ReportedPick, ...] = ()
    versions: Mapping[str, str] = {}

    @property
    def at_s(self) -> float:
        """The moment, in seconds from the start of the slice."""
        return (self.at_ns - self.first_ns) / 1e9


class UnpackedReport(msgspec.Struct, frozen=True):
    """A report whose slice and config are files.

    Args:
        report: the main part.
        bag: the slice, an MCAP file.
        config: YAML.
        picture: None if it has none.
    """

    report: BugReport
    bag: Path
    config: Path
    picture: Path | None
