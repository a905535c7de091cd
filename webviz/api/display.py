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
import typing
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import msgspec

from webviz.api.declared import Declared, Topic

if TYPE_CHECKING:
    from webviz.api.context import Context
    from webviz.api.sample import Sample


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


@dataclass(frozen=True)
class Keep:
    """How much history the framework holds for a display.

    Args:
        count: the newest samples to hold; 0 is without limit of number.
        seconds: hold what was received so recently; 0 is without limit of age.
    """

    count: int = 1
    seconds: float = 0.0


class Display(Declared, kw_only=True):
    """Base of all displays. A subclass declares properties and overrides the hooks it needs."""

    kind = "display"

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
