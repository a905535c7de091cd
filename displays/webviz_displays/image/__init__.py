"""The Image display."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any

import msgspec

from webviz import Context, Input, Lookback, Pane, Prop, Sample, Topic
from webviz.api.pictures import Picture, Video
from webviz.data.images import ImageError
from webviz_displays.image import transports, video
from webviz_displays.image.annotated import (
    INPUT,
    MAX_MESSAGES,
    AnnotatedImage,
    AnnotatedState,
    Annotations,
)

__all__ = ["Image"]


class _ImageState(msgspec.Struct, frozen=True):
    """The newest image, whose message may be a clip, and the newest annotations."""

    image: Sample | None = None
    annotations: Annotations = msgspec.field(default_factory=Annotations)

    @property
    def newest(self) -> Sample | None:
        """The newest image, for the checks of the doctor."""
        return self.image


class Image(AnnotatedImage):
    """A camera's picture in a pane beside the scene: raw, compressed, depth or video."""

    rviz = "rviz_default_plugins/Image"
    icon = "camera"
    has_pane = True

    topic: Annotated[
        Topic,
        Input(transports.RAW, also=(transports.COMPRESSED, *video.TYPES)),
        Prop(help="Topic of the images; choose that of a transport to save bandwidth."),
    ] = Topic("/camera/image_raw")

    def new_state(self) -> AnnotatedState:
        """Return the state before the first image."""
        return AnnotatedState()

    def waits(self, name: str) -> bool:
        """Return whether a transform is needed: a pane needs none."""
        return False

    def lookback(self, name: str) -> Lookback:
        """Return the newest message, or all packets of a video since its last key frame."""
        if name == INPUT:
            return Lookback(count=MAX_MESSAGES)
        return Lookback(starts_over=video.stands_alone)

    def fold(self, name: str, sample: Sample, state: Any) -> Any:
        """Return the newest image or all packets of a video since its last key frame, annotated."""
        content: _ImageState = state or _ImageState()
        if name == INPUT:
            return msgspec.structs.replace(content, annotations=content.annotations.taken(sample))
        if sample.type in video.TYPES:
            before = content.image.message if content.image else None
            clip = video.extended(before if isinstance(before, video.Clip) else None, sample)
            sample = replace(sample, message=clip)
        return msgspec.structs.replace(content, image=sample)

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Show the newest image, and what is annotated there."""
        content: _ImageState = sample.message
        if content.image is None:
            return
        sample = content.image
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
        stamp_ns = self.stamp_of(picture, sample, ctx)
        pane = Pane(
            picture, stamp_ns, ctx.order, marks=self.marks(content.annotations, stamp_ns, ctx)
        )
        ctx.add("pane", self.reuse(pane, ctx))


def _video(clip: video.Clip, ctx: Context) -> Video | None:
    if clip.video is None:
        ctx.warn("Image", clip.problem)
        return None
    ctx.ok("Image", f"{clip.video.codec} video, decoded by the browser.")
    return clip.video
