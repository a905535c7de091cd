"""Definitions of message types that bridges send."""

from __future__ import annotations

import contextlib

from webviz.data.messages import MessageError, interfaces, prepare, register, type_exists

MAX_SERVICE_TEXT = 8 << 20
"""Characters of the definitions of services that are read, a second for each million; those of
large robots have a tenth of it."""


class Definitions:
    """The types that were learned from a bridge; each definition is read once."""

    def __init__(self) -> None:
        self._learned: dict[str, tuple[str, str]] = {}
        self._services = set[str]()
        self._service_text = 0

    def learn(self, type: str, text: str) -> str:
        """Register a type.

        Args:
            type: its name, such as "nav_msgs/msg/Path".
            text: its definition, see `webviz.data.messages.register`; "" if the bridge has none.

        Returns:
            Why its messages cannot be read, "" if they can.
        """
        known, problem = self._learned.get(type, ("", ""))
        if text and known == text:
            return problem
        problem = self._problem(type, text)
        self._learned[type] = text, problem
        return problem

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

    def problem(self, type: str) -> str:
        """Why messages of a type that was learned cannot be read, "" if they can."""
        return self._learned.get(type, ("", ""))[1]

    def _problem(self, type: str, text: str) -> str:
        if not text:
            if type_exists(type):
                return ""
            return (
                f"the bridge does not send the definition of {type}. Source the workspace that "
                "has its package before starting the bridge"
            )
        try:
            register(type, text)
            prepare(type)
        except MessageError as error:
            return str(error).rstrip(".")
        return ""
