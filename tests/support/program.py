"""A program started as a user starts it."""

from __future__ import annotations

import re
import signal
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path

PATIENCE_S = 180.0
"""Time in seconds to start, which takes three seconds on a machine that does nothing else."""


class Program:
    """A program under test and what it prints."""

    def __init__(
        self, arguments: Sequence[str], env: dict[str, str], log: Path, cwd: Path | None = None
    ) -> None:
        self.log = log
        with log.open("w") as file:
            self.process = subprocess.Popen(
                arguments, env=env, stdout=file, stderr=subprocess.STDOUT, cwd=cwd
            )

    def output(self) -> str:
        return self.log.read_text()

    def wait_for(self, pattern: str, seconds: float = PATIENCE_S) -> re.Match[str]:
        """Wait until it prints something."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            if match := re.search(pattern, self.output()):
                return match
            assert self.process.poll() is None, f"it ended: {self.output()}"
            time.sleep(0.05)
        raise AssertionError(f"not within {seconds} s: {pattern!r} in {self.output()!r}")

    def url(self) -> str:
        """The address of the page it serves."""
        return self.wait_for(r"http://[\w.]+:\d+").group()

    def end(self, number: int = signal.SIGINT) -> int:
        """Send a signal and return the exit status."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        try:
            return self.process.wait(timeout=60)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise
