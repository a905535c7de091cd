"""The Image display."""

from __future__ import annotations

from typing import Annotated, Any

from webviz import Context, Input, Lookback, Pane, Prop, Sample, Topic
from webviz.api.pictures import Picture, Video
from webviz.data.images import ImageError
from webviz_displays.image import transports, video
from webviz_displays.image.base import ImageDisplay, ImageState


class Image(ImageDisplay):
    """A camera's picture in a pane beside the scene: raw, compressed, depth or video."""

    rviz = "rviz_default_plugins/Image"
    icon = "camera"
    has_pane = True

    topic: Annotated[
        Topic,
        Input(transports.RAW, also=(transports.COMPRESSED, *video.TYPES)),
        Prop(help="Topic of the images; choose that of a transport to save bandwidth."),
    ] = Topic("/camera/image_raw")

    def new_state(self) -> ImageState:
        """Without an image."""
        return ImageState()

    def waits(self, name: str) -> bool:
        """Return whether a transform is needed: a pane needs none."""
        return False

    def lookback(self, name: str) -> Lookback:
        """Return the newest message, or all packets of a video since its last key frame."""
        return Lookback(starts_over=video.stands_alone)

    def fold(self, name: str, sample: Sample, state: Any) -> Any:
        """Return the newest message, or all packets of a video since its last key frame."""
        if sample.type in video.TYPES:
            return video.extended(state if isinstance(state, video.Clip) else None, sample)
        return sample.message

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Show the newest image."""
        try:
            picture: Picture | None
            if isinstance(sample.message, video.Clip):
                picture = _video(sample.message, ctx)
            else:
                picture = self.picture(sample, ctx)
        except ImageError as error:
            ctx.error("Image", str(error))
            return
        if picture is None:
            return
        before = ctx.state.pane
        if before is None or before.picture != picture:  # else the next is being decompressed
            ctx.state.pane = Pane(picture, sample.stamp_ns, ctx.order)
        ctx.add("pane", ctx.state.pane)


def _video(clip: video.Clip, ctx: Context) -> Video | None:
    if clip.video is None:
        ctx.warn("Image", clip.problem)
        return None
    ctx.ok("Image", f"{clip.video.codec} video, decoded by the browser.")
    return clip.video
