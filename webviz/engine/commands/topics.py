"""Commands for topics."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class InspectTopic(Command):
    """Show the rate and the last message of a topic, displayed or not; "" is none."""

    topic: str
