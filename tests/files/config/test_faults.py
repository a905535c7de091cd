"""Faults that we find along the declared types are those that msgspec finds."""

import math
import re
from collections.abc import Mapping
from typing import Any

import msgspec
import pytest

from webviz.api.declared import Declared, make
from webviz.api.display import Display
from webviz.api.panel import Panel
from webviz.api.properties import properties_of
from webviz.api.registry import plugin_types
from webviz.api.tool import Tool
from webviz.api.views import Orbit
from webviz.files.config import Settings
from webviz.files.config.explain import Fault, first_fault

ODD: tuple[Any, ...] = (
    *(None, True, -1, 3, 2.5, 1e9, math.nan, math.inf, "", "a b", "x" * 300),
    *([], [1], [-1, 0, 300], ["a b"], [1, 2, 3, 4], [{}], [5], ["a"] * 1001),
    *({}, {"a": "b"}, {"a": -1}, {"a": {}}, {1: 2}, {"type": "Orbit"}, {"type": 5}),
    *({"name": 5}, {"depth": -1}, {"namespace": 3}, {"prefix": ""}, {"rate": "slow"}),
)
CLASSES = [
    *(cls for base in (Display, Tool, Panel) for cls in plugin_types(base).values()),
    Settings,
    Orbit,
]


@pytest.mark.parametrize("cls", CLASSES, ids=lambda cls: cls.__name__)
def test_each_refusal_of_msgspec_has_a_fault_at_its_place(cls: type[msgspec.Struct]) -> None:
    for path in (each.path for each in properties_of(cls)):
        for odd in ODD:
            values = {path: odd}
            refusal, fault = _refusal(cls, values), first_fault(cls, values)
            assert (refusal is None) == (fault is None), (values, refusal, fault)
            if refusal is not None and fault is not None:
                assert _is_at(fault, refusal), (values, refusal, fault)
                assert "`str`" not in fault.clause


class Needy(Display):
    """Has a property without a default."""

    size: float


class RefusedDefault(Display):
    """Refuses its own default."""

    size: float = -1.0

    def __post_init__(self) -> None:
        raise ValueError("size must be positive")


@pytest.mark.parametrize(
    ("cls", "text"),
    [(Needy, "missing required field `size`"), (RefusedDefault, "size must be positive")],
)
def test_a_class_with_invalid_defaults_is_refused_with_the_cause(
    cls: type[Display], text: str
) -> None:
    with pytest.raises(msgspec.ValidationError, match=text):
        make(cls, {})


def _refusal(cls: type[msgspec.Struct], values: dict[str, Any]) -> str | None:
    try:
        if issubclass(cls, Declared):
            make(cls, values)
        else:
            msgspec.convert(values, cls)
    except msgspec.ValidationError as error:
        return str(error)
    return None


def _is_at(fault: Fault, refusal: str) -> bool:
    """Compare the place with msgspec's, which does not name keys of mappings."""
    where = refusal.rpartition(" - at `")[2].removesuffix("`").rpartition("` in `")[2]
    steps = re.findall(r"\.(\w+)|\[(\d+)\]|(\[\.\.\.\])", where)
    results = [key or number for key, number, _ in steps]
    path = [str(key) for key in fault.path]
    if "unknown field" in refusal:  # which is the last key of ours
        path = path[:-1]
    return len(path) == len(results) and all(
        not theirs or ours == theirs for ours, theirs in zip(path, results, strict=True)
    )


@pytest.mark.parametrize(
    ("values", "clause"),
    [
        ({"background": 5}, "expected a list of 3 numbers, got 5"),
        ({"robots": [5]}, "expected text or keys such as `namespace:`, got 5"),
        ({"robots": [{"prefix": "a"}]}, "the key `namespace` is missing"),
        ({"watch": [{"display": "Map"}]}, "a rule is one condition."),
        ({"views": {1: {}}}, 'expected text as keys, such as "0":'),
        ({"bookmarks": {"a": "b"}}, "expected a number, got `b`"),
        ({"watch": [{"status": "bad"}]}, "expected warn or error, got `bad`"),
    ],
)
def test_a_clause_names_the_expected_value(values: Mapping[str, Any], clause: str) -> None:
    fault = first_fault(Settings, values)
    assert fault
    assert fault.clause.startswith(clause)
