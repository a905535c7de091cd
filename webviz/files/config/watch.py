"""Rules that save what is remembered, and their bounds."""

from __future__ import annotations

import re
from typing import Annotated, Literal

import msgspec

from webviz.api.declared import Prop
from webviz.api.rule import COMPARISONS, Rule, parse_rule
from webviz.data.messages.message_paths import MessagePath
from webviz.data.messages.paths import PathError

FORMS = (
    "Write {rule: Scan.walls > 0.8}, {display: NAME, status: error}, {topic: /diagnostics, level: "
    'error}, {topic: /scan, rate: "<5"} or {path: /battery_state.percentage, value: "<0.2"}.'
)
_NAME = "[A-Za-z_][A-Za-z0-9_]*"
RATE = re.compile(r"[<>] ?\d+(\.\d+)?")
VALUE = re.compile(r"(?P<comparison>[<>]=?|[=!]=) ?(?P<limit>-?\d+(\.\d+)?([eE][+-]?\d+)?)")
DURATION = re.compile(r"\d+(\.\d+)? ?(ms|s|min)")
_SECONDS = {"ms": 0.001, "s": 1.0, "min": 60.0}


class WatchRule(
    msgspec.Struct,
    frozen=True,
    forbid_unknown_fields=True,
    omit_defaults=True,
    rename={"lasting": "for"},
):
    """A condition; when it holds, the last minute and the next seconds are saved.

    A `rule` is one that must hold, so that a violation is saved.
    """

    rule: Annotated[
        str,
        msgspec.Meta(max_length=300),
        Prop(help="Condition that must hold, such as Scan.walls > 0.8; see `webviz test`."),
    ] = ""
    display: Annotated[
        str, msgspec.Meta(max_length=256), Prop(help="Name of the display whose status is watched.")
    ] = ""
    status: Annotated[
        Literal["warn", "error"] | None, Prop(help="Status of the display, this or worse.")
    ] = None
    topic: Annotated[
        str,
        msgspec.Meta(max_length=256, pattern=f"^((~?/)?{_NAME}(/{_NAME})*)?$"),
        Prop(help="Topic that is watched."),
    ] = ""
    level: Annotated[
        Literal["warn", "error"] | None,
        Prop(help="Level of diagnostic_msgs/DiagnosticArray or rcl_interfaces/Log, this or worse."),
    ] = None
    rate: Annotated[
        str, msgspec.Meta(max_length=20), Prop(help='Messages per second, such as "<5".')
    ] = ""
    path: Annotated[
        str,
        msgspec.Meta(max_length=300),
        Prop(help="Message path of a number that is watched, such as /battery_state.percentage."),
    ] = ""
    value: Annotated[
        str, msgspec.Meta(max_length=30), Prop(help='Condition for that number, such as "<0.2".')
    ] = ""
    lasting: Annotated[
        str,
        msgspec.Meta(max_length=20),
        Prop(help="How long the condition has to hold, such as 2s."),
    ] = ""
    name: Annotated[
        str, msgspec.Meta(max_length=60), Prop(help="Name of its recordings; automatic if empty.")
    ] = ""

    def __post_init__(self) -> None:
        """Raise ValueError for keys that do not go together."""
        of_display = bool(self.display), self.status is not None
        of_topic = self.level is not None, bool(self.rate)
        is_display = all(of_display) and not self.topic and not any(of_topic)
        is_topic = bool(self.topic) and sum(of_topic) == 1 and not any(of_display)
        is_path = bool(self.path) and bool(self.value)
        if bool(self.path) != bool(self.value) or (
            is_path and (self.topic or any(of_topic) or any(of_display) or self.rule)
        ):
            raise ValueError(f"a rule is one condition. {FORMS}")
        is_rule = bool(self.rule) and not (self.display or self.topic or self.lasting)
        if self.rule and is_rule:
            parse_rule(self.rule)
            is_rule = self.status is None and not any(of_topic)
        if is_display + is_topic + is_rule + is_path != 1 or (self.rule and not is_rule):
            raise ValueError(f"a rule is one condition. {FORMS}")
        if self.rate and not RATE.fullmatch(self.rate):
            raise ValueError(
                f'rate `{self.rate}` is not a condition. Write it like "<5" or ">100".'
            )
        if is_path:
            self._check_path()
        if self.lasting and not DURATION.fullmatch(self.lasting):
            raise ValueError(f"for `{self.lasting}` is not a duration. Write it like 2s or 500ms.")

    def _check_path(self) -> None:
        if not VALUE.fullmatch(self.value):
            raise ValueError(
                f'value `{self.value}` is not a condition. Write it like "<0.2" or "==3".'
            )
        try:
            path = MessagePath(self.path)
        except PathError as error:
            raise ValueError(f"path: {error}") from error
        if not path.has_field:
            raise ValueError(f"path `{self.path}` has no field. Add one, such as .data.")

    @property
    def watched_topic(self) -> str:
        """The topic that is read, "" for none."""
        return MessagePath(self.path).topic if self.path else self.topic

    def holds_for(self, number: float) -> bool:
        """Return whether the condition `value` holds for a number."""
        match = VALUE.fullmatch(self.value)
        return match is not None and COMPARISONS[match["comparison"]](number, float(match["limit"]))

    @property
    def condition(self) -> Rule | None:
        """The condition of a `rule`, None of other forms."""
        return parse_rule(self.rule) if self.rule else None

    @property
    def seconds(self) -> float:
        """Time that the condition has to hold, or to be violated."""
        if self.condition:
            return self.condition.seconds
        unit = self.lasting.lstrip("0123456789. ")
        return float(self.lasting.removesuffix(unit)) * _SECONDS[unit] if unit else 0.0

    @property
    def rate_limit(self) -> tuple[str, float] | None:
        """The comparison, "<" or ">", and messages per second."""
        return (self.rate[0], float(self.rate[1:])) if self.rate else None

    @property
    def title(self) -> str:
        """Its name, or what it is about."""
        if self.path:
            return self.name or f"{self.path} {self.value}"
        about = self.status or self.level or f"rate {self.rate}"
        return self.name or self.rule or f"{self.display or self.topic} {about}"


class WatchLimits(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Bounds of what rules save; beyond them, nothing is saved."""

    per_day: Annotated[int, Prop(ge=0, le=1000, help="Recordings per day.")] = 20
    gigabytes: Annotated[
        float, Prop(ge=0, le=100_000, unit="GB", help="Total size of the recordings in the folder.")
    ] = 5.0
