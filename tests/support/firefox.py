"""Firefox by Marionette, its own protocol: Playwright needs a build of its own."""

from __future__ import annotations

import base64
import contextlib
import io
import json
import os
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import PIL.Image
import pytest

PREFERENCES = {"webgl.force-enabled": True, "dom.max_script_run_time": 0}
PATIENCE_S = 120.0
REST_S = 0.1


class Firefox:
    """A running Firefox with one tab.

    Args:
        port: where it listens.
    """

    def __init__(self, port: int) -> None:
        self._socket = _connected(port)
        self._file = self._socket.makefile("rb")
        self._count = 0
        self._read()
        self._do("WebDriver:NewSession", {})

    def open(self, path: Path) -> None:
        """Open a file from the disk."""
        self._do("WebDriver:Navigate", {"url": path.as_uri()})

    def run(self, script: str, *arguments: object) -> Any:
        """The result of a function's body in the page."""
        parameters = {"script": script, "args": list(arguments), "sandbox": None}
        return self._do("WebDriver:ExecuteScript", parameters)["value"]

    def wait_for(self, script: str, *arguments: object) -> None:
        """Wait until a function's body in the page returns something true."""
        end_s = time.monotonic() + PATIENCE_S
        while not self.run(script, *arguments):
            assert time.monotonic() < end_s, f"never: {script}"
            time.sleep(REST_S)

    def pixels(self, selector: str) -> np.ndarray:
        """A picture of an element, uint8 (H, W, 3)."""
        result = self._do("WebDriver:FindElement", {"using": "css selector", "value": selector})
        (element,) = result["value"].values()
        response = self._do("WebDriver:TakeScreenshot", {"id": element, "full": False})
        image = PIL.Image.open(io.BytesIO(base64.b64decode(response["value"])))
        return np.asarray(image.convert("RGB"))

    def close(self) -> None:
        """Let it end."""
        with contextlib.suppress(OSError):
            self._do("Marionette:Quit", {"flags": ["eForceQuit"]})
        self._socket.close()

    def _do(self, name: str, parameters: dict[str, object]) -> Any:
        self._count += 1
        data = json.dumps([0, self._count, name, parameters]).encode()
        self._socket.sendall(b"%d:%s" % (len(data), data))
        _, _, error, result = self._read()
        assert error is None, f"{name}: {error}"
        return result

    def _read(self) -> Any:
        length = b""
        while (character := self._file.read(1)) != b":":
            assert character, "Firefox has ended"
            length += character
        return json.loads(self._file.read(int(length)))


@contextlib.contextmanager
def open_firefox(folder: Path) -> Iterator[Firefox]:
    """Firefox on a screen of its own, since it has no WebGL without one.

    Args:
        folder: an empty one, for its profile.
    """
    program = shutil.which("firefox-esr") or shutil.which("firefox")
    screen = shutil.which("Xvfb")
    if program is None or screen is None:
        pytest.skip("Firefox or Xvfb is not installed (apt install firefox-esr xvfb)")
    port = _free_port()
    preferences = {**PREFERENCES, "marionette.port": port}
    lines = [f"user_pref({json.dumps(k)}, {json.dumps(v)});" for k, v in preferences.items()]
    (folder / "user.js").write_text("\n".join(lines))
    with contextlib.ExitStack() as stack:
        display = stack.enter_context(_screen(screen))
        environment = {**os.environ, "DISPLAY": display, "HOME": str(folder)}
        command = [program, "--marionette", "--no-remote", "--profile", str(folder)]
        process = stack.enter_context(_process(command, environment))
        firefox = Firefox(port)
        stack.callback(process.wait, PATIENCE_S)
        stack.callback(firefox.close)
        if firefox.run("return !document.createElement('canvas').getContext('webgl2')"):
            pytest.skip("Firefox has no WebGL here (apt install libgl1-mesa-dri libegl1)")
        yield firefox


@contextlib.contextmanager
def _screen(program: str) -> Iterator[str]:
    """The name of a virtual screen."""
    own, theirs = os.pipe()
    command = [program, "-displayfd", str(theirs), "-screen", "0", "1280x900x24"]
    process = subprocess.Popen(
        command, pass_fds=[theirs], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    os.close(theirs)
    with os.fdopen(own) as output:
        number = output.readline().strip()
    try:
        yield f":{number}"
    finally:
        process.terminate()
        process.wait()


@contextlib.contextmanager
def _process(command: list[str], environment: dict[str, str]) -> Iterator[subprocess.Popen[bytes]]:
    process = subprocess.Popen(
        command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def _connected(port: int) -> socket.socket:
    end_s = time.monotonic() + PATIENCE_S
    while True:
        try:
            return socket.create_connection(("127.0.0.1", port), PATIENCE_S)
        except OSError:
            if time.monotonic() > end_s:
                raise
            time.sleep(REST_S)
