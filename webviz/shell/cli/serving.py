"""The program of `webviz` and `webviz demo`: a page that is served until Ctrl-C."""

import contextlib
import functools
import gc
import logging
import sys
import threading
import webbrowser
from collections.abc import Callable, Sequence
from pathlib import Path

from webviz.api.check_registry import known_checks
from webviz.api.registry import display_types
from webviz.data.messages import type_exists
from webviz.engine.parts.comparison_config import with_comparison
from webviz.files.config import Config
from webviz.files.sessions import Sessions, name_of
from webviz.server.access.starting import link
from webviz.shell.app.viewer import Viewer
from webviz.shell.bag_player import bag_of
from webviz.shell.cli.ending import INTERRUPTED, Stop, say_end
from webviz.shell.cli.links import show_links
from webviz.shell.cli.options import ConnectOptions
from webviz.shell.cli.terminal import say
from webviz.shell.cli.viewing_options import BagOptions, ViewingOptions
from webviz.sources import Source

YOUNG_OBJECTS = 10_000
"""Garbage that the collector may leave before it runs: more objects than most messages make."""


def serve(
    options: ViewingOptions,
    ros: Sequence[str],
    stop: Stop,
    standard: Path | None = None,
    note: str = "",
    bag: BagOptions = BagOptions(),
    connect: ConnectOptions = ConnectOptions(),
    work: Callable[[Viewer], object] | None = None,
    then: Callable[[Viewer], object] = lambda viewer: None,
) -> int:
    """Serve the page until the program is asked to stop.

    Args:
        options: what to show and where.
        ros: arguments for ROS.
        stop: asks the program to stop.
        standard: config to use if none is given.
        note: printed below the address of the page.
        bag: to play instead of live topics.
        connect: the bridge of live topics.
        work: called once the page is served, instead of printing its address.
        then: called with the viewer before its address is printed.

    Returns:
        The exit status.
    """
    template = options.template or standard
    beside = bag.beside(bag.bag, ros) if bag.ghost else None

    @functools.cache
    def read(path: Path | None, source: Source | None) -> Config:
        config = options.read(path or template, beside or source)
        run = bag_of(beside)
        return with_comparison(config, run) if run else config

    if (options.display_config or options.template) and not options.plugin:
        # Report errors before imports that take seconds. With plug-ins the viewer reads the file
        # later, once it has loaded the displays that the file may name.
        read(options.display_config, None)
    options.allow_meshes()
    _import_slow_parts()
    is_shown = False
    if stop.hold():
        sessions = _sessions(options, template, bag) if options.autosave and not beside else None
        source = beside or (connect.source(ros) if connect.connect else None)
        played = BagOptions(paused=bag.paused) if beside else bag
        with _viewer(options, ros, played, source, read, sessions) as viewer:
            stop.then(viewer.stop)
            then(viewer)
            if options.debug:
                viewer.show_viser_panel()
            is_shown = not stop.is_asked
            if is_shown:
                if work is not None:
                    work(viewer)
                else:
                    with contextlib.suppress(OSError):  # the terminal was closed meanwhile
                        _announce(options, viewer, note)
                # Modules that the frame loop would import for the first browser or message.
                display_types()
                known_checks()
                type_exists("std_msgs/msg/Header")  # reads the definitions of ROS
                calm_collector()
                viewer.wait()
    say_end("\nwebviz: stopped." if is_shown else "webviz: interrupted.")
    return 0 if is_shown else INTERRUPTED


def _viewer(
    options: ViewingOptions,
    ros: Sequence[str],
    bag: BagOptions,
    source: Source | None,
    read: Callable[[Path | None, Source | None], Config],
    sessions: Sessions | None,
) -> Viewer:
    """Start the viewer that the options of the command line describe."""
    return Viewer(
        options.display_config,
        read=read,
        host=options.host,
        port=options.port,
        allow_hosts=options.allow_host,
        fixed_frame=options.fixed_frame,
        bag=bag.bag or None,
        source=source,
        autoplay=not bag.paused,
        ros_args=ros,
        plugins=options.plugin,
        sessions=sessions,
        config_folders=options.config_folder,
        library=options.bag_folder,
        publish=not options.no_publish,
        allow_publish=options.allow_publish,
        certfile=options.certfile,
        keyfile=options.keyfile,
        trust_proxies=options.trust_proxy,
        link=options.link,
        token=options.token,
        journal=options.journal,
        control=not options.no_control,
    )


def _import_slow_parts() -> None:
    """Import what a viewer needs, to keep the time short in which a signal finds it half made."""
    import webviz.page.pages
    import webviz.scene
    import webviz.shell.pictures.snapshots

    with contextlib.suppress(ImportError):  # reported when ROS is needed
        import webviz.ros.node  # noqa: F401
    calm_collector()


def calm_collector() -> None:
    """Keep the garbage collector, which stops all threads, from stopping a driven robot."""
    # Modules and classes stay; to walk them takes each full collection 0.1 s of the frame loop.
    gc.freeze()
    gc.set_threshold(YOUNG_OBJECTS)


def _announce(options: ViewingOptions, viewer: Viewer, note: str) -> None:
    say(f"webviz: open {viewer.url} (press Ctrl-C to stop)")
    if note:
        say(note)
    if viewer.restored:
        say(f"{viewer.restored} Start with --no-restore to see the config as it is saved.")
    if viewer.access.asks:
        logging.getLogger("webviz.journal").setLevel(logging.INFO)
        show_links(viewer.access.tokens, viewer.url, options.host, options.allow_host)
    sys.stdout.flush()
    if options.open:
        tokens = viewer.access.tokens if viewer.access.asks else ()
        address = next((link(viewer.url, token) for token in tokens), "") or viewer.url
        # Browsers in a terminal run until they are closed.
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()


def _sessions(options: ViewingOptions, template: Path | None, bag: BagOptions) -> Sessions:
    standard = template.stem if template else name_of(bag.bag[0]) if bag.bag else "default"
    return Sessions(standard, not options.no_restore)
