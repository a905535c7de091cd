"""Images: every encoding of sensor_msgs to pixels, and values to colours."""

from webviz.data.images.camera_model import CameraModel, calibration_problem, optical_problem
from webviz.data.images.compressed import (
    CompressedInfo,
    decoding,
    inspect_compressed,
    open_compressed,
    read_png16,
)
from webviz.data.images.compressed_depth import decode_depth
from webviz.data.images.encodings import ENCODINGS, PixelLayout, layout_of
from webviz.data.images.errors import ImageError
from webviz.data.images.headers import read_header
from webviz.data.images.lens import Lens
from webviz.data.images.raw import RawImage, needed_bytes, remarks, values, whole_bytes
from webviz.data.images.render import jpeg, render
from webviz.data.images.tone import COLOR_MAPS, Tone, to_rgb, value_range

__all__ = [
    "COLOR_MAPS",
    "ENCODINGS",
    "CameraModel",
    "CompressedInfo",
    "ImageError",
    "Lens",
    "PixelLayout",
    "RawImage",
    "Tone",
    "calibration_problem",
    "decode_depth",
    "decoding",
    "inspect_compressed",
    "jpeg",
    "layout_of",
    "needed_bytes",
    "open_compressed",
    "optical_problem",
    "read_header",
    "read_png16",
    "remarks",
    "render",
    "to_rgb",
    "value_range",
    "values",
    "whole_bytes",
]
