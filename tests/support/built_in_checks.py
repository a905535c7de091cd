"""The checks of displays that are built in, each a class in the display's own test file."""

from __future__ import annotations

import copy
import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

import pytest
from display_messages import MESSAGES
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from webviz import Display
from webviz.api.display import inputs_of
from webviz.shell.testing import DisplayChecks
from webviz.shell.testing.display_checks import PATIENCE_S, Benches
from webviz.shell.testing.extremes import cases, change, faults, send

SHARED = (HealthCheck.function_scoped_fixture, HealthCheck.differing_executors)
"""All checks of a display take the same bench, and all displays the same checks."""
FOLDER = Path(__file__).parents[1] / "displays"


class BuiltInChecks(DisplayChecks):
    """Tries several extreme values at once, too."""

    messages = MESSAGES
    scene: ClassVar[Callable[[Any], None] | None] = None
    """Publishes on a bench what shows every property; None publishes `messages`."""

    def publish(self, bench: Any) -> None:
        if (scene := type(self).scene) is None:
            super().publish(bench)
        else:
            scene(bench)

    @settings(max_examples=60, deadline=None, suppress_health_check=SHARED)
    @given(data=st.data())
    def test_several_extreme_values_at_once_are_no_worse(
        self,
        webviz_bench: Benches,
        made: Callable[[], Display],
        name: str,
        monkeypatch: pytest.MonkeyPatch,
        data: st.DataObject,
    ) -> None:
        monkeypatch.setattr(PATIENCE_S, -1.0)
        bench = self.at_work(webviz_bench, made, name)
        type_name = inputs_of(type(bench.display))[name].type
        known = list(cases(type_name, self.messages[type_name]))
        for _ in range(data.draw(st.integers(1, 3))):
            values = copy.deepcopy(self.messages[type_name])
            for index in data.draw(st.lists(st.integers(0, len(known) - 1), max_size=5)):
                change(values, known[index])
            send(bench, name, values)
            bench.now_ns += 10**8
            assert faults(bench) == []


def built_in_checks() -> dict[str, BuiltInChecks]:
    """The checks of each display, by its name."""
    found: dict[str, BuiltInChecks] = {}
    for path in sorted(FOLDER.glob("test_*.py")):
        for value in vars(_module(path)).values():
            if isinstance(value, type) and value in BuiltInChecks.__subclasses__():
                found[value.display.__name__] = value()
    return found


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
