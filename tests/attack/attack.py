"""Attacks: cases that follow from a seed and a number, and their outcomes."""

from __future__ import annotations

import abc
import enum
import os
import subprocess
import sys
from dataclasses import dataclass
from random import Random
from typing import Any


class Outcome(enum.Enum):
    """Outcome of a case that broke no promise."""

    REFUSED = "refused"
    """The viewer refused it, by a sentence, a status or the end of the connection."""
    DONE = "done"
    """The viewer did what it was asked."""
    SURVIVED = "survived"
    """The viewer took or ignored it, and went on."""


class Violation(Exception):
    """A promise was broken; the message says which."""


@dataclass(frozen=True)
class Case:
    """One input for the viewer.

    Args:
        name: of a file that holds `data`; says how it is sent.
        data: what is sent.
    """

    name: str
    data: bytes


class Attack(abc.ABC):
    """One kind of attack."""

    kind: str
    """Its name, also that of its folder in the corpus."""
    least = 1
    """Number of cases in a turn, however slow the machine is."""

    def start(self) -> None:  # noqa: B027 - most start nothing
        """Start what the attack needs, once before the first case."""

    @abc.abstractmethod
    def draw(self, random: Random) -> Case:
        """A case; the same for the same state of `random`."""

    @abc.abstractmethod
    def strike(self, case: Case) -> Outcome:
        """Try a case.

        Raises:
            Violation: a promise was broken.
        """

    def close(self) -> None:  # noqa: B027 - most start nothing
        """End what it has started."""


def piped(module: str) -> subprocess.Popen[str]:
    """Start a module of this package, which reads and writes lines."""
    command = [sys.executable, "-m", f"tests.attack.{module}"]
    # Where the modules of the tests are found here, they are found there.
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    return subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=env
    )


def random_of(seed: int, kind: str, number: int) -> Random:
    """The source of a case, independent of all others."""
    return Random(f"{seed} {kind} {number}")


def mutated(random: Random, data: bytes) -> bytes:
    """Data with one to four changes of the kinds that parsers get wrong."""
    changed = bytearray(data)
    for _ in range(random.randint(1, 4)):
        at = random.randrange(len(changed) + 1)
        match random.randrange(7):
            case 0 if at < len(changed):
                changed[at] ^= 1 << random.randrange(8)
            case 1:
                del changed[at:]
            case 2:
                del changed[at : at + random.randint(1, 16)]
            case 3:
                changed[at:at] = random.randbytes(random.randint(1, 16))
            case 4:  # a length, or a number
                extreme = random.choice((0, 1, 2**31 - 1, 2**31, 2**32 - 1, 0x7FC00000, 0x7F800000))
                changed[at : at + 4] = extreme.to_bytes(4, "little")
            case 5:  # the same part again
                changed[at:at] = changed[at : at + random.randint(1, 64)] * random.randint(1, 8)
            case _:
                other = random.randrange(len(changed) + 1)
                changed[at : at + 8] = changed[other : other + 8]
    return bytes(changed)


ODD: tuple[Any, ...] = (None, -1, 2**64, 1e999, "", "x" * 5000, [], {}, [[[]]], True)


def changed_part(random: Random, value: Any) -> Any:
    """JSON of which one part is another."""
    if isinstance(value, dict) and value and random.random() < 0.8:
        key = random.choice(sorted(value))
        return {**value, key: changed_part(random, value[key])}
    if isinstance(value, list) and value and random.random() < 0.8:
        place = random.randrange(len(value))
        return [*value[:place], changed_part(random, value[place]), *value[place + 1 :]]
    return random.choice(ODD)
