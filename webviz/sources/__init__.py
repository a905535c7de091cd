"""Sources of messages: a live ROS graph, a bridge or a bag, behind one interface."""

from webviz.api.offer import Endpoint, Offer, Publisher
from webviz.sources.gate import AllowList, Gate, Rights
from webviz.sources.graph import Advertisement, Goal, Graph, Missing, NotConnected, ReadOnly
from webviz.sources.inbox import Inbox, Raw
from webviz.sources.source import Fleet, Source, Subscriber, Subscription, merged

__all__ = [
    "Advertisement",
    "AllowList",
    "Endpoint",
    "Fleet",
    "Gate",
    "Goal",
    "Graph",
    "Inbox",
    "Missing",
    "NotConnected",
    "Offer",
    "Publisher",
    "Raw",
    "ReadOnly",
    "Rights",
    "Source",
    "Subscriber",
    "Subscription",
    "merged",
]
