"""Saving while the disk is full, and while the program is killed."""

from __future__ import annotations

import subprocess
from pathlib import Path
from random import Random

from tests.attack.attack import Attack, Case, Outcome, Violation, piped

WAYS = ("kill config", "kill picture", "kill folder", "full config", "full picture")
"""Ends of the program, and what it saves meanwhile; a folder is for unfinished work."""
SUFFIXES = {"config": "yaml", "picture": "png", "folder": "left"}


class Saving(Attack):
    """Lets a process fork children that save, and ends or limits them at random moments.

    Args:
        folder: for its files.
    """

    kind = "saving"

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._saver: subprocess.Popen[str] | None = None

    def start(self) -> None:
        self._saver = piped("saver")

    def draw(self, random: Random) -> Case:
        how = random.choice(WAYS)
        return Case(how, str(random.uniform(0.0, 0.03)).encode())

    def strike(self, case: Case) -> Outcome:
        saver = self._saver = self._saver or piped("saver")
        assert saver.stdin is not None
        assert saver.stdout is not None
        # A file is kept from case to case: it is always a version that was saved once.
        suffix = SUFFIXES[case.name.partition(" ")[2]]
        path = self._folder / suffix / f"saved.{suffix}"
        path.parent.mkdir(exist_ok=True)
        saver.stdin.write(f"{case.name} {case.data.decode()} {path}\n")
        saver.stdin.flush()
        answer = saver.stdout.readline().strip()
        if answer not in ("survived", "refused"):
            raise Violation(answer or "the process that saves has ended")
        return Outcome(answer)

    def close(self) -> None:
        if self._saver is not None:
            self._saver.kill()
            self._saver.communicate()
        self._saver = None
