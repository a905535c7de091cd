"""`webviz frames`: prints or draws the tree of transforms, live or of a bag."""

from __future__ import annotations

import base64
import contextlib
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import msgspec
from cyclopts import App, Parameter, validators

from webviz.api.errors import Error, UsageError
from webviz.data.names import readable
from webviz.data.transforms import Diagnosis, TransformBuffer, diagnose, tree_text
from webviz.data.transforms.picture import TreePicture
from webviz.engine.pipeline.listener import TransformListener
from webviz.shell.cli.ending import Stop, until_signal
from webviz.shell.cli.options import (
    ROS_ARGS_HELP,
    ConnectOptions,
    File,
    RosArgs,
    check_source,
)
from webviz.shell.cli.screenshot_options import Time
from webviz.shell.cli.terminal import progress, say, warn
from webviz.shell.pictures.browser import LARGEST, launched
from webviz.sources import Source
from webviz.sources.player import Player

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
REST_S = 0.1

Progress = Callable[[str, float], object]
"""Called with what is done and the share of it that is."""


class TreeRead(msgspec.Struct, frozen=True):
    """The tree of transforms at a time.

    Args:
        diagnosis: its frames and faults.
        tree: as indented lines.
        nodes: that publish each topic of transforms.
    """

    diagnosis: Diagnosis
    tree: str
    nodes: Mapping[str, Sequence[str]]

    def notes(self) -> list[str]:
        """Sentences on the publishers."""
        return [
            f"{topic} is published by {', '.join(nodes)}."
            for topic, nodes in self.nodes.items()
            if nodes
        ]

    def text(self) -> str:
        """Return the tree for a terminal, with its faults and publishers."""
        tree = self.tree or "No transforms arrived on /tf or /tf_static."
        return "\n".join([tree, *map(readable, (*self.diagnosis.problems, *self.notes()))])


def read_live(source: Source, seconds: float, progress: Progress) -> TreeRead:
    """Listen to live transforms for some seconds, and read their tree."""
    reader = _Reader(source)
    began = time.monotonic()
    while (passed := time.monotonic() - began) < seconds:
        progress("listening", passed / seconds)
        source.inbox.arrived.wait(REST_S)
        source.inbox.arrived.clear()
        reader.take()
    return reader.read()


def read_bag(bag: Player, at_ns: int, progress: Progress) -> TreeRead:
    """Read the transforms of a bag from its beginning to a time of recording.

    All of them, since a frame that has stopped long ago belongs to the tree.

    Raises:
        BagError: the file can no longer be read.
    """
    reader = _Reader(bag)
    span = max(1, at_ns - bag.history.start_ns)
    while bag.reached_ns < at_ns:
        bag.play_step(at_ns)
        reader.take()
        progress("reading", (bag.reached_ns - bag.history.start_ns) / span)
    return reader.read()


class _Reader:
    def __init__(self, source: Source) -> None:
        self._source = source
        self._buffer = TransformBuffer()
        self._listener = TransformListener(self._buffer, time.monotonic)
        source.want(self._listener.subscriptions())

    def take(self) -> None:
        """Insert what arrived."""
        source = self._source
        if self._listener.take(source.inbox.drain(), source.offers()):
            self._listener.reset()
        source.want(self._listener.subscriptions())

    def read(self) -> TreeRead:
        offers, now_ns = self._source.offers(), self._source.now_ns()
        topics = self._listener.subscriptions()
        nodes = {
            topic: tuple(dict.fromkeys(each.label for each in offers[topic].publishers))
            for topic in topics
            if topic in offers and not offers[topic].is_recorded
        }
        if not nodes:  # each transform of a bag is from the bag
            self._buffer.nodes = {}
        return TreeRead(diagnose(self._buffer, now_ns), tree_text(self._buffer, now_ns), nodes)


def to_png(picture: TreePicture) -> bytes:
    """Draw a picture.

    Raises:
        Error: it is too large, or no browser is installed.
    """
    if max(picture.width, picture.height) > LARGEST:
        raise Error(
            f"The picture would have {picture.width} x {picture.height} pixels; the limit is "
            f"{LARGEST} per side. Write an .svg file instead."
        )
    with launched() as browser:
        context = browser.new_context()
        try:
            tab = context.new_page()
            tab.set_viewport_size({"width": picture.width, "height": picture.height})
            # Scripts do not run in images, whatever the names of frames are.
            url = f"data:image/svg+xml;base64,{base64.b64encode(picture.svg.encode()).decode()}"
            tab.set_content(f'<!doctype html><style>body {{ margin: 0 }}</style><img src="{url}">')
            return tab.screenshot(type="png")
        finally:
            context.close()


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
) -> tuple[TreeRead, str]:
    from webviz.shell.bag_player import bag_player
    from webviz.shell.cli.frames import read_bag, read_live
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


def _draw(tree: TreeRead, title: str, output: Path) -> None:
    from webviz.data.transforms.picture import draw_tree
    from webviz.data.words import counted
    from webviz.shell.cli.frames import to_png
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
