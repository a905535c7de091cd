"""The base class of displays: declared properties, and a function from messages to nodes.

    class Heading(Display):
        \"\"\"An arrow along a pose.\"\"\"

        topic: Annotated[Topic, Input("geometry_msgs/msg/PoseStamped")] = Topic("/pose")
        length: Annotated[float, Prop(gt=0, unit="m", help="Length of the arrow.")] = 1.0

        def draw(self, sample, ctx):
            ...

A property is declared once, for the panel, config files, validation and docs. Subscriptions,
transforms, history, redrawing and removal are up to the framework.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeVar

import msgspec

from webviz.api.capabilities import Selective, capability
from webviz.api.declared import Declared, Topic
from webviz.api.lookback import Lookback
from webviz.api.picking import Details, Hit, noun_of
from webviz.api.ports import Input, Namespace
from webviz.api.properties import ports_of

if TYPE_CHECKING:
    from webviz.api.context import Context
    from webviz.api.sample import Sample


@dataclass(frozen=True, init=False)
class Sync:
    """Inputs whose messages are drawn together, matched by stamp.

        sync = Sync("image", "info")

    A set is one sample: that of the first input, with the others in `Sample.synced`. Its pose is
    that of the first input's message. Each message waits for its own transform first, unless
    `Display.waits` returns False. Inputs that the display does not listen to are ignored, as are
    optional ones until their first message.

    Args:
        inputs: at least two; their message types have a header.
        slop: maximum difference of the stamps of a set in seconds; 0 is equal stamps. These are
            message_filters' ExactTime and the Python version of its ApproximateTime.
        queue_size: waiting messages per input.
    """

    inputs: tuple[str, ...]
    slop: float
    queue_size: int

    def __init__(self, *inputs: str, slop: float = 0.0, queue_size: int = 10) -> None:
        if len(set(inputs)) < 2 or len(set(inputs)) < len(inputs):
            raise ValueError("a Sync needs at least two different inputs")
        if not 0 <= slop < math.inf or queue_size < 1:
            raise ValueError("a Sync needs a slop of at least 0 s and a queue_size of at least 1")
        object.__setattr__(self, "inputs", inputs)
        object.__setattr__(self, "slop", slop)
        object.__setattr__(self, "queue_size", queue_size)


@dataclass(frozen=True)
class Keep:
    """Amount of history the framework holds for each input of a display.

    Args:
        count: number of newest samples to hold; 0 is unlimited.
        seconds: maximum time since arrival; 0 is unlimited.
    """

    count: int = 1
    seconds: float = 0.0


class Display(Declared, kw_only=True):
    """Base of all displays. A subclass declares properties and overrides the hooks it needs.

    What few displays need are capabilities, base classes of their own: `webviz.api.capabilities`.
    """

    kind = "display"

    icon: ClassVar[str] = "plug"
    """An icon of the page by name, or one of its own: the path of an SVG of 24 x 24 units, drawn by
    lines, such as "M4 12h16"."""

    is_threaded: ClassVar[bool] = False
    """True if `fold` and `draw` run in a thread for large messages, while the frame loop goes on.

    They then get a copy of the display, must not change what they are given, and must use neither
    `ctx.frames` nor `ctx.background`. The previous result stays until the new one is there, and
    `draw` skips messages for newer ones.
    """
    slow_bytes: ClassVar[int] = 8_000_000
    """Size in bytes from which a message is large: it takes longer than the way to a thread and
    back. Large messages that are folded are decoded in a thread even if `is_threaded` is False."""
    has_pane: ClassVar[bool] = False
    """True if it draws a `webviz.Pane`, for which pages keep a place beside the scene."""
    reports_only: ClassVar[bool] = False
    """True if its statuses are all that it shows; others warn if they have drawn nothing."""
    sync: ClassVar[Sync | None] = None
    """Inputs that are drawn together; others are drawn as their messages arrive."""

    offered_for: ClassVar[Namespace | None] = None
    """Topics that Add by topic offers it for, besides those of its inputs."""

    name: Annotated[str, msgspec.Meta(description="Shown in the list of displays.")] = ""
    enabled: Annotated[bool, msgspec.Meta(description="Draw this display.")] = True

    def new_state(self) -> Any:
        """Return the state to keep between calls, any object; available as `ctx.state`.

        Called before the first hook that gets a context, and after each reset.
        """
        return None

    def history(self) -> Keep:
        """Return the amount of history to hold; all held samples stay drawn.

        By default as many as a property `history_length` says, else the newest.
        """
        return Keep(count=getattr(self, "history_length", 1))

    def lookback(self, name: str) -> Lookback:
        """Return which past messages of the input `name` make up what is shown.

        A seek in a recording reads these instead of all from the beginning. By default those that
        `history` holds; all if it has `fold` or `accept`.
        """
        if overrides(self, "fold") or capability(self, Selective):
            return Lookback()
        keep = self.history()
        return Lookback(keep.count, keep.seconds)

    def listens(self, name: str) -> bool:
        """Return whether to subscribe to the input `name`, given the properties.

        Samples received before are kept.
        """
        return True

    def waits(self, name: str) -> bool:
        """Return whether messages of the input `name` wait for the transform at their stamp.

        A display that follows the frame itself returns False; its samples have the current pose
        of the frame, or the identity without one.
        """
        return True

    def fold(self, name: str, sample: Sample, state: Any) -> Any:
        """Return `state`, None at first, with a sample of the input `name` merged into it.

        The result becomes the message of the only sample that `draw` gets. If this hook is
        overridden, no message is skipped for a newer one.
        """
        return sample.message

    def depends(self, ctx: Context) -> object:
        """Return what drawing depends on besides properties and messages, such as the lost frames.

        Called on every turn of the frame loop; everything is redrawn when the result changes. So a
        display that seldom changes can draw in `draw_all` at little cost. Nodes and statuses
        added here are ignored.
        """
        return None

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw one sample in its own frame; called once per sample and property change.

        A display with several inputs gets the newest sample of each; `sample.input` names it.
        """

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw all kept samples of all inputs at once, oldest first, in the fixed frame.

        `sample.pose` is the pose of each.
        """

    def tick(self, ctx: Context) -> None:
        """Draw what depends on transforms or time; called on every turn of the frame loop."""

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return the details of a selected item; None if it does not exist any more.

        The name of the display, the frame, the stamp and the position are added. Called again twice
        a second while a browser shows the selection; nodes and statuses added to `ctx` are ignored.
        """
        noun = noun_of(hit.node)
        return Details(noun if hit.id is None else f"{noun} {hit.id}")


D = TypeVar("D", bound=Display)


def overrides(display: Display, hook: str) -> bool:
    """Return whether a display overrides a hook."""
    return getattr(type(display), hook) is not getattr(Display, hook)


@functools.cache
def inputs_of(cls: type[Display]) -> dict[str, Input]:
    """Return the inputs of a display class by property name, in the order of declaration.

    Raises:
        TypeError: its `sync` names something that is not an input.
    """
    inputs = {name: port for name, port in ports_of(cls).items() if isinstance(port, Input)}
    for name in cls.sync.inputs if cls.sync else ():
        if name not in inputs:
            raise TypeError(f"{cls.__name__}.sync: '{name}' is not an input of the display")
    return inputs


def inputs(display: Display) -> list[tuple[str, Input, Topic]]:
    """Each input of a display: property name, declaration, and the topic chosen for it."""
    return [(name, spec, getattr(display, name)) for name, spec in inputs_of(type(display)).items()]
