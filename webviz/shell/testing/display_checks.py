"""Checks that every display should pass, derived from its declaration.

    class TestDocks(webviz.testing.DisplayChecks):
        display = Docks
        messages = {"dock_msgs/msg/Docks": {"docks": [{"name": "left"}]}}

A subclass in the test file of a display is all that they need.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from dataclasses import fields as dataclass_fields
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, get_args, get_origin, get_type_hints

import msgspec
import numpy as np
import pytest

from webviz.api.declared import Topic, set_property
from webviz.api.display import Display, inputs, inputs_of
from webviz.api.nodes import Node, has_content
from webviz.api.properties import value_at
from webviz.data.messages import encode
from webviz.data.messages.classes import DTYPES
from webviz.data.messages.typestore import MessageField, fields
from webviz.engine.pipeline.runner import NOTHING_TO_DRAW
from webviz.shell.testing.bench import DisplayBench
from webviz.shell.testing.messages import header

Values = dict[str, Any]
Case = tuple[tuple[str | int, ...], Any]
"""A place in a message, and the value that is put there."""

FARTHEST = 4e9
"""Metres, of what is drawn at most: a graphics card's float32 cannot square much more."""

LAST = "\x7f"
"""Stands for bytes that are not UTF-8."""


def extremes(field: MessageField) -> list[Any]:
    """Values for a field that is not a message itself."""
    if field.base in ("string", "wstring"):
        texts = ["", "/", LAST, "x" * 70_000, "no such frame", "\N{SNOWMAN}\n\t%s{}<b>"]
        return texts if field.size is None else [[], *([text] for text in texts), texts]
    dtype = DTYPES[field.base]
    if dtype.kind == "b":
        values = [False, True]
    elif dtype.kind == "f":
        limits = np.finfo(dtype)
        large = [float(limits.max), -float(limits.max), float(limits.smallest_subnormal)]
        values = [float("nan"), float("inf"), -float("inf"), *large, 1e12, -1.0, 0.0]
    else:
        limits = np.iinfo(dtype)
        values = sorted({int(limits.min), int(limits.max), 0, 1})
    if field.size is None:
        return values
    counts = [count for count in (0, 1, 5, 1000) if not field.most or count <= field.most]
    return [[value] * (field.size or count) for value in values for count in counts]


def cases(type_name: str, values: Values, path: tuple[str | int, ...] = ()) -> Iterator[Case]:
    """Yield an extreme value for each field of a message, those of its parts included."""
    for field in fields(type_name):
        here, value = (*path, field.name), values.get(field.name)
        if not field.is_message:
            yield from ((here, extreme) for extreme in extremes(field))
        elif field.size is None:
            yield from cases(field.base, value or {}, here)
        else:
            if not field.size:  # any number fits
                yield here, []
            for index, element in enumerate(value or ()):
                yield from cases(field.base, element, (*here, index))


def changed(values: Values, case: Case) -> Values:
    """Return the values with an extreme one in its place; a place that is gone stays gone.

    Only the parts on the way there are copied.
    """
    (*path, last), value = case
    part: Any = (copy := dict(values))
    for key in path:
        if isinstance(key, int) and key >= len(part):
            return copy
        below = part[key] if isinstance(key, int) else part.get(key, {})
        part[key] = dict(below) if isinstance(below, Mapping) else list(below)
        part = part[key]
    part[last] = value
    return copy


def send(at: DisplayBench, name: str, values: Mapping[str, Any]) -> None:
    """Publish a message for an input and let the display draw it, slow work included."""
    type_name = inputs_of(type(at.display))[name].type
    if fields(type_name)[0].base == "std_msgs/msg/Header":
        values = {"header": header("sensor", at.now_ns), **values}
    cdr = encode(type_name, values).replace(LAST.encode(), b"\xff")
    topic = next(topic.name for input, _, topic in inputs(at.display) if input == name)
    at.send_bytes(type_name, cdr, topic)
    at.turn()
    at.settle()


def faults(at: DisplayBench) -> list[str]:
    """Return violations of what must hold however odd a message is."""
    faults_seen, nodes = [], at.nodes()
    for key, node in nodes.items():
        faults_seen += [f"{key}.{name} is not finite" for name in infinite(node)]
    for key, pose in at.poses().items():
        if not np.isfinite([*pose.position, *pose.wxyz]).all():
            faults_seen.append(f"the pose of {key} is not finite")
    box = None if faults_seen else at.scene.bounds("")
    if box is not None and not np.abs([box.low, box.high]).max() < FARTHEST:
        faults_seen.append(f"it reaches to {box}")
    statuses = at.statuses()
    silent = all(level == "OK" or text == NOTHING_TO_DRAW.text for level, text in statuses.values())
    is_blank = not type(at.display).reports_only and not any(map(has_content, nodes.values()))
    if is_blank and silent:
        faults_seen.append(f"nothing is drawn, and the only status is: {statuses}")
    return faults_seen


def infinite(node: Node) -> Iterator[str]:
    """Name the fields of a node that have values which are not finite."""
    for field in dataclass_fields(node):
        value = getattr(node, field.name)
        if field.name == "ids":
            continue  # names, or numbers of items
        if isinstance(value, float | np.ndarray) and not np.isfinite(value).all():
            yield field.name


NEVER_DRAWN = ("name", "selectable")
"""Properties that show in a browser only: its list, and what the tool Select picks."""


@dataclass(frozen=True)
class Change:
    """A property that is to change what a display draws or reports.

    Args:
        path: of the property; dotted for nested ones.
        hint: its type.
        value: its value before.
        needs: other properties by path, without which it has no effect.
    """

    path: str
    hint: Any
    value: Any
    needs: dict[str, Any]

    def others(self) -> list[Any]:
        """Other values; some may be out of bounds. Names are "robot"."""
        hint, value = self.hint, self.value
        if get_origin(hint) is Literal:
            return [choice for choice in get_args(hint) if choice != value]
        if isinstance(value, bool):
            return [not value]
        if isinstance(value, int):
            candidates: list[Any] = [value * 3 + 1, value // 2]
        elif isinstance(value, float):
            candidates = [value * 3 + 50.0, value / 2]
        elif isinstance(value, Topic):
            candidates = [Topic("/somewhere_else")]
        elif isinstance(value, tuple):
            is_color = isinstance(value[0], int)
            candidates = [tuple(255 - each for each in value)] if is_color else [(1.0, 2.0, 3.0)]
        elif hint == dict[str, bool]:
            candidates = [{"robot": False}]
        else:
            assert isinstance(value, str), f"Name other values of {self.path} in `values`."
            candidates = ["robot"]
        return [each for each in candidates if each != value]


def changes(cls: type[Display]) -> Iterator[Change]:
    """Each property of a display that may show, those of nested structs included."""
    for change in _leaves(cls, cls(), "", {}):
        if change.path not in NEVER_DRAWN:
            yield change


def _leaves(struct: Any, value: Any, prefix: str, needs: dict[str, Any]) -> Iterator[Change]:
    hints = get_type_hints(struct, include_extras=True)
    for name in value.__struct_fields__:
        hint, current = hints[name], getattr(value, name)
        more = dict(needs)
        _add_condition(name, hints, prefix, more)
        if isinstance(current, msgspec.Struct) and not isinstance(current, Topic):
            yield from _leaves(type(current), current, f"{prefix}{name}.", more)
        else:
            yield Change(f"{prefix}{name}", _plain(hint), current, more)


def _add_condition(name: str, hints: dict[str, Any], prefix: str, needs: dict[str, Any]) -> None:
    """Add what a property declares as `when`."""
    for item in getattr(hints[name], "__metadata__", ()):
        if isinstance(item, msgspec.Meta) and (when := (item.extra or {}).get("when")):
            other, condition = when
            condition = condition[0] if isinstance(condition, tuple) else condition
            _add_condition(other, hints, prefix, needs)
            plain = _plain(hints[other])
            is_group = isinstance(plain, type) and issubclass(plain, msgspec.Struct)
            inner = isinstance(condition, bool) and not prefix and is_group
            needs[f"{prefix}{other}{'.value' if inner else ''}"] = condition


def _plain(hint: Any) -> Any:
    return get_args(hint)[0] if get_origin(hint) is Annotated else hint


MAX_CASES = 128
"""Largest number of cases of one message; of twice as many every other one is tried."""
LOADING_S = 60.0
PATIENCE_S = "webviz.engine.pipeline.input_subscription.PATIENCE_S"
"""Time in seconds after which a status names a missing transform; with extreme values at once."""

Benches = Callable[[Display], DisplayBench]


class DisplayChecks:
    """Tests of one display: every property shows, and no value of a message is drawn as nonsense.

    A subclass sets `display` and either `messages` or `publish`.
    """

    display: ClassVar[type[Display]]
    messages: ClassVar[Mapping[str, Values]] = {}
    """A message of each type that it reads, with which it draws something; fields left out are zero
    or empty. Each field of them is tried with extreme values."""
    variants: ClassVar[Sequence[Callable[[], Display]]] = ()
    """Displays that read extreme values; () is one with defaults."""
    values: ClassVar[Mapping[str, Sequence[Any]]] = {}
    """Other values of properties by path, where the derived ones do not show."""
    needs: ClassVar[Mapping[str, Mapping[str, Any]]] = {}
    """Properties that must be set for another one to show, besides those that `when` declares."""
    later: ClassVar[Collection[str]] = ("decay_time", "history_length")
    """Paths of properties that affect only what is received later."""
    elsewhere: ClassVar[Collection[str]] = ()
    """Paths of properties that the page acts on, or that other tests hold."""

    def publish(self, bench: DisplayBench) -> None:
        """Publish what shows every property: here `messages`, twice, in the frame `sensor`."""
        bench.transform("map", "sensor", (1.0, 2.0, 0.0), (0.0, 0.0, 0.6, 0.8))
        for _ in range(2):
            for name, spec in inputs_of(type(bench.display)).items():
                if spec.type in self.messages:
                    send(bench, name, self.messages[spec.type])

    def pytest_generate_tests(self, metafunc: pytest.Metafunc) -> None:
        """One test for each property, and for each input of each variant."""
        if "changed" in metafunc.fixturenames:
            own_changes = [
                each for each in changes(self.display) if each.path not in self.elsewhere
            ]
            metafunc.parametrize("changed", own_changes, ids=lambda each: each.path)
        if "make_display" in metafunc.fixturenames:
            metafunc.parametrize(("make_display", "name"), list(self.read_inputs()))

    @classmethod
    def read_inputs(cls) -> Iterator[Any]:
        """Each variant with each of its inputs whose messages are given."""
        for number, make in enumerate(cls.variants or (cls.display,)):
            for name, spec in inputs_of(type(make())).items():
                if spec.type in cls.messages:
                    yield pytest.param(make, name, id=f"{name}-{number}")

    def test_every_property_changes_what_is_drawn_or_reported(
        self, webviz_bench: Benches, changed: Change, tmp_path: Path
    ) -> None:
        """Other values of a property show, and the default shows what it did before."""
        needs = {**changed.needs, **self.needs.get(changed.path, {})}
        before = value_at(_display(self.display, needs), changed.path)
        others = self.other_values(replace(changed, value=before), tmp_path)
        valid = [each for each in others if _is_valid(self.display(), changed.path, each)]
        assert valid, f"Name other values of {changed.path} in `values`."
        bench = webviz_bench(_display(self.display, needs))
        self.publish(bench)
        for value in valid:
            former = _picture(bench)
            if changed.path in self.later or "show_trail=True" in str(value):
                again = webviz_bench(_display(self.display, {changed.path: value} | needs))
                self.publish(again)
                assert _picture(again) != former, f"{value} shows as {before} does"
                continue
            _set(bench, changed.path, before)
            assert _picture(bench) == former, "A display that changes unprompted proves nothing."
            _set(bench, changed.path, value)
            assert _picture(bench) != former, f"{value} shows as {before} does"
            _set(bench, changed.path, before)

    def other_values(self, changed: Change, folder: Path) -> Sequence[Any]:
        """Other values of a property; a `folder` may hold files for them."""
        return self.values.get(changed.path) or changed.others()

    def test_an_extreme_value_is_neither_drawn_as_nonsense_nor_ignored_in_silence(
        self,
        webviz_bench: Benches,
        make_display: Callable[[], Display],
        name: str,
        monkeypatch: pytest.MonkeyPatch,
    ) -> None:
        """Infinite, huge, negative and empty values of every field of a message."""
        monkeypatch.setattr(PATIENCE_S, -1.0)
        type_name = inputs_of(type(make_display()))[name].type
        all_cases = list(cases(type_name, self.messages[type_name]))
        problems = []
        for case in all_cases[:: len(all_cases) // MAX_CASES or 1]:
            bench = self.at_work(webviz_bench, make_display, name)
            send(bench, name, changed(self.messages[type_name], case))
            problems += [f"{case[0]} = {str(case[1])[:40]}: {fault}" for fault in faults(bench)]
        assert problems == []

    @classmethod
    def at_work(
        cls, benches: Benches, make_display: Callable[[], Display], name: str
    ) -> DisplayBench:
        """Return a display that has what it needs before a message for an input arrives."""
        bench = benches(make_display())
        bench.transform("map", "sensor", (1.0, 2.0, 0.0), (0.0, 0.0, 0.6, 0.8))
        for number, (other, spec) in enumerate(inputs_of(type(bench.display)).items()):
            if other != name and (number == 0 or spec.latched) and spec.type in cls.messages:
                send(bench, other, cls.messages[spec.type])
        return bench


def _is_valid(display: Display, path: str, value: Any) -> bool:
    try:
        set_property(display, path, value)
    except msgspec.ValidationError:
        return False  # out of bounds
    return True


def _display(cls: type[Display], values: Mapping[str, Any]) -> Display:
    display = cls()
    for path, value in values.items():
        set_property(display, path, value)
    return display


def _set(bench: DisplayBench, path: str, value: Any) -> None:
    """Change a property, and let slow work finish."""
    bench.set(path, value)
    deadline = time.monotonic() + LOADING_S
    bench.turn()
    while "Loading" in bench.statuses() or bench.runner.is_busy():
        assert time.monotonic() < deadline, bench.statuses()
        time.sleep(0.005)
        bench.turn()


def _picture(bench: DisplayBench) -> tuple[Any, ...]:
    """Everything a user sees but counts and ages of messages."""
    statuses = bench.statuses().items()
    own_statuses = {
        key: status for key, status in statuses if not key.startswith(("Topic", "Message"))
    }
    return bench.nodes(), bench.poses(), bench.runner.handles(), own_statuses
