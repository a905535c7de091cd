"""Documentation of the built-in displays."""

from __future__ import annotations

import importlib
import pkgutil
import re
from typing import get_args, get_type_hints

import msgspec
import pytest

import webviz_displays
from webviz import Display, Topic


def display_classes() -> list[type[Display]]:
    modules = pkgutil.iter_modules(webviz_displays.__path__, "webviz_displays.")
    results = [
        value
        for module in modules
        for value in vars(importlib.import_module(module.name)).values()
        if isinstance(value, type) and issubclass(value, Display) and not value.__subclasses__()
    ]
    return sorted(set(results), key=lambda cls: cls.__name__)


def is_group(hint: object) -> bool:
    inner = get_args(hint)[:1]
    return bool(inner) and isinstance(inner[0], type) and issubclass(inner[0], msgspec.Struct)


@pytest.mark.parametrize("cls", display_classes())
def test_every_property_is_documented(cls: type[Display]) -> None:
    def check(struct: type[msgspec.Struct]) -> None:
        for name, hint in get_type_hints(struct, include_extras=True).items():
            if name not in struct.__struct_fields__:
                continue
            metas = [m for m in getattr(hint, "__metadata__", ()) if isinstance(m, msgspec.Meta)]
            assert any(meta.description for meta in metas), f"{struct.__name__}.{name}"
            if is_group(hint) and get_args(hint)[0] is not Topic:
                check(get_args(hint)[0])

    check(cls)
    assert cls.__doc__
    # Of classes that share a name, such as Path, webviz's say which they are.
    last = re.split("/|::", cls.rviz)[-1].replace(" ", "")
    assert cls.__name__.endswith(last)
