"""Commands that try a static frame in another pose; nothing is published."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class TryFrame(Command):
    """Take hold of a static frame; another one that is tried returns to its place."""

    frame: str


@dataclass(frozen=True)
class FindFrame(Command):
    """Move the tried frame to where its laser scan fits the map best."""


@dataclass(frozen=True)
class EndTrial(Command):
    """Return the tried frame to where its transforms have it."""
