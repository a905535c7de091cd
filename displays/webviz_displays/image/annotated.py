"""Base of displays of images in a pane, over which annotations are drawn."""

from __future__ import annotations

import colorsys
import math
import zlib
from collections.abc import Iterator, Sequence
from typing import Annotated, Any, Literal, NamedTuple

import msgspec

from webviz import Context, Input, Pane, Prop, Sample, Topic
from webviz.api.pictures import Mark, Picture
from webviz.data.words import counted, plain
from webviz_displays.image.base import ImageDisplay, ImageState

DETECTIONS = "vision_msgs/msg/Detection2DArray"
ANNOTATIONS = "foxglove_msgs/msg/ImageAnnotations"
TYPES = (DETECTIONS, ANNOTATIONS)

MAX_MARKS = 1000
"""Marks of a message that are shown."""
MAX_POINTS = 20_000
"""Points of all of them."""
FURTHEST = 1e6
"""Pixels from the corner of the picture."""
MAX_TEXT = 200
MAX_CLASSES = 5
"""Classes of a detection that are listed."""
BOX_PX = 2.0
"""Width of the lines of a detection."""
FONT_PX = 12.0
"""Height of texts that give none."""

_KINDS: dict[int, Literal["points", "strip", "loop", "pairs"]] = {
    1: "points",
    2: "loop",
    3: "strip",
    4: "pairs",
}


class MessageMarks(NamedTuple):
    """The marks of a message.

    Args:
        marks: those that are shown.
        invalid: number of those whose places or sizes are not finite.
        left_out: number of those beyond the limits.
    """

    marks: tuple[Mark, ...]
    invalid: int
    left_out: int


def stamp_of(message: Any, type_name: str) -> int:
    """Return the stamp of a message in nanoseconds, 0 if it has none.

    ImageAnnotations of older versions of foxglove_msgs have none of their own; then that of the
    first annotation counts.
    """
    if type_name == DETECTIONS:
        return _ns(message.header.stamp)
    own = getattr(message, "timestamp", None)
    if own is not None and (stamp := _ns(own)):
        return stamp
    each = (*message.points[:1], *message.circles[:1], *message.texts[:1])
    return next((stamp for one in each if (stamp := _ns(one.timestamp))), 0)


def marks_of(message: Any, type_name: str, labels: bool) -> MessageMarks:
    """Return the marks of a message.

    Args:
        message: of one of `TYPES`.
        type_name: which of them.
        labels: whether the likeliest class of a detection and its score are written beside it.
    """
    if type_name == DETECTIONS:
        count, mark_list = len(message.detections), _detections(message.detections, labels)
    else:
        count = len(message.points) + len(message.circles) + len(message.texts)
        mark_list = _annotations(message)
    marks: list[Mark] = []
    points = invalid = examined = 0
    for mark in mark_list:
        if len(marks) == MAX_MARKS:
            break
        if mark is not None and points + len(mark.points) // 2 > MAX_POINTS:
            break
        examined += 1
        if mark is None:
            invalid += 1
        else:
            marks.append(mark)
            points += len(mark.points) // 2
    return MessageMarks(tuple(marks), invalid, count - examined)


def _detections(detections: Sequence[Any], labels: bool) -> Iterator[Mark | None]:
    for number, each in enumerate(detections):
        hypotheses = sorted((one.hypothesis for one in each.results), key=lambda one: -one.score)
        texts = [
            f"{plain(one.class_id, MAX_TEXT) or 'no class'} {one.score:.2f}"
            for one in hypotheses[:MAX_CLASSES]
        ]
        box = each.bbox
        size = f"{box.size_x:g} x {box.size_y:g} px"
        name = f"Detection {plain(each.id, MAX_TEXT) or number}"
        yield _checked(
            "loop",
            _corners(box),
            _color_of(hypotheses[0].class_id if hypotheses else ""),
            width=BOX_PX,
            text=texts[0] if labels and texts else "",
            about=" · ".join((name, *texts, size)),
        )


def _corners(box: Any) -> list[float]:
    """Return x and y of the corners of a vision_msgs/BoundingBox2D; theta turns it clockwise."""
    x, y, turn = box.center.position.x, box.center.position.y, box.center.theta
    if not (math.isfinite(turn) and box.size_x > 0 and box.size_y > 0):
        return [math.nan]
    cos, sin = math.cos(turn), math.sin(turn)
    coordinates: list[float] = []
    for across, down in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)):
        right, below = across * box.size_x, down * box.size_y
        coordinates += (x + cos * right - sin * below, y + sin * right + cos * below)
    return coordinates


def _annotations(message: Any) -> Iterator[Mark | None]:
    for each in message.points:
        kind = _KINDS.get(each.type)
        if kind is None:
            yield None
            continue
        # One point more than is shown at most, so that a huge array is not copied to be left out.
        points = [at for one in each.points[: MAX_POINTS + 1] for at in (one.x, one.y)]
        yield _checked(
            kind,
            points,
            _css(each.outline_color),
            colors=tuple(_css(color) for color in each.outline_colors[: len(points) // 2]),
            fill=_css(each.fill_color) if kind == "loop" and each.fill_color.a > 0 else "",
            width=each.thickness,
        )
    for each in message.circles:
        x, y = each.position.x, each.position.y
        yield _checked(
            "circle",
            [x, y, x + each.diameter / 2, y] if each.diameter > 0 else [math.nan],
            _css(each.outline_color),
            fill=_css(each.fill_color) if each.fill_color.a > 0 else "",
            width=each.thickness,
        )
    for each in message.texts:
        yield _checked(
            "text",
            [each.position.x, each.position.y],
            _css(each.text_color),
            fill=_css(each.background_color) if each.background_color.a > 0 else "",
            width=each.font_size or FONT_PX,
            text=plain(each.text, MAX_TEXT),
        )


def _checked(kind: Any, points: list[float], color: str, **more: Any) -> Mark | None:
    """Return a mark, None if a place or its width is not valid."""
    if not points or not all(abs(at) <= FURTHEST for at in points):  # False for NaN
        return None
    width = more.get("width", 1.0)
    if not 0 <= width <= FURTHEST:
        return None
    return Mark(kind, tuple(round(at, 2) for at in points), color, **more)


def _color_of(class_id: str) -> str:
    """Return a colour for a class, always the same one; grey for none."""
    if not class_id:
        return "#bebebe"
    # Steps of the golden ratio spread the hues of similar names.
    hue = zlib.crc32(class_id.lower().encode(errors="replace")) * 0.618034 % 1.0
    return _hex(*colorsys.hsv_to_rgb(hue, 0.75, 1.0))


def _css(color: Any) -> str:
    """Return a foxglove_msgs/Color, whose shares that are not finite count as 0."""
    return _hex(color.r, color.g, color.b, color.a)


def _hex(*shares: float) -> str:
    bytes_ = (round(255 * min(max(share, 0.0), 1.0)) if share == share else 0 for share in shares)
    return "#" + "".join(f"{byte:02x}" for byte in bytes_)


def _ns(stamp: Any) -> int:
    return stamp.sec * 1_000_000_000 + stamp.nanosec


INPUT = "annotations_topic"
MAX_MESSAGES = 10
"""Messages with annotations: those of an image may come before it or after it."""
TOLERANCE_S = 1.0
"""Largest difference in seconds between the stamps of an image and of its annotations."""


class Annotations(msgspec.Struct, frozen=True):
    """The newest messages with annotations: stamp, message and type of each, the newest last."""

    newest: tuple[tuple[int, Any, str], ...] = ()

    def taken(self, sample: Sample) -> Annotations:
        """Return these with one more message, which replaces that of its stamp."""
        stamp_ns = stamp_of(sample.message, sample.type)
        others = tuple(each for each in self.newest if each[0] != stamp_ns)
        return Annotations((*others, (stamp_ns, sample.message, sample.type))[-MAX_MESSAGES:])

    def of(self, stamp_ns: int) -> tuple[Any, str, float]:
        """Return the message with the stamp of an image, else the newest.

        Returns:
            It, its type, and by how many seconds it is newer than the image; 0 without stamps.

        Raises:
            LookupError: there is none.
        """
        if not self.newest:
            raise LookupError("no annotations")
        match = next((each for each in self.newest if each[0] == stamp_ns), self.newest[-1])
        stamp, message, type_name = match
        return message, type_name, (stamp - stamp_ns) / 1e9 if stamp and stamp_ns else 0.0


class AnnotatedState(ImageState):
    """Kept between images.

    Args:
        cache: the newest marks, with their message and how they were made of it.
    """

    cache: tuple[Any, bool, MessageMarks] | None = None


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

    def reuse(self, pane: Pane, ctx: Context) -> Pane:
        """Return the pane that was drawn before if it is the same, so that nothing is sent."""
        if ctx.state.pane != pane:
            ctx.state.pane = pane
        return ctx.state.pane

    def marks(self, annotations: Annotations, stamp_ns: int, ctx: Context) -> tuple[Mark, ...]:
        """Return the marks of an image, and report on them."""
        if not self.annotations_topic.name:
            return ()
        try:
            message, type_name, newer_s = annotations.of(stamp_ns)
        except LookupError:
            return ()  # the status of the topic says why
        cached = ctx.state.cache
        if cached is None or cached[0] is not message or cached[1] != self.show_labels:
            marks = marks_of(message, type_name, self.show_labels)
            cached = ctx.state.cache = message, self.show_labels, marks
        drawn_marks: MessageMarks = cached[2]
        apart = "" if not newer_s else f"{abs(newer_s):.2g} s {_older_or_newer(newer_s)}"
        if abs(newer_s) > TOLERANCE_S:
            ctx.warn(
                "Annotations",
                f"None within {TOLERANCE_S:g} s of the image: the newest are {apart} than it. "
                "Compare the stamps of both topics.",
            )
            return ()
        count = counted(len(drawn_marks.marks), "annotation")
        if drawn_marks.invalid:
            ctx.error(
                "Annotations",
                f"{drawn_marks.invalid} of {drawn_marks.invalid + len(drawn_marks.marks)} "
                "annotations have a place, size or kind that is not valid. Fix the publisher.",
            )
        elif drawn_marks.left_out:
            ctx.warn("Annotations", f"Showing {count}; {drawn_marks.left_out} more are left out.")
        else:
            ctx.ok("Annotations", f"{count}, {apart} than the image." if apart else f"{count}.")
        return drawn_marks.marks


def _older_or_newer(newer_s: float) -> str:
    return "newer" if newer_s > 0 else "older"
