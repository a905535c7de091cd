"""Parameters and services of the viewer's node."""

from __future__ import annotations

import functools
import logging
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Protocol

from rcl_interfaces.msg import ParameterDescriptor, ParameterType, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from webviz import commands
from webviz.api.errors import Error
from webviz.api.finding import Finding
from webviz.commands import Reset, SetFixedFrame, ShowView, StartWithView
from webviz.engine.commands import Command
from webviz.files.config import Settings
from webviz.files.config.files import SUFFIXES
from webviz.ros.distribution import apt_name

if TYPE_CHECKING:
    from webviz.ros.diagnostics import DiagnosticsPublisher

log = logging.getLogger("webviz")

DIAGNOSTICS = "publish_diagnostics"
CONFIG_FILE, FIXED_FRAME, VIEW = "config_file", "fixed_frame", "view"
PARAMETERS = {
    CONFIG_FILE: "Path of the config file. Set it to open another one from the same folder.",
    FIXED_FRAME: "Frame in which everything is drawn.",
    VIEW: "Saved view in which browsers start. Set it to move all cameras.",
}
NO_SERVICES = (
    "The viewer's services, such as ~/load_config and ~/screenshot, are unavailable because "
    "std_srvs is missing. Install {package}."
)
NO_DIAGNOSTICS = (
    "The service ~/doctor and the parameter publish_diagnostics are unavailable because "
    "diagnostic_msgs is missing. Install {package}."
)
NO_CONTROL = "This viewer was started with --no-control. Restart it without this option."
MAX_REQUESTS = 4
"""Largest number of requests of a service at a time; rclpy itself queues ten."""


class Controlled(Protocol):
    """The part of `webviz.Viewer` that is used here; thread-safe."""

    @property
    def settings(self) -> Settings:
        """Everything in the config except its lists."""
        ...

    @property
    def path(self) -> str:
        """The config file, or ""."""
        ...

    def fact(self, name: str, otherwise: Any = None) -> Any:
        """Return one field of its state."""
        ...

    def do(self, command: Command) -> str:
        """Run a command, wait for it, and return its message."""
        ...

    def doctor(self) -> Sequence[Finding]:
        """Examine the viewer, which takes seconds, and return the findings."""
        ...

    def last_findings(self) -> Sequence[Finding]:
        """Return the findings of the last round, and let rounds go on for some seconds."""
        ...

    def save_screenshot(self) -> Path:
        """Save a picture to a new file, which takes seconds."""
        ...


class ControlNode:
    """Mirrors the state of a viewer in parameters of a node, and offers services to change it.

    All methods but `open` must be called in the thread that spins the node.

    Args:
        node: that has them.
        wake: makes that thread call `turn` soon.
    """

    def __init__(self, node: Node, wake: Callable[[], None]) -> None:
        self._node = node
        self._wake = wake
        self._viewer: Controlled | None = None
        self._folders: Sequence[Path] = ()
        self._may_change = True
        self._services: list[_Service] | None = None
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="webviz-service")
        self._mirrored: Mapping[str, str] = {}
        self._is_mirroring = False
        self.initial: Mapping[str, str] = {
            name: str(node.declare_parameter(name, "", ParameterDescriptor(description=text)).value)
            for name, text in PARAMETERS.items()
        }
        """Values of the parameters at startup, "" if unset."""
        about = "Publish the findings of the doctor on /diagnostics, once a second."
        node.declare_parameter(
            DIAGNOSTICS,
            False,
            ParameterDescriptor(type=ParameterType.PARAMETER_BOOL, description=about),
        )
        self._diagnostics: DiagnosticsPublisher | None = None
        about_time = "Take the time from /clock. The viewer then waits for its first message."
        node.set_descriptor(
            "use_sim_time",
            ParameterDescriptor(type=ParameterType.PARAMETER_BOOL, description=about_time),
        )
        node.add_on_set_parameters_callback(self._set)

    def open(
        self, viewer: Controlled, folders: Sequence[Path] = (), *, may_change: bool = True
    ) -> None:
        """Start to control a viewer; may be called from any thread.

        Args:
            viewer: to control.
            folders: from which configs may be opened, besides the viewer's own folder.
            may_change: whether parameters can be set and services called; else they only report.
        """
        self._may_change = may_change
        self._folders = [Path(os.path.abspath(folder)) for folder in folders]
        self._viewer = viewer
        self._wake()

    def turn(self) -> None:
        """Update the parameters, and send responses that are ready; to be called often."""
        if self._viewer is None:
            return
        if self._services is None:
            self._services = self._create_services(self._viewer) if self._may_change else []
        for service in self._services:
            service.turn()
        self._follow_diagnostics(self._viewer)
        if (values := _values(self._viewer)) != self._mirrored:
            self._mirror(values)
            self._mirrored = values

    def close(self) -> None:
        """Cancel service requests that have not started."""
        self._pool.shutdown(cancel_futures=True)

    def _follow_diagnostics(self, viewer: Controlled) -> None:
        """Publish diagnostics while the parameter asks for them."""
        is_wanted = self._node.get_parameter(DIAGNOSTICS).value
        if is_wanted and self._diagnostics is None and (module := _diagnostics()):
            self._diagnostics = module.DiagnosticsPublisher(self._node, viewer.last_findings)
        elif not is_wanted and self._diagnostics is not None:
            self._diagnostics.close()
            self._diagnostics = None
        if self._diagnostics is not None:
            self._diagnostics.turn()

    # Parameters

    def _mirror(self, values: Mapping[str, str]) -> None:
        """Set the parameters to these values."""
        new = [
            Parameter(name, value=value)
            for name, value in values.items()
            if value != self._node.get_parameter(name).value
        ]
        if new:
            self._is_mirroring = True
            try:
                self._node.set_parameters(new)
            finally:
                self._is_mirroring = False

    def _set(self, parameters: Sequence[Parameter]) -> SetParametersResult:
        """Pass parameters that were set to the viewer; those of others are accepted unseen."""
        if self._is_mirroring:
            return SetParametersResult(successful=True)
        self._mirrored = {}  # look at them again: "/map" is to become "map"
        self._wake()
        try:
            commands = [
                command
                for parameter in parameters
                if parameter.name in PARAMETERS
                for command in self._commands(parameter.name, str(parameter.value))
            ]
            is_change = commands or any(each.name == DIAGNOSTICS for each in parameters)
            if is_change and not self._may_change:
                raise Error(NO_CONTROL)
            for command in commands:
                self._require_viewer().do(command)
        except Error as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _commands(self, name: str, value: str) -> Sequence[Command]:
        if name == VIEW:
            return StartWithView(view=value), ShowView(value)
        if name == CONFIG_FILE:
            if not value:
                raise Error("config_file needs a file name.")
            return (commands.Open(self._allowed(value)),)
        return (SetFixedFrame(value),)

    def _allowed(self, value: str) -> str:
        """Return the path of a config that may be opened through ROS.

        Links are not resolved, since creating one takes the same permission as writing a config.
        """
        own = self._require_viewer().fact("file").folder
        path = Path(os.path.normpath(Path(own, value)))
        is_allowed = str(path.parent) == os.path.normpath(own) or any(
            path.is_relative_to(folder) for folder in self._folders
        )
        if not is_allowed:
            raise Error(
                f"{path} is outside {own}. Start webviz with --config-folder {path.parent} "
                "to allow it."
            )
        if path.suffix.lower() not in SUFFIXES:
            raise Error(f"{path} is not a config file. Its name must end with .yaml or .rviz.")
        return str(path)

    def _require_viewer(self) -> Controlled:
        if self._viewer is None:
            raise Error("The viewer is starting. Try again in a second.")
        return self._viewer

    # Services

    def _create_services(self, viewer: Controlled) -> list[_Service]:
        try:
            from std_srvs.srv import Empty, Trigger
        except ImportError:
            log.warning(NO_SERVICES.format(package=apt_name("std_srvs")))
            return []

        def load() -> str:
            path = _absolute(viewer.path)
            if not path:
                raise Error("No config file to load. Set the parameter config_file.")
            viewer.do(commands.Open(path))
            return f"Opened {path}."

        def save() -> str:
            if not viewer.path:
                raise Error("The config has no file yet. Save it on the page first.")
            viewer.do(commands.Save())
            return f"Saved {_absolute(viewer.path)}."

        def reset() -> str:
            viewer.do(Reset())
            return "Reset."

        def screenshot() -> str:
            return f"Saved {viewer.save_screenshot()}."

        def save_last() -> str:
            return viewer.do(commands.SaveMemory())

        def start_recording() -> str:
            return viewer.do(commands.StartRecording())

        def stop_recording() -> str:
            return viewer.do(commands.StopRecording())

        return [
            _Service(self._node, type, name, work, self._pool, self._wake, _say)
            for name, type, work in (
                ("~/load_config", Trigger, load),
                ("~/save_config", Trigger, save),
                ("~/reset", Trigger, reset),
                ("~/reset_time", Empty, reset),  # RViz's
                ("~/screenshot", Trigger, screenshot),
                ("~/save_last", Trigger, save_last),
                ("~/start_recording", Trigger, start_recording),
                ("~/stop_recording", Trigger, stop_recording),
            )
        ] + self._doctor_service(viewer)

    def _doctor_service(self, viewer: Controlled) -> list[_Service]:
        """Return the service that returns findings, none if diagnostic_msgs is missing."""
        module = _diagnostics()
        if module is None:
            return []

        def fill(response: Any, future: Future[Any]) -> None:
            response.id = self._node.get_fully_qualified_name()
            if future.exception() is None:
                response.status = module.statuses_of(future.result())
                response.passed = bytes([response.status[0].level == b"\0"])

        type, work = module.SelfTest, viewer.doctor
        return [_Service(self._node, type, "~/doctor", work, self._pool, self._wake, fill)]


class _Service:
    """A service that responds later without blocking the node.

    rclpy's events executor (7.1.6) does not support coroutines as callbacks. But every executor
    passes the response to `send_response` of the service, which is replaced here.

    Args:
        node, type, name: of the service.
        work: called in `pool` for each request.
        pool: one thread for all services.
        wake: called from any thread when a response is ready.
        fill: fills the response with the result of `work`, or its error.
    """

    def __init__(
        self,
        node: Node,
        type: Any,
        name: str,
        work: Callable[[], Any],
        pool: ThreadPoolExecutor,
        wake: Callable[[], None],
        fill: Callable[[Any, Future[Any]], None],
    ) -> None:
        self._service = node.create_service(type, name, lambda _, response: response)
        self._send = self._service.send_response
        self._service.send_response = self._begin
        self._work = work
        self._fill = fill
        self._pool = pool
        self._wake = wake
        self._pending: list[tuple[Future[Any], Any, Any]] = []

    def turn(self) -> None:
        """Send the responses that are ready."""
        for entry in [entry for entry in self._pending if entry[0].done()]:
            self._pending.remove(entry)
            self._respond(*entry)

    def _begin(self, response: Any, header: Any) -> None:
        if len(self._pending) < MAX_REQUESTS:
            future = self._pool.submit(self._work)
            self._pending.append((future, response, header))
            future.add_done_callback(lambda _: self._wake())
            return
        refused: Future[Any] = Future()
        refused.set_exception(Error("Too many requests at once. Try again later."))
        self._respond(refused, response, header)

    def _respond(self, future: Future[Any], response: Any, header: Any) -> None:
        error = future.exception()
        if error is not None and not isinstance(error, Error):
            log.error("A service failed", exc_info=error)
        self._fill(response, future)
        self._send(response, header)


@functools.cache
def _diagnostics() -> ModuleType | None:
    """Return the module of diagnostic messages, None if diagnostic_msgs is missing."""
    try:
        from webviz.ros import diagnostics
    except ImportError:
        log.warning(NO_DIAGNOSTICS.format(package=apt_name("diagnostic_msgs")))
        return None
    return diagnostics


def _say(response: Any, future: Future[Any]) -> None:
    """Fill the response of a Trigger; that of Empty has no fields."""
    if hasattr(response, "success"):
        error = future.exception()
        response.success = error is None
        response.message = str(error) if error is not None else future.result()


def _values(viewer: Controlled) -> dict[str, str]:
    """Return the values of the parameters."""
    settings = viewer.settings
    start, saved = settings.view, settings.views
    return {
        CONFIG_FILE: _absolute(viewer.path),
        FIXED_FRAME: settings.fixed_frame,
        VIEW: next((name for name, view in saved.items() if view == start), ""),
    }


def _absolute(path: str) -> str:
    return str(Path(path).absolute()) if path else ""
