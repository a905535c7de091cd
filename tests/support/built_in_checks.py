"""The checks of displays that are built in, each a class in the display's own test file."""

from __future__ import annotations

import importlib.util
import random
import sys
from collections.abc import Callable, Iterator, Sequence
from functools import reduce
from itertools import islice
from pathlib import Path
from typing import Any, ClassVar

import pytest
from display_messages import MESSAGES

from webviz import Display
from webviz.api.display import inputs_of
from webviz.shell.testing import DisplayBench, DisplayChecks
from webviz.shell.testing.display_checks import (
    PATIENCE_S,
    Benches,
    Case,
    cases,
    changed,
    faults,
    send,
)

HANDS = 128
"""Messages with several extreme values, for each input of a display."""
MOST = 5
"""Extreme values in one of them."""
IN_A_ROW = 3
"""Messages that the same display receives."""
FOLDER = Path(__file__).parents[1] / "displays"


class BuiltInChecks(DisplayChecks):
    """Tries several extreme values at once, too."""

    messages = MESSAGES
    scene: ClassVar[Callable[[Any], None] | None] = None
    """Publishes on a bench what shows every property; None publishes `messages`."""

    def publish(self, bench: DisplayBench) -> None:
        if (scene := type(self).scene) is None:
            super().publish(bench)
        else:
            scene(bench)

    def test_several_extreme_values_at_once_are_drawn_or_reported(
        self,
        webviz_bench: Benches,
        make_display: Callable[[], Display],
        name: str,
        monkeypatch: pytest.MonkeyPatch,
    ) -> None:
        """Messages with several of them follow each other."""
        monkeypatch.setattr(PATIENCE_S, -1.0)
        type_name = inputs_of(type(make_display()))[name].type
        all_cases = list(cases(type_name, self.messages[type_name]))
        results = []
        hands = dealt(all_cases)
        while row := list(islice(hands, IN_A_ROW)):
            bench = self.at_work(webviz_bench, make_display, name)
            for hand in row:
                send(bench, name, reduce(changed, hand, self.messages[type_name]))
                bench.now_ns += 10**8
                results += [f"{hand!r:.200}: {fault}" for fault in faults(bench)]
        assert results == []


def dealt(all_cases: Sequence[Case]) -> Iterator[Sequence[Case]]:
    """Deal values like cards, so that each comes before one comes again."""
    draw = random.Random(0)
    pack: list[Case] = []
    for _ in range(HANDS):
        size = draw.randint(1, MOST)
        if len(pack) < size:
            pack += draw.sample(all_cases, len(all_cases))
        yield [pack.pop() for _ in range(size)]


def built_in_checks() -> dict[str, BuiltInChecks]:
    """The checks of each display, by its name."""
    result: dict[str, BuiltInChecks] = {}
    for path in sorted(FOLDER.glob("test_*.py")):
        for value in vars(_module(path)).values():
            if isinstance(value, type) and value in BuiltInChecks.__subclasses__():
                result[value.display.__name__] = value()
    return result


def _module(path: Path) -> Any:
    """A test file, as pytest has imported it if it has."""
    name = f"tests.displays.{path.stem}"
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, path)
        assert spec is not None
        assert spec.loader is not None
        sys.modules[name] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[name])
    return sys.modules[name]
