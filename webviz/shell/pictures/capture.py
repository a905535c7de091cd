"""Pictures of a config by a headless browser: `webviz.capture`."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import msgspec

from webviz.api.declared import make
from webviz.api.display import Display
from webviz.api.errors import Error
from webviz.api.registry import plugin_types
from webviz.api.status import Status
from webviz.api.views import View
from webviz.data.words import joined
from webviz.engine.pipeline import plugins
from webviz.files.config import Config, Settings, nearest
from webviz.files.opening import load, parse
from webviz.shell.bag_player import bag_player
from webviz.shell.live_source import ros_source
from webviz.shell.pictures.browser import Pixels, check_size, launched
from webviz.shell.pictures.headless_renderer import HeadlessRenderer
from webviz.shell.pictures.offline_viewer import OfflineViewer, Readiness
from webviz.shell.pictures.times import At, position_ns, seconds_from_start
from webviz.sources import Source
from webviz.sources.bag.extras import Extra
from webviz.sources.player import Player

SIZE = (1280, 720)
TIMEOUT_S = 20.0


class Picture(msgspec.Struct, frozen=True, eq=False):
    """A picture of one view at one time.

    Args:
        pixels: uint8 (height, width, 3), or (height, width, 4) with straight alpha if the
            background is transparent.
        view: name of the view, "" for the default view.
        at_s: seconds from the start of the bag, None for live topics.
        readiness: statuses of the displays.
    """

    pixels: Pixels
    view: str
    at_s: float | None
    readiness: Readiness

    @property
    def statuses(self) -> dict[str, Status]:
        """The worst status of each enabled display, by its name."""
        return dict(self.readiness.statuses)


class Capture(msgspec.Struct, frozen=True, eq=False):
    """The pictures of one run, ordered by time and view."""

    pictures: tuple[Picture, ...]

    @property
    def pixels(self) -> Pixels:
        """The pixels of the last picture."""
        return self.pictures[-1].pixels

    @property
    def statuses(self) -> dict[str, Status]:
        """The worst status of each enabled display in the last picture, by its name."""
        return self.pictures[-1].statuses

    @property
    def is_ok(self) -> bool:
        """Return whether all awaited displays are OK in every picture."""
        return all(picture.readiness.is_ok for picture in self.pictures)


class Order(msgspec.Struct, frozen=True):
    """The pictures to make; see `capture`.

    Args:
        is_image: make pictures of the pane of the config's only display, at the size of its image.
    """

    config: Config
    source: Source
    name: str = ""
    at: Sequence[At] = ("end",)
    size: tuple[int, int] = SIZE
    views: Sequence[str | View] = ()
    focus: str = ""
    transparent: bool = False
    wait_for: Sequence[str] | None = None
    timeout: float = TIMEOUT_S
    is_image: bool = False

    def positions(self) -> Sequence[int | None]:
        """Return times of recording in ns, sorted; None for now.

        Raises:
            Error: a time is outside of the bag.
        """
        if not isinstance(self.source, Player):
            return [None]
        return sorted({position_ns(at, self.source.history, self.name) for at in self.at})

    def looks(self) -> list[tuple[str, View]]:
        """Return views with their names.

        Raises:
            Error: the name of a view is unknown.
        """
        if not self.views:
            return [("", self.config.settings.view)]
        named = self.config.settings.views
        looks = []
        for number, view in enumerate(self.views):
            if not isinstance(view, str):
                looks.append((str(number), view))
            elif view in named:
                looks.append((view, named[view]))
            else:
                hint = nearest(view, named) if named else "it has no saved views."
                raise Error(f"The config has no view {view!r}: {hint}")
        return looks


def capture(
    config: Config | str | Path,
    *,
    bag: str | Path | None = None,
    at: At | Sequence[At] = "end",
    size: tuple[int, int] = SIZE,
    views: Sequence[str | View] = (),
    transparent: bool = False,
    wait_for: Sequence[str] | None = None,
    timeout: float = TIMEOUT_S,
    focus: str = "",
    fixed_frame: str | None = None,
    plugin: Sequence[str | Path] = (),
    extras: Sequence[Extra] = (),
    ros_args: Sequence[str] = (),
    renderer: HeadlessRenderer | None = None,
) -> Capture:
    """Make pictures of a config, live or from a bag.

    A display that is not OK does not raise an error: check `is_ok` and `statuses`.

    Args:
        config: a YAML or .rviz file, YAML text with at least one line break, or a config.
        bag: an MCAP or db3 file, or a rosbag2 folder; None for live topics.
        at: times of the bag: seconds from its start (Unix times if above 1e9), "start" or "end".
            Each view is drawn at each time.
        size: width and height of the pictures in pixels.
        views: views or names of saved ones; none for the default view.
        transparent: omit the background.
        wait_for: names of displays that must be OK; None for all enabled ones.
        timeout: seconds per time, to play the bag and to wait for the displays.
        focus: frame to look at, instead of the focal points of the views.
        fixed_frame: overrides that of the config.
        plugin: Python files with displays.
        extras: messages to add to the bag, see `webviz.sources.bag.extras`.
        ros_args: for the ROS node: `["--ros-args", "-r", "/scan:=/front/scan"]`.
        renderer: to reuse for many pictures; by default a browser is launched.

    Raises:
        Error: no picture can be made.
    """

    def run() -> Capture:
        with one_sentence():
            for path in plugin:
                plugins.load(Path(path))
            picture_config = _read(config)
            if fixed_frame:
                picture_config.set_fixed_frame(fixed_frame)
            times = at if isinstance(at, Sequence) and not isinstance(at, str) else (at,)
            with opened(bag, extras, ros_args) as source:
                order = Order(
                    picture_config,
                    source,
                    str(bag),
                    times,
                    size=size,
                    views=views,
                    focus=focus,
                    transparent=transparent,
                    wait_for=wait_for,
                    timeout=timeout,
                )
                return Capture(tuple(pictures(order, renderer)))

    if renderer is None and _is_in_event_loop():
        # For example in a notebook: playwright needs a thread without a loop.
        with ThreadPoolExecutor(1) as thread:
            return thread.submit(run).result()
    return run()


def pictures(order: Order, renderer: HeadlessRenderer | None = None) -> Generator[Picture]:
    """Make the pictures of an order one by one, in order of time.

    Args:
        order: what to make.
        renderer: to reuse; by default a browser is launched, and closed with the iterator.
    """
    check_size(order.size)
    positions, looks = order.positions(), order.looks()
    with contextlib.ExitStack() as stack:
        if renderer is None:
            browser = stack.enter_context(launched())
            renderer = HeadlessRenderer(browser, *order.size)
            stack.callback(renderer.close)
        else:
            renderer.resize(*order.size)
        viewer = OfflineViewer(order.config, order.source, renderer.scene)
        stack.callback(viewer.close)
        awaited = viewer.names() if order.wait_for is None else order.wait_for
        if not viewer.names():
            raise Error("The config has no enabled display. Add or enable one.")
        for position in positions:
            deadline = time.monotonic() + order.timeout
            at_s = None
            if isinstance(order.source, Player) and position is not None:
                viewer.seek(order.source, position, deadline)
                at_s = seconds_from_start(position, order.source.history)
            readiness = viewer.wait(awaited, deadline)
            for name, view in looks:
                renderer.look(viewer.focused(view, order.focus) if order.focus else view)
                pixels = renderer.image() if order.is_image else None
                if pixels is None:
                    if order.is_image:
                        reasons = [status.text for status in readiness.statuses.values()]
                        raise Error(joined("No image to write.", *reasons))
                    pixels = renderer.capture(order.transparent, viewer.hidden())
                yield Picture(pixels, name, at_s, readiness)


def image_alone(topic: str) -> Config:
    """Return a config that shows the images of a topic."""
    display = make(plugin_types(Display)["Image"], {"name": topic, "topic": topic})
    return Config(Settings(), [display])


@contextlib.contextmanager
def opened(
    bag: str | Path | None,
    extras: Sequence[Extra] = (),
    ros_args: Sequence[str] = (),
    live: Callable[[Sequence[str]], Source] = ros_source,
) -> Iterator[Source]:
    """Provide a bag, or live topics.

    Args:
        bag: None for live topics.
        extras: for the bag.
        ros_args: for ROS.
        live: opens the source of live topics.

    Raises:
        Error: the bag cannot be read, or ROS is missing.
    """
    if bag is not None:
        source: Source = bag_player(Path(bag), extras, ros_args)
    elif extras:
        raise Error("Maps and transforms can only be added to a bag. Give a bag.")
    else:
        source = live(ros_args)
    with contextlib.closing(source):
        yield source


@contextlib.contextmanager
def one_sentence() -> Iterator[None]:
    """Turn time-outs into `Error`."""
    try:
        yield
    except TimeoutError as error:
        raise Error(str(error)) from error


def _read(config: Config | str | Path) -> Config:
    if isinstance(config, Config):
        return config
    if isinstance(config, str) and "\n" in config:
        return parse(config, "the config")
    return load(Path(config))


def _is_in_event_loop() -> bool:
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return False
    return True
