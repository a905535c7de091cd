"""Where messages come from: a live ROS graph or a bag, behind one interface."""

from webviz.engine.sources.inbox import Inbox, Raw
from webviz.engine.sources.source import Offer, Publisher, Source, Subscription, merged

__all__ = ["Inbox", "Offer", "Publisher", "Raw", "Source", "Subscription", "merged"]
