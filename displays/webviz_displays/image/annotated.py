"""Base of displays of images in a pane, over which annotations are drawn."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec

from webviz import Context, Input, Pane, Prop, Sample, Topic
from webviz.api.pictures import Mark, Picture
from webviz.data.words import counted
from webviz_displays.image.base import ImageDisplay, ImageState
from webviz_displays.image.marks import TYPES, MessageMarks, marks_of, stamp_of

INPUT = "annotations_topic"
KEPT = 10
"""Messages with annotations: those of an image may come before it or after it."""
TOLERANCE_S = 1.0
"""By how much the stamps of an image and of its annotations may differ."""


class Annotations(msgspec.Struct, frozen=True):
    """The newest messages with annotations: stamp, message and type of each, the newest last."""

    newest: tuple[tuple[int, Any, str], ...] = ()

    def taken(self, sample: Sample) -> Annotations:
        """Return these with one more message, which replaces that of its stamp."""
        stamp_ns = stamp_of(sample.message, sample.type)
        others = tuple(each for each in self.newest if each[0] != stamp_ns)
        return Annotations((*others, (stamp_ns, sample.message, sample.type))[-KEPT:])

    def of(self, stamp_ns: int) -> tuple[Any, str, float]:
        """Return the message with the stamp of an image, else the newest.

        Returns:
            It, its type, and by how many seconds it is newer than the image; 0 without stamps.

        Raises:
            LookupError: there is none.
        """
        if not self.newest:
            raise LookupError("no annotations")
        found = next((each for each in self.newest if each[0] == stamp_ns), self.newest[-1])
        stamp, message, type_name = found
        return message, type_name, (stamp - stamp_ns) / 1e9 if stamp and stamp_ns else 0.0


class AnnotatedState(ImageState):
    """Kept between images.

    Args:
        made: the newest marks, with their message and how they were made of it.
    """

    made: tuple[Any, bool, MessageMarks] | None = None


class AnnotatedImage(ImageDisplay):
    """Base of displays of images in a pane, over which annotations are drawn."""

    annotations_topic: Annotated[
        Topic,
        Input(TYPES[0], also=TYPES[1:], is_offered=False),
        Prop(help="Topic of boxes, lines, circles and texts over the image; empty for none."),
    ] = Topic()
    show_labels: Annotated[
        bool,
        Prop(help="Write the class and the score of detections beside them."),
    ] = True

    def listens(self, name: str) -> bool:
        """Return whether a topic is chosen."""
        return name != INPUT or bool(self.annotations_topic.name)

    def waits(self, name: str) -> bool:
        """Return whether a transform is needed: annotations have that of their image."""
        return name != INPUT

    def stamp_of(self, picture: Picture, sample: Sample, ctx: Context) -> int:
        """Return the stamp of a picture, which may be older than the newest image."""
        before: Pane | None = ctx.state.pane
        return before.stamp_ns if before and before.picture == picture else sample.stamp_ns

    def kept(self, pane: Pane, ctx: Context) -> Pane:
        """Return the pane that was drawn before if it is the same, so that nothing is sent."""
        if ctx.state.pane != pane:
            ctx.state.pane = pane
        return ctx.state.pane

    def marks(self, known: Annotations, stamp_ns: int, ctx: Context) -> tuple[Mark, ...]:
        """Return the marks of an image, and report on them."""
        if not self.annotations_topic.name:
            return ()
        try:
            message, type_name, newer_s = known.of(stamp_ns)
        except LookupError:
            return ()  # the status of the topic says why
        made = ctx.state.made
        if made is None or made[0] is not message or made[1] != self.show_labels:
            marks = marks_of(message, type_name, self.show_labels)
            made = ctx.state.made = message, self.show_labels, marks
        found: MessageMarks = made[2]
        apart = "" if not newer_s else f"{abs(newer_s):.2g} s {_older_or_newer(newer_s)}"
        if abs(newer_s) > TOLERANCE_S:
            ctx.warn(
                "Annotations",
                f"None within {TOLERANCE_S:g} s of the image: the newest are {apart} than it. "
                "Compare the stamps of both topics.",
            )
            return ()
        count = counted(len(found.marks), "annotation")
        if found.invalid:
            ctx.error(
                "Annotations",
                f"{found.invalid} of {found.invalid + len(found.marks)} annotations have a place, "
                "size or kind that is not valid. Fix the publisher.",
            )
        elif found.left_out:
            ctx.warn("Annotations", f"Showing {count}; {found.left_out} more are left out.")
        else:
            ctx.ok("Annotations", f"{count}, {apart} than the image." if apart else f"{count}.")
        return found.marks


def _older_or_newer(newer_s: float) -> str:
    return "newer" if newer_s > 0 else "older"
