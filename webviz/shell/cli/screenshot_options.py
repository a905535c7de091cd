"""The arguments of `webviz screenshot`."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Group, Parameter, Token

from webviz.shell.cli.options import ConfigOptions, ConnectOptions, File, Flag, Repeatable
from webviz.shell.pictures import files as picture_files
from webviz.shell.pictures.times import At, TimeError, read_at

EXAMPLES = """\
Examples:
  webviz screenshot -d lab.yaml -o lab.png                           live
  webviz screenshot -d lab.yaml --bag run.mcap --at 12.3 -o lab.png
  webviz screenshot -d lab.yaml --bag run --every 5 --contact-sheet -o run.png
  webviz screenshot -d lab.yaml --bag run --every 0.2 -o run.webp    animated
  webviz screenshot -d lab.yaml --bag run --every 0.1 --clock -o run.mp4
  webviz screenshot --image /camera/image_raw --bag run --at 5 -o frame.png
  webviz screenshot -d a.rviz --bag run --map map.yaml --wait-for Map -o a.png

Exit status:
  0    pictures written, all displays (or those of --wait-for) are OK
  1    error, no picture written
  2    invalid arguments
  3    pictures written, but a display is not OK; its status is printed
  4    a .webp file was written, since no video can be made; the reason is printed
  130  interrupted

"""
FPS = 10.0


def _positive(_: object, number: float | None) -> None:
    if number is not None and not (math.isfinite(number) and number > 0):
        raise ValueError("Must be > 0.")


def _size(_: object, tokens: Sequence[Token]) -> tuple[int, int]:
    match = re.fullmatch(r"(\d{1,5})[xX](\d{1,5})", tokens[0].value)
    if match is None:
        raise ValueError(f"`{tokens[0].value}` is not a size. Write it as 1280x720.")
    return int(match[1]), int(match[2])


def _times(_: object, tokens: Sequence[Token]) -> tuple[At, ...]:
    try:
        return tuple(read_at(token.value) for token in tokens)
    except TimeError as error:
        raise ValueError(str(error)) from error


def _time(_: object, tokens: Sequence[Token]) -> At:
    return _times(_, tokens)[0]


Seconds = Annotated[float, Parameter(metavar="S", validator=_positive)]
Time = Annotated[At, Parameter(metavar="S", converter=_time, n_tokens=1)]
BAG = Parameter(group=Group("Pictures of a bag", sort_key=2))


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ScreenshotOptions(ConfigOptions):
    """Options for the pictures to make."""

    output: Annotated[File, Parameter(alias="-o")]
    """File to write (.png, .jpg, .webp, .gif, .mp4); several get view and number as suffix."""
    size: Annotated[
        tuple[int, int] | None, Parameter(metavar="WxH", converter=_size, n_tokens=1)
    ] = None
    """Size of each picture in pixels (default: 1280x720; on a contact sheet 480x270)."""
    view: Annotated[Repeatable[str], Parameter(metavar="NAME")] = ()
    """Saved view of the config (repeatable; default: its start view)."""
    focus: Annotated[str, Parameter(metavar="FRAME", show_default=False)] = ""
    """Look at this frame, from the direction and distance of the view."""
    image: Annotated[str, Parameter(metavar="TOPIC", show_default=False)] = ""
    """Write the image of this topic alone, at its own size, instead of a config."""
    transparent: Flag = False
    """Make the background transparent (.png, .webp)."""
    clock: Flag = False
    """Write the time into each picture."""
    contact_sheet: Flag = False
    """Write all pictures to one file, with captions."""
    wait_for: Annotated[Repeatable[str], Parameter(metavar="DISPLAY")] = ()
    """Display that must be OK for exit status 0 (repeatable; default: all enabled ones)."""
    timeout: Seconds = 20.0
    """Time limit per picture in seconds, to play the bag and wait for the displays."""

    bag: Annotated[File | None, BAG] = None
    """Read a bag instead of live topics: MCAP or db3 file, rosbag2 folder, or ROS 1 bag."""
    at: Annotated[Repeatable[At], BAG, Parameter(metavar="S", converter=_times, n_tokens=1)] = ()
    """Time: seconds from the start, a Unix time, `start` or `end` (repeatable; default: end)."""
    every: Annotated[Seconds | None, BAG] = None
    """Make a picture every S seconds."""
    first: Annotated[Time | None, BAG, Parameter(name="--from")] = None
    """Time of the first picture of --every (default: start)."""
    last: Annotated[Time | None, BAG, Parameter(name="--to")] = None
    """Time of the last picture of --every (default: end)."""
    fps: Annotated[Seconds | None, BAG, Parameter(metavar="N")] = None
    """Frames per second of an animation: several times, in a .gif, .webp or .mp4 (default: 10)."""
    map: Annotated[Repeatable[Path], BAG, Parameter(metavar="FILE")] = ()
    """Add a map from a map_server YAML file, on /map in frame map (repeatable)."""
    transform: Annotated[
        Repeatable[tuple[str, str, float, float, float]],
        BAG,
        Parameter(metavar="PARENT CHILD X Y YAW"),
    ] = ()
    """Add a static transform, in metres and radians (repeatable)."""

    @property
    def is_animation(self) -> bool:
        """Return whether the pictures become one animated file."""
        return (
            self.output.suffix.lower() in (*picture_files.ANIMATIONS, *picture_files.VIDEOS)
            and not self.contact_sheet
            and (self.every is not None or len(self.at) > 1)
        )


def check(options: ScreenshotOptions, connect: ConnectOptions = ConnectOptions(), **_: Any) -> None:
    """Raise ValueError for an invalid combination of arguments."""
    connect.check(options.bag is not None)
    if options.bag is None:
        for flag, value in (
            ("at", options.at),
            ("every", options.every),
            ("from", options.first),
            ("to", options.last),
            ("map", options.map),
            ("transform", options.transform),
        ):
            if value not in (None, ()):
                raise ValueError(f"--{flag} needs --bag.")
    if options.image:
        for flag, value in (
            ("display-config", options.display_config),
            ("view", options.view),
            ("focus", options.focus),
            ("size", options.size),
            ("transparent", options.transparent),
            ("contact-sheet", options.contact_sheet),
            ("wait-for", options.wait_for),
        ):
            if value not in (None, (), "", False):
                raise ValueError(f"--{flag} has no effect with --image. Leave one of them out.")
    if options.every is None and (options.first, options.last) != (None, None):
        raise ValueError("--from and --to need --every.")
    if options.fps is not None and not options.is_animation:
        raise ValueError("--fps needs an animation: several times, in a .gif, .webp or .mp4 file.")
