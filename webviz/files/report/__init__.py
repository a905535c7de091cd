"""Bug reports: one file with a part of a recording, the config, and what was wrong."""

from webviz.files.report.archive import read_report, write_report
from webviz.files.report.content import (
    BugReport,
    FindingEntry,
    ReportedMoment,
    ReportedPick,
    ReportError,
    StatusEntry,
    UnpackedReport,
)
from webviz.files.report.names import PrivateNames

__all__ = [
    "BugReport",
    "FindingEntry",
    "PrivateNames",
    "ReportError",
    "ReportedMoment",
    "ReportedPick",
    "StatusEntry",
    "UnpackedReport",
    "read_report",
    "write_report",
]
