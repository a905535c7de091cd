"""Transforms between frames over time, as true as tf2."""

from webviz.transforms.buffer import TransformBuffer
from webviz.transforms.diagnosis import Diagnosis, FrameReport, diagnose, tree_text
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
from webviz.transforms.explain import explain
from webviz.transforms.filter import MessageFilter
from webviz.transforms.many_frames import FramesIn
from webviz.transforms.reasons import Explanation, Kind
from webviz.transforms.records import Rejection, Transform

__all__ = [
    "BackwardExtrapolationException",
    "ConnectivityException",
    "Diagnosis",
    "Explanation",
    "ExtrapolationException",
    "ForwardExtrapolationException",
    "FrameReport",
    "FramesIn",
    "InvalidArgumentException",
    "Kind",
    "LookupException",
    "MessageFilter",
    "NoDataForExtrapolationException",
    "Rejection",
    "TimeoutException",
    "Transform",
    "TransformBuffer",
    "TransformException",
    "diagnose",
    "explain",
    "tree_text",
]
