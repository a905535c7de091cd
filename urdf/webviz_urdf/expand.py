"""Expanding xacro files in a process of their own, as they evaluate Python."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

from webviz_urdf.robot import RobotDescriptionError

ALLOWED_BY = "WEBVIZ_XACRO"
"""The environment variable that is 1 if the user who started webviz trusts xacro files."""
TIME_S = 20
MAX_BYTES = 16 << 20
"""Limit in bytes of the expanded text."""
MAX_MEMORY = 1 << 30
MISSING = 3
"""Exit status without the package `xacro`."""

_PROGRAM = f"""
import resource, signal, sys
signal.alarm(int(sys.argv[2]) + 1)  # in case the parent process is gone
for kind, most in (
    (resource.RLIMIT_AS, {MAX_MEMORY}),
    (resource.RLIMIT_CPU, int(sys.argv[2])),
    (resource.RLIMIT_FSIZE, 0),  # nothing is written
    (resource.RLIMIT_CORE, 0),
):
    resource.setrlimit(kind, (most, most))
try:
    import xacro
except ImportError:
    sys.exit({MISSING})
try:
    print(xacro.process_file(sys.argv[1]).toxml())
except BaseException as error:
    print(" ".join(str(error).split())[:500] or type(error).__name__)
    sys.exit(1)
"""


def expand(path: Path) -> str:
    """Return the URDF of a xacro file.

    Raises:
        RobotDescriptionError: that is not allowed, or fails; one sentence.
    """
    by_hand = f"expand it with `xacro {path.name} > {path.stem}`"
    if os.environ.get(ALLOWED_BY) != "1":
        raise RobotDescriptionError(
            f"{path} is a xacro file, which may run any program: {by_hand}, or start webviz with "
            f"{ALLOWED_BY}=1 if you trust it."
        )
    text, status, is_late = _run(path)
    if status == MISSING:
        raise RobotDescriptionError(
            f"{path} needs xacro: install ros-$ROS_DISTRO-xacro and source ROS, or `pip install "
            f"xacro`, or {by_hand}."
        )
    if is_late:
        raise RobotDescriptionError(f"xacro takes longer than {TIME_S} s with {path}: {by_hand}.")
    if len(text) > MAX_BYTES:
        raise RobotDescriptionError(
            f"{path} expands to more than {MAX_BYTES >> 20} MB: simplify the description."
        )
    output = text.decode(errors="replace").strip()
    if status:
        reason = output if status == 1 and output else f"it ended with status {status}"
        raise RobotDescriptionError(f"xacro cannot expand {path}: {reason.rstrip('.')}.")
    return output


def _run(path: Path) -> tuple[bytes, int, bool]:
    """Return xacro's output (one byte beyond the limit at most), status, and a timeout flag."""
    # Tokens are in variables of webviz.
    environment = {k: v for k, v in os.environ.items() if not k.startswith("WEBVIZ_")}
    with subprocess.Popen(
        [sys.executable, "-P", "-B", "-c", _PROGRAM, str(path), str(TIME_S)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=environment,
        start_new_session=True,
    ) as process:
        assert process.stdout is not None
        is_late = threading.Event()

        def end() -> None:
            is_late.set()
            os.killpg(process.pid, signal.SIGKILL)

        timer = threading.Timer(TIME_S, end)
        timer.start()
        try:
            text = process.stdout.read(MAX_BYTES + 1)
            if len(text) > MAX_BYTES:
                os.killpg(process.pid, signal.SIGKILL)
            status = process.wait()
        finally:
            timer.cancel()
        return text, status, is_late.is_set()
