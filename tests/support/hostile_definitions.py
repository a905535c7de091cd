"""Definitions of messages that are made to harm: that recurse, compute or make much of little."""

from __future__ import annotations

from collections.abc import Mapping

NAME = "evil_msgs/msg/Evil"
SEPARATOR = "=" * 80 + "\n"


def msg(text: str, **others: str) -> str:
    """Return .msg text, followed by other types of the package."""
    parts = [text, *(f"MSG: evil_msgs/{name}\n{own}" for name, own in others.items())]
    return f"\n{SEPARATOR}".join(parts)


def idl(text: str) -> str:
    """Return an IDL file with these definitions in the module of `NAME`."""
    body = f"module evil_msgs {{ module msg {{ {text} }}; }};"
    return f"{SEPARATOR}IDL: {NAME}\n{body}"


def chain(levels: int, array: str = "") -> str:
    """Return messages within messages."""
    others = {f"E{level}": f"E{level + 1}{array} e" for level in range(levels)}
    return msg(f"E0{array} e", **others, **{f"E{levels}": "uint8 x"})


def constant(value: str) -> str:
    """Return a type in IDL with a constant."""
    return idl(f"module Evil_Constants {{ const long A = {value}; }}; struct Evil {{ long x; }};")


REFUSED: Mapping[str, tuple[str, str]] = {
    "array of empty messages": (
        msg("Nothing[2000000000] a", Nothing=""),
        "fixed arrays of more than 100000 elements",
    ),
    "array of constants": (
        msg("Nothing[2000000000] a", Nothing="int32 ONE=1"),
        "fixed arrays of more than 100000 elements",
    ),
    "arrays in arrays": (
        msg("A[1000] a", A="B[1000] b", B="C[1000] c", C="uint8 x"),
        "fixed arrays of more than 100000 elements",
    ),
    "array of texts": (msg("string[4000000000] a"), "fixed arrays of more than 100000 elements"),
    "array of numbers": (msg("float64[4000000000] a"), "fixed arrays of more than 64 MB"),
    "arrays of arrays of numbers": (
        msg("A[50000] a", A="float64[50000] b"),
        "fixed arrays of more than 64 MB",
    ),
    "array without elements": (msg("uint8[0] a"), "line 1 has an invalid size"),
    "array of many digits": (msg(f"uint8[{'9' * 5000}] a"), "line 1 has an invalid size"),
    "bound of many digits": (msg(f"string<={'9' * 5000} a"), "line 1 has an invalid size"),
    "constant of many digits": (msg(f"int64 A={'9' * 5000}"), "more than 40 digits"),
    "float of many digits": (msg(f"float64 A=0.{'9' * 5000}"), "more than 40 digits"),
    "field twice": (msg("uint8 x\nuint8 x"), "has the field x twice"),
    "field three times": (msg("uint8 x\n" * 3), "has the field x twice"),
    "field twice in Python": (msg("uint8 if_\nuint8 if"), "has the field if twice"),
    "900 levels": (chain(900), "nested deeper than 64 levels"),
    "5000 levels": (chain(5000, "[]"), "nested deeper than 64 levels"),
    "levels that are known already": (
        msg(
            "A0 a\nB0 b",
            **{f"A{level}": f"A{level + 1} a" for level in range(60)},
            A60="uint8 x",
            **{f"B{level}": f"B{level + 1} b" for level in range(5)},
            B5="A0 a",
        ),
        "nested deeper than 64 levels",
    ),
    "many types": (
        msg(
            "\n".join(f"A{i} a{i}" for i in range(2000)),
            **{f"A{i}": "uint8 x" for i in range(2000)},
        ),
        "more than 1000 types",
    ),
    "long name": (msg(f"{'A' * 50_000} a"), "a name of more than 255 characters"),
    "brackets": (msg("[" * 3000), "line 1 is not a field"),
    "unfinished separator": (msg("uint8 x") + f"\n{SEPARATOR}", "does not name a type"),
    "long text": (msg("# " + "x" * (1 << 20)), "longer than 1 MB"),
    "shift": (constant("1 << 99999999999"), "<< by 99999999999"),
    "product": (constant(" * ".join(["9999999999"] * 10)), "more than 64 bits"),
    "products of products": (
        idl(
            "const long A0 = 9; "
            + " ".join(f"const long A{i + 1} = A{i} * A{i};" for i in range(60))
            + " struct Evil { long x; };"
        ),
        "more than 64 bits",
    ),
    "division": (constant("1 / 0"), "/ by 0"),
    "numbers of many digits": (constant("9" * 5000), "more than 40 digits"),
    "brackets of an expression": (constant("(" * 3000 + "1" + ")" * 3000), "deeper than 16"),
    "signs": (constant("-" * 3000 + "1"), "deeper than 16"),
    "modules": (idl("module a { " * 5000), "deeper than 16"),
    "sequences": (idl(f"struct Evil {{ {'sequence<' * 3000}"), "sequences of sequences"),
    "comments": (idl("/* x " * 100_000), "unclear at character"),
    "array of an IDL structure": (
        idl("struct Nothing { }; struct Evil { Nothing a[2000000000]; };"),
        "fixed arrays of more than 100000 elements",
    ),
    "negative size": (idl("struct Evil { long a[-5]; };"), "a size is invalid"),
    "words": (idl("@a " * 300_000), "more than 200000 words and signs"),
}
"""Definitions of `NAME` by what is wrong with them, with a part of the sentence that says so."""
READ: Mapping[str, str] = {
    "60 000 constants": msg("".join(f"int8 C{i}=1\n" for i in range(60_000)) + "uint8 x"),
    "brackets in IDL": constant("((((((1))))))"),
    "64 levels": chain(62, "[]"),
    "list of empty messages": msg("Nothing[] a", Nothing=""),
    "list of chains": msg("E0[] a", **{f"E{i}": f"E{i + 1} e" for i in range(60)}, E60="uint8 x"),
    "list of arrays of empty messages": msg("A[] a", A="Nothing[99999] b", Nothing=""),
    "many fields": msg("".join(f"uint8 a{i}\n" for i in range(19_000))),
    "constant like a field": msg("uint8 x=5\nuint8 x"),
}
"""Definitions of `NAME` that are valid, and take much to read or to use."""


def renamed(text: str, package: str) -> str:
    """Return a definition with its types in another package; a type has one definition only."""
    return text.replace("evil_msgs", package)
