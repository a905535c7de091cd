"""Images whose data does not fit their encoding."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.images import ImageError, layout_of, needed_bytes, whole_bytes

IMAGE = "sensor_msgs/msg/Image"
ALIGNED = 64
"""Bytes to which drivers align rows. Padding as long as this and as the row itself is pixels."""


class ImageSize(Check):
    """Encoding and data of an image disagree.

    An image, or a row of it, has more or fewer bytes than its size and encoding call for.

    Why:
        The driver names another encoding than it sends, such as `rgb8` for grey pixels, or fills in
        a size of another resolution. The picture is sheared, repeated or missing.

    Repair:
        Correct `encoding`, `width`, `height` or `step` in the driver:

            ros2 topic echo --once --field encoding /camera/image_raw
    """

    id = "DATA015"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        for display, each in observation.samples(IMAGE):
            image = each.message
            try:
                layout = layout_of(image.encoding)
            except ImageError:
                continue  # its status says which encodings are known
            width, height, has = int(image.width), int(image.height), len(image.data)
            row = width * layout.pixel_bytes
            step = int(image.step) or row
            least, most = (
                needed_bytes(layout, width, height, step),
                whole_bytes(layout, height, step),
            )
            if step < row or step - row >= max(row, ALIGNED):
                cause = f"{row} bytes in a row, but its rows have {step}"
            elif not least <= has <= most:
                cause = f"{most} bytes, but it has {has}"
            else:
                continue
            is_drawn = step >= row and has >= least
            yield self.found(
                f"{width} x {height} pixels of {image.encoding} on {each.topic} take {cause}.",
                "Correct the encoding, the size or the step in the driver.",
                subject=each.topic,
                severity=Severity.WARNING if is_drawn else Severity.ERROR,
                evidence={
                    "encoding": image.encoding,
                    "width": width,
                    "height": height,
                    "step": int(image.step),
                    "bytes": has,
                },
                command=f"ros2 topic echo --once --field encoding {each.topic}",
                explains=display.symptom("Image"),
            )
