"""Reading of IDL, as ROS 2 and DDS describe messages, in time that grows with its length alone.

Of OMG IDL 4.2 these are the modules, constants, structures and type definitions of rosidl:
https://design.ros2.org/articles/idl_interface_definition.html. Annotations and enumerations are
skipped.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Mapping
from typing import NamedTuple

from rosbags.interfaces import Nodetype

from webviz.data.messages.msg_text import (
    MAX_DIGITS,
    MAX_NAME,
    MAX_SIZE,
    Description,
    One,
    TextError,
    Types,
    Value,
    integer,
)

MAX_DEPTH = 16
"""Modules within modules, and brackets within brackets."""
MAX_TOKENS = 200_000
"""Words and signs, which take half a second; those of ROS have a tenth of them."""
_PREPROCESSOR = re.compile(r"^[ \t]*#.*$", re.MULTILINE)
"""Lines that are not read; what they include follows in the definition."""
_TOKEN = re.compile(
    r"""\s+|//[^\n]*|/\*[\s\S]*?\*/
    |(?P<token>(?:::)?[A-Za-z]\w*(?:::[A-Za-z]\w*)*
    |(?:[0-9]+\.[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|[0-9]+[eE][+-]?[0-9]+
    |0[xX][0-9a-fA-F]+|[0-9]+
    |"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])'|<<|/(?!\*)|[{}()\[\]<>;,=:@+*%&^|~-])""",
    re.ASCII | re.VERBOSE,
)
_NUMBERS = {
    "boolean": "bool",
    "octet": "byte",
    "char": "char",
    "wchar": "wchar",
    "float": "float32",
    "double": "float64",
    "long double": "float128",
    "short": "int16",
    "long": "int32",
    "long long": "int64",
    "unsigned short": "uint16",
    "unsigned long": "uint32",
    "unsigned long long": "uint64",
    **{f"{sign}int{bits}": f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)},
}
_OPERATORS: Mapping[str, tuple[int, Callable[[int, int], int]]] = {
    "|": (1, operator.or_),
    "^": (2, operator.xor),
    "&": (3, operator.and_),
    "<<": (4, operator.lshift),
    ">>": (4, operator.rshift),
    "+": (5, operator.add),
    "-": (5, operator.sub),
    "*": (6, operator.mul),
    "/": (6, operator.floordiv),
    "%": (6, operator.mod),
}
"""Precedence and function."""
_UNARY = 7
_LARGEST = 1 << 64
"""Number above all integers, those within expressions included."""


class _Kind(NamedTuple):
    """A type.

    Args:
        one: description of one value.
        size: None for one, 0 for a sequence, else the length of an array.
        most: of a sequence, 0 for any number.
    """

    one: One
    size: int | None = None
    most: int = 0

    def described(self) -> Description:
        """Return the description of a field."""
        if self.size is None:
            return self.one
        if self.size:
            return Nodetype.ARRAY, (self.one, self.size)
        return Nodetype.SEQUENCE, (self.one, self.most)


def types_in_idl(text: str) -> Types:
    """Return the structures in one IDL file.

    Raises:
        TextError: the text is invalid.
    """
    return _Reader(_tokens(_PREPROCESSOR.sub("", text))).types()


def _tokens(text: str) -> list[str]:
    tokens: list[str] = []
    at = 0
    while at < len(text):
        if (match := _TOKEN.match(text, at)) is None:
            raise TextError(f"it is unclear at character {at}")
        if token := match["token"]:
            tokens.append(token)
            if len(tokens) > MAX_TOKENS:
                raise TextError(f"it has more than {MAX_TOKENS} words and signs")
        at = match.end()
    tokens.append("")
    return tokens


class _Reader:
    """Reads the tokens of a file, the last of which is "" and never taken."""

    def __init__(self, tokens: list[str]) -> None:
        self._tokens = tokens
        self._at = 0
        self._scope: list[str] = []
        self._types: Types = {}
        self._aliases: dict[str, _Kind] = {}
        self._constants: dict[str, Value] = {}
        self._by_scope: dict[str, list[tuple[str, str, Value]]] = {}

    def types(self) -> Types:
        """Return the structures."""
        while self._peek():
            self._definition()
        if self._scope:
            raise TextError("a module does not end")
        return self._types

    def _definition(self) -> None:
        self._skip_annotations()
        match self._take():
            case "module":
                self._scope.append(self._name())
                if len(self._scope) > MAX_DEPTH:
                    raise TextError(f"modules are nested deeper than {MAX_DEPTH} levels")
                self._expect("{")
            case "}" if self._scope:
                self._scope.pop()
                self._expect(";")
            case "const":
                self._constant()
                self._expect(";")
            case "struct":
                self._struct()
                self._expect(";")
            case "typedef":
                for name, kind in self._declared():
                    self._aliases[self._full(name)] = kind
                self._expect(";")
            case "enum":
                self._name()
                self._skip("{", "}")
                self._expect(";")
            case other:
                raise TextError(f"{_excerpt(other)} is not a definition")

    def _constant(self) -> None:
        kind = self._kind()
        base, detail = kind.one
        name = self._name()
        self._expect("=")
        value = self._expression(0, 0)
        if kind.size is not None or base != Nodetype.BASE:
            raise TextError(f"the constant {_excerpt(name)} is not of a basic type")
        self._constants[self._full(name)] = value
        own = self._by_scope.setdefault("/".join(self._scope), [])
        own.append((name, str(detail[0]), value))

    def _struct(self) -> None:
        name = self._full(self._name())
        if self._peek() == ";":  # declared before it is defined
            return
        self._expect("{")
        fields: list[tuple[str, Description]] = []
        while self._peek() != "}":
            self._skip_annotations()
            fields += [(field, kind.described()) for field, kind in self._declared()]
            self._expect(";")
        self._expect("}")
        self._types[name] = self._by_scope.get(f"{name}_Constants", []), fields

    def _declared(self) -> list[tuple[str, _Kind]]:
        """Read a type, and the names that have it."""
        kind = self._kind()
        declarations: list[tuple[str, _Kind]] = []
        while True:
            name, own = self._name(), kind
            if self._peek() == "[":
                self._take()
                own = _sized(kind, self._size(1))
                self._expect("]")
            declarations.append((name, own))
            if self._peek() != ",":
                return declarations
            self._take()

    def _kind(self) -> _Kind:
        """Read a type."""
        token = self._take()
        if token in ("string", "wstring"):
            return _Kind((Nodetype.BASE, (token, self._bound())))
        if token == "sequence":
            self._expect("<")
            if self._peek() == "sequence":
                raise TextError("sequences of sequences are unsupported")
            kind, most = self._kind(), 0
            if kind.size is not None:
                raise TextError("sequences of sequences are unsupported")
            if self._peek() == ",":
                self._take()
                most = self._size(1)
            self._expect(">")
            return _Kind(kind.one, 0, most)
        while (longer := f"{token} {self._peek()}") in _NUMBERS:
            token = longer
            self._take()
        if token in _NUMBERS:
            return _Kind((Nodetype.BASE, (_NUMBERS[token], 0)))
        return self._referred(token)

    def _referred(self, token: str) -> _Kind:
        """Return the type of a name."""
        if not token[:1].isalpha() and not token.startswith("::"):
            raise TextError(f"{_excerpt(token)} is not a type")
        name = token.replace("::", "/")
        if len(name) > MAX_NAME:
            raise TextError(f"a name has more than {MAX_NAME} characters")
        for candidate in self._candidates(name):
            if candidate in self._aliases:
                return self._aliases[candidate]
            if candidate in self._types:
                return _Kind((Nodetype.NAME, candidate))
        return _Kind((Nodetype.NAME, name.lstrip("/") if "/" in name else self._full(name)))

    def _candidates(self, name: str) -> list[str]:
        """Return what a name may mean, the innermost first."""
        if name.startswith("/"):
            return [name[1:]]
        scopes = ["/".join(self._scope[:count]) for count in range(len(self._scope), 0, -1)]
        return [*(f"{scope}/{name}" for scope in scopes), name]

    def _bound(self) -> int:
        """Read the bound of a string, 0 without one."""
        if self._peek() != "<":
            return 0
        self._take()
        size = self._size(1)
        self._expect(">")
        return size

    def _size(self, least: int) -> int:
        value = self._expression(0, 0, is_bracketed=True)
        if not isinstance(value, int) or not least <= value <= MAX_SIZE:
            raise TextError("a size is invalid")
        return value

    def _expression(self, above: int, depth: int, is_bracketed: bool = False) -> Value:
        """Read an expression, up to an operator that binds less than the one before it.

        Args:
            above: precedence of the operator before it.
            depth: brackets around it.
            is_bracketed: between `<` and `>`, so that `>>` are two ends.
        """
        if depth > MAX_DEPTH:
            raise TextError(f"brackets are nested deeper than {MAX_DEPTH} levels")
        value = self._operand(depth)
        while True:
            symbol = self._operator(is_bracketed)
            if symbol not in _OPERATORS or _OPERATORS[symbol][0] <= above:
                return value
            precedence, apply = _OPERATORS[symbol]
            self._at += 2 if symbol == ">>" else 1
            other = self._expression(precedence, depth + 1, is_bracketed)
            value = _computed(symbol, apply, value, other)

    def _operator(self, is_bracketed: bool) -> str:
        token = self._peek()
        is_shift = token == ">" and not is_bracketed and self._tokens[self._at + 1] == ">"
        return ">>" if is_shift else token

    def _operand(self, depth: int) -> Value:
        token = self._take()
        if token in ("+", "-", "~"):
            value = self._expression(_UNARY, depth + 1)
            if isinstance(value, str) or (token == "~" and isinstance(value, float)):
                raise TextError(f"{token} applied to a value that is not a number")
            return -value if token == "-" else ~int(value) if token == "~" else value
        if token == "(":
            value = self._expression(0, depth + 1)
            self._expect(")")
            return value
        if token in ("TRUE", "FALSE"):
            return token == "TRUE"
        if token[:1] == '"':
            parts = [token[1:-1]]
            while self._peek()[:1] == '"':
                parts.append(self._take()[1:-1])
            return "".join(parts)
        if token[:1] == "'":
            return token[1:-1]
        if token[:1].isdigit() or token[:1] == ".":
            return _number(token)
        for candidate in self._candidates(token.replace("::", "/")):
            if candidate in self._constants:
                return self._constants[candidate]
        raise TextError(f"{_excerpt(token)} is not a constant")

    def _skip_annotations(self) -> None:
        while self._peek() == "@":
            self._take()
            self._take()
            if self._peek() == "(":
                self._skip("(", ")")

    def _skip(self, opening: str, closing: str) -> None:
        """Skip what is in brackets."""
        self._expect(opening)
        depth = 1
        while depth:
            token = self._take()
            depth += (token == opening) - (token == closing)

    def _full(self, name: str) -> str:
        return "/".join([*self._scope, name])

    def _name(self) -> str:
        name = self._take()
        if len(name) > MAX_NAME:
            raise TextError(f"a name has more than {MAX_NAME} characters")
        if not name.replace("_", "a").isalnum() or not name[0].isalpha():
            raise TextError(f"{_excerpt(name)} is not a name")
        return name

    def _expect(self, token: str) -> None:
        actual = self._take()
        if actual != token:
            raise TextError(f"expected {token}, got {_excerpt(actual)}")

    def _peek(self) -> str:
        return self._tokens[self._at]

    def _take(self) -> str:
        token = self._tokens[self._at]
        if not token:
            raise TextError("it ends early")
        self._at += 1
        return token


def _excerpt(token: str) -> str:
    return token[:40]


def _sized(kind: _Kind, size: int) -> _Kind:
    if kind.size is not None:
        raise TextError("arrays of arrays are unsupported")
    return kind._replace(size=size)


def _number(token: str) -> int | float:
    if len(token) > MAX_DIGITS:
        raise TextError(f"a number has more than {MAX_DIGITS} digits")
    is_whole = token.isdecimal() or token[:2] in ("0x", "0X")
    return integer(token) if is_whole else float(token)


def _computed(name: str, apply: Callable[[int, int], int], left: Value, right: Value) -> Value:
    """Return the result of an operator; integers have 64 bits at most."""
    if isinstance(left, float) and isinstance(right, float) and name in "+-*/":
        if name == "/":
            return left / right if right else float("nan")
        results = {"+": left + right, "-": left - right, "*": left * right}
        return results[name]
    if not isinstance(left, int) or not isinstance(right, int):
        raise TextError(f"{name} applied to values that are not two integers")
    if (name in ("<<", ">>") and not 0 <= right < 64) or (name in ("/", "%") and not right):
        raise TextError(f"{name} by {right}")
    value = apply(left, right)
    if abs(value) >= _LARGEST:
        raise TextError(f"the result of {name} has more than 64 bits")
    return value
