"""Showing the moment of a bug report."""

from __future__ import annotations

from webviz import commands
from webviz.files.report import BugReport
from webviz.shell.app.viewer import Viewer


def show(viewer: Viewer, report: BugReport) -> None:
    """Show the time and the selection of a report.

    Args:
        viewer: with its bag and config.
        report: the main part.
    """
    span = viewer.span
    end_s = span[1] - span[0]
    viewer.seek(min(max(report.at_s, 0.0), end_s))
    viewer.do(commands.RestoreSelection(tuple(report.selection)))
