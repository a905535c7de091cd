"""Commands for what is sent to other nodes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from webviz.api.status import Status
from webviz.engine.commands.command import Command, ignore


class Publish(Command, frozen=True):
    """Publish a message.

    Args:
        topic: its name; remapped.
        type: such as "std_msgs/msg/String".
        values: of the message by field; missing fields have their defaults.
        report: called with the result from any thread; must not block.
        latched: whether subscriptions that come later get the message, too (transient local).
    """

    topic: str
    type: str
    values: Mapping[str, Any]
    report: Callable[[Status], None] = ignore
    latched: bool = False


class CallService(Command, frozen=True):
    """Call a service.

    Args:
        service: its name; remapped like a topic.
        type: such as "std_srvs/srv/Trigger".
        request: values by field; missing fields have their defaults.
        definition: text of the .srv file, for types unknown to webviz.
        answered: called with the response from another thread; must not block.
        failed: called with a sentence in the same way if there is none.
        timeout_s: for service and response to appear.
    """

    service: str
    type: str
    request: Mapping[str, Any]
    definition: str = ""
    answered: Callable[[Any], object] = ignore
    failed: Callable[[str], object] = ignore
    timeout_s: float = 5.0
