"""Sources of messages: a live ROS graph, a bridge or a bag, behind one interface."""

from webviz.api.offer import Endpoint, Offer, Publisher
from webviz.sources.graph import Advertisement, Goal, Graph, Missing, NotConnected, ReadOnly
from webviz.sources.inbox import Inbox, Raw
from webviz.sources.restricted_graph import AllowList, RestrictedGraph, Rights
from webviz.sources.source import Fleet, Source, Subscriber, Subscription, merged

__all__ = [
    "Advertisement",
    "AllowList",
    "Endpoint",
    "Fleet",
    "Goal",
    "Graph",
    "Inbox",
    "Missing",
    "NotConnected",
    "Offer",
    "Publisher",
    "Raw",
    "ReadOnly",
    "RestrictedGraph",
    "Rights",
    "Source",
    "Subscriber",
    "Subscription",
    "merged",
]
