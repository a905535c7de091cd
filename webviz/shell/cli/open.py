"""`webviz open`: opens a bug report as it was."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter

from webviz import commands
from webviz.files.report import BugReport
from webviz.shell.app.viewer import Viewer
from webviz.shell.cli.ending import Stop, until_signal
from webviz.shell.cli.options import ROS_ARGS_HELP, File, RosArgs
from webviz.shell.cli.viewing_options import ViewingOptions

EXAMPLES = """\
Examples:
  webviz bug.zip                     open a report: the same time, view, displays and selection
  webviz bug.zip -d other.yaml       look at its recording with another config

A report is read-only: nothing is published, and the zip file stays as it is.

"""

app = App("open", help_epilogue=EXAMPLES + ROS_ARGS_HELP)


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


@app.default
def open_report(
    report: Annotated[File, Parameter(name="REPORT")],
    /,
    *,
    options: ViewingOptions = ViewingOptions(),
    ros: RosArgs,
) -> int:
    """Serve the page with a bug report until Ctrl-C or SIGTERM.

    Args:
        report: Zip file of a bug report.
        options: Of the viewer.
        ros: Arguments for ROS.
    """

    def work(stop: Stop) -> int:
        from dataclasses import replace

        from webviz.data.words import counted
        from webviz.data.working_folder import working_folder
        from webviz.files.report import read_report
        from webviz.shell.cli.open import show
        from webviz.shell.cli.serving import serve
        from webviz.shell.cli.viewing_options import BagOptions

        with working_folder("webviz_report_") as folder:
            unpacked = read_report(report, folder)
            quiet = replace(
                options, template=unpacked.config, no_publish=True, autosave=False, no_restore=True
            )
            bag = BagOptions(bag=(unpacked.bag,), paused=True)
            return serve(
                quiet,
                ros,
                stop,
                note=f"{counted(len(unpacked.report.findings), 'finding')} in {report.name}.",
                bag=bag,
                then=lambda viewer: show(viewer, unpacked.report),
            )

    return until_signal(work)
