"""Definitions that would take all memory or time, and messages of types that need few bytes."""

from __future__ import annotations

import contextlib
import re
import resource
import struct
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from hostile_definitions import NAME, READ, REFUSED, idl, msg
from known_types import OURS
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore

from webviz.data.messages import (
    DecodeError,
    DefinitionError,
    MessageError,
    decode,
    definition,
    definitions,
    encode,
    message_class,
    register,
    type_exists,
    type_hash,
    typestore,
)
from webviz.data.messages import cdr as cdr_module
from webviz.data.messages.idl_text import types_in_idl
from webviz.data.messages.msg_text import types_in_msg
from webviz.data.messages.ros1 import Ros1Type
from webviz.data.messages.stamps import shifted
from webviz.data.messages.typestore import add, fields
from webviz.panels.sending import fields_of, template
from webviz.sources.bridge.rosbridge_values import to_values

CDR = b"\0\1\0\0"
MEMORY = 4 << 30
"""Bytes of address space while a test reads what would take more."""
ALL = {**{name: text for name, (text, _) in REFUSED.items()}, **READ}


@contextmanager
def bounded() -> Iterator[None]:
    """Have what takes all memory fail, instead of the machine."""
    before = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


@pytest.mark.parametrize("what", REFUSED)
def test_a_definition_that_would_take_too_much_is_refused_with_a_sentence(what: str) -> None:
    text, reason = REFUSED[what]
    began_s = time.process_time()
    with bounded(), pytest.raises(DefinitionError, match=re.escape(reason)) as raised:
        register(NAME, text)
    assert time.process_time() - began_s < 5.0
    assert len(str(raised.value)) < 300
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("data", [b"", struct.pack("<I", 400_000), b"\1\0\0\0" * 64])
@pytest.mark.parametrize("what", READ)
def test_decoding_a_hostile_definition_is_bounded(what: str, data: bytes) -> None:
    with bounded():
        register(NAME, READ[what])
        assert message_class(NAME)() is not None
        assert fields_of(template(NAME)) is not None
        encode(NAME)
        definition(NAME)
        type_hash(NAME)
        for size in (0, 1 << 22):
            cdr = CDR + data + bytes(size)
            began_s = time.process_time()
            for read in (decode, to_values):
                with contextlib.suppress(MessageError):
                    read(NAME, cdr)
            shifted(NAME, cdr, 5)
            assert time.process_time() - began_s < 20.0


def test_a_message_without_fields_has_the_byte_that_ros_adds() -> None:
    register(NAME, msg("Nothing[2] a\nuint8 x", Nothing="int32 ONE=1"))
    evil = decode(NAME, CDR + b"\0\0\7")
    assert (len(evil.a), evil.x) == (2, 7)
    assert decode(NAME, encode(NAME, {"x": 9})).x == 9
    assert to_values(NAME, CDR + b"\0\0\7") == {"a": [{}, {}], "x": 7}


@pytest.mark.parametrize("array", ["[4]", "[]"])
def test_elements_of_arrays_count_as_those_of_sequences(
    monkeypatch: pytest.MonkeyPatch, array: str
) -> None:
    name = "evil_msgs/msg/Few"
    register(name, msg(f"Nothing{array} a\nuint8 x", Nothing=""))
    cdr = encode(name, {"a": [{}] * 4, "x": 9})
    assert decode(name, cdr).x == 9
    monkeypatch.setattr(cdr_module, "MAX_ELEMENTS", 3)
    for read in (decode, to_values):
        with pytest.raises(MessageError, match="more than 3 elements"):
            read(name, cdr)


def test_stamps_behind_too_many_elements_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    name = "evil_msgs/msg/Late"
    register(name, msg("Nothing[4] a\ntime at", Nothing=""))
    cdr = encode(name, {"at": {"sec": 5}})
    assert decode(name, shifted(name, cdr, 10**9)).at.sec == 6
    monkeypatch.setattr(cdr_module, "MAX_ELEMENTS", 3)
    assert shifted(name, cdr, 10**9) == cdr


def test_elements_count_as_the_objects_that_their_bytes_do_not_pay_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    name = "evil_msgs/msg/Wrapped"
    register(name, msg("A[] a", A="B b", B="C c", C="uint8 x"))
    cdr = encode(name, {"a": [{}] * 4})
    monkeypatch.setattr(cdr_module, "MAX_ELEMENTS", 12)
    assert len(decode(name, cdr).a) == 4
    monkeypatch.setattr(cdr_module, "MAX_ELEMENTS", 11)
    with pytest.raises(DecodeError, match="more than 11 elements"):
        decode(name, cdr)
    poses = [{}] * 11
    odometry = "evil_msgs/msg/Tracks"
    register(odometry, "geometry_msgs/PoseWithCovarianceStamped[] a")
    assert len(decode(odometry, encode(odometry, {"a": poses})).a) == 11


def test_a_type_does_not_grow_by_one_that_another_definition_replaces() -> None:
    first, second = "evil_msgs/msg/First", "evil_msgs/msg/Second"
    register(first, msg("Part[50000] a", Part="uint8 x"))
    assert len(message_class(first)().a) == 50_000
    register(second, msg("Part a", Part="Piece[1000] b", Piece="uint8 x"))
    for use in (message_class, fields, definition, encode, lambda name: decode(name, CDR)):
        with pytest.raises(DefinitionError, match="fixed arrays of more than 100000 elements"):
            use(first)
    register(first, msg("Part[2] a", Part="uint8 x"))
    with pytest.raises(DefinitionError, match="cannot contain itself"):
        register(second, msg("Part a", Part="First b"))
    register(second, msg("uint8 x", Part="First b"))
    assert message_class(first)().a[0].x == 0, "types that are in no message of it are not taken"


def test_a_definition_that_is_refused_changes_nothing() -> None:
    name = "evil_msgs/msg/Steady"
    register(name, msg("Inner a", Inner="uint8 x"))
    with pytest.raises(DefinitionError):
        register(name, msg("Inner[60000] a\nInner[60000] b", Inner="float64 y"))
    assert fields("evil_msgs/msg/Inner")[0].base == "uint8"
    assert decode(name, CDR + b"\5").a.x == 5


def test_a_message_that_takes_the_rest_of_the_stack_is_refused() -> None:
    register(NAME, READ["64 levels"])
    cdr = CDR + struct.pack("<I", 1) * 64

    def at(levels: int) -> Any:
        return at(levels - 1) if levels else decode(NAME, cdr)

    assert decode(NAME, cdr).e
    with pytest.raises(DecodeError, match="too large for the stack"):
        at(sys.getrecursionlimit() - 150)


def test_elements_without_bytes_are_limited_in_ros_1() -> None:
    nothings = msg("A[] a", A="Nothing[] b", Nothing="")
    data = struct.pack("<I", 5000) + struct.pack("<I", 20_000) * 5000
    arrays = msg("A[] a", A="Nothing[99999] b", Nothing="")
    lists = {f"A{i}": f"A{i + 1} a\nA{i + 1} b" for i in range(12)}
    for text, bytes_ in (
        (nothings, data),
        (arrays, struct.pack("<I", 10_000) + bytes(10_000)),
        (msg("A0[] a", **lists, A12=""), struct.pack("<I", 10_000) + bytes(10_000)),
    ):
        with bounded(), pytest.raises(DecodeError, match="more than 2000000 elements"):
            Ros1Type(NAME, text).to_cdr(bytes_)


@pytest.mark.parametrize("what", [name for name in ALL if "IDL" not in ALL[name][:200]])
def test_definitions_of_ros_1_are_bounded_as_others(what: str) -> None:
    began_s = time.process_time()
    with bounded():
        if what in READ or what == "many types":  # made once, not per type
            Ros1Type(NAME, ALL[what])
        else:
            with pytest.raises(DefinitionError):
                Ros1Type(NAME, ALL[what])
    assert time.process_time() - began_s < 5.0


def test_many_long_definitions_are_read_in_seconds() -> None:
    fields_ = [f"field_with_a_long_name_{number}" for number in range(1200)]
    plain = "".join(f"float64 {name} # m\n" for name in fields_)
    typed = idl(f"struct Evil {{ {' '.join(f'double {name};' for name in fields_)} }};")
    constants = "".join(f"int32 CONSTANT_{number}={number}\n" for number in range(60_000))
    assert min(len(plain), len(typed)) > 40_000
    began_s = time.process_time()
    for _ in range(100):
        add(NAME, plain, ())
        add(NAME, typed, ())
    types_in_msg(constants, NAME)
    assert time.process_time() - began_s < 10.0


def test_texts_are_read_as_rosbags_reads_them() -> None:
    store = get_typestore(Stores.ROS2_JAZZY)
    texts = {name: definition(name) for name in store.fielddefs if "/msg/" in name}
    ours = {name: definitions.text(name) for name in OURS}
    odd = (
        'int32 A=5\nstring B = "x y" # c\nfloat32 C=1.5e3 # d\nbool D=True\nint8[<=3] a\n'
        "string<=5[2] b [1,2]\n@key\n@optional int8 x 5\n int32 Z=0x1F\nint8 Y=-017\nint8 W=0b11\n"
        "string E=foo # bar \nbyte Q=1\nuint8 c#c\nint8 U=09\ntime t\nduration[] d\nHeader header\n"
        "foo/Bar[3] x1\nfoo/msg/Bar[] x2\n"
    )
    for name, text in {**texts, **ours, NAME: odd}.items():
        assert types_in_msg(text, name) == get_types_from_msg(text, name), name
    words = {"bool": "boolean", "byte": "octet", "float32": "float", "float64": "double"}

    def one(described: Any) -> str:
        kind, value = described
        if kind == Nodetype.NAME:
            return value.replace("/", "::")
        base, most = value
        return words.get(str(base), str(base)) + (f"<{most}>" if most else "")

    def member(name: str, described: Any) -> str:
        kind, value = described
        if kind == Nodetype.ARRAY:
            return f"{one(value[0])} {name}[{value[1]}];"
        if kind == Nodetype.SEQUENCE:
            most = f", {value[1]}" if value[1] else ""
            return f"sequence<{one(value[0])}{most}> {name};"
        return f"{one(described)} {name};"

    for name, (_, own) in store.fielddefs.items():
        package, folder, short = name.split("/")
        members = " ".join(member(*each) for each in own)
        text = f"module {package} {{ module {folder} {{ struct {short} {{ {members} }}; }}; }};"
        assert types_in_idl(text) == get_types_from_idl(text), name
    odd = (
        "module a { typedef double D[9]; typedef string<5> T; const long N = 3 + 1; module msg {"
        ' module X_Constants { const unsigned long long M = 4 << 2; const string S = "a" "b";'
        " const boolean B = TRUE; const float F = -1.5; const long O = 017; };\n"
        '@verbatim (language="comment", text="a" "b (")\n'
        "struct X { D d; long e[N], f; @default (value=5) T t[2]; sequence<T> u; // c\n"
        " sequence<string<7>, 4> v; unsigned short w; b::msg::Y y; Z z; long long ll; /* d */"
        " ::a::D g; wstring<4> ws; }; struct Z { X x; }; }; };"
    )
    assert types_in_idl(odd) == get_types_from_idl(odd)


def test_definitions_come_in_by_one_door_only() -> None:
    folder = Path(typestore.__file__).parents[2]
    assert folder.name == "webviz"
    for path in folder.rglob("*.py"):
        text = path.read_text()
        assert not re.search(r"get_types_from|IDLParser|MSGParser", text), path
        if path.name != "typestore.py":
            assert not re.search(r"\btypes_in_(?:msg|idl)\(", re.sub(r"def types_in", "", text)), (
                path
            )


def test_a_refused_type_is_not_known() -> None:
    name = "evil_msgs/msg/Never"
    with pytest.raises(DefinitionError):
        register(name, "uint8 x\nuint8 x")
    assert not type_exists(name)
