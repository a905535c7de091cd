"""Subscriptions that exist only because pages watch them."""

from __future__ import annotations

from collections.abc import Callable

from webviz.commands import InspectSelections, OpenPanels
from webviz.engine.commands import PROGRAM, Command, Sender


class DerivedSubscriptions:
    """Follows which stores are watched: work for stores that no page watches ends automatically.

    Args:
        enqueue: takes commands, from any thread.
    """

    def __init__(self, enqueue: Callable[[Command, Sender], object]) -> None:
        self._enqueue = enqueue
        self._wished = _derived(set())

    def update(self, watched: set[str]) -> None:
        """Ask for what these stores need, if that is something else than before."""
        wished = _derived(watched)
        for command in wished - self._wished:
            self._enqueue(command, PROGRAM)
        self._wished = wished


def _derived(stores: set[str]) -> set[Command]:
    """Return the commands that these stores need."""
    return {
        InspectSelections(
            _browsers("selected", stores), _browsers("selection", stores), "picking" in stores
        ),
        OpenPanels(frozenset(_arguments("panel", stores))),
    }


def _arguments(name: str, stores: set[str]) -> set[str]:
    """Return the arguments after the colon of the stores of a name."""
    return {store.partition(":")[2] for store in stores if store.startswith(f"{name}:")}


def _browsers(name: str, stores: set[str]) -> frozenset[int]:
    return frozenset(int(each) for each in _arguments(name, stores) if each.isdecimal())
