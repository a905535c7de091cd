"""Transforms between frames over time, equivalent to tf2."""

from webviz.data.transforms.buffer import TransformBuffer
from webviz.data.transforms.clocks import received_ns, receptions
from webviz.data.transforms.diagnosis import Diagnosis, FrameReport, diagnose, tree_text
from webviz.data.transforms.errors import (
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
from webviz.data.transforms.explain import explain
from webviz.data.transforms.filter import MessageFilter
from webviz.data.transforms.geometry import REACH_M
from webviz.data.transforms.many_frames import FramesIn
from webviz.data.transforms.reasons import Explanation, Kind, distinct
from webviz.data.transforms.records import NewestTransform, Rejection, Transform

__all__ = [
    "REACH_M",
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
    "NewestTransform",
    "NoDataForExtrapolationException",
    "Rejection",
    "TimeoutException",
    "Transform",
    "TransformBuffer",
    "TransformException",
    "diagnose",
    "distinct",
    "explain",
    "received_ns",
    "receptions",
    "tree_text",
]
