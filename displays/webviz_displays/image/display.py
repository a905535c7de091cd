"""The Image display."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Any, Literal

from webviz import Context, Display, Input, Pane, Prop, Sample, Topic
from webviz.api.pictures import Encoded, Pixels, Video
from webviz.data.images import ImageError, RawImage, Tone, remarks
from webviz_displays.image import transports, video
from webviz_displays.image.newest import Newest
from webviz_displays.image.range import RunningRange

MAX_WINDOW = 100


@dataclass
class _State:
    """Kept between images."""

    decompressed: Newest[RawImage] = field(default_factory=Newest[RawImage])
    range: RunningRange = field(default_factory=RunningRange)
    pane: Pane | None = None


class Image(Display):
    """A camera's picture in a pane beside the scene: raw, compressed, depth or video."""

    rviz = "rviz_default_plugins/Image"
    has_pane = True

    topic: Annotated[
        Topic,
        Input(transports.RAW, also=(transports.COMPRESSED, *video.TYPES)),
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

    def new_state(self) -> _State:
        """Without an image."""
        return _State()

    def waits(self, name: str) -> bool:
        """A pane needs no transform."""
        return False

    def fold(self, name: str, sample: Sample, state: Any) -> Any:
        """The newest image, or all packets of a video since its last key frame."""
        if sample.type in video.TYPES:
            return video.extended(state if isinstance(state, video.Clip) else None, sample)
        return sample.message

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Show the newest image."""
        try:
            picture = self._picture(sample, ctx)
        except ImageError as error:
            ctx.error("Image", str(error))
            return
        if picture is None:
            return
        before = ctx.state.pane
        if before is None or before.picture != picture:  # else the next is being decompressed
            ctx.state.pane = Pane(picture, sample.stamp_ns, ctx.order)
        ctx.add("pane", ctx.state.pane)

    def _picture(self, sample: Sample, ctx: Context) -> Pixels | Encoded | Video | None:
        """What to show, None if there is nothing yet."""
        if isinstance(sample.message, video.Clip):
            return _video(sample.message, ctx)
        found = transports.read(sample)
        if isinstance(found, Encoded):
            ctx.ok("Image", f"{found.width} x {found.height}, {found.mime.partition('/')[2]}.")
            return found
        is_job = isinstance(found, transports.Job)
        image = ctx.state.decompressed.of(sample.number, found.run, ctx) if is_job else found
        if image is None:
            ctx.warn("Image", "Decompressing the first image.")
            return None
        remark = "" if is_job else remarks(sample.message, image)
        if remark:
            ctx.warn("Image", remark)
        else:
            ctx.ok("Image", f"{image.width} x {image.height}, {image.encoding}.")
        return Pixels(image, self._tone(sample.number, image, ctx))

    def _tone(self, number: int, image: RawImage, ctx: Context) -> Tone:
        """How measurements become colours."""
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
                "Image", f"Min Value {low:g} is not below Max Value {high:g}. Correct one of them."
            )
        return Tone(low, high, self.color_map)


def _video(clip: video.Clip, ctx: Context) -> Video | None:
    if clip.video is None:
        ctx.warn("Image", clip.problem)
        return None
    ctx.ok("Image", f"{clip.video.codec} video, decoded by the browser.")
    return clip.video
