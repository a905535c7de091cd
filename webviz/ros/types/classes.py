"""Classes for rclpy: installed ones, or composed from the definition of the type."""

from __future__ import annotations

import ctypes
import functools
import importlib
from collections.abc import Callable, Sequence
from typing import Any

from rclpy.serialization import deserialize_message, serialize_message
from rclpy.utilities import get_rmw_implementation_identifier

from webviz.data.messages import MessageError, UnknownTypeError, interfaces
from webviz.data.words import joined
from webviz.ros import distribution
from webviz.ros.types import wire
from webviz.ros.types.descriptions import BOUNDED_SEQUENCE, describe, fields
from webviz.ros.types.structs import (
    Member,
    Members,
    MessageCallbacks,
    ServiceCallbacks,
    ServiceTypeSupport,
    TypeSupport,
    address,
    capsule,
    finder,
    function,
    getters,
    text,
)
from webviz.ros.types.wire import RawPayload

_FEEDBACK = "_FeedbackMessage"
# Primitive types by their number in the introspection's field_types.h.
_INTROSPECTED = {"float32": 1, "float64": 2, "bool": 6, "byte": 7, "octet": 7, "uint8": 8}
_INTROSPECTED |= {"char": 8, "int8": 9, "uint16": 10, "int16": 11, "uint32": 12, "int32": 13}
_INTROSPECTED |= {"uint64": 14, "int64": 15, "string": 16, "wstring": 17}
_NESTED = 18
_C, _FASTRTPS, _INTROSPECTION = (
    "rosidl_typesupport_c",
    "rosidl_typesupport_fastrtps_c",
    "rosidl_typesupport_introspection_c",
)
_pointer = ctypes.c_void_p


class _ComposedType(type):
    """Metaclass of the composed classes; each class has its own subclass with the capsules."""

    @classmethod
    def __import_type_support__(cls) -> None:
        """Do nothing: the capsules exist from the start."""


class _ComposedMessage(_ComposedType):
    def __call__(cls, *_: object, **__: object) -> Any:
        raise TypeError(f"The package of {cls.__name__} is missing: use serialised bytes.")


@functools.cache
def composed_message(type_name: str) -> type:
    """Return the class of a message type, composed from its definition."""
    # Called by a subscription without raw=True: null makes rclpy raise.
    no_message = capsule(function(lambda: None, _pointer))
    attributes = dict.fromkeys(wire.conversions(), no_message)
    attributes["_TYPE_SUPPORT"] = capsule(_message_support(type_name))
    return _class(type_name, _ComposedMessage, (), attributes)


@functools.cache
def composed_service(type_name: str) -> type:
    """Return the class of a service type, composed from its definition.

    Requests are `RawPayload`.
    """
    parts = interfaces.service(type_name)
    cls = _class(type_name, _ComposedType, (), {"_TYPE_SUPPORT": capsule(_service(type_name))})
    for name, part in (("Request", parts.request), ("Response", parts.response)):
        attributes = wire.conversions() | {"_TYPE_SUPPORT": capsule(_message_support(part))}
        setattr(cls, name, _class(part, _ComposedType, (wire.RawPayload,), attributes))
    return cls


def _class(type_name: str, base: type, bases: tuple[type, ...], attributes: dict[str, Any]) -> Any:
    package, kind, name = type_name.split("/")
    metaclass = type(f"Metaclass_{name}", (base,), attributes)
    return metaclass(name, bases, {"__module__": f"{package}.{kind}"})


def _handle(
    type_name: str, identifier: str, data: int, others: dict[str, int], messages: Sequence[int] = ()
) -> int:
    """Return a `rosidl_message_type_support_t`, or that of a service with `messages`."""
    support: Any
    if messages:
        more = (*messages, 0, 0, *getters(type_name))
        support = ServiceTypeSupport(text(identifier), data, 0, *more)
    else:
        support = TypeSupport(text(identifier), data, 0, *getters(type_name))
    own = address(support)
    support.func = finder({**others, identifier: own})
    return own


@functools.cache
def _introspection(type_name: str) -> int:
    """Return the handle from which Fast DDS reads the members to announce them as an XTypes object.

    Sizes, offsets and functions stay zero, since they describe a C struct that does not exist.
    """
    members = [
        Member(
            name=text(field.name),
            type_id=_INTROSPECTED.get(field.type_name, _NESTED),
            string_bound=field.string_bound,
            members=_introspection(field.type_name) if field.is_nested else 0,
            is_array=bool(field.repeated),
            array_size=field.capacity,
            is_upper_bound=field.repeated == BOUNDED_SEQUENCE,
        )
        for field in fields(type_name)
    ]
    package, kind, name = type_name.split("/")
    array = address((Member * len(members))(*members))
    data = Members(text(f"{package}__{kind}"), text(name), len(members), members=array)
    return _handle(type_name, _INTROSPECTION, address(data), {})


@functools.cache
def _message_support(type_name: str) -> int:
    """Return the handle for rclpy, through which rmw_fastrtps_cpp finds the two that it uses."""
    package, kind, name = type_name.split("/")

    def max_serialized_size(bounds: Any) -> int:
        bounds[0] = b"\0"  # ROSIDL_TYPESUPPORT_FASTRTPS_UNBOUNDED_TYPE: memory as each one needs
        return 0

    callbacks = MessageCallbacks(
        text(f"{package}::{kind}"),
        text(name),
        function(wire.serialize, ctypes.c_bool, _pointer, _pointer),
        function(wire.deserialize, ctypes.c_bool, _pointer, _pointer),
        function(wire.serialized_size, ctypes.c_uint32, _pointer),
        function(max_serialized_size, ctypes.c_size_t, ctypes.POINTER(ctypes.c_char)),
    )
    data = address(callbacks)
    others = {
        _FASTRTPS: _handle(type_name, _FASTRTPS, data, {}),
        _INTROSPECTION: _introspection(type_name),
    }
    return _handle(type_name, _C, data, others)


def _service(type_name: str) -> int:
    """Return a `rosidl_service_type_support_t`; the counterpart of `_message_support`."""
    package, kind, name = type_name.split("/")
    parts = interfaces.service(type_name)
    supports = [_message_support(part) for part in (*parts, f"{type_name}_Event")]
    members = [
        _handle(part, _FASTRTPS, TypeSupport.from_address(support).data, {})
        for part, support in zip(parts, supports[:2], strict=True)
    ]
    data = address(ServiceCallbacks(text(f"{package}::{kind}"), text(name), *members))
    others = {_FASTRTPS: _handle(type_name, _FASTRTPS, data, {}, supports)}
    return _handle(type_name, _C, data, others, supports)


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
            action = _installed(package, "action", name.removesuffix(_FEEDBACK))
            installed = action.Impl.FeedbackMessage if action else None
        case _:
            raise MessageTypeError(
                f"{type_name!r} is not a message type name. Write package/msg/Name."
            )
    return installed or composed(type_name, describe, composed_message)


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
            action_class = _installed(package, "action", action)
            installed = getattr(action_class.Impl, f"{part}Service") if action_class else None
        case _:
            raise MessageTypeError(
                f"{type_name!r} is not a service type name. Write package/srv/Name."
            )
    return installed or composed(type_name, interfaces.service, composed_service)


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
def composed(
    type_name: str, check: Callable[[str], object], compose: Callable[[str], type]
) -> type:
    """Return the class of a type whose package is not installed."""
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
