"""The base class of the doctor's checks: plug-ins that find one cause each.

    class Lidar(Check):
        \"\"\"Laser that has lost its motor.

        The driver publishes scans in which every beam has the same range.

        Why:
            Localisation follows the last good scan, and drifts.

        Repair:
            Power the laser off and on.
        \"\"\"

        id = "DATA900"

        def find(self, seen):
            for display, port in seen.inputs():
                if port.type == SCAN and port.message and is_stuck(port.message):
                    yield self.found(f"Every beam of {port.topic} has the same range.", ...)

A package names the module or package that holds its checks as an entry point of the group
`webviz.checks`; each class in it is a check. `--plugin FILE` loads those of a file.
"""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Iterable
from typing import Any, ClassVar

from webviz.api.finding import CauseLevel, Finding
from webviz.api.observation import Observation


class Check:
    """A check of the doctor: a function from what was observed to findings.

    Its docstring is its documentation: a title, what it finds, and the sections `Why` and `Repair`.
    """

    id: ClassVar[str] = ""
    """A level of causes and three digits, such as NET004; it never changes its meaning."""

    def find(self, observation: Observation) -> Iterable[Finding]:
        """Return a finding for each cause of this kind, none if all is well.

        It is called about once a second by the frame loop, so it may not block.
        """
        raise NotImplementedError

    def found(self, cause: str, remedy: str, **facts: Any) -> Finding:
        """Make a finding of this check; the arguments are those of `webviz.Finding`."""
        return Finding(id=self.id, cause=cause, remedy=remedy, **facts)


class CheckText:
    """The documentation of a check, read from its docstring.

    Args:
        check: the class.
    """

    def __init__(self, check: type[Check]) -> None:
        self.id = check.id
        self.level = CauseLevel.of(check.id)
        title, _, rest = inspect.cleandoc(check.__doc__ or "").partition("\n")
        self.title = title.rstrip(".")
        what, _, rest = rest.partition("\nWhy:\n")
        why, _, repair = rest.partition("\nRepair:\n")
        self.what, self.why, self.repair = (_paragraphs(part) for part in (what, why, repair))


def _paragraphs(text: str) -> tuple[str, ...]:
    """Paragraphs, one line each; indented lines in them keep their breaks, as code."""
    parts = textwrap.dedent(text.strip("\n")).split("\n\n")
    return tuple(p.rstrip() if p.startswith("    ") else " ".join(p.split()) for p in parts if p)
