"""Values that rules are about, and whether the rules hold."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from webviz.api.finding import Severity
from webviz.api.observation import DisplaySeen, InputSeen, Observation
from webviz.api.rule import DOCTOR, Rule, Verdict
from webviz.api.status import worst

NS_PER_S = 1e9


class Judge:
    """Judges rules; a violation lasts from the first moment at which it was seen."""

    def __init__(self) -> None:
        self._since: dict[str, int] = {}

    def judge(self, rules: Iterable[Rule], seen: Observation) -> Sequence[Verdict]:
        """Judge rules at the moment of an observation, which must not be before the last one."""
        before, self._since = self._since, {}
        verdicts: list[Verdict] = []
        for rule in rules:
            value = value_of(rule, seen)
            lasting_s = 0.0
            if value is not None and not rule.holds(value):
                since = before.get(rule.text, seen.now_ns)
                since = since if since <= seen.now_ns else seen.now_ns  # time jumped back
                self._since[rule.text] = since
                lasting_s = (seen.now_ns - since) / NS_PER_S
            verdicts.append(Verdict(rule, value, lasting_s))
        return verdicts


def value_of(rule: Rule, seen: Observation) -> float | None:
    """Return the value that a rule is about, None while it is unknown."""
    if rule.path:
        return _of_path(rule, seen.numbers.get(rule.path, ()))
    if rule.subject == DOCTOR:
        least = Severity.ERROR if rule.value == "errors" else Severity.WARNING
        return float(sum(finding.severity >= least for finding in seen.findings))
    for display in seen.displays:
        for each in display.inputs:
            if rule.subject == each.topic:
                return _of_input(rule.value, display, each, seen)
    display = next((each for each in seen.displays if each.display.name == rule.subject), None)
    return _of_display(rule.value, display, seen) if display else None


def _of_path(rule: Rule, numbers: Sequence[float]) -> float | None:
    """Return the first number that violates a rule, else the newest.

    With a duration the newest counts, since the violation must last.
    """
    if not numbers:
        return None
    violating = () if rule.seconds else (each for each in numbers if not rule.holds(each))
    return next(iter(violating), numbers[-1])


def _of_display(value: str, display: DisplaySeen, seen: Observation) -> float | None:
    if value == "status":
        return float(max(0, worst(display.statuses.values())))
    if value == "walls":
        return display.fit.fit.share if display.fit else None
    if value == "blocked":
        return float(display.blocked)
    return next((_of_input(value, display, each, seen) for each in display.inputs), None)


def _of_input(value: str, display: DisplaySeen, each: InputSeen, seen: Observation) -> float | None:
    stamp_ns, received_ns = each.stamps[-1] if each.stamps else (0, 0)
    if value == "status":
        status = display.statuses.get(each.status)
        return float(max(0, status.level)) if status else None
    if value == "rate" and each.rate_hz:
        waited_s = (seen.now_ns - received_ns) / NS_PER_S if received_ns else 0.0
        return min(each.rate_hz, 1.0 / max(waited_s, 1.0 / each.rate_hz))
    if value not in ("age", "delay") or not stamp_ns:
        return None
    return ((seen.now_ns if value == "age" else received_ns) - stamp_ns) / NS_PER_S
