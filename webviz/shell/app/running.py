"""A viewer that runs in its own threads."""

from __future__ import annotations

import atexit
import contextlib
import itertools
import logging
import math
import os
import ssl
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import PIL.Image

from webviz.api.errors import Error
from webviz.api.views import View, with_type
from webviz.engine.commands import Command, Refresh, ShowView, StartWithView
from webviz.engine.pipeline import plugins as plugin_files
from webviz.engine.state import State
from webviz.files import config as config_file
from webviz.files.config import Config
from webviz.files.sessions import Sessions
from webviz.server.access.journal_file import JournalFile
from webviz.server.access.login import cookie_name
from webviz.server.access.tls import doubts, server_context
from webviz.shell.app.allow_list import check_names, report_everything
from webviz.shell.app.link_rate import bytes_per_second
from webviz.shell.app.reading import read_config
from webviz.shell.bag_source import bag_source
from webviz.shell.pictures import files as picture_files
from webviz.shell.ros_source import ros_source

if TYPE_CHECKING:
    from webviz.shell.pictures.browser import Pixels
    from webviz.sources import Source

log = logging.getLogger("webviz")

BagPaths = str | os.PathLike[str] | Sequence[str | os.PathLike[str]]
"""A bag, or several to merge by time."""

PATIENCE_S = 30.0
"""For a command in the frame loop; opening a config of hundreds of displays takes seconds."""
CLOSING_S, ALL_CLOSING_S = 1.5, 2.0
"""For a part to close, and for all: a program that is asked to end has three seconds."""
LAST_S = 0.1
"""For each part that remains after that."""


class Running:
    """Source, frame loop, server and panel of one viewer; see `webviz.Viewer`."""

    def __init__(
        self,
        config: str | os.PathLike[str] | None = None,
        *,
        port: int = 8080,
        host: str = "127.0.0.1",
        allow_hosts: Sequence[str] = (),
        fixed_frame: str = "",
        source: Source | None = None,
        bag: BagPaths | None = None,
        autoplay: bool = False,
        ros_args: Sequence[str] = (),
        plugins: Sequence[str | os.PathLike[str]] = (),
        autosave: Path | None = None,
        sessions: Sessions | None = None,
        config_folders: Sequence[str | os.PathLike[str]] = (),
        publish: bool = True,
        allow_publish: Sequence[str] = (),
        certfile: str | os.PathLike[str] | None = None,
        keyfile: str | os.PathLike[str] | None = None,
        trust_proxies: Sequence[str] = (),
        link: str = "",
        token: bool = False,
        journal: str | os.PathLike[str] | None = None,
        control: bool = True,
        read: Callable[[Path | None, Source | None], Config] = read_config,
    ) -> None:
        with contextlib.ExitStack() as stack:
            closing = _Closing(stack)
            check_names(allow_publish)
            link_rate = bytes_per_second(link) if link else None
            kept = None if journal is None else JournalFile(Path(journal))
            if kept is not None:
                closing.add("The journal", kept.close)
            if bag is not None:
                if source is not None:
                    raise Error("Give either `bag` or `source`.")
                source = bag_source(_paths(bag), ros_args=ros_args)
            if source is not None:
                closing.add("The source of messages", source.close)
            files = [Path(file) for file in plugins]
            watcher = plugin_files.Watcher(files)
            for file in files:
                plugin_files.load(file)
            path = Path(config) if config is not None else None
            # Report errors in files before importing viser, which is slow.
            shown = read(path, None) if path is not None else None
            tls = _tls(certfile, keyfile)
            from webviz.engine.loop import FrameLoop
            from webviz.page.pages import Pages
            from webviz.scene import ViserScene, open_server
            from webviz.server.access.announcing import Announcement, reachable
            from webviz.server.access.starting import access_to, make_missing
            from webviz.shell.pictures.snapshots import Snapshots

            # A proxy on this machine brings others.
            self.access = access_to(host, token or bool(trust_proxies))
            """Who may connect."""
            server = open_server(
                host,
                port,
                allow_hosts,
                tls=tls,
                trusted_proxies=trust_proxies,
                access=self.access,
                link_rate=link_rate,
            )
            closing.add("The server of the page", server.stop)
            make_missing(self.access)  # until then, nobody can connect
            node_control = None
            if source is None:
                source = ros_source(ros_args)
                closing.add("The ROS node", source.close)
                node_control = source.control
                if path is None and node_control.initial["config_file"]:
                    path = Path(node_control.initial["config_file"])
                fixed_frame = fixed_frame or node_control.initial["fixed_frame"]
            shown = shown or read(path, source)
            if publish:
                report_everything((*(shown.settings.publish or ()), *allow_publish))
            if fixed_frame:
                shown.set_fixed_frame(fixed_frame)
            session = sessions.claim(path) if sessions else None
            if session is not None:
                closing.add("The session", session.close)
            scene = self._scene = ViserScene(server)
            self._loop = FrameLoop(
                shown,
                source,
                scene,
                self._show,
                path=path,
                autoplay=autoplay,
                may_publish=publish,
                allow_publish=allow_publish,
                autosave=autosave,
                session=session and session.path,
                restore=bool(sessions and sessions.restore),
            )
            self._pages = Pages(
                server.channel,
                self._loop.enqueue,
                self._loop.controllers.steer,
                self.access,
                kept and kept.write,
            )
            self._scheme = "http" if tls is None else "https"
            self._host, self.port = host, server.get_port()
            if self.access.asks:
                page = reachable(self.url, host, allow_hosts)
                closing.add("The announcement", Announcement(page, self.port).close)
            self._ended: Future[None] = Future()
            thread = threading.Thread(target=self._run, name="webviz-viewer", daemon=True)
            thread.start()
            closing.add("The frame loop", thread.join)
            stack.callback(self._loop.stop)
            scene.link.late.wake = source.inbox.arrived.set
            self._snapshots = Snapshots(scene, self._drawn, self._look, self._cookie())
            closing.add("The browser of pictures", self._snapshots.close)
            watcher.start(self._loop.enqueue)
            closing.add("The plug-in watcher", watcher.stop)
            self.do(Refresh())  # so that there is a state
            if node_control is not None:
                if name := node_control.initial["view"]:
                    self.do(StartWithView(view=name))
                folders = [Path(folder) for folder in config_folders]
                node_control.open(self, folders, may_change=control)
            self._stack = stack.pop_all()
        atexit.register(self.close)

    @property
    def restored(self) -> str:
        """Return a sentence on how much of the last session is shown; "" if none was restored."""
        answer = self._loop.restored
        is_there = answer is not None and answer.done() and answer.exception() is None
        return answer.result() if answer is not None and is_there else ""

    def close(self) -> None:
        """Close the viewer and its page, and end all threads except those that hang."""
        atexit.unregister(self.close)
        self._stack.close()

    def show_viser_panel(self) -> None:
        """Show viser's own panel on every page, too, for those who look into webviz itself."""
        self._pages.debug()

    def stop(self) -> None:
        """Make `wait` return, from any thread or a signal handler; `close` does the rest."""
        self._loop.stop()

    def wait(self) -> None:
        """Wait until Ctrl-C or `stop`."""
        with contextlib.suppress(KeyboardInterrupt):
            self._ended.result()

    @property
    def url(self) -> str:
        """Address of the page for browsers on this machine."""
        host = "127.0.0.1" if self._host in ("0.0.0.0", "::") else self._host
        return f"{self._scheme}://{f'[{host}]' if ':' in host else host}:{self.port}"

    @property
    def state(self) -> State:
        """A read-only snapshot of all that the panel shows, at most half a second old."""
        return self._state

    def do(self, command: Command) -> str:
        """Run a command of `webviz.engine.commands` and wait for it.

        Returns:
            A message, or "".

        Raises:
            Error: the command failed, or the viewer is closed.
        """
        if not self._ended.done():
            answer = self._loop.enqueue(command)
            either: list[Future[Any]] = [answer, self._ended]
            wait(either, PATIENCE_S, FIRST_COMPLETED)
            if answer.done():
                return answer.result()
        if self._ended.done():
            raise Error("The viewer is closed. Create a new one.") from self._ended.exception()
        raise Error(f"The viewer has been busy for {PATIENCE_S:g} s. Try again later.")

    def acknowledged(self, timeout: float) -> bool:
        """Wait until every connected browser has applied everything sent so far.

        Args:
            timeout: in seconds.

        Returns:
            False if a browser did not answer, or none is connected.
        """
        try:
            self._scene.link.acknowledge(timeout)
        except TimeoutError:
            return False
        return self._scene.has_watchers()

    def screenshot(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        size: tuple[int, int] = (1280, 720),
        view: View | str | Mapping[str, Any] | None = None,
    ) -> Pixels:
        """Make a picture of the scene as a new browser would show it, with images beside it.

        Takes seconds, and requires playwright and a browser on this machine.

        Args:
            path: file to write (.png, .jpg, .webp), if any.
            size: width and height in pixels.
            view: a view or the name of a saved one; None for the default view.

        Returns:
            uint8 (height, width, 3).

        Raises:
            Error: there is no browser, or the file cannot be written.
        """
        if path is not None:
            picture_files.check(Path(path), is_animation=False, transparent=False)
        if isinstance(view, str):
            if view not in (saved := self.state.settings.views):
                hint = config_file.nearest(view, saved)
                raise Error(f"Unknown saved view `{view}`: {hint}")
            view = saved[view]
        looked = None if view is None else checked_view(view)
        pixels = self._snapshots.take(self.url, size, looked)
        if path is not None:
            picture_files.save(PIL.Image.fromarray(pixels), Path(path))
        return pixels

    def save_screenshot(self) -> Path:
        """Save a picture of the scene next to the config, named by the time."""
        stem = time.strftime("webviz_screenshot_%Y_%m_%d-%H_%M_%S")
        folder = Path(self.state.file.folder)
        path = folder / f"{stem}.png"
        for number in itertools.count(2):
            if not path.exists():
                break
            path = folder / f"{stem}_{number}.png"
        self.screenshot(path)
        return path

    def _cookie(self) -> tuple[str, str] | None:
        """The cookie of the browser that takes pictures, None if none is asked for."""
        return (cookie_name(self.port), self.access.own.cookie) if self.access.asks else None

    def _drawn(self) -> State:
        self.do(Refresh())
        return self.state

    def _look(self, view: View, browser: int) -> None:
        self.do(ShowView(view, browser))

    def _run(self) -> None:
        try:
            self._loop.run()
        except BaseException as error:
            log.exception("The viewer stopped")
            self._ended.set_exception(error)
        else:
            self._ended.set_result(None)

    def _show(self, state: State) -> None:
        self._state = state
        self._pages.update(state)


class _Closing:
    """Closes the parts of a viewer in the reverse order; those that hang are reported and left.

    They share one time limit, so that a program ends in time however many of them are slow.
    """

    def __init__(self, stack: contextlib.ExitStack) -> None:
        self._stack = stack
        self._until = math.inf

    def add(self, what: str, close: Callable[[], object]) -> None:
        """Close a part when the stack is closed."""
        self._stack.callback(self._close, what, close)

    def _close(self, what: str, close: Callable[[], object]) -> None:
        self._until = min(self._until, time.monotonic() + ALL_CLOSING_S)
        thread = threading.Thread(target=close, name="webviz-closing", daemon=True)
        thread.start()
        patience_s = min(CLOSING_S, max(LAST_S, self._until - time.monotonic()))
        thread.join(patience_s)
        if thread.is_alive():
            log.warning("%s did not close within %.1f s.", what, patience_s)


def _paths(bag: BagPaths) -> list[Path]:
    """The files and folders of a bag, or of several."""
    several = [bag] if isinstance(bag, str | os.PathLike) else bag
    if not several:
        raise Error("`bag` is empty. Give a file or folder, or None for the ROS graph.")
    return [Path(path) for path in several]


def _tls(
    certfile: str | os.PathLike[str] | None, keyfile: str | os.PathLike[str] | None
) -> ssl.SSLContext | None:
    """The context of a server with TLS, if there is a certificate; doubts about it are logged."""
    if certfile is None:
        if keyfile is not None:
            raise Error("`keyfile` needs `certfile`.")
        return None
    context = server_context(Path(certfile), None if keyfile is None else Path(keyfile))
    for doubt in doubts(context, Path(certfile)):
        log.warning("%s", doubt)
    return context


def checked_view(view: View | Mapping[str, Any]) -> View:
    """A validated view.

    Raises:
        Error: a value is invalid.
    """
    values = with_type(msgspec.to_builtins(view))
    try:
        return msgspec.convert(values, View)
    except msgspec.ValidationError as error:
        found = config_file.explain(error, View, values)
        raise Error(f"Invalid view: {config_file.sentences([found])}") from error
