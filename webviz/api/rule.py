"""Rules: conditions that must hold, such as `Scan.walls > 0.8 for 2s`."""

from __future__ import annotations

import functools
import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from webviz.data.messages.message_paths import MessagePath
from webviz.data.messages.paths import PathError

COMPARISONS: Mapping[str, Callable[[float, float], bool]] = {
    "<=": operator.le,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
}
LEVELS = {"ok": 0.0, "warn": 1.0, "error": 2.0}
"""Limits of the value `status` by name."""
_NAMES = {level: name for name, level in LEVELS.items()}
VALUES: Mapping[str, str] = {
    "status": "Worst status: ok, warn or error.",
    "rate": "Messages per second.",
    "age": "Time since the stamp of the newest message, in s.",
    "delay": "Time from the stamp of the newest message to its reception, in s.",
    "walls": "Share of the points of a laser scan that lie on walls of the map, from 0 to 1.",
    "blocked": "Points of a laser scan on a path.",
    "findings": "Findings of the doctor that are more than notes; the subject is `doctor`.",
    "errors": "Findings of the doctor that are errors; the subject is `doctor`.",
}
"""Meaning of each value."""
OF_DOCTOR = ("findings", "errors")
DOCTOR = "doctor"

_UNITS = {"ms": 0.001, "s": 1.0, "min": 60.0}
_LINE = re.compile(
    r"(?P<about>\S.*?) *(?P<comparison>[<>]=?|[=!]=) *"
    r"(?P<limit>-?\d+(\.\d+)?|ok|warn|error)"
    r"( +for +(?P<count>\d+(\.\d+)?) ?(?P<unit>ms|s|min))?"
)
_NAMED = re.compile(r"(?P<subject>\S.*)\.(?P<value>[a-z]+)")
_TOPIC = re.compile(r"/[\w~/]+")
FORM = (
    'Write it like "Scan.walls > 0.8", "/scan.rate >= 5 for 2s", "/battery.percentage > 0.2" or '
    '"doctor.errors == 0".'
)


@dataclass(frozen=True)
class Rule:
    """A condition that must hold.

    Args:
        text: as it was written.
        subject: name of a display, a topic that a display shows, `DOCTOR`, or a message path.
        value: one of `VALUES`, "" of a message path.
        comparison: one of `COMPARISONS`.
        limit: that the value is compared with.
        seconds: a violation counts once it has lasted as long.
    """

    text: str
    subject: str
    value: str
    comparison: str
    limit: float
    seconds: float = 0.0

    @property
    def path(self) -> str:
        """The message path that it is about, "" for none."""
        return "" if self.value else self.subject

    @property
    def about(self) -> str:
        """The value that it is about, such as "Scan.walls"."""
        return self.path or f"{self.subject}.{self.value}"

    def holds(self, value: float) -> bool:
        """Return whether the condition holds for a value."""
        return COMPARISONS[self.comparison](value, self.limit)

    @property
    def expectation(self) -> str:
        """The comparison and its limit, such as "> 0.8"."""
        return f"{self.comparison} {self._name_of(self.limit) or f'{self.limit:g}'}"

    def text_of(self, value: float) -> str:
        """Return a value for sentences."""
        return self._name_of(value) or f"{value:.4g}"

    def _name_of(self, value: float) -> str:
        return _NAMES.get(value, "") if self.value == "status" else ""


@dataclass(frozen=True)
class Verdict:
    """A rule at one moment.

    Args:
        rule: the rule.
        value: that it is about, None while it is unknown.
        lasting_s: time since when it has been violated; 0 while it holds.
    """

    rule: Rule
    value: float | None
    lasting_s: float = 0.0

    @property
    def holds(self) -> bool | None:
        """Return whether the condition holds, None while that is unknown."""
        return None if self.value is None else self.rule.holds(self.value)

    @property
    def is_violated(self) -> bool:
        """Return whether it has been violated for long enough."""
        return self.holds is False and self.lasting_s >= self.rule.seconds


@functools.lru_cache
def parse_rule(text: str) -> Rule:
    """Read a rule.

    Raises:
        ValueError: it is not a rule; a sentence.
    """
    match = _LINE.fullmatch(text.strip())
    if match is None:
        raise ValueError(f"`{text}` is not a rule. {FORM}")
    subject, value = _subject_and_value(text, match["about"])
    limit = match["limit"]
    if value and value not in VALUES:
        raise ValueError(f"`{text}`: unknown value {value}. Use {', '.join(VALUES)}.")
    if (subject == DOCTOR) != (value in OF_DOCTOR):
        raise ValueError(f"`{text}`: {' and '.join(OF_DOCTOR)} are values of doctor only.")
    if limit in LEVELS and value != "status":
        raise ValueError(f"`{text}`: {limit} fits status only; {value or subject} needs a number.")
    return Rule(
        text=text.strip(),
        subject=subject,
        value=value,
        comparison=match["comparison"],
        limit=LEVELS[limit] if limit in LEVELS else float(limit),
        seconds=float(match["count"]) * _UNITS[match["unit"]] if match["count"] else 0.0,
    )


def _subject_and_value(text: str, about: str) -> tuple[str, str]:
    """Split what a rule is about; a message path is a subject without a value."""
    named = _NAMED.fullmatch(about)
    is_topic = named is not None and _TOPIC.fullmatch(named["subject"]) and named["value"] in VALUES
    if about.startswith("/") and not is_topic:
        try:
            path = MessagePath(about)
        except PathError as error:
            raise ValueError(f"`{text}`: {error}") from error
        if not path.has_field:
            raise ValueError(f"`{text}` is not a rule. {FORM}")
        return about, ""
    if named is None:
        raise ValueError(f"`{text}` is not a rule. {FORM}")
    return named["subject"], named["value"]
