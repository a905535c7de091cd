"""Commands that try a static frame in another pose; nothing is published."""

from __future__ import annotations

from webviz.engine.commands.command import Command


class TryFrame(Command, frozen=True):
    """Take hold of a static frame; another one that is tried returns to its place."""

    frame: str


class FindFrame(Command, frozen=True):
    """Move the tried frame to where its laser scan fits the map best."""


class EndTrial(Command, frozen=True):
    """Return the tried frame to where its transforms have it."""
