"""A Python with Eclipse Cyclone DDS and without ROS, in an environment of its own."""

from __future__ import annotations

import fcntl
import subprocess
import venv
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / ".venv-peer"


def peer_python() -> Path:
    """Return the Python; skip the test if Cyclone DDS cannot be installed.

    Workers that need it at once wait for the first.
    """
    python = FOLDER / "bin" / "python"
    FOLDER.mkdir(exist_ok=True)
    with (FOLDER / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not python.exists():
            venv.create(FOLDER, with_pip=True)
        if subprocess.run([python, "-c", "import cyclonedds"], capture_output=True).returncode:
            command = [python, "-m", "pip", "install", "--quiet", "cyclonedds==11.0.1"]
            if subprocess.run(command).returncode:
                pytest.skip("cyclonedds could not be installed")
    return python
