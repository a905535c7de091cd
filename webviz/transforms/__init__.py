"""Transforms between frames over time, as true as tf2."""

from webviz.transforms.buffer import Rejection, Transform, TransformBuffer
from webviz.transforms.errors import (
    BackwardExtrapolationException,
    ConnectivityException,
    ExtrapolationException,
    ForwardExtrapolationException,
    InvalidArgumentException,
    LookupException,
    NoDataForExtrapolationException,
    TimeoutException,
    TransformException,
)

__all__ = [
    "BackwardExtrapolationException",
    "ConnectivityException",
    "ExtrapolationException",
    "ForwardExtrapolationException",
    "InvalidArgumentException",
    "LookupException",
    "NoDataForExtrapolationException",
    "Rejection",
    "TimeoutException",
    "Transform",
    "TransformBuffer",
    "TransformException",
]
