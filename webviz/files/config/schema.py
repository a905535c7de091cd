"""The JSON Schema of config files, with which editors complete and check them.

It follows draft 7, which the YAML language servers of editors support best. It accepts displays,
tools and panels of types that are not installed, since plug-ins add types; webviz reports unknown
types on opening.
"""

from __future__ import annotations

import inspect as python
from collections.abc import Mapping
from typing import Any

import msgspec
from msgspec import inspect

from webviz.api.declared import Declared, Topic
from webviz.api.display import Display
from webviz.api.group import DisplayGroup
from webviz.api.panel import Panel
from webviz.api.properties import Property, properties_of
from webviz.api.tool import Tool
from webviz.files.config.model import VERSION, Settings

Schema = dict[str, Any]

DRAFT = "http://json-schema.org/draft-07/schema#"
DEFINITION = "#/definitions/"
_BOUNDS = {
    "ge": "minimum",
    "gt": "exclusiveMinimum",
    "le": "maximum",
    "lt": "exclusiveMaximum",
    "min_length": "minLength",
    "max_length": "maxLength",
    "pattern": "pattern",
}


def schema(
    displays: Mapping[str, type[Display]],
    tools: Mapping[str, type[Tool]],
    panels: Mapping[str, type[Panel]],
) -> Schema:
    """Return the JSON Schema of a config file.

    Args:
        displays: display classes by the name each has in config files.
        tools, panels: their classes in the same way.
    """
    schemas = _Schemas()
    top = schemas.properties(Settings)
    top["version"] = {**top["version"], "minimum": VERSION, "maximum": VERSION}
    top["displays"] = _list_of(Display, "Displays, in the order of the list.")
    top["tools"] = _list_of(Tool, "The toolbar; without this key, all tools that are installed.")
    top["panels"] = _list_of(
        Panel, "Additional tabs; without this key, those of all installed plug-ins."
    )
    schemas.add(Display, displays)
    schemas.add(Tool, tools)
    schemas.add(Panel, panels)
    return {
        "$schema": DRAFT,
        "title": "webviz",
        "description": _words(Settings),
        "type": "object",
        "additionalProperties": False,
        "properties": top,
        "definitions": dict(sorted(schemas.definitions.items())),
    }


def _list_of(base: type[Declared], description: str) -> Schema:
    items = {"$ref": DEFINITION + base.kind}
    return {"description": description, "type": ["array", "null"], "items": items}


def _any(base: type[Declared], types: Mapping[str, type[Declared]], name: Schema) -> Schema:
    """Return an entry of a list.

    Only what its type says is checked, so that errors are about that.
    """
    named = [{"const": name, "description": _words(cls)} for name, cls in types.items()]
    schema: Schema = {
        "type": "object",
        "required": ["type"],
        "properties": {
            "type": {
                "description": f"What kind of {base.kind} this is.",
                "anyOf": [*named, {"type": "string"}],
            },
            "name": name,
        },
    }
    if types:  # an empty list is not valid here
        schema["allOf"] = [
            {
                # What is kept of RViz has the name of RViz's class as its type.
                "if": {
                    "required": ["type"],
                    "properties": {"type": {"const": name}},
                    "not": {"required": ["rviz"]},
                },
                "then": {"$ref": DEFINITION + _definition(base, name)},
            }
            for name in types
        ]
    return schema


def _definition(base: type[Declared], name: str) -> str:
    """Return a display and a tool may have the same name; those of displays stand alone."""
    return name if base is Display else f"{base.kind}.{name}"


class _Schemas:
    """Schemas of types; those of structs stand in the definitions, each once."""

    def __init__(self) -> None:
        self.definitions: dict[str, Schema] = {}

    def add(self, base: type[Declared], types: Mapping[str, type[Declared]]) -> None:
        """Define the entries of a list of displays, tools or panels."""
        for name, cls in types.items():
            properties = {"type": {"const": name}, **self.properties(cls)}
            if cls is DisplayGroup:
                inner = _list_of(Display, "Contents of the group, in the order of the list.")
                properties["displays"] = inner
            self.definitions[_definition(base, name)] = _object(properties, _words(cls))
        self.definitions[base.kind] = _any(base, types, self.properties(base)["name"])

    def properties(self, cls: type[msgspec.Struct]) -> dict[str, Schema]:
        return {each.path: self._property(each) for each in properties_of(cls)}

    def _property(self, declared: Property) -> Schema:
        schema = self._type(declared.type)
        words = [declared.help] if declared.help else []
        if declared.unit:
            words.append(f"In {declared.unit}.")
        for path, values in declared.when[:1]:
            texts = [msgspec.json.encode(value).decode() for value in values]
            words.append(f"Where {path} is {' or '.join(texts)}.")
        if words:
            schema = {**schema, "description": " ".join(words)}
        default = declared.default
        if default is not msgspec.NODEFAULT and default not in ("", {}, []):
            is_name = isinstance(default, Topic) and default == Topic(default.name)
            plain = default.name if is_name else msgspec.to_builtins(default)
            schema = {**schema, "default": plain}
        return schema

    def _type(self, type_: inspect.Type) -> Schema:
        match type_:
            case inspect.Metadata(type=inner):
                return self._type(inner)
            case inspect.LiteralType(values=choices):
                return {"enum": list(choices)}
            case inspect.StructType(cls=cls):
                return {"allOf": [self._reference(type_)], "description": _words(cls)}
            case inspect.UnionType(types=types):
                return {"anyOf": [self._type(each) for each in types]}
            case inspect.TupleType(item_types=items):
                size = {"minItems": len(items), "maxItems": len(items)}
                return {"type": "array", "items": self._type(items[0]), **size}
            case inspect.ListType(item_type=item) | inspect.VarTupleType(item_type=item):
                most = {} if type_.max_length is None else {"maxItems": type_.max_length}
                return {"type": "array", "items": self._type(item), **most}
            case inspect.DictType(value_type=value):
                return {"type": "object", "additionalProperties": self._type(value)}
            case inspect.AnyType():
                return {}
        return {"type": _JSON_TYPES[type(type_)], **_bounds(type_)}

    def _reference(self, type_: inspect.StructType) -> Schema:
        name = f"{type_.cls.__module__}.{type_.cls.__qualname__}"
        if name not in self.definitions:
            self.definitions[name] = {}  # a struct may hold its own kind
            properties = self.properties(type_.cls)
            if type_.tag_field:
                properties = {type_.tag_field: {"const": type_.tag}, **properties}
            reference = _object(properties, _words(type_.cls))
            if type_.cls is Topic:  # the bare name is enough
                reference = {"anyOf": [{"type": "string"}, reference]}
            self.definitions[name] = reference
        return {"$ref": DEFINITION + name}


_JSON_TYPES: dict[type, str] = {
    inspect.BoolType: "boolean",
    inspect.IntType: "integer",
    inspect.FloatType: "number",
    inspect.StrType: "string",
    inspect.NoneType: "null",
}


def _bounds(type_: Any) -> Schema:
    limits = {word: getattr(type_, name, None) for name, word in _BOUNDS.items()}
    return {word: limit for word, limit in limits.items() if limit is not None}


def _object(properties: dict[str, Schema], description: str) -> Schema:
    return {
        "type": "object",
        "description": description,
        "additionalProperties": False,
        "properties": properties,
    }


def _words(cls: type) -> str:
    """Return the first paragraph of a docstring."""
    return " ".join((python.getdoc(cls) or "").partition("\n\n")[0].split())
