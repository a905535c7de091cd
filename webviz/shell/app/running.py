"""A viewer that runs in its own threads."""

from __future__ import annotations

import atexit
import contextlib
import logging
import os
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from webviz import commands
from webviz.api.errors import Error
from webviz.api.finding import Finding
from webviz.api.views import View
from webviz.commands import Refresh, ShowView, StartWithView
from webviz.engine.commands import PROGRAM, Command, Sender, wrong_text
from webviz.engine.parts.config import ConfigPart
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.state import Row, State
from webviz.files.config import Config, Settings
from webviz.files.sessions import Sessions
from webviz.server.access.login import cookie_name
from webviz.server.access.visitors import Visitor
from webviz.shell.app import notebook, starting
from webviz.shell.app.arguments import bytes_per_second, check_names, report_everything
from webviz.shell.app.picture_controls import PictureControls
from webviz.shell.app.reading import read_config
from webviz.shell.app.starting import BagPaths, Closing
from webviz.shell.live_source import bridge_source, is_alone, ros_source, with_robots

if TYPE_CHECKING:
    import ssl

    from webviz.ros.control import ControlNode
    from webviz.server.http.viser_server import Server
    from webviz.sources import Source

log = logging.getLogger("webviz")

ROUNDS = 3
"""Number of rounds of checks: two in a row make a finding, and one may be under way."""
REST_S = 0.1
PATIENCE_S = 30.0
"""Time in seconds for a command in the frame loop; opening a config of hundreds of displays takes
seconds."""
BUSY = f"The viewer has been busy for {PATIENCE_S:g} s. Try again later."

T = TypeVar("T")


class Running(PictureControls):
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
        connect: str = "",
        connect_headers: str | os.PathLike[str] | None = None,
        autoplay: bool = False,
        ros_args: Sequence[str] = (),
        plugins: Sequence[str | os.PathLike[str]] = (),
        autosave: Path | None = None,
        sessions: Sessions | None = None,
        config_folders: Sequence[str | os.PathLike[str]] = (),
        library: Sequence[str | os.PathLike[str]] = (),
        publish: bool = True,
        allow_publish: Sequence[str] = (),
        certfile: str | os.PathLike[str] | None = None,
        keyfile: str | os.PathLike[str] | None = None,
        trust_proxies: Sequence[str] = (),
        link: str = "",
        token: bool = False,
        journal: str | os.PathLike[str] | None = None,
        control: bool = True,
        embed_in: Sequence[str] | None = None,
        read: Callable[[Path | None, Source | None], Config] = read_config,
    ) -> None:
        with contextlib.ExitStack() as stack:
            self._closing = closing = Closing(stack)
            check_names(allow_publish)
            link_rate = bytes_per_second(link) if link else None
            keep = starting.journal(journal, closing)
            if connect:
                if bag is not None or source is not None:
                    raise Error("Give only one of `bag`, `connect` and `source`.")
                source = bridge_source(connect, connect_headers, ros_args)
            source = starting.given_source(bag, source, ros_args, closing)
            watcher = starting.loaded_plugins(plugins)
            path = None if config is None else Path(config)
            # Report errors in files before importing viser, which is slow.
            initial = None if path is None else read(path, None)
            tls = starting.tls_context(certfile, keyfile)
            embedders = notebook.embedders(embed_in)
            server = self._open_server(
                host, port, allow_hosts, tls, trust_proxies, token, link_rate, embedders
            )
            node_control = None
            if source is None and not (initial and is_alone(initial.settings.robots)):
                source = ros_source(ros_args)
                closing.add("The ROS node", source.close)
                node_control = source.control
                file = node_control.initial["config_file"]
                path = path or (Path(file) if file else None)
                fixed_frame = fixed_frame or node_control.initial["fixed_frame"]
            initial = initial or read(path, source)
            from webviz.sources.player import Player

            if not isinstance(source, Player):
                source = with_robots(source, initial.settings.robots)
                closing.add("The connections of robots", source.close)
            if publish:
                report_everything((*(initial.settings.publish or ()), *allow_publish))
            if fixed_frame:
                initial.set_fixed_frame(fixed_frame)
            session = sessions.claim(path) if sessions else None
            if session is not None:
                closing.add("The session", session.close)
            from webviz.engine.loop import FrameLoop
            from webviz.engine.parts.part import HostProgram
            from webviz.shell.app.own_pasts import OwnPasts

            pasts = OwnPasts(server.door)
            closing.add("The look backs of pages", pasts.close)

            self._loop = FrameLoop(
                initial,
                source,
                self._scene,
                lambda: self._pages.update(),
                path=path,
                autoplay=autoplay,
                may_publish=publish,
                allow_publish=allow_publish,
                autosave=autosave,
                session=session and session.path,
                restore=bool(sessions and sessions.restore),
                host=HostProgram(
                    server.shared.offer,
                    [Path(file) for file in plugins],
                    [Path(folder) for folder in library],
                    pasts.open,
                ),
            )
            self._open_pages(server, allow_hosts, keep)
            self._run_loop(source)
            watcher.start(lambda path: self._loop.enqueue(commands.ReloadPlugin(path)))
            closing.add("The plug-in watcher", watcher.stop)
            self.do(Refresh())  # so that there is something to read
            if node_control is not None:
                self._open_control(node_control, config_folders, control)
            self._stack = stack.pop_all()
        atexit.register(self.close)

    def _open_control(
        self,
        node: ControlNode,
        config_folders: Sequence[str | os.PathLike[str]],
        may_change: bool,
    ) -> None:
        """Let ROS nodes command the viewer, and begin with the view of the node's parameters."""
        if name := node.initial["view"]:
            self.do(StartWithView(view=name))
        node.open(self, [Path(folder) for folder in config_folders], may_change=may_change)

    def _open_server(
        self,
        host: str,
        port: int,
        allow_hosts: Sequence[str],
        tls: ssl.SSLContext | None,
        trust_proxies: Sequence[str],
        token: bool,
        link_rate: float | None,
        embedders: Sequence[str],
    ) -> Server:
        """Serve the page, with a scene that is still empty."""
        from webviz.scene import ViserScene, open_server
        from webviz.server.access.starting import access_to, make_missing

        # A proxy on this machine brings others.
        self.access = access_to(host, token or bool(trust_proxies))
        """Rules of who may connect."""
        server = open_server(
            host,
            port,
            allow_hosts,
            tls=tls,
            trusted_proxies=trust_proxies,
            access=self.access,
            link_rate=link_rate,
            embedders=embedders,
        )
        self.is_embeddable = bool(embedders)
        """True if some pages may embed this one."""
        self._closing.add("The server of the page", server.stop)
        make_missing(self.access)  # until then, no page can connect
        self._host, self.port = host, server.get_port()
        self._scheme = "http" if tls is None else "https"
        self._scene = ViserScene(server)
        return server

    def _open_pages(
        self, server: Server, allow_hosts: Sequence[str], keep: Callable[[str], object] | None
    ) -> None:
        """Show the viewer on all pages, and announce their address to `webviz links`."""
        from webviz.page.pages import Pages
        from webviz.server.access.announcing import Announcement, reachable

        loop = self._loop
        self._pages = Pages(server.channel, loop.enqueue, self.access, keep, loop.parts)
        if self.access.asks:
            page = reachable(self.url, self._host, allow_hosts)
            self._closing.add("The announcement", Announcement(page, self.port).close)

    def _run_loop(self, source: Source) -> None:
        """Start the thread of the frame loop, and what takes pictures of what it shows."""
        from webviz.shell.pictures.snapshots import Snapshots

        self._ended: Future[None] = Future()
        thread = threading.Thread(target=self._run, name="webviz-viewer", daemon=True)
        thread.start()
        self._closing.add("The frame loop", thread.join)
        self._closing.before(self._loop.stop)
        self._scene.link.deferred.wake = source.inbox.arrived.set
        self._snapshots = Snapshots(self._scene, self, self._look, self._cookie())
        self._closing.add("The browser of pictures", self._snapshots.close)

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
        """A read-only snapshot of all that the panel shows; `fact` reads one field of it."""
        return self._called(self._loop.last_state)

    def fact(self, name: str, otherwise: Any = None) -> Any:
        """Return one field of `state`.

        Args:
            name: of the field.
            otherwise: what to return if this viewer has none.
        """
        return self._called(lambda: self._loop.fact(name, otherwise))

    @property
    def rows(self) -> Sequence[Row]:
        """The list of displays with their statuses."""
        return self._loop.get(DisplaysPart).rows

    @property
    def settings(self) -> Settings:
        """Everything in the config except its lists."""
        return self._loop.settings

    @property
    def path(self) -> str:
        """The config file, or ""."""
        path = self._loop.get(ConfigPart).path
        return str(path) if path else ""

    def do(self, command: Command, sender: Sender = PROGRAM) -> str:
        """Run a command of `webviz.engine.commands` and wait for it.

        Args:
            command: what to do.
            sender: in whose name, which decides on files.

        Returns:
            A message, or "".

        Raises:
            Error: the command failed, or the viewer is closed.
        """
        if fault := wrong_text(command):
            raise Error(fault)
        if not self._ended.done():
            answer = self._loop.enqueue(command, sender)
            either: list[Future[Any]] = [answer, self._ended]
            wait(either, PATIENCE_S, FIRST_COMPLETED)
            if answer.done():
                return answer.result()
        if self._ended.done():
            raise Error("The viewer is closed. Create a new one.") from self._ended.exception()
        raise Error(BUSY)

    def acknowledged(self, timeout: float) -> bool:
        """Wait until every connected browser that has loaded has applied everything sent so far.

        Args:
            timeout: in seconds.

        Returns:
            False if a browser did not answer, or none has loaded.
        """
        try:
            return self._scene.link.acknowledge(timeout) > 0
        except TimeoutError:
            return False

    def attend(self, seconds: float) -> None:
        """Draw and examine for some seconds as if a browser were connected; thread-safe."""
        until_s = time.monotonic() + seconds
        self._scene.attended_until_s = max(until_s, self._scene.attended_until_s)

    def note(self, visitor: Visitor, text: str) -> None:
        """Add a program's action for a person to the journal."""
        self._pages.journal.note(visitor, text)

    def doctor(self) -> list[Finding]:
        """Examine the viewer, and return the findings, the one to repair first at the beginning.

        Takes about three seconds, since a finding counts once it has lasted. Displays draw nothing
        without a browser, so that their data is not examined then, unless the viewer is asked to
        `attend`.
        """
        doctor = self._loop.doctor
        until = doctor.rounds + ROUNDS
        doctor.ask()
        while doctor.rounds < until:
            self.do(Refresh())
            time.sleep(REST_S)
        return list(self._loop.doctor.findings)

    def last_findings(self) -> list[Finding]:
        """Return the findings of the last round; rounds go on for some seconds after a call."""
        self._loop.doctor.ask()
        return list(self._loop.doctor.findings)

    def _cookie(self) -> tuple[str, str] | None:
        """Return the cookie of the browser that takes pictures, None if none is asked for."""
        return (cookie_name(self.port), self.access.own.cookie) if self.access.asks else None

    def _called(self, read: Callable[[], T]) -> T:
        try:
            return self._loop.call(read).result(PATIENCE_S)
        except TimeoutError:
            raise Error(BUSY) from None

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
