"""The C structs of rosidl that the middleware reads, in ctypes.

The middleware keeps pointers to them until the process ends, so they are never freed, not even at
interpreter shutdown.
"""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable
from typing import Any

from webviz.ros.types.descriptions import describe, type_hash

_CTYPES = {"bool": ctypes.c_bool, "size": ctypes.c_size_t, "pointer": ctypes.c_void_p}
_CTYPES |= {"u8": ctypes.c_uint8, "u32": ctypes.c_uint32, "u64": ctypes.c_uint64}

_immortal: list[Any] = []
ctypes.pythonapi.Py_IncRef(ctypes.py_object(_immortal))


def struct(layout: str, **structs: type) -> type[ctypes.Structure]:
    """Return a C struct of `name:type` words, where a bare `name` is a pointer."""
    members = []
    for word in layout.split():
        name, _, kind = word.partition(":")
        members.append((name, structs.get(kind) or _CTYPES[kind or "pointer"]))
    return type("Struct", (ctypes.Structure,), {"_fields_": members})


TypeSupport = struct("identifier data func hash description sources")
ServiceTypeSupport = struct(
    "identifier data func request response event create_event destroy_event "
    "hash description sources"
)
MessageCallbacks = struct(
    "namespace name serialize deserialize serialized_size max_serialized_size key_callbacks"
)
ServiceCallbacks = struct("namespace name request response")
Members = struct("namespace name count:u32 size:size has_key:bool members init fini")
Member = struct(
    "name type_id:u8 string_bound:size members is_key:bool is_array:bool array_size:size "
    "is_upper_bound:bool offset:u32 default_value functions:six",
    six=ctypes.c_void_p * 6,
)
_TypeHash = struct("version:u8 value:digest", digest=ctypes.c_uint8 * 32)
_String = struct("data size:size capacity:size")
_Sequence = struct("data size:size capacity:size")
_FieldType = struct("type_id:u8 capacity:u64 string_capacity:u64 nested:str", str=_String)
_FieldDescription = struct("name:str type:type default:str", str=_String, type=_FieldType)
_Individual = struct("name:str fields:list", str=_String, list=_Sequence)
_Description = struct("main:main referenced:list", main=_Individual, list=_Sequence)


def address(value: Any) -> int:
    """Return the address of a ctypes value, which is kept alive forever."""
    _immortal.append(value)
    return ctypes.addressof(value)


def text(text: str) -> int:
    """Return the address of a C string."""
    return address(ctypes.create_string_buffer(text.encode()))


def function(call: Callable, result: Any, *arguments: Any) -> int:
    """Return the address of a C function that calls a Python one."""
    callback = ctypes.CFUNCTYPE(result, *arguments)(call)
    _immortal.append(callback)
    return ctypes.cast(callback, ctypes.c_void_p).value or 0


def capsule(address: int) -> object:
    """Return a Python capsule of a pointer, as rclpy reads it from classes."""
    new = ctypes.pythonapi.PyCapsule_New
    new.restype = ctypes.py_object
    new.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
    return new(address, None, None)


@functools.cache
def getters(type_name: str) -> list[int]:
    """Functions that return the hash, the description and the (empty) sources of a type."""
    described = describe(type_name)
    main = _individual(described["type_description"])
    referenced = [_individual(other) for other in described["referenced_type_descriptions"]]
    digest = bytes.fromhex(type_hash(type_name).removeprefix("RIHS01_"))
    answers = (
        _TypeHash(1, (ctypes.c_uint8 * 32)(*digest)),
        _Description(main, _sequence(_Individual, referenced)),
        _sequence(_String, []),
    )
    pointer = ctypes.c_void_p
    addresses = [address(answer) for answer in answers]
    return [function(lambda _, address=a: address, pointer, pointer) for a in addresses]


def finder(handles: dict[str, int]) -> int:
    """Return the `func` of a handle: returns the handle of an identifier, or null."""
    named = {name.encode(): each for name, each in handles.items()}
    return function(
        lambda _, key: named.get(key), ctypes.c_void_p, ctypes.c_void_p, ctypes.c_char_p
    )


def _string(text_: str) -> ctypes.Structure:
    size = len(text_.encode())
    return _String(text(text_), size, size + 1)


def _sequence(kind: type[ctypes.Structure], items: list) -> ctypes.Structure:
    return _Sequence(address((kind * len(items))(*items)), len(items), len(items))


def _individual(described: dict[str, Any]) -> ctypes.Structure:
    fields = []
    for field in described["fields"]:
        *numbers, nested = field["type"].values()
        kind = _FieldType(*numbers, _string(nested))
        fields.append(_FieldDescription(_string(field["name"]), kind, _string("")))
    return _Individual(_string(described["type_name"]), _sequence(_FieldDescription, fields))
