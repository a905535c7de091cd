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
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeVar

import msgspec

from webviz.api.declared import Declared, Topic
from webviz.api.ports import Input
from webviz.api.properties import properties_of

if TYPE_CHECKING:
    from webviz.api.context import Context
    from webviz.api.sample import Sample


@dataclass(frozen=True, init=False)
class Sync:
    """Inputs whose messages are drawn together, matched by stamp.

        sync = Sync("image", "info")

    A set is one sample: that of the first input, with the others in `Sample.synced`. It is placed
    where the first input's message is. Each message waits for its own transform first, unless
    `Display.waits` says otherwise. Inputs that the display does not listen to are left out, and
    optional ones until a message arrives on them.

    Args:
        inputs: at least two; their message types have a header.
        slop: seconds by which the stamps of a set may differ; 0 is equal stamps. These are
            message_filters' ExactTime and the Python version of its ApproximateTime.
        queue_size: messages per input that may wait for the others.
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
    """How much history the framework holds for each input of a display.

    Args:
        count: the newest samples to hold; 0 is without limit of number.
        seconds: hold what was received so recently; 0 is without limit of age.
    """

    count: int = 1
    seconds: float = 0.0


class Display(Declared, kw_only=True):
    """Base of all displays. A subclass declares properties and overrides the hooks it needs."""

    kind = "display"

    sync: ClassVar[Sync | None] = None
    """Inputs that are drawn together; the others are drawn as they come."""

    name: Annotated[str, msgspec.Meta(description="Shown in the list of displays.")] = ""
    enabled: Annotated[bool, msgspec.Meta(description="Draw this display.")] = True

    def new_state(self) -> Any:
        """What the display remembers between calls: an object of its own, `ctx.state`.

        Called before the first hook that gets a context, and again after a reset.
        """
        return None

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
        """Whether a new sample joins those kept of its input (oldest first).

        A text says what is wrong with it.
        """
        return True

    def fold(self, name: str, sample: Sample, state: Any) -> Any:
        """Return `state`, None at first, with a sample of the input `name` merged into it.

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
        """Draw one sample in its own frame; called once per sample and property change.

        A display with several inputs gets the newest sample of each; `sample.input` names it.
        """

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw all kept samples of all inputs at once, oldest first, in the fixed frame.

        `sample.pose` is where each is.
        """

    def tick(self, ctx: Context) -> None:
        """Draw what follows transforms or time; called on every frame of the loop."""


D = TypeVar("D", bound=Display)


def overrides(display: Display, hook: str) -> bool:
    """Whether a display's class has its own version of a hook."""
    return getattr(type(display), hook) is not getattr(Display, hook)


@functools.cache
def inputs_of(cls: type[Display]) -> dict[str, Input]:
    """The inputs of a display class by property name, in the order of declaration.

    Raises:
        TypeError: its `sync` names something else.
    """
    ports = {each.path: each.port for each in properties_of(cls)}
    found = {path: port for path, port in ports.items() if isinstance(port, Input)}
    for name in cls.sync.inputs if cls.sync else ():
        if name not in found:
            raise TypeError(f"{cls.__name__}.sync: '{name}' is not an input of the display")
    return found


def inputs(display: Display) -> list[tuple[str, Input, Topic]]:
    """Each input of a display: property name, declaration, and the topic chosen for it."""
    return [(name, spec, getattr(display, name)) for name, spec in inputs_of(type(display)).items()]
