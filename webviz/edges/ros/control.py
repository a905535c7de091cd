"""A viewer as ROS sees it: parameters and services of its node."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any, Protocol

from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from webviz.api.errors import Error
from webviz.engine.commands import (
    Command,
    Open,
    Reset,
    Save,
    SetFixedFrame,
    ShowView,
    StartWithView,
)
from webviz.engine.state import State
from webviz.files.config.files import SUFFIXES

log = logging.getLogger("webviz")

CONFIG_FILE, FIXED_FRAME, VIEW = "config_file", "fixed_frame", "view"
PARAMETERS = {
    CONFIG_FILE: "The file that the config came from; setting it opens another one of its folder.",
    FIXED_FRAME: "The frame that everything is drawn in.",
    VIEW: "The saved view that browsers begin with; setting it moves every camera.",
}
NO_SERVICES = (
    "The services ~/load_config, ~/save_config, ~/reset, ~/reset_time and ~/screenshot are left "
    "out, as the package std_srvs is missing: install ros-jazzy-std-srvs."
)
MAX_REQUESTS = 4
"""Of one service at a time; rclpy itself holds ten."""


class Steered(Protocol):
    """What is controlled; see `webviz.Viewer`. All of it may be called from any thread."""

    @property
    def state(self) -> State:
        """A snapshot of the viewer."""
        ...

    def do(self, command: Command) -> str:
        """Change something, wait until it is done, and return what there is to tell of it."""
        ...

    def save_screenshot(self) -> Path:
        """Write a picture of the scene into a new file, which takes seconds."""
        ...


class Control:
    """Lets parameters and services of a node change a viewer, and parameters tell what it shows.

    All methods but `open` belong to the thread that spins the node.

    Args:
        node: where they are declared.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._viewer: Steered | None = None
        self._folders: Sequence[Path] = ()
        self._services: list[_Service] | None = None
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="webviz-service")
        self._state: State | None = None
        self._is_telling = False
        self.asked: Mapping[str, str] = {
            name: str(node.declare_parameter(name, "", _described(text)).value)
            for name, text in PARAMETERS.items()
        }
        """What parameters were given at the start, "" for none."""
        node.add_on_set_parameters_callback(self._set)

    def open(self, viewer: Steered, folders: Sequence[Path] = ()) -> None:
        """Begin to control a viewer; may be called from any thread.

        Args:
            viewer: to control.
            folders: where configs may be opened, besides the folder that the viewer saves in.
        """
        self._folders = [Path(os.path.abspath(folder)) for folder in folders]
        self._viewer = viewer

    def turn(self) -> None:
        """Tell what is new, and send the answers that are ready; to be called very often."""
        if self._viewer is None:
            return
        if self._services is None:
            self._services = self._offer(self._viewer)
        for service in self._services:
            service.turn()
        if (state := self._viewer.state) is not self._state:
            self._state = state
            self._tell(state)

    def close(self) -> None:
        """End what is under way."""
        self._pool.shutdown(cancel_futures=True)

    # Parameters

    def _tell(self, state: State) -> None:
        """Give parameters the values that are true now."""
        begin, saved = state.settings.view, state.settings.views
        values = {
            CONFIG_FILE: _absolute(state.file.path),
            FIXED_FRAME: state.fixed_frame,
            VIEW: next((name for name, view in saved.items() if view == begin), ""),
        }
        new = [
            Parameter(name, value=value)
            for name, value in values.items()
            if value != self._node.get_parameter(name).value
        ]
        if new:
            self._is_telling = True
            try:
                self._node.set_parameters(new)
            finally:
                self._is_telling = False

    def _set(self, parameters: Sequence[Parameter]) -> SetParametersResult:
        """Do what somebody wants by setting parameters; those of others are not ours to judge."""
        if self._is_telling:
            return SetParametersResult(successful=True)
        try:
            commands = [
                command
                for parameter in parameters
                if parameter.name in PARAMETERS
                for command in self._commands(parameter.name, str(parameter.value))
            ]
            for command in commands:
                self._steered().do(command)
        except Error as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _commands(self, name: str, value: str) -> Sequence[Command]:
        if name == VIEW:
            return StartWithView(view=value), ShowView(value)
        if name == CONFIG_FILE:
            if not value:
                raise Error("A config_file needs a name.")
            return (Open(self._allowed(value)),)
        return (SetFixedFrame(value),)

    def _allowed(self, value: str) -> str:
        """The path of a config that anyone on the ROS network may open.

        Links are not followed: who may make them in these folders may also write configs there.
        """
        file = self._steered().state.file
        path = Path(os.path.normpath(Path(file.folder, value)))
        is_allowed = str(path.parent) == os.path.normpath(file.folder) or any(
            path.is_relative_to(folder) for folder in self._folders
        )
        if not is_allowed:
            raise Error(
                f"{path} is outside {file.folder}. Start webviz with --config-folder {path.parent} "
                "to allow it."
            )
        if path.suffix.lower() not in SUFFIXES:
            raise Error(f"{path} is not a config file: its name must end with .yaml or .rviz.")
        return str(path)

    def _steered(self) -> Steered:
        if self._viewer is None:
            raise Error("The viewer is starting: try again in a second.")
        return self._viewer

    # Services

    def _offer(self, viewer: Steered) -> list[_Service]:
        try:
            from std_srvs.srv import Empty, Trigger
        except ImportError:
            log.warning(NO_SERVICES)
            return []

        def load() -> str:
            path = _absolute(viewer.state.file.path)
            if not path:
                raise Error("There is no config file to load: set the parameter config_file.")
            viewer.do(Open(path))
            return f"Opened {path}."

        def save() -> str:
            if not viewer.state.file.path:
                raise Error("This config has no file yet: save it once on the page, under a name.")
            viewer.do(Save())
            return f"Saved {_absolute(viewer.state.file.path)}."

        def reset() -> str:
            viewer.do(Reset())
            return "Reset."

        def screenshot() -> str:
            return f"Saved {viewer.save_screenshot()}."

        return [
            _Service(self._node, type, name, work, self._pool)
            for name, type, work in (
                ("~/load_config", Trigger, load),
                ("~/save_config", Trigger, save),
                ("~/reset", Trigger, reset),
                ("~/reset_time", Empty, reset),  # RViz's
                ("~/screenshot", Trigger, screenshot),
            )
        ]


class _Service:
    """A service whose answers are sent when they are ready, while the node goes on.

    rclpy's events executor of 7.1.6 cannot have coroutines for that. But every executor hands the
    response to `send_response` of the service, which here begins the work.

    Args:
        node, type, name: of the service.
        work: what to do for a request, in a thread of `pool`; its text is the answer.
        pool: where to work.
    """

    def __init__(
        self,
        node: Node,
        type: Any,
        name: str,
        work: Callable[[], str],
        pool: ThreadPoolExecutor,
    ) -> None:
        self._service = node.create_service(type, name, lambda _, response: response)
        self._send = self._service.send_response
        self._service.send_response = self._begin
        self._work = work
        self._pool = pool
        self._under_way: list[tuple[Future[str], Any, Any]] = []

    def turn(self) -> None:
        """Send the answers that are ready."""
        for entry in [entry for entry in self._under_way if entry[0].done()]:
            self._under_way.remove(entry)
            self._answer(*entry)

    def _begin(self, response: Any, header: Any) -> None:
        if len(self._under_way) < MAX_REQUESTS:
            self._under_way.append((self._pool.submit(self._work), response, header))
            return
        refused: Future[str] = Future()
        refused.set_exception(Error("Too many requests at once. Try again later."))
        self._answer(refused, response, header)

    def _answer(self, done: Future[str], response: Any, header: Any) -> None:
        error = done.exception()
        if error is not None and not isinstance(error, Error):
            log.error("A service failed", exc_info=error)
        if hasattr(response, "success"):
            response.success = error is None
            response.message = str(error) if error is not None else done.result()
        self._send(response, header)


def _described(text: str) -> ParameterDescriptor:
    return ParameterDescriptor(description=text)


def _absolute(path: str) -> str:
    return str(Path(path).absolute()) if path else ""
