"""Results of rules over an examination: for people, and as JUnit XML."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from xml.etree import ElementTree

import msgspec

from webviz.api.rule import Rule, Verdict
from webviz.data.names import readable
from webviz.files.config import WatchRule


class RuleResult(msgspec.Struct):
    """A rule over an examination.

    Args:
        rule: the rule.
        lowest, highest: values that were seen; None without one.
        violated: the first verdict that counts as a violation; None without one.
        at_s: when that was, in seconds since the start.
    """

    rule: Rule
    lowest: float | None = None
    highest: float | None = None
    violated: Verdict | None = None
    at_s: float = 0.0

    def note(self, verdict: Verdict, at_s: float) -> None:
        """Take a verdict."""
        value = verdict.value
        if value is None:
            return
        self.lowest = value if self.lowest is None else min(self.lowest, value)
        self.highest = value if self.highest is None else max(self.highest, value)
        if verdict.is_violated and self.violated is None:
            self.violated, self.at_s = verdict, at_s

    @property
    def problem(self) -> str:
        """The reason why the rule failed, a sentence; "" if it held."""
        name = self.rule.about
        if self.violated is not None and self.violated.value is not None:
            value = self.rule.text_of(self.violated.value)
            return f"{name} is {value} at {self.at_s:.1f} s, expected {self.rule.expectation}."
        if self.lowest is None:
            return (
                f"{name} never had a value. Check the name, that it is a number, and that its "
                "topic has messages."
            )
        return ""

    @property
    def extent(self) -> str:
        """The values that were seen, such as "0.93 to 1"."""
        if self.lowest is None or self.highest is None:
            return "no value"
        ends = dict.fromkeys(map(self.rule.text_of, (self.lowest, self.highest)))
        return " to ".join(ends)


class RuleResults:
    """The results of several rules.

    Args:
        name: of what is examined.
        rules: of a config or the command line.
    """

    def __init__(self, name: str, rules: Iterable[WatchRule]) -> None:
        self.name = name
        conditions = [rule.condition for rule in rules]
        self.all = {rule.text: RuleResult(rule) for rule in conditions if rule}

    @property
    def rules(self) -> Sequence[Rule]:
        """The rules."""
        return [each.rule for each in self.all.values()]

    @property
    def failed(self) -> Sequence[RuleResult]:
        """The rules that did not hold."""
        return [each for each in self.all.values() if each.problem]

    def note(self, verdicts: Iterable[Verdict], at_s: float) -> None:
        """Take the verdicts of a moment, in seconds since the start."""
        for verdict in verdicts:
            self.all[verdict.rule.text].note(verdict, at_s)

    def to_text(self) -> str:
        """Return the results for a person."""
        lines = [
            f"FAILED {readable(each.rule.text)}\n       {readable(each.problem)}"
            if each.problem
            else f"ok     {readable(each.rule.text)} ({each.extent})"
            for each in self.all.values()
        ]
        passed = len(self.all) - len(self.failed)
        hold = "rule holds" if passed == len(self.all) == 1 else "rules hold"
        return "\n".join([*lines, f"{passed} of {len(self.all)} {hold}."])

    def to_junit(self) -> str:
        """Return the results as JUnit XML: a test case for each rule."""
        counts = {"tests": str(len(self.all)), "failures": str(len(self.failed))}
        root = ElementTree.Element("testsuites", counts)
        suite = ElementTree.SubElement(root, "testsuite", {"name": "webviz test", **counts})
        for each in self.all.values():
            attributes = {"classname": readable(self.name), "name": readable(each.rule.text)}
            case = ElementTree.SubElement(suite, "testcase", attributes)
            if each.problem:
                ElementTree.SubElement(case, "failure", {"message": readable(each.problem)})
        ElementTree.indent(root)
        return ElementTree.tostring(root, encoding="unicode", xml_declaration=True) + "\n"
