"""The viewer that is attacked, as a user starts it, and what holds of it at any time."""

from __future__ import annotations

import contextlib
import http.client
import re
import sys
import threading
import time
from pathlib import Path

import psutil
import websockets.exceptions
from program import Program

from tests.attack.attack import Violation
from tests.attack.visitor import Visitor
from webviz.api.errors import Error
from webviz.api.registry import display_types
from webviz.api.roles import Role
from webviz.files.opening import load
from webviz.server.access.roles import LINKS

ANSWER_S = 20.0
"""Time in seconds in which the viewer must answer whatever else it is sent; a busy machine takes
seconds."""
MEMORY_MB = 1750.0
"""Limit in MB of the viewer, its simulator and what reads meshes for it; 450 MB when nothing
happens."""
INTERNAL = re.compile(r"^.*(?:Traceback|[Ii]nternal (?:server )?error|handler failed).*$", re.M)
"""Lines of the log that an internal error leaves."""
WARNINGS = {"PYTHONWARNINGS": "error::RuntimeWarning"}
"""An unexpected overflow would be printed to users."""
EVERY_S = 0.5
SECRETS = {role: f"token-of-the-attacked-{role.label}" for role in Role}
PARAMETERS = {role: parameter for parameter, role in LINKS.items()}
TOKENS = {
    f"WEBVIZ_TOKEN_{parameter.upper()}": SECRETS[role] for role, parameter in PARAMETERS.items()
}


def config() -> str:
    """A config with a display of each type."""
    rows = [f"- {{type: {name}}}" for name in display_types() if name != "Group"]
    return "\n".join(["version: 1", "fixed_frame: map", "displays:", *rows, ""])


def homes(folder: Path) -> dict[str, str]:
    """The environment of a program whose user has nothing but an empty folder."""
    return {
        "HOME": str(folder),
        "XDG_CONFIG_HOME": str(folder / "config"),
        "XDG_STATE_HOME": str(folder / "state"),
    }


class Target:
    """A viewer with a simulated robot, and a bystander who looks at it.

    Args:
        folder: for its files.
        environment: of its process, with the ROS domain.
    """

    def __init__(self, folder: Path, environment: dict[str, str]) -> None:
        self.folder = folder
        self.configs = folder / "configs"
        self.configs.mkdir(parents=True)
        self.config = config()
        path = self.configs / "attacked.yaml"
        path.write_text(self.config)
        home = folder / "home"
        home.mkdir()
        self._program = Program(
            [sys.executable, "-m", "webviz", "demo", "-d", str(path), "--port", "0"],
            {**environment, **TOKENS, **WARNINGS, "PYTHONUNBUFFERED": "1", **homes(home)},
            folder / "log.txt",
            cwd=home,  # where an owner records
        )
        self.port = int(self._program.url().rpartition(":")[2])
        self.process = psutil.Process(self._program.process.pid)
        self._cookies: dict[Role, str] = {}
        self._read = 0
        self.slowest_s = self.memory_mb = 0.0
        self._fault = ""
        self._is_closed = threading.Event()
        self._answered = threading.Event()
        self._bystander = self.visitor(Role.OWNER)
        self._watches = [
            threading.Thread(target=watch, daemon=True) for watch in (self._watch_over, self._weigh)
        ]
        for watch in self._watches:
            watch.start()

    def headers(self, role: Role | None) -> dict[str, str]:
        """Headers of requests by a role; None is without a token."""
        if role is None:
            return {}
        if role not in self._cookies:
            connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=ANSWER_S)
            with contextlib.closing(connection):
                typed = {"Sec-Fetch-Site": "none"}
                connection.request("GET", f"/?{PARAMETERS[role]}={SECRETS[role]}", headers=typed)
                cookie = connection.getresponse().headers["Set-Cookie"]
            self._cookies[role] = cookie.partition(";")[0]
        return {"Cookie": self._cookies[role]}

    def visitor(self, role: Role) -> Visitor:
        """A person of a role with a page of the viewer."""
        return Visitor(self.port, **self.headers(role))

    @property
    def is_alive(self) -> bool:
        """Return whether the viewer runs."""
        return self._program.process.poll() is None

    def check(self) -> None:
        """Raise Violation if a promise is broken since the last check."""
        if (status := self._program.process.poll()) is not None:
            raise Violation(f"the viewer has ended with status {status}: {self._tail()}")
        if self._fault:
            fault, self._fault = self._fault, ""
            raise Violation(fault)
        log = self._program.output()[self._read :]
        self._read += len(log)
        if result := INTERNAL.search(log):
            raise Violation(f"an internal error in the log: {log[result.start() :][:2000]}")
        outside = {path.name for path in self.folder.iterdir()} - {"configs", "home", "log.txt"}
        if outside:
            raise Violation(f"files outside of the folder of configs: {outside}")

    def wait_until_answered(self) -> None:
        """Wait until the bystander is answered once more, then check."""
        self._answered.clear()
        self._answered.wait(2 * ANSWER_S)
        self.check()

    def restore(self) -> None:
        """Put back what attacks have opened, changed or removed."""
        visitor = self.visitor(Role.OWNER)
        try:
            level, text = visitor.do("Load", ANSWER_S, text=self.config, name="attacked.yaml")
        except (TimeoutError, websockets.exceptions.ConnectionClosed) as error:
            raise Violation(f"the viewer does not open its own config: {error!r}") from error
        finally:
            visitor.close()
        if level == "error":
            raise Violation(f"the viewer does not open its own config: {text}")

    def kill_while_saving(self, delay_s: float) -> None:
        """Kill the viewer at some moment of saving a config again and again."""
        self._stop_watching()
        path = self.configs / "killed.yaml"
        visitor = self.visitor(Role.OWNER)
        visitor.do("Save", ANSWER_S, path=path.name)
        for number in range(9):
            # What has not changed is not written again.
            arguments = {"hz": 30.0 + number}
            visitor.send("CommandRequest", number=100, command="SetFrameRate", arguments=arguments)
            visitor.send(
                "CommandRequest", number=101, command="Save", arguments={"path": path.name}
            )
        time.sleep(delay_s)
        self._program.process.kill()
        self._program.process.wait()
        visitor.close()
        for file in (path, *filter(Path.exists, [path.with_name(f"{path.name}.bak")])):
            try:
                load(file)
            except Error as error:
                raise Violation(f"a viewer that is killed leaves {file.name}: {error}") from error

    def close(self) -> None:
        """End the viewer, which must end by itself."""
        self._stop_watching()
        self._bystander.close()
        if self._program.process.poll() is None:
            self._program.end()

    def _stop_watching(self) -> None:
        self._is_closed.set()
        for watch in self._watches:
            watch.join()

    def _weigh(self) -> None:
        """Measure the memory, also while the viewer does not answer."""
        while not self._is_closed.wait(EVERY_S):
            try:
                self._measure()
            except Violation as violation:
                self._fault = str(violation)

    def _watch_over(self) -> None:
        while not self._is_closed.wait(EVERY_S):
            try:
                self._look()
            except Violation as violation:
                self._fault = str(violation)
            except OSError as error:
                self._fault = f"the viewer does not answer: {error!r}"
            except websockets.exceptions.ConnectionClosed as error:
                self._fault = f"the bystander was thrown out: {error}"
                with contextlib.suppress(OSError, websockets.exceptions.WebSocketException):
                    self._bystander = self.visitor(Role.OWNER)
            self._answered.set()

    def _look(self) -> None:
        start = time.monotonic()
        with contextlib.closing(
            http.client.HTTPConnection("127.0.0.1", self.port, timeout=ANSWER_S)
        ) as connection:
            connection.request("HEAD", "/", headers=self.headers(Role.OWNER))
            connection.getresponse().read()
        self._bystander.do("Pause", ANSWER_S, paused=False)
        self.slowest_s = max(self.slowest_s, time.monotonic() - start)

    def _measure(self) -> None:
        total = 0
        with contextlib.suppress(psutil.NoSuchProcess):
            for process in (self.process, *self.process.children(recursive=True)):
                with contextlib.suppress(psutil.NoSuchProcess):
                    total += process.memory_info().rss
        self.memory_mb = max(self.memory_mb, total / 1e6)
        if total / 1e6 > MEMORY_MB:
            raise Violation(f"the viewer has {total / 1e6:.0f} MB of memory")

    def _tail(self) -> str:
        return self._program.output()[-1000:]
