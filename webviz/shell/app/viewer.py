"""The Python API: `webviz.Viewer`."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Mapping
from concurrent.futures import Future, InvalidStateError
from pathlib import Path
from typing import Any

import msgspec

from webviz import commands
from webviz.api.declared import Color
from webviz.api.errors import Error
from webviz.api.status import Level, Status
from webviz.api.views import View
from webviz.commands import (
    AddDisplay,
    Reset,
    SetBackground,
    SetFixedFrame,
    SetFrameRate,
    ShowView,
    StartWithView,
)
from webviz.engine.parts.topics import TopicsPart
from webviz.engine.parts.transforms import TransformsPart
from webviz.files import config as config_file
from webviz.files import opening
from webviz.shell.app import notebook
from webviz.shell.app.adding import by_topic, check_properties
from webviz.shell.app.arguments import absolute
from webviz.shell.app.handles import DisplayHandle, NoSuchDisplay
from webviz.shell.app.picture_controls import checked_view
from webviz.shell.app.running import Running
from webviz.shell.app.time_controls import TimeControls

PATIENCE_S = 5.0
"""Time in seconds for a tool to report the result of a gesture."""


class ToolHandle:
    """A tool, by its name in the toolbar."""

    def __init__(self, viewer: Running, name: str) -> None:
        self._viewer = viewer
        self.name = name

    def send(self, x: float, y: float, yaw: float = 0.0, z: float = 0.0) -> str:
        """Use the tool as with a gesture on the page.

        Args:
            x, y, z: position in metres in the fixed frame.
            yaw: heading in radians.

        Returns:
            The result, as a sentence.

        Raises:
            Error: the tool is unknown, or it could not publish.
        """
        first: Future[Status] = Future()

        def report(status: Status) -> None:
            with contextlib.suppress(InvalidStateError):  # a tool may report more than once
                first.set_result(status)

        self._viewer.do(commands.UseTool(self.name, ((x, y, z),), yaw, report=report))
        try:
            status = first.result(PATIENCE_S)
        except TimeoutError:
            raise Error(f"{self.name} reported nothing within {PATIENCE_S:g} s.") from None
        if status.level is Level.ERROR:
            raise Error(status.text)
        return status.text


class Viewer(Running, TimeControls):
    """A running viewer with its page at `url`; end it with `close` or a `with` block.

    Methods return when the change is drawn and shown on the page. They may be called from any
    thread except those of displays.

    Args:
        config: a YAML or .rviz file; None for the file in the ROS parameter `config_file`, or else
            the default displays.
        port: of the page; 0 picks a free one.
        host: address to listen on. Others than loopback ask browsers for a token; see `token`.
        allow_hosts: host names that browsers may use with `host`.
        fixed_frame: overrides that of the config.
        source: of messages, closed with the viewer; None for the ROS graph.
        bag: an MCAP or db3 file, a rosbag2 folder, a ROS 1 bag, or several of them, to play instead
            of the ROS graph; without a config, its topics are shown. It is paused at its start.
        connect: bridge or Zenoh router whose topics are live, such as "ws://robot:8765" or
            "tcp/robot:7447", instead of the ROS graph.
        connect_headers: file with HTTP headers for the bridge, one `Name: value` a line.
        autoplay: play the bag as soon as a browser is connected.
        ros_args: for the ROS node: `["--ros-args", "-r", "/scan:=/front/scan"]`; with a bag,
            remappings of topics only.
        plugins: Python files with displays, reloaded whenever they are saved.
        autosave: file to which every change is saved.
        sessions: keeps unsaved changes and restores them at the next start, as the program does;
            None to start with the config as it is saved.
        config_folders: from which ROS may open configs, besides the folder of `config`.
        library: folders whose bags owners may open in the page.
        publish: whether tools may publish, call services and send goals, as far as the list
            `publish` of the config allows; without it, those that the config uses. Configs opened
            later can only narrow it.
        allow_publish: names of topics, services and actions that are allowed besides; * matches
            any characters.
        certfile: PEM file with a certificate, to serve https.
        keyfile: PEM file with its private key; None if `certfile` contains it.
        trust_proxies: IP addresses or networks of proxies whose forwarded headers are used.
        link: rate of the link to each browser, such as "5Mbit/s" or "500kbit/s"; "" to measure it.
        token: whether browsers of this machine need a link with a token, too. Without tokens in the
            file of this user or in the environment, one of each role is made: `webviz token`.
        journal: file to which it is appended who published, saved and opened what; 1 MB, and as
            much before that in FILE.1.
        control: whether parameters and services of the ROS node may change the viewer.
        embed_in: origins of pages that may embed the page, such as "http://localhost:8888"; None
            for notebooks of this machine, if this is one.
        read: reads a config file; called with None for the default config of a source.

    Raises:
        Error: the config, the bag, a plug-in or the certificate cannot be read, ROS is missing, the
            port is not available, or `link` is not a rate.
    """

    def __enter__(self) -> Viewer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<webviz.Viewer at {self.url}>"

    def _repr_html_(self) -> str:
        """Return the page, for notebooks whose cell ends with the viewer."""
        return notebook.html(self.url, self.access, self.is_embeddable)

    # State

    @property
    def displays(self) -> list[DisplayHandle]:
        """All displays and groups, in the order of the list."""
        return [DisplayHandle(self, row.id) for row in self.rows]

    @property
    def groups(self) -> list[DisplayHandle]:
        """All groups."""
        return [display for display in self.displays if display.type == "Group"]

    def __getitem__(self, key: str | int) -> DisplayHandle:
        """Return a display by its name or its number in the list.

        Raises:
            NoSuchDisplay: it does not exist, or the name is ambiguous.
        """
        rows = self.rows
        names = [row.name for row in rows]
        if isinstance(key, int):
            if not -len(rows) <= key < len(rows):
                raise NoSuchDisplay(f"There is no display {key}; the list has {len(rows)}.")
            number = key
        elif names.count(key) > 1:
            numbers = " or ".join(str(number) for number, name in enumerate(names) if name == key)
            raise NoSuchDisplay(
                f"{names.count(key)} displays are named {key!r}. Use the number in the list: "
                f"{numbers}."
            )
        elif key in names:
            number = names.index(key)
        else:
            hint = config_file.nearest(key, names)
            raise NoSuchDisplay(f"No display is named {key!r}: {hint}")
        return DisplayHandle(self, rows[number].id)

    def __contains__(self, name: object) -> bool:
        return any(row.name == name for row in self.rows)

    def __iter__(self) -> Iterator[DisplayHandle]:
        return iter(self.displays)

    def __len__(self) -> int:
        return len(self.rows)

    def __bool__(self) -> bool:
        return True

    def _ipython_key_completions_(self) -> list[str]:
        return [row.name for row in self.rows]

    @property
    def frames(self) -> tuple[str, ...]:
        """All known frame ids, sorted."""
        return tuple(self._loop.get(TransformsPart).frames().frames)

    @property
    def topics(self) -> dict[str, tuple[str, ...]]:
        """The message types of all topics."""
        return dict(self._loop.get(TopicsPart).types)

    @property
    def statuses(self) -> dict[str, Status]:
        """The statuses of the viewer as a whole, such as "Fixed Frame"."""
        return dict(self._loop.statuses)

    # Changes

    def tool(self, name: str) -> ToolHandle:
        """Return a tool by its name in the toolbar: `viewer.tool("2D Goal Pose").send(1, 2)`."""
        return ToolHandle(self, name)

    def add(
        self,
        type: str | None = None,
        *,
        group: DisplayHandle | str | None = None,
        **properties: Any,
    ) -> DisplayHandle:
        """Add a display at the end of the list or of a group.

        Args:
            type: of the display, such as "LaserScan" or "Group"; None for the one that shows the
                published topic `topic`.
            group: to add it to.
            properties: as in a config file.

        Raises:
            Error: the type or a property is unknown, or a value is invalid.
        """
        if type is None:
            type, properties = by_topic(properties, self.topics)
        check_properties(type, properties)
        ids: list[str] = []
        self.do(AddDisplay(type, properties, self._group_id(group), ids.append))
        return DisplayHandle(self, ids[0])

    @property
    def fixed_frame(self) -> str:
        """The frame in which everything is drawn."""
        return self.settings.fixed_frame

    @fixed_frame.setter
    def fixed_frame(self, frame: str) -> None:
        self.do(SetFixedFrame(frame))

    @property
    def background(self) -> Color | None:
        """The background colour; None follows the theme of each page."""
        return self.settings.background

    @background.setter
    def background(self, color: Color | None) -> None:
        self.do(SetBackground(color))

    @property
    def frame_rate(self) -> float:
        """Maximum updates of the scene per second."""
        return self.settings.frame_rate

    @frame_rate.setter
    def frame_rate(self, hz: float) -> None:
        self.do(SetFrameRate(hz))

    @property
    def view(self) -> View:
        """The default view of browsers and pictures.

        Assign a view, its values as in a config file, or the name of a saved one to show it in all
        browsers, now and when they join.
        """
        return self.settings.view

    @view.setter
    def view(self, view: View | str | Mapping[str, Any]) -> None:
        chosen_view = view if isinstance(view, str) else checked_view(view)
        self.do(StartWithView(view=chosen_view))
        self.do(ShowView(chosen_view))

    @property
    def views(self) -> dict[str, View]:
        """Saved views by name."""
        return dict(self.settings.views)

    def save_view(self, name: str, view: View | Mapping[str, Any] | None = None) -> None:
        """Save a view, by default that of the newest browser.

        Raises:
            Error: no browser is connected, or a value of the view is invalid.
        """
        self.do(commands.SaveView(name, view=None if view is None else checked_view(view)))

    def remove_view(self, name: str) -> None:
        """Remove a saved view."""
        self.do(commands.RemoveView(name))

    def reset(self) -> None:
        """Discard transforms and messages, like RViz's Reset."""
        self.do(Reset())

    # Files

    @property
    def is_changed(self) -> bool:
        """Return whether there are unsaved changes."""
        return self.fact("file").is_changed

    def open(self, path: str | os.PathLike[str]) -> None:
        """Open a config file.

        Raises:
            Error: the file cannot be read; nothing was changed.
        """
        self.do(commands.Open(absolute(path, "path")))

    def save(self, path: str | os.PathLike[str] = "") -> Path:
        """Save the config, by default to its file, and return the file.

        Raises:
            Error: the config has no file, or the file cannot be written.
        """
        self.do(commands.Save(absolute(path, "path") if path != "" else ""))
        return Path(self.path)

    @property
    def config_text(self) -> str:
        """The current config as YAML."""
        texts: list[str] = []
        self.do(commands.Export(texts.append))
        return texts[0]

    @property
    def config(self) -> dict[str, Any]:
        """The current config as values; assign values or YAML to replace it."""
        return config_file.document(opening.parse(self.config_text, "the config"))

    @config.setter
    def config(self, config: str | Mapping[str, Any]) -> None:
        text = config if isinstance(config, str) else msgspec.json.encode(config).decode()
        self.do(commands.Load(text, "the config"))

    def _group_id(self, group: DisplayHandle | str | None) -> str:
        if group is None:
            return ""
        handle = self[group] if isinstance(group, str) else group
        if handle.type != "Group":
            raise Error(f"{handle.name} is not a group.")
        return handle.id
