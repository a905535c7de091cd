"""Where messages come from: a live ROS graph or a bag, behind one interface."""

from webviz.sources.inbox import Inbox, Raw
from webviz.sources.source import Offer, Publisher, Source, Subscription

__all__ = ["Inbox", "Offer", "Publisher", "Raw", "Source", "Subscription"]
