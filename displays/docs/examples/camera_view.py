"""A display with two inputs that are matched by stamp."""

from typing import Annotated

from webviz import Color, Context, Display, Input, Prop, Sample, Sync, Topic


class CameraView(Display):
    """The field of view of a camera."""

    image: Annotated[Topic, Input("sensor_msgs/msg/Image")] = Topic("/camera/image_raw")
    info: Annotated[Topic, Input("sensor_msgs/msg/CameraInfo")] = Topic("/camera/camera_info")
    color: Annotated[Color, Prop(help="Color of the lines.")] = (255, 170, 0)
    sync = Sync("image", "info")  # equal stamps; slop=0.05 also matches stamps 50 ms apart

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Four rays, and the edge of the image 1 m ahead."""
        image, info = sample.message, sample.synced["info"].message
        fx, _, cx, _, fy, cy, *_ = info.k
        if not (fx > 0 and fy > 0):
            ctx.error("Camera", "The CameraInfo has no focal length. Calibrate the camera.")
            return
        pixels = ((0, 0), (image.width, 0), (image.width, image.height), (0, image.height))
        corners = [((x - cx) / fx, (y - cy) / fy, 1.0) for x, y in pixels]
        ctx.strip("image", [*corners, corners[0]], self.color)
        ctx.lines("rays", [((0.0, 0.0, 0.0), corner) for corner in corners], self.color)
        ctx.ok("Camera", f"{image.width} x {image.height} pixels.")
