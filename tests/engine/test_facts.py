"""Facts that parts let panels, programs and each other read, by name."""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from inspect import Parameter
from typing import Any, ClassVar, get_type_hints

import pytest
from bench import Bench, Benches

from webviz.api.panel import Panel
from webviz.api.registry import plugin_types
from webviz.engine.parts import Part, PartContext
from webviz.engine.parts.panels import PanelsPart, parameters_of
from webviz.engine.requests import LoopCalls
from webviz.engine.state import PanelTimes, State

Calls = list[tuple[Any, ...]]


class Batteries(Part):
    """Has two facts, of which the second is not asked for."""

    name = "Batteries"

    def state(self) -> Mapping[str, Any]:
        return {"charge": 0.5, "cells": 4}


class Unreadable(Part):
    """Has none that can be read."""

    name = "Unreadable"

    def state(self) -> Mapping[str, Any]:
        raise RuntimeError("no luck")


def show(b: Bench, panel: Panel) -> None:
    b.viewer.get(PanelsPart).show(panel)


def test_a_panel_gets_the_values_it_names_and_no_others(
    bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Charge(Panel):
        calls: ClassVar[Calls] = []

        def show(self, charge: float, clock: PanelTimes, bridges: Sequence[Any] = ()) -> None:
            self.calls.append((charge, clock.is_paused, bridges))

    b = bench(parts=[Batteries])
    monkeypatch.setattr(
        PartContext, "state", lambda context: pytest.fail("not all of it is asked for")
    )
    panel = Charge()
    show(b, panel)
    assert panel.calls == [(0.5, False, ())]


def test_a_panel_that_names_nothing_gets_nothing(bench: Benches) -> None:
    show(bench(), Panel())


def test_a_missing_value_is_the_default_of_the_panel_or_an_error(bench: Benches) -> None:
    class Lenient(Panel):
        calls: ClassVar[Calls] = []

        def show(self, frames: Sequence[str], wheels: int = 3) -> None:
            self.calls.append((frames, wheels))

    class Strict(Panel):
        def show(self, frames: Sequence[str], wheels: int) -> None:
            pytest.fail("show was called without wheels")

    b = bench()
    panel = Lenient()
    show(b, panel)
    assert panel.calls == [((), 3)]
    with pytest.raises(TypeError, match="`show` asks for wheels, which this viewer does not have"):
        show(b, Strict())


def test_a_panel_of_before_gets_the_whole_state(bench: Benches) -> None:
    class Old(Panel):
        calls: ClassVar[Calls] = []

        def show(self, state: State) -> None:
            self.calls.append((state.fixed_frame, state.charge))

    b = bench(parts=[Batteries])
    panel = Old()
    show(b, panel)
    assert panel.calls == [("map", 0.5)]


def test_a_part_that_fails_has_no_facts_and_harms_no_others(bench: Benches) -> None:
    b = bench(parts=[Unreadable, Batteries], strict=False)
    assert b.viewer.fact("cells") == 4
    assert b.viewer.fact("wheels", 3) == 3
    state = b.viewer.state()
    assert (state.cells, state.fixed_frame) == (4, "map")
    assert "no luck" in b.viewer.state().statuses["Unreadable"].text


def test_calls_of_other_threads_wait_for_the_end_of_a_turn() -> None:
    woken = threading.Event()
    calls = LoopCalls(woken.set)
    assert calls.put(lambda: 1).result(0) == 1, "there is no frame loop"
    calls.begin()
    assert calls.put(lambda: 2).result(0) == 2, "within a turn nothing else happens"
    results: list[Any] = []
    thread = threading.Thread(target=lambda: results.append(calls.put(lambda: 1 / 0)))
    thread.start()
    thread.join()
    assert woken.is_set()
    assert not results[0].done()
    calls.answer()
    assert isinstance(results[0].exception(0), ZeroDivisionError)
    thread = threading.Thread(target=lambda: results.append(calls.put(lambda: 3)))
    thread.start()
    thread.join()
    calls.end()
    assert results[1].result(0) == 3


@pytest.mark.parametrize("panel", plugin_types(Panel).values(), ids=lambda panel: panel.__name__)
def test_built_in_panels_name_values_of_every_viewer(panel: type[Panel]) -> None:
    required = {
        name for name, default in parameters_of(panel.show).items() if default is Parameter.empty
    }
    assert required <= {*State.__struct_fields__}
    types, state_types = get_type_hints(panel.show), get_type_hints(State)
    wrong = [n for n in required if types[n] != state_types[n] and n not in LOOSER]
    assert not wrong


LOOSER = ("topics", "panels", "rows")
"""Tuples, which panels read as sequences."""
