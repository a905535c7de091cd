"""`webviz test`: checks rules over a bag or live topics, for CI."""

import contextlib
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import App, Parameter, validators

from webviz.shell.cli.ending import Stop, until_signal
from webviz.shell.cli.options import (
    ROS_ARGS_HELP,
    ConnectOptions,
    File,
    Plugins,
    Repeatable,
    RosArgs,
)
from webviz.shell.cli.terminal import say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from webviz.files.config import Config
    from webviz.shell.doctor.rule_results import RuleResults

EXAMPLES = """\
Examples:
  webviz test --bag run.mcap --rule "Scan.walls > 0.8"
  webviz test --bag run.mcap -d nav2.yaml --junit report.xml
  webviz test bug.zip -o tests/test_bug.py     write a test of a bug report
  webviz test --rule "/scan.rate >= 5 for 2s" --rule "doctor.errors == 0" --seconds 30

A rule names a display, a topic that a display shows, or the doctor, and a value: status, rate, age,
delay, walls, blocked; findings and errors of the doctor. Rules of the config (`watch:`) count, too.
They are evaluated once per second.

Exit status: 0 if all rules hold, 1 after an error, 2 for invalid arguments, 3 if one does not hold.

"""
VIOLATED = 3

app = App("test", help_epilogue=EXAMPLES + ROS_ARGS_HELP)


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class RuleOptions:
    """Rules, what they are about, and the form of the report."""

    rule: Annotated[Repeatable[str], Parameter(metavar="RULE")] = ()
    """A condition that must hold (repeatable)."""
    bag: Annotated[File | None, Parameter(alias="-b")] = None
    """Play a bag from its beginning to its end, instead of live topics."""
    display_config: Annotated[File | None, Parameter(alias="-d")] = None
    """The displays of this config (default: those that fit the topics)."""
    seconds: Annotated[
        float, Parameter(validator=validators.Number(gt=0, lte=86400), metavar="SECONDS")
    ] = 10.0
    """Time for live topics, after their discovery."""
    junit: Annotated[File | None, Parameter()] = None
    """Write the results to this file as JUnit XML, too."""
    plugin: Plugins = ()
    output: Annotated[File | None, Parameter(alias="-o")] = None
    """Write a test of a bug report to this Python file, with its recording beside it."""
    check: Annotated[
        Literal["finding", "status", "picture"] | None, Parameter(show_default=False)
    ] = None
    """Part of a bug report to test (default: findings, or else statuses, or else the picture)."""


def _check(
    report: Path | None = None,
    *,
    options: RuleOptions = RuleOptions(),
    connect: ConnectOptions = ConnectOptions(),
    **_: object,
) -> None:
    """Raise ValueError for an invalid combination of arguments."""
    connect.check(options.bag is not None)
    for text in options.rule:
        from webviz.files.config import WatchRule

        try:
            WatchRule(rule=text)
        except ValueError as error:
            raise ValueError(f"--rule {error}") from error
    if report is None:
        if options.output or options.check:
            raise ValueError("-o and --check need a bug report: webviz test bug.zip -o test_bug.py")
        return
    if options.output is None:
        raise ValueError("A test of a bug report needs -o FILE.")
    if not options.output.stem.isidentifier() or options.output.suffix != ".py":
        raise ValueError(f"{options.output.name} is not a valid name of a Python module.")


@app.default(validator=_check)
def check_rules(
    report: Annotated[File | None, Parameter(name="REPORT", show_default=False)] = None,
    /,
    *,
    options: RuleOptions = RuleOptions(),
    connect: ConnectOptions = ConnectOptions(),
    ros: RosArgs,
) -> int:
    """Check that rules hold, over a bag or live topics; or write a test of a bug report.

    Args:
        report: Zip file of a bug report, to write a test of it.
        options: What to check.
        connect: Bridge of live topics.
        ros: Arguments for ROS.
    """

    def work(stop: Stop) -> int:
        if report is not None and options.output is not None:
            from webviz.shell.report.writing import write_test

            say(f"webviz: {write_test(report, options.output, options.check)}")
            return 0
        from webviz.files.config.atomic import write_text

        results = _examined(options, connect, ros)
        say(*results.to_text().split("\n"))
        if options.junit is not None:
            write_text(results.to_junit(), options.junit)
        return VIOLATED if results.failed else 0

    return until_signal(work)


def _examined(options: RuleOptions, connect: ConnectOptions, ros: "Sequence[str]") -> "RuleResults":
    from webviz.engine.pipeline import plugins
    from webviz.shell.app.reading import read_config
    from webviz.shell.bag_player import bag_player
    from webviz.shell.cli.doctor import progress
    from webviz.shell.doctor.examination import DISCOVERY_S, examine_bag, examine_live

    for path in options.plugin:
        plugins.load(path)
    path = options.display_config
    _rules(options, None)  # mistakes in them come before the bag is read
    if options.bag is not None:
        with contextlib.closing(bag_player(options.bag, ros_args=ros)) as bag:
            config = read_config(path, bag)
            results = _rules(options, config)
            examine_bag(bag, config, str(options.bag), progress, results)
            return results
    chosen_config = read_config(path) if path else None
    results = _rules(options, chosen_config)
    with contextlib.closing(connect.source(ros, chosen_config)) as source:
        until_s = time.monotonic() + DISCOVERY_S + options.seconds
        examine_live(source, chosen_config, until_s, progress, results)
    return results


def _rules(options: RuleOptions, config: "Config | None") -> "RuleResults":
    """Return the rules of the config and of the command line, without results yet."""
    from webviz.api.errors import Error, UsageError
    from webviz.files.config import WatchRule
    from webviz.shell.doctor.rule_results import RuleResults

    own = [WatchRule(rule=text) for text in options.rule]
    results = RuleResults(
        str(options.bag or "live"), [*(config.settings.watch if config else ()), *own]
    )
    if (config or not options.display_config) and not results.all:
        kind = Error if options.display_config else UsageError
        raise kind("No rules to check. Give --rule, or a config with rules in `watch:`.")
    return results
