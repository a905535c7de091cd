"""`webviz doctor`: finds the causes of what is not shown, live or in a bag, without a browser."""

import contextlib
import os
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from cyclopts import App, Parameter, validators

from webviz.shell.cli.ending import Stop, until_signal
from webviz.shell.cli.options import (
    ROS_ARGS_HELP,
    ConnectOptions,
    File,
    Flag,
    Plugins,
    RosArgs,
    check_source,
)
from webviz.shell.cli.terminal import progress, say, say_json, say_painted

if TYPE_CHECKING:
    from webviz.shell.doctor.report import DoctorReport

EXAMPLES = """\
Examples:
  webviz doctor                      examine the ROS graph for some seconds
  webviz doctor --bag run.mcap       examine a bag
  webviz doctor -d nav2.rviz --json  examine the displays of a config, for a program
  webviz doctor --connect ws://robot:8765
  webviz doctor --peer user@robot    compare this machine with another, over ssh
  webviz doctor --explain TF003      explain a finding

Exit status: 0 without findings above "note", 3 with some or with an error of a display that none
explains, 1 after an error or with too little time to find any, 2 for invalid arguments.

"""
FINDINGS, UNKNOWN = 3, 1

app = App("doctor", help_epilogue=EXAMPLES + ROS_ARGS_HELP)


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class DoctorOptions:
    """Subject of the examination, and the form of the report."""

    bag: Annotated[File | None, Parameter(alias="-b")] = None
    """Examine a bag instead of the ROS graph."""
    display_config: Annotated[File | None, Parameter(alias="-d")] = None
    """Examine the displays of this config (default: those that fit the topics)."""
    seconds: Annotated[
        float, Parameter(validator=validators.Number(gt=0, lte=3600), metavar="SECONDS")
    ] = 8.6
    """Time for the examination of live topics, from the start of the command to the report."""
    peer: Annotated[str, Parameter(metavar="HOST", show_default=False)] = ""
    """Compare this machine with another, such as user@robot, instead of examining topics."""
    ssh: Annotated[str, Parameter(metavar="COMMAND")] = "ssh -o ConnectTimeout=10"
    """Command that runs a command line on the peer; it needs Python 3.8, and no ROS."""
    plugin: Plugins = ()
    json: Flag = False
    """Write the report as JSON."""
    explain: Annotated[str, Parameter(metavar="ID", show_default=False)] = ""
    """Explain a finding: what it is, why it matters, how to repair it; `all` lists all checks."""


@app.default(validator=check_source)
def doctor(
    *,
    options: DoctorOptions = DoctorOptions(),
    connect: ConnectOptions = ConnectOptions(),
    ros: RosArgs,
) -> int:
    """Examine the ROS graph or a bag, and print the causes of what is wrong."""
    until_s = time.monotonic() + options.seconds
    from webviz.engine.pipeline import plugins

    for path in options.plugin:
        plugins.load(path)
    if options.explain:
        return _explain(options.explain)

    def work(stop: Stop) -> int:
        from webviz.shell.doctor.report import DoctorReport, to_json, to_text

        def tell(report: DoctorReport) -> int:
            is_colored = sys.stdout.isatty() and not os.environ.get("NO_COLOR")
            if options.json:
                say_json(f"{to_json(report)}\n")
            else:
                say_painted(to_text(report, is_colored))
            return UNKNOWN if report.is_unknown else 0 if report.is_well else FINDINGS

        return _examine(options, connect, ros, until_s, tell)

    return until_signal(work)


def _examine(
    options: DoctorOptions,
    connect: ConnectOptions,
    ros: Sequence[str],
    until_s: float,
    tell: "Callable[[DoctorReport], int]",
) -> int:
    """Tell the report as soon as it is made: to leave the graph takes time on a busy machine."""
    from webviz.api.errors import Error
    from webviz.engine.machine.environment import look_around
    from webviz.shell.app.reading import read_config
    from webviz.shell.bag_player import bag_player
    from webviz.shell.doctor.examination import examine_bag, examine_live, examine_machine
    from webviz.shell.live_source import is_alone

    if options.peer:
        from webviz.shell.doctor.peer import compare

        ends = compare(options.peer, options.ssh, progress)
        return tell(examine_machine(look_around(), ends))
    path = options.display_config
    if options.bag is not None:
        with contextlib.closing(bag_player(options.bag, ros_args=ros)) as bag:
            config = read_config(path, bag)
            return tell(examine_bag(bag, config, str(options.bag), progress))
    config = read_config(path) if path else None
    if connect.connect or (config and is_alone(config.settings.robots)):
        with contextlib.closing(connect.source(ros, config)) as bridge:
            return tell(examine_live(bridge, config, until_s, progress))
    # Some faults end the program when ROS starts.
    environment = look_around()
    machine = examine_machine(environment)
    if any(finding.severity == "error" for finding in machine.findings):
        return tell(machine)
    progress("starting ROS", 0.0)
    try:
        source = connect.source(ros, config)
    except Error as error:
        return tell(examine_machine(look_around(str(error))))
    with contextlib.closing(source):
        report = examine_live(source, config, until_s, progress, environment=environment)
        machine.unfinished = report.unfinished
        return tell(machine if report.unfinished else report)


def _explain(id: str) -> int:
    """Print the documentation of a check, or a list of all."""
    from webviz.api.check import CheckText
    from webviz.api.check_registry import known_checks
    from webviz.api.errors import UsageError
    from webviz.files.config import nearest

    texts = {check.id: CheckText(check) for check in known_checks()}
    if id == "all":
        for text in texts.values():
            say(f"{text.id:9} {text.title}")
        return 0
    if (text := texts.get(id.upper())) is None:
        raise UsageError(f"Unknown finding {id}: {nearest(id.upper(), texts)}")
    say(f"{text.id}: {text.title}", "")
    for title, parts in (("", text.what), ("Why", text.why), ("Repair", text.repair)):
        for part in (*([f"{title}:"] if title else []), *parts):
            say(*part.split("\n"), "")
    return 0
