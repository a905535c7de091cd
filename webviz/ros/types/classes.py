"""Classes for rclpy: installed ones, or composed from the definition of the type."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable
from typing import Any

from rclpy.serialization import deserialize_message, serialize_message
from rclpy.utilities import get_rmw_implementation_identifier

from webviz.data.messages import MessageError, UnknownTypeError, interfaces
from webviz.data.words import joined
from webviz.ros import distribution
from webviz.ros.types.composing import composed_message, composed_service
from webviz.ros.types.descriptions import describe
from webviz.ros.types.wire import RawPayload

_FEEDBACK = "_FeedbackMessage"


class MessageTypeError(Exception):
    """A type is unavailable; the message says why and what to do."""


def message_class(type_name: str) -> type:
    """Return the message class for publishers and subscriptions.

    A composed class works with `create_subscription(..., raw=True)` and `publish(bytes)` only.
    Repeated calls return the same class.

    Args:
        type_name: full name, such as "tf2_msgs/msg/TFMessage". Register types unknown to webviz
            whose package is missing with `webviz.data.messages.register`.

    Raises:
        MessageTypeError: the name is malformed or unknown, or the package is missing and the type
            cannot be composed: with an RMW implementation other than rmw_fastrtps_cpp, or a
            distribution with other structs.
    """
    match type_name.split("/"):
        case [package, "msg", name] if package.isidentifier() and name.isidentifier():
            installed = _installed(package, "msg", name)
        case [package, "action", name] if name.endswith(_FEEDBACK):
            found = _installed(package, "action", name.removesuffix(_FEEDBACK))
            installed = found.Impl.FeedbackMessage if found else None
        case _:
            raise MessageTypeError(
                f"{type_name!r} is not a message type name. Write package/msg/Name."
            )
    return installed or _composed(type_name, describe, composed_message)


def service_class(type_name: str) -> Any:
    """Return the service class for clients, including the services of an action.

    Convert its requests and responses with `to_cdr` and `from_cdr`.

    Args:
        type_name: such as "std_srvs/srv/Trigger" or "nav2_msgs/action/Spin_SendGoal".

    Raises:
        MessageTypeError: as `message_class`.
    """
    match type_name.split("/"):
        case [package, "srv", name] if package.isidentifier() and name.isidentifier():
            installed = _installed(package, "srv", name)
        case [package, "action", name] if package.isidentifier() and name.isidentifier():
            action, _, part = name.rpartition("_")
            found = _installed(package, "action", action)
            installed = getattr(found.Impl, f"{part}Service") if found else None
        case _:
            raise MessageTypeError(
                f"{type_name!r} is not a service type name. Write package/srv/Name."
            )
    return installed or _composed(type_name, interfaces.service, composed_service)


def from_cdr(cdr: bytes, cls: Any) -> Any:
    """Return a request or response of a class from its serialised bytes."""
    return cls(cdr) if issubclass(cls, RawPayload) else deserialize_message(cdr, cls)


def to_cdr(message: Any) -> bytes:
    """Return the serialised bytes of a request or response."""
    return message.cdr if isinstance(message, RawPayload) else serialize_message(message)


def _installed(package: str, kind: str, name: str) -> Any:
    """Return the generated class, or None; a source folder named like the package has none."""
    try:
        return getattr(importlib.import_module(f"{package}.{kind}"), name, None)
    except ModuleNotFoundError as error:
        if error.name in (package, f"{package}.{kind}"):
            return None
        raise


@functools.cache
def _composed(
    type_name: str, check: Callable[[str], object], compose: Callable[[str], type]
) -> type:
    try:
        check(type_name)
    except UnknownTypeError as error:
        remedy = "Install its package, or source the workspace that contains it."
        raise MessageTypeError(joined(str(error), remedy)) from error
    except MessageError as error:
        raise MessageTypeError(str(error)) from error
    rmw = get_rmw_implementation_identifier()
    package = distribution.apt_name(type_name.partition("/")[0])
    if not distribution.has_known_type_supports():
        raise MessageTypeError(
            f"{type_name} needs its package with this ROS 2: install {package} with apt."
        )
    if rmw != "rmw_fastrtps_cpp":
        raise MessageTypeError(
            f"{type_name} needs its package with {rmw}: install {package} with apt, or "
            "set RMW_IMPLEMENTATION=rmw_fastrtps_cpp."
        )
    return compose(type_name)
