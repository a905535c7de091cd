"""Definitions of message types that bridges send."""

from __future__ import annotations

import contextlib
from typing import NamedTuple

from webviz.data.messages import (
    KNOWN,
    DefinitionError,
    MessageError,
    MessageTypes,
    defined,
    interfaces,
    prepare,
    type_exists,
)
from webviz.data.messages.distributions import OtherLayout

MAX_SERVICE_TEXT = 8 << 20
"""Characters of the definitions of services that are read, a second for each million; those of
large robots have a tenth of it."""


UNDEFINED = (
    "the bridge does not send the definition of {type}. Source the workspace that has its package "
    "before starting the bridge"
)


class TopicTypes(NamedTuple):
    """The types by which a topic is read.

    Attributes:
        type: of its messages.
        text: the definition of the type.
        types: of that definition, or those of this process.
        layout: of its messages, if that of `types` has more or fewer fields.
        problem: why its messages cannot be read, "" if they can.
    """

    type: str = ""
    text: str = ""
    types: MessageTypes = KNOWN
    layout: OtherLayout | None = None
    problem: str = ""


class Definitions:
    """The types of the topics of a bridge, and those of its services.

    Each topic is read by its own definition alone, whatever others have the names of its types.

    Args:
        undefined: why a topic without definition cannot be read, with {type}.
    """

    def __init__(self, undefined: str = UNDEFINED) -> None:
        self._undefined = undefined
        self._topics: dict[str, TopicTypes] = {}
        self._services = set[str]()
        self._service_text = 0

    def learn(self, topic: str, type: str, text: str) -> str:
        """Read a topic by a definition.

        Args:
            topic: its name.
            type: of its messages, such as "nav_msgs/msg/Path".
            text: the definition of the type, see `webviz.data.messages.register`; "" if the bridge
                has none.

        Returns:
            Why its messages cannot be read, "" if they can.
        """
        topic_types = self._topics.get(topic, TopicTypes())
        if not text or topic_types[:2] != (type, text):
            topic_types = self._topics[topic] = _types(type, text, self._undefined)
        return topic_types.problem

    def learn_service(self, type: str, request: str, response: str) -> None:
        """Register a service type, unless it is known; what is invalid stays unknown.

        So does what is above `MAX_SERVICE_TEXT`.

        Args:
            type: its name, such as "my_robot_msgs/srv/SetMode".
            request, response: definitions, see `webviz.data.messages.register`; "" if it is empty.
        """
        size = len(request) + len(response)
        if type in self._services or self._service_text + size > MAX_SERVICE_TEXT:
            return
        self._services.add(type)
        self._service_text += size
        with contextlib.suppress(MessageError):
            interfaces.learn(type, request, response)

    def read(self, topic: str, cdr: bytes) -> tuple[bytes, MessageTypes]:
        """Return a message of a topic, and the types by which it is read.

        One that does not fit its definition stays as it is.
        """
        topic_types = self._topics.get(topic, TopicTypes())
        if topic_types.layout is not None:
            with contextlib.suppress(MessageError):
                cdr = topic_types.layout.to_cdr(cdr)
        return cdr, topic_types.types

    def problem(self, topic: str) -> str:
        """Return why messages of a topic cannot be read, "" if they can or it is not read."""
        return self._topics.get(topic, TopicTypes()).problem

    def forget(self, topic: str) -> None:
        """Forget a topic that is not read any more."""
        self._topics.pop(topic, None)


def _types(type: str, text: str, undefined: str) -> TopicTypes:
    if not text:
        missing = "" if type_exists(type) else undefined.format(type=type)
        return TopicTypes(type, text, problem=missing)
    try:
        types = defined(type, text)
        try:
            prepare(type, types)
        except DefinitionError:  # of another distribution, if its types have fewer fields
            if not type_exists(type):
                raise
            return TopicTypes(type, text, layout=OtherLayout(type, text))
    except MessageError as error:
        return TopicTypes(type, text, problem=str(error).rstrip("."))
    return TopicTypes(type, text, types)
