"""Rules over statuses and topics: when they hold, and what they save."""

from collections.abc import Sequence

import msgspec

from webviz.api.status import Level
from webviz.features.black_box.observation import WatchedMoment
from webviz.files.config import WatchRule

REARM_S = 30.0
"""Time that a condition has to be clear before its rule can fire again, so that one that flaps does
not fill the disk."""


class RuleWatcher:
    """Follows rules.

    Args:
        rules: of a config.
    """

    def __init__(self, rules: Sequence[WatchRule]) -> None:
        self.rules = tuple(rules)
        self._states = [_State() for _ in self.rules]

    def fired(self, now: WatchedMoment) -> list[WatchRule]:
        """Return the rules that fire at a moment, which must not be before the last one."""
        return [
            rule
            for rule, state in zip(self.rules, self._states, strict=True)
            if state.fires(holds(rule, now), rule.seconds, now.at_s)
        ]


def holds(rule: WatchRule, now: WatchedMoment) -> bool | None:
    """Return whether the condition of a rule holds; None while that is unknown."""
    if condition := rule.condition:
        is_kept = now.conditions.get(condition.text)
        return None if is_kept is None else not is_kept
    if rule.path:
        numbers = now.numbers.get(rule.path)
        return None if numbers is None else any(map(rule.holds_for, numbers))
    if rule.display:
        level, least = now.displays.get(rule.display), rule.status
    elif rule.rate_limit is not None:
        comparison, limit = rule.rate_limit
        rate = now.rates.get(rule.topic)
        return None if rate is None else (rate < limit if comparison == "<" else rate > limit)
    else:
        level, least = now.levels.get(rule.topic), rule.level
    return None if level is None else level >= (Level.ERROR if least == "error" else Level.WARN)


class _State(msgspec.Struct):
    """One rule; times are monotonic, in seconds."""

    since_s: float | None = None
    clear_s: float | None = None
    is_armed: bool = True

    def fires(self, is_true: bool | None, seconds: float, now_s: float) -> bool:
        """Take the condition at a moment; whether the rule fires."""
        if is_true:
            self.clear_s = None
            self.since_s = now_s if self.since_s is None else self.since_s
            if self.is_armed and now_s - self.since_s >= seconds:
                self.is_armed = False
                return True
            return False
        self.since_s = None
        if is_true is False:
            self.clear_s = now_s if self.clear_s is None else self.clear_s
            self.is_armed = self.is_armed or now_s - self.clear_s >= REARM_S
        return False
