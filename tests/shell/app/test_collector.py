"""Pauses of the garbage collector, in which a robot that is driven gets no command."""

from __future__ import annotations

import subprocess
import sys

SCRIPT = """
import gc, msgspec
from webviz.shell.cli.serving import calm_collector
calm_collector()
gc.collect()
pauses = []
gc.callbacks.append(lambda phase, info: pauses.append(info))
for _ in range(1000):
    msgspec.json.decode("[" + "[]," * 8000 + "1]")
print(len(pauses))
"""


def test_messages_of_many_values_cause_no_pause() -> None:
    run = subprocess.run(
        [sys.executable, "-c", SCRIPT], capture_output=True, text=True, timeout=120, check=True
    )
    assert run.stdout == "0\n"


STARTED = """
import gc, sys
from webviz.shell.cli import program
gc.callbacks.append(lambda phase, info: print("collected", file=sys.stderr))
sys.argv = ["webviz", "--help"]
program()
"""


def test_a_command_starts_without_collecting() -> None:
    run = subprocess.run(
        [sys.executable, "-c", STARTED], capture_output=True, text=True, timeout=120, check=True
    )
    assert run.stderr == ""
