"""Base of image displays: common properties, and the way from a message to a picture."""

from __future__ import annotations

import statistics
from collections import deque
from typing import Annotated, Literal

import msgspec

from webviz import Context, Display, Input, Pane, Prop, Remedy, Sample, Topic
from webviz.api.pictures import Encoded, Pixels
from webviz.data.images import RawImage, Tone, remarks, value_range, values
from webviz_displays.image import transports
from webviz_displays.image.newest import Newest


class RunningRange:
    """The medians of the lowest and the highest values of the newest images."""

    def __init__(self) -> None:
        self._ranges: deque[tuple[int, tuple[float, float]]] = deque()

    def of(self, number: int, image: RawImage, window: int) -> tuple[float, float] | None:
        """Return the range for an image, None if no image of the window has a valid value.

        Args:
            number: of the message; the same message counts once.
            image: of measurements.
            window: number of images.
        """
        if not self._ranges or self._ranges[-1][0] != number:
            own_range = value_range(values(image), image.layout.zero_is_invalid)
            if own_range is not None:
                self._ranges.append((number, own_range))
        while len(self._ranges) > window:
            self._ranges.popleft()
        if not self._ranges:
            return None
        ranges = [each for _, each in self._ranges]
        low = statistics.median(low for low, _ in ranges)
        return low, statistics.median(high for _, high in ranges)


MAX_WINDOW = 100


class ImageState(msgspec.Struct):
    """Kept between images.

    Args:
        number: of the message of the newest picture, which is older than the newest message while
            that is decompressed.
    """

    number: int = 0
    decompressed: Newest[tuple[int, RawImage]] = msgspec.field(
        default_factory=Newest[tuple[int, RawImage]]
    )
    range: RunningRange = msgspec.field(default_factory=RunningRange)
    pane: Pane | None = None


class ImageDisplay(Display):
    """Base of displays of images."""

    topic: Annotated[
        Topic,
        Input(transports.RAW, also=(transports.COMPRESSED,)),
        Prop(help="Topic of the images; choose that of a transport to save bandwidth."),
    ] = Topic("/camera/image_raw")
    normalize_range: Annotated[
        bool,
        Prop(help="Scale depths and other measurements from the lowest to the highest value."),
    ] = True
    min_value: Annotated[
        float,
        Prop(when=("normalize_range", False), help="Value with the first colour."),
    ] = 0.0
    max_value: Annotated[
        float,
        Prop(when=("normalize_range", False), help="Value with the last colour."),
    ] = 1.0
    median_window: Annotated[
        int,
        Prop(
            ge=1,
            le=MAX_WINDOW,
            rviz="Median window",
            when=("normalize_range", True),
            help="Number of images whose lowest and highest values are averaged by the median.",
        ),
    ] = 5
    color_map: Annotated[
        Literal["Grey", "Turbo", "Viridis", "Rainbow"],
        Prop(help="Colours of depths and other measurements of one channel."),
    ] = "Grey"

    def picture(self, sample: Sample, ctx: Context) -> Pixels | Encoded | None:
        """Return the picture of the newest message of `topic`, None if there is none.

        `ImageState.number` becomes that of its message.

        Raises:
            ImageError: it cannot be shown.
        """
        content, state, number = transports.read(sample), ctx.state, sample.number
        state.number = number
        if isinstance(content, Encoded):
            ctx.ok(
                "Image", f"{content.width} x {content.height}, {content.mime.partition('/')[2]}."
            )
            return content
        image, remark = content, ""
        if isinstance(image, transports.Decompression):
            run = image.run
            newest = state.decompressed.of(number, lambda: (number, run()), ctx)
            if newest is None:
                ctx.warn("Image", "Decompressing the first image.")
                return None
            state.number, image = newest
        else:
            remark = remarks(sample.message, image)
        if remark:
            ctx.warn("Image", remark)
        else:
            ctx.ok("Image", f"{image.width} x {image.height}, {image.encoding}.")
        return Pixels(image, self._tone(state.number, image, ctx))

    def _tone(self, number: int, image: RawImage, ctx: Context) -> Tone:
        """Return the mapping from measurements to colours."""
        low, high = self.min_value, self.max_value
        if not image.layout.is_scaled:
            return Tone()
        if self.normalize_range:
            limits = ctx.state.range.of(number, image, self.median_window)
            if limits is None:
                ctx.warn("Image", "No pixel has a valid value: the image is black.")
            low, high = limits or (low, high)
        elif not low < high:
            ctx.warn(
                "Image",
                f"Min Value {low:g} is not below Max Value {high:g}. Correct one of them.",
                Remedy("normalize_range", True, "Use the range of the images"),
            )
        return Tone(low, high, self.color_map)
