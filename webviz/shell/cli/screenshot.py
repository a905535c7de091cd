"""`webviz screenshot`: saves pictures of a config without a screen."""

from __future__ import annotations

import contextlib
import logging
import math
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

import PIL.Image
from cyclopts import App

from webviz.api.errors import UsageError
from webviz.api.status import Level, Status
from webviz.engine.pipeline import plugins
from webviz.shell.cli.ending import INTERRUPTED, end_children, end_in_time, on_signal, say_end
from webviz.shell.cli.options import ROS_ARGS_HELP, ConnectOptions, RosArgs
from webviz.shell.cli.screenshot_options import EXAMPLES, FPS, ScreenshotOptions, check
from webviz.shell.cli.terminal import say, warn
from webviz.shell.pictures import files as picture_files
from webviz.shell.pictures.times import At, every

if TYPE_CHECKING:
    from webviz.files.config import Config
    from webviz.shell.pictures.capture import Order, Picture
    from webviz.sources import Source
    from webviz.sources.player import Player

MAX_TOPICS = 40
"""Topics of a bag to list at most."""
SHEET_SIZE = (480, 270)
"""Default size of the pictures of a contact sheet."""
NOT_OK, NOT_A_VIDEO = 3, 4


app = App("screenshot", help_epilogue=EXAMPLES + ROS_ARGS_HELP)


@app.default(validator=check)
def screenshot(
    *,
    options: ScreenshotOptions,
    connect: ConnectOptions = ConnectOptions(),
    ros: RosArgs,
) -> int:
    """Make pictures and write them; the exit status as in --help."""
    # Importing viser is slow, and --help does not need it.
    from webviz.shell.pictures.capture import one_sentence

    on_signal(_interrupt)
    try:
        with one_sentence():
            return _make(options, connect, ros)
    except KeyboardInterrupt:
        say_end("webviz: interrupted.")
        return INTERRUPTED


def _make(options: ScreenshotOptions, connect: ConnectOptions, ros: Sequence[str]) -> int:
    from webviz.shell.pictures.browser import check_size
    from webviz.shell.pictures.capture import SIZE, Order, opened
    from webviz.sources.bag.extras import map_of_file, static_transform
    from webviz.sources.player import Player

    output: Path = options.output
    is_animation = options.is_animation
    picture_files.check(output, is_animation=is_animation, transparent=options.transparent)
    if is_animation and len(options.view) > 1:
        raise UsageError("An animation shows one view. Give one --view or another extension.")
    if options.size:
        check_size(options.size)
    options.allow_meshes()
    for path in options.plugin:
        plugins.load(path)
    config = None if options.bag else _config(options)
    extras = [map_of_file(each) for each in options.map]
    extras += [static_transform(*each) for each in options.transform]
    with opened(options.bag, extras, ros, lambda args: connect.source(args, config)) as source:
        config = config or _config(options, source)
        at: Sequence[At] = ("end",)
        if isinstance(source, Player):
            at = _times(options, source)
        order = Order(
            config,
            source,
            str(options.bag),
            at,
            size=options.size or (SHEET_SIZE if options.contact_sheet else SIZE),
            views=options.view,
            focus=options.focus,
            transparent=options.transparent,
            wait_for=options.wait_for or None,
            timeout=options.timeout,
            is_image=bool(options.image),
        )
        status = _write(options, order)
        if isinstance(source, Player):
            for warning in [*source.warnings, *([_topics(source)] if status == NOT_OK else [])]:
                warn(f"webviz: {options.bag}: {warning}")
        return status


def _config(options: ScreenshotOptions, source: Source | None = None) -> Config:
    """Return the config to show; without one that of the topics of a bag."""
    from webviz.shell.pictures.capture import image_alone

    return image_alone(options.image) if options.image else options.config_of(source)


def _times(options: ScreenshotOptions, source: Player) -> Sequence[At]:
    if options.every is None:
        return options.at or ("end",)
    times = every(
        options.first or "start",
        options.last or "end",
        options.every,
        source.history,
        str(options.bag),
    )
    return [*times, *options.at]


def _write(options: ScreenshotOptions, order: Order) -> int:
    """Make the pictures of an order; the exit status."""
    from webviz.shell.pictures.capture import pictures

    path: Path = options.output
    times, views = len(order.positions()), len(order.looks())
    report = _Report()
    clock = _clock(order) if options.clock else None

    def image_of(picture: Picture) -> PIL.Image.Image:
        image = PIL.Image.fromarray(picture.pixels)
        return image if clock is None else picture_files.with_clock(image, clock(picture))

    columns = views if min(times, views) > 1 else math.ceil(math.sqrt(times * views))
    if options.contact_sheet:
        picture_files.sheet_size(order.size, times * views, columns)
    with contextlib.closing(pictures(order)) as taken_pictures:
        checked = report.follow(taken_pictures)
        if options.contact_sheet:
            captioned = [(_caption(picture), image_of(picture)) for picture in checked]
            picture_files.save(picture_files.contact_sheet(captioned, columns), path)
            written = [path]
        elif options.is_animation:
            images = (image_of(picture) for picture in checked)
            written = [_save_animation(images, path, options.fps or FPS)]
        else:
            written = []
            for number, picture in enumerate(checked):
                index = number // views if times > 1 else None
                name = picture_files.numbered(path, picture.view, index, times)
                picture_files.save(image_of(picture), name)
                written.append(name)
    width, height = report.size
    names = f"{written[0]}" if len(written) == 1 else f"{written[0]} to {written[-1]}"
    number = "1 picture" if report.count == 1 else f"{report.count} pictures"
    say(f"webviz: wrote {names}, {number} of {width} x {height} pixels.")
    status = report.print(options.timeout)
    return status if written[0].suffix == path.suffix else status or NOT_A_VIDEO


class _Report:
    """Pictures with displays that are not OK."""

    def __init__(self) -> None:
        self.count = 0
        self.size = 0, 0
        self._bad = 0
        self._first: Picture | None = None

    def follow(self, pictures: Iterator[Picture]) -> Iterator[Picture]:
        """Pass pictures through and note those that are not OK."""
        for picture in pictures:
            self.count += 1
            height, width = picture.pixels.shape[:2]
            self.size = width, height
            if not picture.readiness.is_ok:
                self._bad += 1
                self._first = self._first or picture
            yield picture

    def print(self, timeout: float) -> int:
        """Print the statuses of the first bad picture, and return the exit status."""
        first = self._first
        if first is None:
            return 0
        when = f"within {timeout:g} s" if first.at_s is None else f"at {first.at_s:g} s of the bag"
        more = f", nor in {self._bad - 1} more pictures" if self._bad > 1 else ""
        warn(f"webviz: not all displays are OK {when}{more}:")
        # Unsupported parts were reported when the config was read; the bag is reported afterwards.
        general = {
            key: status
            for key, status in first.readiness.general.items()
            if status.level is not Level.OK and key not in ("Import", "Bag")
        }
        for line in _table(first.statuses | general):
            warn(f"  {line}")
        return NOT_OK


def _table(statuses: dict[str, Status]) -> Iterator[str]:
    width = max(map(len, statuses))
    for name, status in statuses.items():
        first, *more = [""] if status.level is Level.OK else status.text.split("\n")
        yield f"{status.level.name:5}  {name:{width}}  {first}".rstrip()
        for text in more:
            yield f"{'':5}  {'':{width}}  {text}"


def _topics(bag: Player) -> str:
    """Return the topics of a bag that displays can show, as a sentence."""
    topics = sorted(topic for topic, offer in bag.offers().items() if not offer.problem)
    more = f" and {len(topics) - MAX_TOPICS} more" if len(topics) > MAX_TOPICS else ""
    return f"The topics are {', '.join(topics[:MAX_TOPICS])}{more}."


def _caption(picture: Picture) -> str:
    time = "" if picture.at_s is None else f"{picture.at_s:.2f} s"
    return "   ".join(filter(None, (picture.view, time)))


def _clock(order: Order) -> Callable[[Picture], str]:
    """Return the line of a picture's time: seconds of a bag, and the local date and time."""
    from webviz.sources.player import Player

    source = order.source
    start_ns = source.history.start_ns if isinstance(source, Player) else 0

    def text(picture: Picture) -> str:
        at_s = picture.at_s
        when = time.time() if at_s is None else start_ns / 1e9 + at_s
        date = datetime.fromtimestamp(when).isoformat(" ", "milliseconds")
        return date if at_s is None else f"{at_s:.2f} s   {date}"

    return text


def _save_animation(images: Iterable[PIL.Image.Image], path: Path, fps: float) -> Path:
    """Write an animation or a video; the file, which is a WebP if no video can be made."""
    from webviz.shell.pictures.videos import encoder, save_video

    if path.suffix.lower() not in picture_files.VIDEOS:
        picture_files.save_animation(images, path, fps)
        return path
    name, reason = encoder()
    if name:
        save_video(images, path, fps, name)
        return path
    path = path.with_suffix(".webp")
    warn(f"webviz: {path} instead of a video, since {reason}.")
    picture_files.save_animation(images, path, fps)
    return path


def _interrupt() -> None:
    end_in_time()
    # Both would report that playwright's driver, a child process, has ended.
    for name in ("asyncio", "playwright"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    end_children()  # including a browser that hangs
    raise KeyboardInterrupt
