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
from webviz.engine.parts import Core, Part
from webviz.engine.parts.panels import PanelsPart, parameters_of
from webviz.engine.requests import LoopCalls
from webviz.engine.state import PanelTimes, State

Shown = list[tuple[Any, ...]]


class Batteries(Part):
    """Has two facts, of which nobody asks for the second."""

    name = "Batteries"

    def state(self) -> Mapping[str, Any]:
        return {"charge": 0.5, "cells": 4}


class Broken(Part):
    """Has none that can be read."""

    name = "Broken"

    def state(self) -> Mapping[str, Any]:
        raise RuntimeError("no luck")


def show(b: Bench, panel: Panel) -> None:
    b.viewer.get(PanelsPart).show(panel)


def test_a_panel_gets_what_it_names_and_nothing_else(
    bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Charge(Panel):
        shown: ClassVar[Shown] = []

        def show(self, charge: float, clock: PanelTimes, bridges: Sequence[Any] = ()) -> None:
            self.shown.append((charge, clock.is_paused, bridges))

    b = bench(parts=[Batteries])
    monkeypatch.setattr(Core, "state", lambda core: pytest.fail("nobody asks for all of it"))
    panel = Charge()
    show(b, panel)
    assert panel.shown == [(0.5, False, ())]


def test_a_panel_that_names_nothing_gets_nothing(bench: Benches) -> None:
    show(bench(), Panel())


def test_what_no_part_has_is_what_the_panel_says_or_an_error(bench: Benches) -> None:
    class Lenient(Panel):
        shown: ClassVar[Shown] = []

        def show(self, frames: Sequence[str], wheels: int = 3) -> None:
            self.shown.append((frames, wheels))

    class Strict(Panel):
        def show(self, frames: Sequence[str], wheels: int) -> None:
            pytest.fail("show was called without wheels")

    b = bench()
    panel = Lenient()
    show(b, panel)
    assert panel.shown == [((), 3)]
    with pytest.raises(TypeError, match="`show` asks for wheels, which this viewer does not have"):
        show(b, Strict())


def test_a_panel_of_before_gets_the_whole_state(bench: Benches) -> None:
    class Old(Panel):
        shown: ClassVar[Shown] = []

        def show(self, state: State) -> None:
            self.shown.append((state.fixed_frame, state.charge))

    b = bench(parts=[Batteries])
    panel = Old()
    show(b, panel)
    assert panel.shown == [("map", 0.5)]


def test_a_part_that_fails_has_no_facts_and_harms_no_others(bench: Benches) -> None:
    b = bench(parts=[Broken, Batteries], strict=False)
    assert b.viewer.fact("cells") == 4
    assert b.viewer.fact("wheels", 3) == 3
    state = b.viewer.state()
    assert (state.cells, state.fixed_frame) == (4, "map")
    assert "no luck" in b.viewer.state().statuses["Broken"].text


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
def test_the_panels_of_webviz_name_what_every_viewer_has(panel: type[Panel]) -> None:
    required = {
        name for name, default in parameters_of(panel.show).items() if default is Parameter.empty
    }
    assert required <= {*State.__struct_fields__}
    types, known = get_type_hints(panel.show), get_type_hints(State)
    wrong = [n for n in required if types[n] != known[n] and n not in LOOSER]
    assert not wrong


LOOSER = ("topics", "panels", "rows")
"""Tuples, which panels read as sequences."""
