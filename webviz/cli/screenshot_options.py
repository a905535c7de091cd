"""The arguments of `webviz screenshot`."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Sequence
from pathlib import Path

from webviz.cli.options import add_config, add_plugin, add_ros_args, new_parser
from webviz.pictures import files as picture_files
from webviz.pictures.times import TimeError, read_at

EPILOG = """\
examples:
  webviz screenshot -d lab.yaml -o lab.png                    the robot that runs now
  webviz screenshot -d lab.yaml --bag run.mcap --at 12.3 -o lab.png
  webviz screenshot -d lab.yaml --bag run --every 5 --contact-sheet -o run.png
  webviz screenshot -d lab.yaml --bag run --every 0.2 --size 640x360 -o run.webp
  webviz screenshot -d nav2.rviz --bag run --map lab_map.yaml --wait-for Map -o nav2.png

exit status:
  0    the pictures are written, and the displays that were waited for are OK
  1    no picture: one sentence says why
  2    the arguments are wrong
  3    the pictures are written, but a display is not OK: a table says which and why
  130  interrupted
"""
FPS = 10.0


def parse_arguments(arguments: Sequence[str]) -> argparse.Namespace:
    """The options, checked as far as they can be without a bag; ends the program otherwise."""
    parser = _parser()
    options = parser.parse_args(arguments)
    if options.bag is None:
        for name in ("at", "first", "last", "every", "map", "transform"):
            if getattr(options, name) not in (None, []):
                flag = {"first": "from", "last": "to"}.get(name, name)
                parser.error(f"--{flag} is for a bag: give one with --bag")
    if options.every is None and (options.first, options.last) != (None, None):
        parser.error("--from and --to need --every, which says how far apart pictures are")
    options.first, options.last = options.first or "start", options.last or "end"
    try:
        options.transform = [_transform(values) for values in options.transform]
    except ValueError as error:
        parser.error(str(error))
    options.is_animation = (
        options.output.suffix.lower() in picture_files.ANIMATIONS
        and not options.contact_sheet
        and (options.every is not None or len(options.at) > 1)
    )
    if options.fps is not None and not options.is_animation:
        parser.error("--fps is for several times and a name that ends with .gif or .webp")
    options.fps = options.fps or FPS
    return options


def _parser() -> argparse.ArgumentParser:
    parser = new_parser(
        "webviz screenshot",
        "Makes pictures of what a config shows, without a screen: of the ROS graph, "
        "or of a bag, which needs no ROS.",
        EPILOG,
    )
    add = parser.add_argument
    add_config(parser)
    add(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="FILE",
        help=f"picture to write, overwritten ({', '.join(picture_files.STILLS)}); several get "
        "numbers and the names of views behind its name",
    )
    add(
        "--size",
        type=_size,
        metavar="WxH",
        help="of each picture in pixels (default: 1280x720; on a contact sheet 480x270)",
    )
    add(
        "--view",
        action="append",
        default=[],
        metavar="NAME",
        help="saved view of the config (repeatable; default: its current view)",
    )
    add(
        "--focus",
        default="",
        metavar="FRAME",
        help="look at this frame, wherever it is, from the side and distance of the view",
    )
    add("--transparent", action="store_true", help="leave the background out")
    add("--contact-sheet", action="store_true", help="all pictures in one, with captions")
    add(
        "--wait-for",
        action="append",
        default=[],
        metavar="DISPLAY",
        help="name of a display that has to be OK (repeatable; default: all enabled ones)",
    )
    add(
        "--timeout",
        type=_positive,
        default=20.0,
        metavar="S",
        help="how long to wait for that (default: 20 s)",
    )
    add_plugin(parser)
    add_ros_args(parser)
    _add_bag(parser)
    return parser


def _add_bag(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument_group("of a bag").add_argument
    add("--bag", type=Path, metavar="PATH", help="mcap file, db3 file or rosbag2 folder")
    add(
        "--at",
        type=_time,
        action="append",
        default=[],
        metavar="S",
        help="seconds from its start, a stamp in seconds since 1970, `start` or `end` "
        "(repeatable; default: end)",
    )
    add("--every", type=_positive, metavar="S", help="a picture every so many seconds")
    for flag, name, end in (("--from", "first", "start"), ("--to", "last", "end")):
        word = "begins" if name == "first" else "ends"
        text = f"where --every {word} (default: {end})"
        add(flag, dest=name, type=_time, metavar="S", help=text)
    add(
        "--fps",
        type=_positive,
        metavar="N",
        help="pictures a second of an animation, which several times make of a .gif or .webp "
        f"(default: {FPS:g})",
    )
    add(
        "--map",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help="yaml of map_server, shown as /map in the frame map, if the bag has none",
    )
    add(
        "--transform",
        nargs=5,
        action="append",
        default=[],
        metavar=("PARENT", "CHILD", "X", "Y", "YAW"),
        help="static transform that the bag lacks, in metres and radians (repeatable)",
    )


def _transform(values: Sequence[str]) -> tuple[str, str, float, float, float]:
    parent, child, *numbers = values
    try:
        x, y, yaw = map(float, numbers)
    except ValueError as error:
        raise ValueError(
            f"--transform: X, Y and YAW must be numbers, not {' '.join(numbers)}"
        ) from error
    return parent, child, x, y, yaw


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d{1,5})[xX](\d{1,5})", text)
    if match is None:
        raise argparse.ArgumentTypeError(f"{text!r} is no size: write it as 1280x720")
    return int(match[1]), int(match[2])


def _time(text: str) -> float | str:
    try:
        return read_at(text)
    except TimeError as error:
        raise argparse.ArgumentTypeError(str(error).rstrip(".")) from error


def _positive(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not (math.isfinite(number) and number > 0):
        raise argparse.ArgumentTypeError(f"{text!r} is no number above 0")
    return number
