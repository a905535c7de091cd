"""Round trips of saved configs, for every display and every value."""

from __future__ import annotations

import functools
import math
import types
import typing
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from webviz.api.declared import make
from webviz.api.display import Display
from webviz.api.group import DisplayGroup
from webviz.api.registry import display_types
from webviz.api.views import Orbit, TopDownOrtho
from webviz.files.config import Branch, Config, Unreadable, WatchRule, document, dump
from webviz.files.config.model import Settings
from webviz.files.opening import load, parse, save

TYPES = display_types()
FIXED = ("version", "rviz")
"""Settings with unusual values."""
LIMITS = ("gt", "ge", "lt", "le", "pattern", "max_length")
TEXTS = st.text(st.characters(exclude_categories=["Cs"]), max_size=12) | st.sampled_from(
    [
        "on",
        "1e3",
        "0x10",
        "12:30",
        "~",
        "null",
        "a: b",
        "#x",
        "- y",
        "{",
        "?x",
        ":0",
        " x ",
        "=",
        "|",
    ]
)


def values_of(hint: Any, bounds: dict[str, Any]) -> st.SearchStrategy[Any]:
    """Every plain value that a property of this type may have."""
    while typing.get_origin(hint) is Annotated:
        hint, *marks = typing.get_args(hint)
        for mark in marks:
            if isinstance(mark, msgspec.Meta):
                limits = {name: getattr(mark, name) for name in LIMITS}
                bounds = bounds | {
                    name: limit for name, limit in limits.items() if limit is not None
                }
    parts = typing.get_args(hint)
    match typing.get_origin(hint) or hint:
        case types.UnionType | typing.Union:
            return st.one_of([values_of(part, {}) for part in parts])
        case types.NoneType:
            return st.none()
        case origin if origin is Literal:
            return st.sampled_from(parts)
        case origin if origin is tuple and Ellipsis in parts:
            return st.lists(values_of(parts[0], {}), max_size=3)
        case origin if origin is tuple:
            return st.tuples(*(values_of(part, {}) for part in parts)).map(list)
        case origin if origin is list:
            return st.lists(values_of(parts[0], {}), max_size=3)
        case origin if origin is dict:
            return st.dictionaries(TEXTS, values_of(parts[1], {}), max_size=3)
        case kind if kind is bool:
            return st.booleans()
        case kind if kind is str:
            texts = st.from_regex(bounds["pattern"]) if "pattern" in bounds else TEXTS
            return texts.filter(lambda text: len(text) <= bounds.get("max_length", math.inf))
        case kind if kind in (int, float):
            return numbers(kind, bounds)
    return structs(hint)


def numbers(kind: type, bounds: dict[str, Any]) -> st.SearchStrategy[Any]:
    low = bounds.get("gt", bounds.get("ge", -1e6))
    high = bounds.get("lt", bounds.get("le", 1e6))
    if kind is int:
        return st.integers(math.ceil(low) + ("gt" in bounds), math.floor(high) - ("lt" in bounds))
    return st.floats(
        low, high, exclude_min="gt" in bounds, exclude_max="lt" in bounds, allow_nan=False
    )


RULES = (
    {"display": "Scan", "status": "error", "for": "2s"},
    {"topic": "/diagnostics", "level": "warn", "name": "bad"},
    {"topic": "/scan", "rate": "<5.5"},
)
"""Rules whose keys go together."""


@functools.cache
def structs(cls: type[msgspec.Struct]) -> st.SearchStrategy[dict[str, Any]]:
    if cls is WatchRule:
        return st.sampled_from(RULES).map(dict)
    hints = typing.get_type_hints(cls, include_extras=True)
    fields = {n: values_of(hints[n], {}) for n in cls.__struct_fields__ if n not in FIXED}
    config = cls.__struct_config__
    tag: Any = {config.tag_field: st.just(config.tag)} if config.tag_field else {}
    needed = {field.name for field in msgspec.structs.fields(cls) if field.required} & fields.keys()
    always = tag | {name: fields.pop(name) for name in needed}
    return st.fixed_dictionaries(always, optional=fields)


@st.composite
def displays(draw: st.DrawFn, cls: type[Display]) -> Display:
    return make(cls, draw(structs(cls)))


def builtins(config: Config) -> Any:
    """All values of a config, defaults too."""

    def whole(item: Any) -> Any:
        if isinstance(item, Branch):
            return [whole(item.group), [whole(each) for each in item.displays]]
        if isinstance(item, Unreadable):
            return item.values
        return [type(item).__name__, msgspec.to_builtins(item)]

    return msgspec.to_builtins(config.settings), [whole(item) for item in config.displays]


@pytest.mark.parametrize("name", TYPES)
@settings(deadline=None, max_examples=15, suppress_health_check=[HealthCheck.too_slow])
@given(data=st.data())
def test_every_value_of_every_display_comes_back(name: str, data: st.DataObject) -> None:
    display = data.draw(displays(TYPES[name]))
    item = Branch(display, []) if isinstance(display, DisplayGroup) else display
    again = parse(dump(Config(displays=[item])), "x.yaml")
    assert builtins(again) == builtins(Config(displays=[item]))


@settings(deadline=None, max_examples=100)
@given(structs(Settings))
def test_all_settings_come_back(values: dict[str, Any]) -> None:
    try:
        config = Config(msgspec.convert(values, Settings))
    except msgspec.ValidationError as error:
        assume("`$.layout" not in str(error))  # panels that are named twice, or not at all
        raise
    assert builtins(parse(dump(config), "x.yaml")) == builtins(config)


def test_two_hundred_and_fifty_displays_in_groups_come_back() -> None:
    def nested(depth: int) -> Branch:
        scans = [make(TYPES["LaserScan"], {"name": f"{depth}/{i}"}) for i in range(50)]
        inner = [nested(depth - 1)] if depth else []
        return Branch(make(DisplayGroup, {"name": f"Group {depth}"}), [*scans, *inner])

    config = Config(displays=[nested(4)])
    assert builtins(parse(dump(config), "x.yaml")) == builtins(config)


def test_defaults_are_left_out() -> None:
    assert dump(Config()) == "version: 1\ndisplays: []\n"
    assert document(Config()) == {"version": 1, "displays": []}


def test_every_type_can_be_made_from_nothing_and_saved() -> None:
    for name in TYPES:
        config = parse(f"displays: [{{type: {name}}}]", "x.yaml")
        assert dump(config) == f"version: 1\ndisplays:\n- {{type: {name}}}\n"


def test_comments_at_the_beginning_stay(tmp_path: Path) -> None:
    path = tmp_path / "lab.yaml"
    head = "# yaml-language-server: $schema=webviz.schema.json\n\n# The lab.\n"
    path.write_text(f"{head}version: 1\n# gone\ndisplays:\n- type: Grid # gone\n")
    config = load(path)
    save(config, path)
    assert path.read_text() == f"{head}version: 1\ndisplays:\n- {{type: Grid}}\n"
    save(config, tmp_path / "other.yaml")
    assert (tmp_path / "other.yaml").read_text() == dump(config)


def test_views_are_written_without_defaults() -> None:
    config = Config()
    config.settings.view = Orbit(distance=3.0)
    config.settings.views = {"Above": TopDownOrtho(scale=20.0), "Start": Orbit()}
    values = document(config)
    assert values["view"] == {"distance": 3.0}
    assert values["views"] == {"Above": {"type": "TopDownOrtho", "scale": 20.0}, "Start": {}}
    assert parse(dump(config), "x.yaml").settings == config.settings
    assert "view" not in document(Config())
