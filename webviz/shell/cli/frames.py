"""`webviz frames`: prints or draws the tree of transforms, live or of a bag."""

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import App, Parameter, validators

from webviz.api.errors import UsageError
from webviz.shell.cli.ending import Stop, until_signal
from webviz.shell.cli.options import (
    ROS_ARGS_HELP,
    ConnectOptions,
    File,
    RosArgs,
    check_source,
)
from webviz.shell.cli.progress import progress
from webviz.shell.cli.screenshot_options import Time
from webviz.shell.cli.terminal import say, warn

if TYPE_CHECKING:
    from webviz.shell.frames.reading import TreeRead

EXAMPLES = """\
Examples:
  webviz frames                                print the tree of live transforms
  webviz frames -o frames.svg                  draw it, as tf2_tools view_frames does
  webviz frames --bag run.mcap --at 12.3 -o frames.png
  webviz frames --ros-args -r /tf:=/robot1/tf -r /tf_static:=/robot1/tf_static

Exit status: 0 if the tree has no fault, 1 after an error, 2 for invalid arguments, 3 with faults.

"""
FAULTY = 3
SUFFIXES = (".svg", ".png")

app = App("frames", help_epilogue=EXAMPLES + ROS_ARGS_HELP)


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class FramesOptions:
    """Source of the transforms, and the picture."""

    output: Annotated[File | None, Parameter(alias="-o")] = None
    """Draw the tree to this file, .svg or .png, instead of printing it."""
    bag: Annotated[File | None, Parameter(alias="-b")] = None
    """Read a bag instead of the ROS graph."""
    at: Time = "end"
    """Time in the bag: seconds from its start, a Unix time, `start` or `end`."""
    seconds: Annotated[
        float, Parameter(validator=validators.Number(gt=0, lte=3600), metavar="SECONDS")
    ] = 5.0
    """Time to listen to live transforms."""


@app.default(validator=check_source)
def frames(
    *,
    options: FramesOptions = FramesOptions(),
    connect: ConnectOptions = ConnectOptions(),
    ros: RosArgs,
) -> int:
    """Print or draw the frames with their rates, ages, publishers and faults."""
    output = options.output
    if output is not None and output.suffix.lower() not in SUFFIXES:
        raise UsageError(f"{output} has no supported extension. Use {' or '.join(SUFFIXES)}.")
    if options.bag is None and options.at != "end":
        raise UsageError("--at is a time of a bag. Add --bag.")

    def work(stop: Stop) -> int:
        tree, title = _read(options, connect, ros)
        if output is None:
            say(*tree.text().split("\n"))
        else:
            _draw(tree, title, output)
        return FAULTY if tree.diagnosis.problems else 0

    return until_signal(work)


def _read(
    options: FramesOptions, connect: ConnectOptions, ros: Sequence[str]
) -> "tuple[TreeRead, str]":
    from webviz.shell.bag_player import bag_player
    from webviz.shell.frames.reading import read_bag, read_live
    from webviz.shell.pictures.times import position_ns, seconds_from_start

    if options.bag is None:
        title = f"Frames of {connect.connect or 'the ROS graph'}"
        with contextlib.closing(connect.source(ros)) as source:
            return read_live(source, options.seconds, progress), title
    with contextlib.closing(bag_player(options.bag, ros_args=ros)) as bag:
        at_ns = position_ns(options.at, bag.history, str(options.bag))
        title = f"Frames of {options.bag.name} at {seconds_from_start(at_ns, bag.history):.1f} s"
        tree = read_bag(bag, at_ns, progress)
        for warning in bag.warnings:
            warn(f"webviz: {options.bag}: {warning}")
        return tree, title


def _draw(tree: "TreeRead", title: str, output: Path) -> None:
    from webviz.data.transforms.picture import draw_tree
    from webviz.data.words import counted
    from webviz.shell.frames.pixels import to_png
    from webviz.shell.pictures.files import writing

    picture = draw_tree(tree.diagnosis, title, tree.notes())
    is_png = output.suffix.lower() == ".png"
    content = to_png(picture) if is_png else picture.svg.encode()
    with writing(output) as file:
        file.write(content)
    number = counted(len(tree.diagnosis.names), "frame")
    say(f"webviz: wrote {output}, {number}.")
    for problem in tree.diagnosis.problems:
        warn(f"webviz: {problem}")
