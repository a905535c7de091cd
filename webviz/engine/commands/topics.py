"""What is about topics."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class InspectTopic(Command):
    """Follow a topic that need not be shown: its rate and its last message; "" is none."""

    topic: str
