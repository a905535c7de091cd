"""Base of the displays of two vectors: one straight, one to turn about."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from webviz import (
    Color,
    Context,
    Details,
    Display,
    Group,
    Hit,
    Pose,
    Prop,
    Remedy,
    Rgb,
    Sample,
    Topic,
)
from webviz.data import messages
from webviz.data.rotations import matrices
from webviz.data.words import joined
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import FARTHEST, Length, origin_near
from webviz_displays.shared.properties import opaque
from webviz_displays.shared.rods import add_solid_arrows, rods

Ids = NDArray[np.intp]

HEAD = 0.3
"""Length of a head in lengths of its shaft, so that an arrow is 1.3 times as long as its value."""

SHAFT_RADIUS, HEAD_RADIUS = 0.05, 0.1
"""Radii in widths."""

CIRCLE_RADIUS, CIRCLE_HEIGHT = 0.25, 0.5
"""Radius and height in lengths of the shaft."""

CIRCLE_LINE, CIRCLE_HEAD = 0.05, 0.1
"""Width of the circle's line, length and radius of its head; in widths of the arrow."""

_ANGLES = np.arange(4, 33) * (2 * np.pi / 32)
"""The circle leaves its first eighth open, where its head is."""

_CIRCLE = np.stack((np.cos(_ANGLES), np.sin(_ANGLES), np.zeros_like(_ANGLES)), axis=1)


class Vectors(NamedTuple):
    """N vectors to draw.

    Attributes:
        tails: (N, 3), metres.
        shafts: (N, 3), directions and lengths of the shafts in metres.
        ids: (N,), of the samples.
    """

    tails: F64
    shafts: F64
    ids: Ids


def add_straight(
    group: Group, key: str, vectors: Vectors, width: float, color: Rgb, alpha: float
) -> None:
    """Draw an arrow along each vector.

    Args:
        group, key: where to draw, and what distinguishes the nodes there.
        vectors: to draw.
        width: of RViz's property Arrow Width, metres.
        color, alpha: of all.
    """
    lengths = np.linalg.norm(vectors.shafts, axis=1)
    segments = np.stack((vectors.tails, vectors.tails + (1 + HEAD) * vectors.shafts), axis=1)
    sizes = SHAFT_RADIUS * width, HEAD_RADIUS * width, HEAD * lengths
    add_solid_arrows(group, segments, color, *sizes, alpha, vectors.ids, key)


def add_turning(
    group: Group, key: str, vectors: Vectors, width: float, color: Rgb, alpha: float
) -> None:
    """Draw an arrow along each vector and a circle that turns about it; as `add_straight`."""
    add_straight(group, key, vectors, width, color, alpha)
    turns = matrices(rods(np.zeros_like(vectors.shafts), vectors.shafts, 0.0).wxyzs)
    radii = CIRCLE_RADIUS * np.linalg.norm(vectors.shafts, axis=1)[:, None]
    centers = vectors.tails + CIRCLE_HEIGHT * vectors.shafts
    points = centers[:, None] + radii[:, None] * np.einsum("nij,pj->npi", turns, _CIRCLE)
    segments = np.stack((points[:, :-1], points[:, 1:]), axis=2).reshape(-1, 2, 3)
    group.lines(
        f"{key} circles",
        segments,
        color,
        CIRCLE_LINE * width,
        "m",
        np.repeat(vectors.ids, len(_CIRCLE) - 1),
        alpha,
    )
    ends = points[:, -1]
    heads = np.stack((ends, ends + CIRCLE_HEAD * width * turns[:, :, 1]), axis=1)
    size = CIRCLE_HEAD * width
    add_solid_arrows(group, heads, color, 0.0, size, size, alpha, vectors.ids, f"{key} circle")


F64 = NDArray[np.float64]
Mask = NDArray[np.bool_]


class VectorLook(NamedTuple):
    """Appearance of one of the vectors.

    Attributes:
        noun: such as "force".
        unit: such as "N".
        color: of the arrows.
        scale: metres per unit.
    """

    noun: str
    unit: str
    color: Color
    scale: float


class VectorDisplay(Display):
    """Base of displays that draw a linear and an angular vector at the origin of a frame."""

    topic: Annotated[Topic, Prop(help="Topic of the vectors.")] = Topic()
    alpha: Annotated[
        Alpha,
        Prop(help="Opacity of arrows and circles."),
    ] = 1.0
    arrow_width: Annotated[Length, Prop(help="Width of the arrows; a head takes 0.2 of it.")] = 0.5

    def vectors(self, message: Any) -> tuple[messages.Vector3, messages.Vector3]:
        """Return the linear and the angular vector of a message."""
        raise NotImplementedError

    def looks(self) -> tuple[VectorLook, VectorLook]:
        """Return the appearance of both vectors."""
        raise NotImplementedError

    def hides(self, lengths: F64) -> Mask:
        """Return the mask of vectors (N,), given their lengths in metres, that are not drawn."""
        return lengths == 0

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """All vectors, each where its frame was at its stamp."""
        if samples:
            origin = origin_near([samples[-1].pose.position])
            self.draw_vectors(samples, origin, ctx.follow(None, offset=Pose(origin)), ctx)

    def draw_vectors(
        self, samples: Sequence[Sample], origin: Sequence[float], group: Group, ctx: Context
    ) -> None:
        """Draw the vectors of samples.

        Args:
            samples: oldest first.
            origin: of the group in the fixed frame, metres.
            group: where to draw.
            ctx: collects statuses.
        """
        values = np.array([self._row(sample.message) for sample in samples])
        ok: Mask = np.all(np.isfinite(values), axis=(1, 2))
        if not ok[-1]:
            numbers = ", ".join(f"{number:g}" for number in values[-1].ravel())
            remedy = "Fix the publisher."
            ctx.error("Values", f"The message has values that are not finite: {numbers}. {remedy}")
        tails = np.array([sample.pose.position for sample in samples]) - origin
        turns = matrices([sample.pose.wxyz for sample in samples])
        texts: list[str] = []
        count = 0
        for number, (look, add) in enumerate(
            zip(self.looks(), (add_straight, add_turning), strict=True)
        ):
            with np.errstate(over="ignore", invalid="ignore"):
                shafts = look.scale * np.einsum("nij,nj->ni", turns, values[:, number])
                lengths = np.linalg.norm(shafts, axis=1)
                fits: Mask = ok & (lengths < FARTHEST)
                rows = np.flatnonzero(fits & ~self.hides(lengths))
                size = np.linalg.norm(values[-1, number])
            if ok[-1] and not fits[-1]:
                text = f"is too large to be drawn: {size:.4g} {look.unit}. Fix the publisher."
                ctx.error("Values", f"The {look.noun} {text}")
            elif ok[-1]:
                hidden = "" if len(samples) - 1 in rows else ", not drawn"
                texts.append(f"{look.noun} {size:.4g} {look.unit}{hidden}")
            if len(rows) and self.alpha > 0:
                vectors = Vectors(tails[rows], shafts[rows], rows)
                add(group, look.noun, vectors, self.arrow_width, look.color, self.alpha)
                count += len(rows)
        if texts:
            text = "; ".join(texts)
            sentence = f"{text[0].upper()}{text[1:]}."
            if self.alpha == 0:
                ctx.warn("Vectors", f"Invisible: alpha is 0. {sentence}", opaque())
            elif count:
                ctx.ok("Vectors", sentence)
            else:
                reason, remedy = self.why_hidden()
                ctx.warn("Vectors", joined(sentence, reason), remedy)

    def why_hidden(self) -> tuple[str, Remedy | None]:
        """Return why no vector is drawn, and what would show them."""
        return "Both are zero, so there is no arrow.", None

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Both vectors in their own frame."""
        sample = hit.samples[hit.id]
        pairs = zip(self.looks(), self.vectors(sample.message), strict=True)
        values = {
            f"{look.noun.capitalize()} in {sample.frame or hit.frame}": (
                f"{v.x:.6g}, {v.y:.6g}, {v.z:.6g} {look.unit}"
            )
            for look, v in pairs
        }
        return Details(f"{type(self).__name__} {sample.number}", values)

    def _row(self, message: Any) -> list[tuple[float, float, float]]:
        return [(v.x, v.y, v.z) for v in self.vectors(message)]
