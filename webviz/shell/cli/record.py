"""`webviz record`: records topics to a rosbag2 folder of MCAP files."""

import contextlib
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import App, Parameter, validators

from webviz.shell.cli.ending import Stop, say_end, until_signal
from webviz.shell.cli.options import ROS_ARGS_HELP, ConnectOptions, RosArgs, Size
from webviz.shell.cli.terminal import show, warn

if TYPE_CHECKING:
    from webviz.shell.recording import TopicRecorder

EXAMPLES = """\
Examples:
  webviz record                                  record all topics until Ctrl-C
  webviz record -o run --topics /tf* /scan       record some; * matches any characters
  webviz record --shown lab.yaml                 record what this config shows
  webviz record --split 1GB --keep 10GB          keep the newest 10 GB, in files of 1 GB

"""
SAY_S = 1.0
"""Time between two lines of progress."""

app = App("record", help_epilogue=EXAMPLES + ROS_ARGS_HELP)


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class RecordOptions:
    """Topics to record, and the folder."""

    output: Annotated[Path | None, Parameter(alias="-o", metavar="FOLDER")] = None
    """New folder of the recording (default: webviz_ with date and time)."""
    topics: Annotated[
        tuple[str, ...], Parameter(consume_multiple=True, metavar="TOPIC", show_default=False)
    ] = ()
    """Topics to record; * matches any characters (default: all)."""
    shown: Annotated[Path | None, Parameter(metavar="FILE", show_default=False)] = None
    """Topics of the displays in this config (YAML or .rviz), transforms and the log."""
    all: Annotated[bool, Parameter(negative="", show_default=False)] = False
    """All topics, with hidden ones, whose names contain /_ (default: all others)."""
    split: Size = 0
    """Begin a new file at this size, such as 1GB."""
    split_time: Annotated[
        float, Parameter(validator=validators.Number(gte=0), metavar="SECONDS", show_default=False)
    ] = 0.0
    """Begin a new file after this time."""
    keep: Size = 0
    """Delete the oldest files beyond this size in all; files are a tenth of it unless --split."""


def _check(
    *,
    options: RecordOptions = RecordOptions(),
    connect: ConnectOptions = ConnectOptions(),
    **_: object,
) -> None:
    """Raise ValueError for an invalid combination of arguments."""
    connect.check(has_bag=False)
    if sum(map(bool, (options.topics, options.shown, options.all))) > 1:
        raise ValueError("Give only one of --topics, --shown and --all.")
    if options.keep and options.split > options.keep:
        raise ValueError("--keep must be at least --split.")


@app.default(validator=_check)
def record(
    *,
    options: RecordOptions = RecordOptions(),
    connect: ConnectOptions = ConnectOptions(),
    ros: RosArgs,
) -> int:
    """Record until Ctrl-C or SIGTERM."""

    def work(stop: Stop) -> int:
        from webviz.api.errors import Error
        from webviz.data.names import new_path
        from webviz.data.recordings import RecordingError
        from webviz.data.recordings.folder_writing import RecordingFolder, RecordingLimits
        from webviz.files.opening import load
        from webviz.shell.recording import TopicRecorder, topics_of
        from webviz.sources.recording import library

        limits = RecordingLimits(
            options.split or options.keep // 10, options.split_time, options.keep
        )
        config = load(options.shown) if options.shown else None
        try:
            with contextlib.closing(connect.source(ros, config)) as source:
                patterns = ("*",) if options.all else options.topics
                if config is not None:
                    patterns = topics_of(config, source.resolve)
                folder = RecordingFolder(options.output or new_path("webviz"), library(), limits)
                with TopicRecorder(source, folder, patterns) as recorder:
                    _follow(recorder, stop)
        except RecordingError as error:
            raise Error(str(error)) from error
        return 0

    return until_signal(work)


def _follow(recorder: "TopicRecorder", stop: Stop) -> None:
    """Record until the program is asked to end, and say how far it is."""
    stop.hold()
    stop.then(recorder.wake)
    warn(f"webviz: recording to {recorder.path} (press Ctrl-C to stop)")
    said_s = time.monotonic()
    is_terminal = sys.stderr.isatty()
    while not stop.is_asked:
        recorder.turn()
        for problem in recorder.new_problems():
            warn(f"webviz: {problem}")
        if is_terminal and time.monotonic() - said_s >= SAY_S:
            said_s = time.monotonic()
            show(recorder.progress())
    recorder.close()
    say_end(f"{chr(10) if is_terminal else ''}webviz: {recorder.progress()}.")
