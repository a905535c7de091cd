"""Message classes for rclpy by name, also for types whose package is not installed.

`/tf` carries `tf2_msgs/msg/TFMessage`, and tf2_msgs is not among the ROS packages on PyPI; neither
is map_msgs. For a publisher or a subscription rclpy needs no generated Python code, only what the
middleware must know of the type: a `rosidl_message_type_support_t`, held by a capsule in the
attribute `_TYPE_SUPPORT` of the message class's metaclass. A package brings that struct compiled
in a shared library. Where the package is missing, this module composes the same struct with
ctypes, from the message definition:

* names and bounds, as rmw_fastrtps_cpp wants them (`message_type_support_callbacks_t`),
* the members of the type and of every nested type (`MessageMembers`), which Fast DDS announces,
* the type description and its hash (REP 2016), which other nodes compare and ask for.

No C struct stands behind such a class, so its messages exist as serialised CDR bytes only:
subscribe with `raw=True`, publish `bytes`. The layouts are those of ROS 2 Jazzy, in the headers of
rosidl_runtime_c, rosidl_typesupport_fastrtps_cpp and rosidl_typesupport_introspection_c. Another
RMW implementation looks for other structs and so needs the real package.
"""

import ctypes
import functools
import hashlib
import importlib
import json
from collections.abc import Callable
from typing import Any, NamedTuple

from rclpy.utilities import get_rmw_implementation_identifier
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, TypesysError, get_types_from_msg, get_typestore

# Types of everyday topics which neither common_interfaces nor rosbags has.
_DEFINITIONS = {
    "map_msgs/msg/OccupancyGridUpdate": (
        "std_msgs/Header header\nint32 x\nint32 y\nuint32 width\nuint32 height\nint8[] data\n"
    ),
}

# Primitive types by their number in type_description_interfaces/msg/FieldType, and in the
# introspection's field_types.h. A `char` in a .msg file is a uint8 to both, a `byte` an octet.
_DESCRIBED = {"int8": 2, "uint8": 3, "char": 3, "int16": 4, "uint16": 5, "int32": 6, "uint32": 7}
_DESCRIBED |= {"int64": 8, "uint64": 9, "float32": 10, "float64": 11, "bool": 15, "byte": 16}
_DESCRIBED |= {"octet": 16, "string": 17}
_INTROSPECTED = {"float32": 1, "float64": 2, "bool": 6, "byte": 7, "octet": 7, "uint8": 8}
_INTROSPECTED |= {"char": 8, "int8": 9, "uint16": 10, "int16": 11, "uint32": 12, "int32": 13}
_INTROSPECTED |= {"uint64": 14, "int64": 15, "string": 16}
_DESCRIBED_NESTED, _INTROSPECTED_NESTED = 1, 18
_DESCRIBED_BOUNDED_STRING = 21
_ARRAY, _BOUNDED_SEQUENCE, _SEQUENCE = 48, 96, 144  # added to a FieldType's number

# IDL has no empty struct, so rosidl gives a message without fields this one.
_PLACEHOLDER = ("structure_needs_at_least_one_member", (Nodetype.BASE, ("uint8", 0)))


class MessageTypeError(Exception):
    """A message type cannot be provided; the text says why and what to do."""


def message_class(type_name: str, definition: str | None = None) -> type:
    """Returns the message class to create publishers and subscriptions with.

    The real class where its package is importable, else one composed at run time, which works
    with `create_subscription(..., raw=True)` and `publisher.publish(bytes)` only. The same call
    returns the same class.

    Args:
        type_name: Full name, such as `"tf2_msgs/msg/TFMessage"`.
        definition: The `.msg` text of a type that neither an installed package nor rosbags
            knows; nested types follow as in a bag's schema, each after a line of 80 `=` and
            `MSG: <name>`.

    Raises:
        MessageTypeError: The name is malformed or unknown, the definition does not parse or
            contradicts an earlier one, or the package is missing under another RMW implementation
            than rmw_fastrtps_cpp.
    """
    match type_name.split("/"):
        case [package, "msg", name] if package.isidentifier() and name.isidentifier():
            return _installed(package, name) or _composed(type_name, definition)
    raise MessageTypeError(
        f"{type_name!r} is not the name of a message type; write package/msg/Name."
    )


def type_hash(type_name: str) -> str:
    """Returns the `RIHS01_…` hash (REP 2016) of a type, computed from its definition.

    rosbags has such a function too, which takes a `char` for a type of its own and so disagrees
    with rosidl about std_msgs/msg/Char.

    Raises:
        MessageTypeError: The type, or one it contains, is not known.
    """
    text = json.dumps(_describe(type_name))
    return f"RIHS01_{hashlib.sha256(text.encode()).hexdigest()}"


def _installed(package: str, name: str) -> type | None:
    """The generated class; a source folder that merely bears the package's name has none."""
    try:
        return getattr(importlib.import_module(f"{package}.msg"), name, None)
    except ModuleNotFoundError as error:
        if error.name in (package, f"{package}.msg"):
            return None
        raise


# --- What a type looks like: from its definition to its description -----------------------------


@functools.cache
def _typestore():
    store = get_typestore(Stores.ROS2_JAZZY)
    for name, text in _DEFINITIONS.items():
        store.register(get_types_from_msg(text, name))
    return store


class _Field(NamedTuple):
    """One member of a message."""

    name: str
    type_name: str  # a key of _DESCRIBED, or the full name of a nested type
    string_bound: int
    repeated: int  # 0 for one value, else _ARRAY, _BOUNDED_SEQUENCE or _SEQUENCE
    capacity: int  # length of an array, upper bound of a bounded sequence, else 0

    @property
    def nested(self) -> bool:
        return self.type_name not in _DESCRIBED


def _fields(type_name: str) -> list[_Field]:
    try:
        _, definition = _typestore().fielddefs[type_name]
    except KeyError:
        raise MessageTypeError(
            f"The message type {type_name} is not known: install its package, or source the "
            "workspace that contains it."
        ) from None
    fields = []
    node: Any
    detail: Any
    for name, (node, detail) in definition or [_PLACEHOLDER]:
        repeated = capacity = 0
        if node in (Nodetype.ARRAY, Nodetype.SEQUENCE):
            is_array = node == Nodetype.ARRAY
            (node, detail), capacity = detail
            repeated = _ARRAY if is_array else _BOUNDED_SEQUENCE if capacity else _SEQUENCE
        base, bound = (detail, 0) if node == Nodetype.NAME else detail
        fields.append(_Field(name, base, bound, repeated, capacity))
    return fields


def _describe(type_name: str) -> dict[str, Any]:
    """The type description as JSON data, with the keys in the order that is hashed."""
    described: dict[str, dict] = {}

    def visit(name: str) -> None:
        if name not in described:
            fields = _fields(name)
            described[name] = {
                "type_name": name,
                "fields": [{"name": f.name, "type": _describe_type(f)} for f in fields],
            }
            for field in fields:
                if field.nested:
                    visit(field.type_name)

    visit(type_name)
    return {
        "type_description": described.pop(type_name),
        "referenced_type_descriptions": [described[name] for name in sorted(described)],
    }


def _describe_type(field: _Field) -> dict[str, Any]:
    number = _DESCRIBED.get(field.type_name, _DESCRIBED_NESTED)
    return {
        "type_id": field.repeated + (_DESCRIBED_BOUNDED_STRING if field.string_bound else number),
        "capacity": field.capacity,
        "string_capacity": field.string_bound,
        "nested_type_name": field.type_name if field.nested else "",
    }


# --- The same in C: structs laid out as in the headers ------------------------------------------

_CTYPES = {"bool": ctypes.c_bool, "size": ctypes.c_size_t, "pointer": ctypes.c_void_p}
_CTYPES |= {"u8": ctypes.c_uint8, "u32": ctypes.c_uint32, "u64": ctypes.c_uint64}


def _struct(layout: str, **structs: type) -> type[ctypes.Structure]:
    """A C struct of `name:type` words, where a bare `name` is a pointer."""
    members = []
    for word in layout.split():
        name, _, kind = word.partition(":")
        members.append((name, structs.get(kind) or _CTYPES[kind or "pointer"]))
    return type("Struct", (ctypes.Structure,), {"_fields_": members})


_TypeSupport = _struct("identifier data func hash description sources")
_TypeHash = _struct("version:u8 value:digest", digest=ctypes.c_uint8 * 32)
_FastrtpsCallbacks = _struct(
    "namespace name serialize deserialize serialized_size max_serialized_size key_callbacks"
)
_Members = _struct("namespace name count:u32 size:size has_key:bool members init fini")
_Member = _struct(
    "name type_id:u8 string_bound:size members is_key:bool is_array:bool array_size:size "
    "is_upper_bound:bool offset:u32 default_value functions:six",
    six=ctypes.c_void_p * 6,
)
_String = _struct("data size:size capacity:size")
_Sequence = _struct("data size:size capacity:size")
_FieldType = _struct("type_id:u8 capacity:u64 string_capacity:u64 nested:str", str=_String)
_FieldDescription = _struct("name:str type:type default:str", str=_String, type=_FieldType)
_Individual = _struct("name:str fields:list", str=_String, list=_Sequence)
_Description = _struct("main:main referenced:list", main=_Individual, list=_Sequence)

# The middleware keeps plain pointers into all of this for as long as the process lives, so
# nothing is ever freed, not even when the interpreter ends.
_immortal: list[Any] = []
ctypes.pythonapi.Py_IncRef(ctypes.py_object(_immortal))


def _address(value: Any) -> int:
    _immortal.append(value)
    return ctypes.addressof(value)


def _text(text: str) -> int:
    return _address(ctypes.create_string_buffer(text.encode()))


def _function(call: Callable, result: Any, *arguments: Any) -> int:
    callback = ctypes.CFUNCTYPE(result, *arguments)(call)
    _immortal.append(callback)
    return ctypes.cast(callback, ctypes.c_void_p).value or 0


def _string(text: str) -> ctypes.Structure:
    size = len(text.encode())
    return _String(_text(text), size, size + 1)


def _sequence(kind: type[ctypes.Structure], items: list) -> ctypes.Structure:
    return _Sequence(_address((kind * len(items))(*items)), len(items), len(items))


def _individual(described: dict[str, Any]) -> ctypes.Structure:
    fields = []
    for field in described["fields"]:
        *numbers, nested = field["type"].values()
        kind = _FieldType(*numbers, _string(nested))
        fields.append(_FieldDescription(_string(field["name"]), kind, _string("")))
    return _Individual(_string(described["type_name"]), _sequence(_FieldDescription, fields))


@functools.cache
def _getters(type_name: str) -> list[int]:
    """Three functions: a type's hash, its description, and its source files (none)."""
    described = _describe(type_name)
    main = _individual(described["type_description"])
    referenced = [_individual(other) for other in described["referenced_type_descriptions"]]
    digest = bytes.fromhex(type_hash(type_name).removeprefix("RIHS01_"))
    answers = (
        _TypeHash(1, (ctypes.c_uint8 * 32)(*digest)),
        _Description(main, _sequence(_Individual, referenced)),
        _sequence(_String, []),
    )
    pointer = ctypes.c_void_p
    addresses = [_address(answer) for answer in answers]
    return [_function(lambda _, address=a: address, pointer, pointer) for a in addresses]


def _handle(type_name: str, identifier: str, data: int, **others: int) -> int:
    """A `rosidl_message_type_support_t`: asked for an identifier, it leads there or nowhere."""
    support = _TypeSupport(_text(identifier), data, 0, *_getters(type_name))
    own = _address(support)
    handles = {name.encode(): address for name, address in {**others, identifier: own}.items()}
    support.func = _function(
        lambda _, wanted: handles.get(wanted), ctypes.c_void_p, ctypes.c_void_p, ctypes.c_char_p
    )
    return own


@functools.cache
def _introspection(type_name: str) -> int:
    """The handle from which Fast DDS learns the members, to announce them as an XTypes object.

    Sizes, offsets and functions stay zero: they are about the C struct that does not exist.
    """
    members = [
        _Member(
            name=_text(field.name),
            type_id=_INTROSPECTED.get(field.type_name, _INTROSPECTED_NESTED),
            string_bound=field.string_bound,
            members=_introspection(field.type_name) if field.nested else 0,
            is_array=bool(field.repeated),
            array_size=field.capacity,
            is_upper_bound=field.repeated == _BOUNDED_SEQUENCE,
        )
        for field in _fields(type_name)
    ]
    package, _, name = type_name.split("/")
    array = _address((_Member * len(members))(*members))
    data = _Members(_text(f"{package}__msg"), _text(name), len(members), members=array)
    return _handle(type_name, "rosidl_typesupport_introspection_c", _address(data))


def _type_support(type_name: str) -> int:
    """The handle for rclpy, which leads rmw_fastrtps_cpp to the two it works with."""
    package, _, name = type_name.split("/")
    pointer = ctypes.c_void_p

    def max_serialized_size(bounds: Any) -> int:
        bounds[0] = b"\0"  # ROSIDL_TYPESUPPORT_FASTRTPS_UNBOUNDED_TYPE: memory as each one needs
        return 0

    refuse = _function(lambda *_: False, ctypes.c_bool, pointer, pointer)
    callbacks = _FastrtpsCallbacks(
        _text(f"{package}::msg"),
        _text(name),
        refuse,
        refuse,
        _function(lambda _: 0, ctypes.c_uint32, pointer),
        _function(max_serialized_size, ctypes.c_size_t, ctypes.POINTER(ctypes.c_char)),
    )
    data = _address(callbacks)
    return _handle(
        type_name,
        "rosidl_typesupport_c",
        data,
        rosidl_typesupport_fastrtps_c=_handle(type_name, "rosidl_typesupport_fastrtps_c", data),
        rosidl_typesupport_introspection_c=_introspection(type_name),
    )


# --- The class ----------------------------------------------------------------------------------


class _ComposedType(type):
    """Metaclass of the composed classes; a subclass per class holds the capsules."""

    @classmethod
    def __import_type_support__(cls) -> None:
        """Nothing to import: the capsules are there from the start."""

    def __call__(cls, *_: object, **__: object) -> Any:
        raise TypeError(f"{cls.__name__} was composed without its package: use serialised bytes.")


@functools.cache
def _composed(type_name: str, definition: str | None) -> type:
    package, _, name = type_name.split("/")
    if definition is not None:
        try:
            _typestore().register(get_types_from_msg(definition, type_name))
        except TypesysError as error:
            reason = str(error).partition("\n")[0].rstrip(":.")
            raise MessageTypeError(
                f"The definition of {type_name} is of no use: {reason}."
            ) from None
    _describe(type_name)  # an unknown type is refused as such before the RMW is blamed
    rmw = get_rmw_implementation_identifier()
    if rmw != "rmw_fastrtps_cpp":
        raise MessageTypeError(
            f"{type_name} needs its package with {rmw}: install ros-jazzy-"
            f"{package.replace('_', '-')} with apt, or set RMW_IMPLEMENTATION=rmw_fastrtps_cpp."
        )
    # A subscription without raw=True calls this for a message: null makes rclpy raise.
    no_message = _capsule(_function(lambda: None, ctypes.c_void_p))
    conversions = ("CREATE_ROS_MESSAGE", "CONVERT_FROM_PY", "CONVERT_TO_PY", "DESTROY_ROS_MESSAGE")
    attributes = {f"_{conversion}": no_message for conversion in conversions}
    attributes["_TYPE_SUPPORT"] = _capsule(_type_support(type_name))
    metaclass = type(f"Metaclass_{name}", (_ComposedType,), attributes)
    return metaclass(name, (), {"__module__": f"{package}.msg"})


def _capsule(address: int) -> object:
    new = ctypes.pythonapi.PyCapsule_New
    new.restype = ctypes.py_object
    new.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
    return new(address, None, None)
