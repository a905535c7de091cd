"""`webviz report`: writes a bug report of a bag or of live topics."""

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from cyclopts import App, Parameter, validators

from webviz.shell.cli.comparison_options import ComparisonOptions
from webviz.shell.cli.ending import Stop, until_signal
from webviz.shell.cli.options import (
    ROS_ARGS_HELP,
    ConfigOptions,
    ConnectOptions,
    File,
    Flag,
    RosArgs,
)
from webviz.shell.cli.screenshot_options import Time
from webviz.shell.cli.terminal import progress, say, warn

if TYPE_CHECKING:
    from webviz.sources import Source

EXAMPLES = """\
Examples:
  webviz report -o bug.zip                              listen to live topics for some seconds
  webviz report --bag run.mcap --from 10 --to 20 -o bug.zip
  webviz report --bag run.mcap --list                   print what a report would contain
  webviz bug.zip                                        open a report
  webviz test bug.zip -o tests/test_bug.py              make a test of it

Names of hosts, users and home folders are left out; nothing is sent anywhere.

"""

app = App("report", help_epilogue=EXAMPLES + ROS_ARGS_HELP)


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ReportOptions(ConfigOptions, ComparisonOptions):
    """Subject of the report, and the file."""

    output: Annotated[File | None, Parameter(alias="-o")] = None
    """Zip file to write."""
    bag: Annotated[File | None, Parameter(alias="-b")] = None
    """Report on a bag instead of live topics."""
    first: Annotated[Time, Parameter(name="--from", show_default=False)] = "start"
    """First time of the bag in the report: seconds, a Unix time or `start` (default: start)."""
    last: Annotated[Time, Parameter(name="--to", show_default=False)] = "end"
    """Last time of the bag in the report (default: end)."""
    at: Annotated[Time | None, Parameter(show_default=False)] = None
    """The moment to show (default: that of --to)."""
    seconds: Annotated[
        float, Parameter(validator=validators.Number(gt=0, lte=3600), metavar="SECONDS")
    ] = 10.0
    """Time to listen to live topics."""
    list: Flag = False
    """Print what the report would contain, and write nothing."""
    with_names: Flag = False
    """Keep names of hosts, users and home folders."""
    no_picture: Flag = False
    """Make no picture, which takes a browser on this machine."""


def _check(
    *,
    options: ReportOptions = ReportOptions(),
    connect: ConnectOptions = ConnectOptions(),
    **_: object,
) -> None:
    """Raise ValueError for an invalid combination of arguments."""
    connect.check(options.bag is not None)
    options.check_comparison(options.bag is not None)
    if options.bag is None:
        defaults_changed = {
            "from": options.first != "start",
            "to": options.last != "end",
            "at": options.at,
        }
        for flag, value in defaults_changed.items():
            if value not in (None, False):
                raise ValueError(f"--{flag} needs --bag.")
    if (options.output is None) is not options.list:
        raise ValueError("Give either -o FILE or --list.")
    if options.output is not None and options.output.suffix.lower() != ".zip":
        raise ValueError(f"{options.output} must end with .zip.")


@app.default(validator=_check)
def report(
    *,
    options: ReportOptions = ReportOptions(),
    connect: ConnectOptions = ConnectOptions(),
    ros: RosArgs,
) -> int:
    """Write a bug report, which `webviz FILE.zip` opens as it was."""

    def work(stop: Stop) -> int:
        from webviz.engine.pipeline import plugins
        from webviz.shell.report.making import make_report
        from webviz.shell.report.scenes import reported_scene

        for path in options.plugin:
            plugins.load(path)
        options.allow_meshes()
        with contextlib.closing(_source(options, connect, ros)) as source:
            config = options.config_of(source)
            wants_picture = not (options.list or options.no_picture)
            with reported_scene(config, wants_picture) as (scene, problem):
                if problem:
                    warn(f"webviz: the report has no picture: {problem}")
                answer = make_report(
                    config,
                    source,
                    scene,
                    options.output,
                    span=(options.first, options.last),
                    at=options.at,
                    name=str(options.bag),
                    seconds=options.seconds,
                    with_names=options.with_names,
                    progress=progress,
                )
        say(*(answer.split("\n") if options.list else [f"webviz: {answer}"]))
        return 0

    return until_signal(work)


def _source(options: ReportOptions, connect: ConnectOptions, ros: Sequence[str]) -> "Source":
    if options.bag is not None:
        return options.beside(options.bag, ros)
    path = options.display_config
    return connect.source(ros, options.read(path) if path else None)
