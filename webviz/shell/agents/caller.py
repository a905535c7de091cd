"""Callers of the tools of agents, and what they may do."""

from __future__ import annotations

import time

import msgspec

from webviz.api.roles import Role
from webviz.engine.commands import Command, Sender
from webviz.server.access import rules
from webviz.server.access.visitors import Visitor

BROWSER = -1
"""Stands for the browser of an agent, which has none: files are those that pages may open."""


class AgentCaller(msgspec.Struct, frozen=True):
    """An agent.

    Args:
        name: of its token.
        role: what it may do.
        address: where it calls from.
    """

    name: str
    role: Role
    address: str = "stdio"

    def visitor(self) -> Visitor:
        """Return the caller as the journal knows people."""
        return Visitor(self.name, self.role, self.address, time.time())

    def sender(self) -> Sender:
        """Return the caller as commands know it: like a page, and unlike a program."""
        return Sender(BROWSER, priority=self.role)

    def refusal(self, command: type[Command]) -> str:
        """Return why a command is not its to give, by the rules of pages; "" if it is."""
        needed = rules.commands()[command]
        if self.role >= needed:
            return ""
        return (
            f"{command.__name__} needs {needed.phrase}, but this connection is that of "
            f"{self.role.phrase}. Start `webviz mcp` with --role {needed.label}, or use that token."
        )
