"""What the viewer does only because pages watch it."""

from __future__ import annotations

from collections.abc import Callable

from webviz.engine.commands import PROGRAM, Command, InspectTopics, Sender


class Wishes:
    """Follows which stores are watched: what nobody looks at any more ends by itself.

    Args:
        enqueue: takes commands, from any thread.
    """

    def __init__(self, enqueue: Callable[[Command, Sender], object]) -> None:
        self._enqueue = enqueue
        self._wished: set[Command] = {InspectTopics(frozenset())}

    def update(self, watched: set[str]) -> None:
        """Ask for what these stores need, if that is something else than before."""
        topics = frozenset(_arguments("message", watched))
        wished: set[Command] = {InspectTopics(topics)}
        for command in wished - self._wished:
            self._enqueue(command, PROGRAM)
        self._wished = wished


def _arguments(name: str, stores: set[str]) -> set[str]:
    """What stands behind the colon of the stores of a name."""
    return {store.partition(":")[2] for store in stores if store.startswith(f"{name}:")}
