"""Services and actions as the messages they consist of.

A service is a request and a response; an action is three services and two messages (REP 2016,
https://design.ros2.org/articles/actions.html). Each part is a type of its own with a definition,
named as rosidl names it: `std_srvs/srv/SetBool_Request`, `nav2_msgs/action/Spin_SendGoal_Request`.
Once declared, the parts are encoded and decoded like any message.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from typing import Any, NamedTuple

from rosbags.interfaces import Nodetype

from webviz.data.messages import definitions, typestore
from webviz.data.messages.decode import decode
from webviz.data.messages.errors import DefinitionError, UnknownTypeError

_SEPARATOR = re.compile(r"^---\s*$", re.MULTILINE)


class Service(NamedTuple):
    """Type names of what a service exchanges."""

    request: str
    response: str


class Action(NamedTuple):
    """Type names of what an action exchanges."""

    send_goal: str
    """A service: `goal_id` and `goal`, answered by `accepted` and `stamp`."""
    get_result: str
    """A service: `goal_id`, answered by `status` and `result`."""
    feedback: str
    """A message: `goal_id` and `feedback`."""
    goal: str


class _KnownTypes:
    """The names of all types that are known."""

    def __contains__(self, name: str) -> bool:
        if not typestore.type_exists(name):
            typestore.find(name)
        return typestore.type_exists(name)


def service(type_name: str, text: str = "") -> Service:
    """Return the parts of a service type; declares them when first used.

    Args:
        type_name: such as "std_srvs/srv/SetBool".
        text: the .srv definition, for types unknown to webviz.

    Raises:
        UnknownTypeError: no definition is known.
        DefinitionError: the definition is invalid.
    """
    parts = Service(f"{type_name}_Request", f"{type_name}_Response")
    is_known = typestore.type_exists(parts.request)
    if not is_known and not (text := text or definitions.text(type_name)):
        typestore.find(type_name)
    if not typestore.type_exists(parts.request):
        texts = _split(type_name, text, 2)
        for part, definition in zip(parts, texts, strict=True):
            typestore.declare(part, _fields(part, definition))
    return _with_event(type_name, parts)


def learn(type_name: str, request: str, response: str) -> None:
    """Declare a service type by the definitions that its server sends, unless it is known.

    Args:
        type_name: such as "my_robot_msgs/srv/SetMode".
        request, response: .msg text or IDL with all nested types, see `register`; "" if it has no
            fields. They change no type that is known.

    Raises:
        MessageError: the name or a definition is invalid, or contradicts a known type.
    """
    parts = Service(f"{type_name}_Request", f"{type_name}_Response")
    if type_name in definitions.FILES:
        return
    if not typestore.type_exists(parts.request):
        typestore.find(type_name)
    if typestore.type_exists(parts.request):
        return
    described = [
        _described(part, text) for part, text in zip(parts, (request, response), strict=True)
    ]
    for part, fields in zip(parts, described, strict=True):
        typestore.declare(part, fields)
    _with_event(type_name, parts)


def _described(part: str, text: str) -> list[Any]:
    """Return the fields of a part, and register its unknown types."""
    if not text.strip():
        return []
    package, _, name = typestore.full_name(part).split("/")
    plain = part if typestore.is_idl(text) else f"{package}/msg/{name}"
    # rosbags reads .msg texts of messages only.
    typestore.add(plain, text, fixed=_KnownTypes())
    return typestore.described(plain)


def action(type_name: str, text: str = "") -> Action:
    """Return the parts of an action type; declares them when first used.

    Args:
        type_name: such as "nav2_msgs/action/NavigateToPose".
        text: the .action definition, for types unknown to webviz.

    Raises:
        UnknownTypeError: no definition is known.
        DefinitionError: the definition is invalid.
    """
    goal, result, feedback = (f"{type_name}_{part}" for part in ("Goal", "Result", "Feedback"))
    parts = Action(
        f"{type_name}_SendGoal", f"{type_name}_GetResult", f"{type_name}_FeedbackMessage", goal
    )
    if not typestore.type_exists(goal) and not (text := text or definitions.text(type_name)):
        typestore.find(type_name)
    if typestore.type_exists(goal):
        return parts
    texts = _split(type_name, text, 3)
    for part, definition in zip((goal, result, feedback), texts, strict=True):
        typestore.declare(part, _fields(part, definition))
    goal_id = ("goal_id", (Nodetype.NAME, "unique_identifier_msgs/msg/UUID"))
    stamp = ("stamp", (Nodetype.NAME, "builtin_interfaces/msg/Time"))
    accepted = ("accepted", (Nodetype.BASE, ("bool", 0)))
    status = ("status", (Nodetype.BASE, ("int8", 0)))
    typestore.declare(f"{parts.send_goal}_Request", [goal_id, ("goal", (Nodetype.NAME, goal))])
    typestore.declare(f"{parts.send_goal}_Response", [accepted, stamp])
    typestore.declare(f"{parts.get_result}_Request", [goal_id])
    typestore.declare(f"{parts.get_result}_Response", [status, ("result", (Nodetype.NAME, result))])
    typestore.declare(parts.feedback, [goal_id, ("feedback", (Nodetype.NAME, feedback))])
    for each in (parts.send_goal, parts.get_result):
        service(each)
    return parts


def taker(
    service: str, type: str, answered: Callable[[Any], object], failed: Callable[[str], object]
) -> Callable[[Future[bytes]], None]:
    """Return the function that takes the response of a service once it is there.

    Args:
        service: its name.
        type: of its response.
        answered: called with the response.
        failed: called with a sentence if there is none, or `answered` raises.
    """

    def take(response: Future[bytes]) -> None:
        try:
            answered(decode(type, response.result()))
        except CancelledError:
            failed("The viewer has ended.")
        except Exception as error:  # of the service, its message, or a plug-in
            failed(str(error) or f"{service}: {error.__class__.__name__}.")

    return take


def _with_event(type_name: str, parts: Service) -> Service:
    """Declare the service type itself, from which its hash is computed."""
    event = f"{type_name}_Event"
    if not typestore.type_exists(event):
        info = ("info", (Nodetype.NAME, "service_msgs/msg/ServiceEventInfo"))
        most_one = [
            (name, (Nodetype.SEQUENCE, ((Nodetype.NAME, part), 1)))
            for name, part in zip(("request", "response"), parts, strict=True)
        ]
        typestore.declare(event, [info, *most_one])
        whole = zip(
            ("request_message", "response_message", "event_message"), (*parts, event), strict=True
        )
        typestore.declare(type_name, [(name, (Nodetype.NAME, part)) for name, part in whole])
    return parts


def _split(type_name: str, text: str, count: int) -> list[str]:
    if not text:
        raise UnknownTypeError(f"No definition of {type_name} is known.")
    texts = _SEPARATOR.split(text)
    if len(texts) != count:
        raise DefinitionError(
            f"The definition of {type_name} has {len(texts)} parts separated by ---, "
            f"expected {count}."
        )
    return texts


def _fields(part: str, text: str) -> list[Any]:
    package, _, name = part.split("/")
    plain = f"{package}/msg/{name}"  # rosbags reads definitions of messages only
    return typestore.parsed(plain, text)[plain][1]
