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
from webviz.transforms.explain import Explanation, explain
from webviz.transforms.filter import MessageFilter
from webviz.transforms.many_frames import FramesIn

__all__ = [
    "BackwardExtrapolationException",
    "ConnectivityException",
    "Explanation",
    "ExtrapolationException",
    "ForwardExtrapolationException",
    "FramesIn",
    "InvalidArgumentException",
    "LookupException",
    "MessageFilter",
    "NoDataForExtrapolationException",
    "Rejection",
    "TimeoutException",
    "Transform",
    "TransformBuffer",
    "TransformException",
    "explain",
]
