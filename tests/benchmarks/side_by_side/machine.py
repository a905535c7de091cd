"""The machine, the commit and the versions that figures depend on."""

from __future__ import annotations

import importlib.metadata
import os
import platform
import subprocess
from collections.abc import Sequence
from pathlib import Path

import psutil

from side_by_side.systems.registry import SYSTEMS


def machine() -> dict[str, str]:
    """Return the properties of the machine that figures depend on."""
    memory = round(psutil.virtual_memory().total / 2**30)
    model = "unknown"
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            model = line.partition(": ")[2]
    return {
        "processor": f"{os.cpu_count()} x {model}",
        "memory": f"{memory} GiB",
        "system": f"{platform.system()} {platform.release()}, Python {platform.python_version()}",
    }


def commit() -> str:
    """The commit of the checkout, marked if something has changed since."""
    command = ["git", "describe", "--always", "--dirty", "--exclude=*"]
    completed = subprocess.run(command, cwd=Path(__file__).parent, capture_output=True, text=True)
    return completed.stdout.strip() or "unknown"


def versions(systems: Sequence[str]) -> dict[str, str]:
    """Versions of the packages that matter."""
    packages = [package for name in systems for package in SYSTEMS[name].packages]
    return {package: importlib.metadata.version(package) for package in dict.fromkeys(packages)}
