"""What a display is: properties declared once, and a function from messages to nodes.

    class Heading(Display):
        \"\"\"An arrow along a pose.\"\"\"

        topic: Annotated[Topic, Input("geometry_msgs/msg/PoseStamped")] = Topic("/pose")
        length: Annotated[float, Prop(gt=0, unit="m", help="Length of the arrow.")] = 1.0

        def draw(self, sample, ctx):
            ...

One declaration of a property gives its control in the panel, its key in the config file, its check
and its place in the docs. Everything else (subscribing, transforms, history, redrawing, removing)
is the framework's.
"""

from __future__ import annotations

import functools
import math
import typing
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, TypeVar

import msgspec

if TYPE_CHECKING:
    from webviz.context import Context
    from webviz.sample import Sample

Byte = Annotated[int, msgspec.Meta(ge=0, le=255)]
Color = tuple[Byte, Byte, Byte]
"""Red, green and blue, 0 to 255."""


class Topic(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A topic and how to subscribe to it. In a config file the bare name is enough."""

    name: str = ""
    reliability: Literal["auto", "reliable", "best_effort"] = "auto"
    durability: Literal["auto", "volatile", "transient_local"] = "auto"
    depth: Annotated[int, msgspec.Meta(ge=0)] = 0
    """0 is what suits the message type."""
    filter_size: Annotated[int, msgspec.Meta(ge=1)] = 10
    """Messages that may wait for their transform."""


@dataclass(frozen=True)
class Input:
    """Marks a `Topic` property as an input of the display.

    Args:
        type: the message type, such as "sensor_msgs/msg/LaserScan". Messages with a header wait
            for the transform at their stamp.
        latched: subscribe transient local, whatever the publishers known so far offer.
        suffix: an input without a topic name listens to the first input's topic with this suffix.
        optional: nothing is amiss while nobody publishes it.
    """

    type: str
    latched: bool = False
    suffix: str = ""
    optional: bool = False


def Prop(
    *,
    help: str = "",
    unit: str = "",
    rviz: str = "",
    when: tuple[str, object] | None = None,
    widget: Literal["", "frame", "slider"] = "",
    gt: float | None = None,
    ge: float | None = None,
    lt: float | None = None,
    le: float | None = None,
) -> msgspec.Meta:
    """What is known of a property besides its type and default.

    Args:
        help: one sentence, the control's tooltip.
        unit: "m", "s", "px", ...
        rviz: RViz's name, where it is not the name in snake_case written with spaces.
        when: (property, value) on which this property has a meaning; several values as a tuple.
        widget: how to edit it, where the type alone does not tell.
        gt, ge, lt, le: bounds.
    """
    extra = {"unit": unit, "rviz": rviz, "when": when, "widget": widget}
    extra = {key: value for key, value in extra.items() if value}
    bounds: dict[str, Any] = {"gt": gt, "ge": ge, "lt": lt, "le": le}
    return msgspec.Meta(description=help or None, extra=extra, **bounds)


@dataclass(frozen=True)
class Keep:
    """How much history the framework holds for a display.

    Args:
        count: the newest samples to hold; 0 is without limit of number.
        seconds: hold what was received so recently; 0 is without limit of age.
    """

    count: int = 1
    seconds: float = 0.0


class Display(msgspec.Struct, kw_only=True, forbid_unknown_fields=True, eq=False, weakref=True):
    """Base of all displays. A subclass declares properties and overrides the hooks it needs."""

    rviz: ClassVar[str] = ""
    """The class of the counterpart in a .rviz file."""

    name: Annotated[str, msgspec.Meta(description="Shown in the list of displays.")] = ""
    enabled: Annotated[bool, msgspec.Meta(description="Draw this display.")] = True

    def history(self) -> Keep:
        """How much history to hold; every held sample stays drawn."""
        return Keep()

    def listens(self, name: str) -> bool:
        """Whether the input `name` has a meaning as the properties are; else it is not subscribed.

        What was heard before is kept.
        """
        return True

    def waits(self, name: str) -> bool:
        """Whether messages of the input `name` wait for the transform at their stamp.

        Those that do not are for a display that follows their frame; their samples have the pose
        of the frame now, or the identity while there is none.
        """
        return True

    def duration_ns(self, message: Any) -> int:
        """How long after its stamp a message goes on; transforms up to there are waited for.

        A message is decoded only when it is drawn, so this tells how long the next one waits.
        """
        return 0

    def accept(self, new: Sample, kept: Sequence[Sample]) -> bool | str:
        """Whether a new sample joins the kept ones (oldest first); text: what is wrong with it."""
        return True

    def fold(self, name: str, sample: Sample, state: Any) -> Any:
        """Merge a sample of the input `name` into `state` (None at first) and return it.

        The result becomes the message of the one sample that `draw` gets. Overriding this hook
        makes every message count: none is skipped for a newer one.
        """
        return sample.message

    def depends(self, ctx: Context) -> object:
        """What drawing depends on besides properties and messages, such as which frames are lost.

        Called on every frame of the loop; when the result is another than before, all is drawn
        anew. So a display that seldom changes draws in `draw_all` and costs little meanwhile.
        What is drawn or said here is ignored.
        """
        return None

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw one sample in its own frame; called once per sample and property change."""

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw all kept samples at once in the fixed frame (`sample.pose` tells where each is)."""

    def tick(self, ctx: Context) -> None:
        """Draw what follows transforms or time; called on every frame of the loop."""


D = TypeVar("D", bound=Display)


def overrides(display: Display, hook: str) -> bool:
    """Whether a display's class has its own version of a hook."""
    return getattr(type(display), hook) is not getattr(Display, hook)


@functools.cache
def inputs_of(cls: type[Display]) -> dict[str, Input]:
    """The inputs of a display class by property name, in the order of declaration."""
    found = {}
    for name, hint in typing.get_type_hints(cls, include_extras=True).items():
        for item in getattr(hint, "__metadata__", ()):
            if isinstance(item, Input):
                found[name] = item
    return found


def inputs(display: Display) -> list[tuple[str, Input, Topic]]:
    """Each input of a display: property name, declaration, and the topic chosen for it."""
    return [(name, spec, getattr(display, name)) for name, spec in inputs_of(type(display)).items()]


def default_name(cls: type[Display]) -> str:
    """The name a display has when nobody gave it one."""
    return cls.__name__


def make(cls: type[D], values: dict[str, Any]) -> D:
    """A display from plain values, as a config file has them.

    A topic may be its bare name. A nested setting given in part keeps the display's own defaults
    for the rest.

    Raises:
        msgspec.ValidationError: a value does not fit; the text ends with the path of the value.
    """
    defaults = {f.name: f.default for f in msgspec.structs.fields(cls)}
    merged = {key: _merge(defaults.get(key), value) for key, value in values.items()}
    display = msgspec.convert(merged, cls, strict=True)
    _check_finite(display, "$")
    if not display.name:
        display.name = default_name(cls)
    return display


def set_property(display: Display, path: str, value: Any) -> None:
    """Set one property, nested ones by a dotted path (`topic.depth`).

    Raises:
        msgspec.ValidationError: the value does not fit; nothing was changed.
        AttributeError: there is no such property.
    """
    head, _, rest = path.partition(".")
    if head not in display.__struct_fields__:
        raise AttributeError(f"{type(display).__name__} has no property {head!r}")
    whole = _replaced(getattr(display, head), rest.split(".") if rest else [], value)
    checked = make(type(display), {head: whole})
    setattr(display, head, getattr(checked, head))


def _replaced(current: Any, path: list[str], value: Any) -> Any:
    """`current` as plain values, with what lies at a path replaced."""
    plain = msgspec.to_builtins(current)
    if not path:
        return _merge(current, value)
    inner = plain if isinstance(plain, dict) else {}
    return {**inner, path[0]: _replaced(inner.get(path[0]), path[1:], value)}


def _merge(default: Any, value: Any) -> Any:
    """`value` as a whole value of the type of `default`, with what it leaves out taken from it."""
    if isinstance(default, Topic) and isinstance(value, str):
        value = {"name": value}
    if isinstance(default, msgspec.Struct) and isinstance(value, dict):
        whole = {f.name: getattr(default, f.name) for f in msgspec.structs.fields(default)}
        return msgspec.to_builtins(
            {**whole, **{key: _merge(whole.get(key), item) for key, item in value.items()}}
        )
    if isinstance(value, msgspec.Struct):
        return msgspec.to_builtins(value)
    return value


def _check_finite(value: Any, path: str) -> None:
    """YAML can say .inf and .nan, and bounds such as gt=0 let infinity through."""
    if isinstance(value, float) and not math.isfinite(value):
        raise msgspec.ValidationError(f"Expected a finite number, got {value} - at `{path}`")
    if isinstance(value, msgspec.Struct):
        for name in value.__struct_fields__:
            _check_finite(getattr(value, name), f"{path}.{name}")
    elif isinstance(value, tuple | list):
        for index, item in enumerate(value):
            _check_finite(item, f"{path}[{index}]")


def to_values(display: Display) -> dict[str, Any]:
    """The properties that differ from the defaults, as plain values for a config file."""
    defaults = msgspec.to_builtins(type(display)(name=default_name(type(display))))
    values = _difference(msgspec.to_builtins(display), defaults)
    for name in inputs_of(type(display)):
        if set(values.get(name, ())) == {"name"}:
            values[name] = values[name]["name"]
    return values


def _difference(values: dict[str, Any], defaults: dict[str, Any]) -> dict[str, Any]:
    result = {}
    for key, value in values.items():
        default = defaults.get(key)
        if isinstance(value, dict) and isinstance(default, dict):
            if difference := _difference(value, default):
                result[key] = difference
        elif value != default:
            result[key] = value
    return result
