"""Rules over statuses and topics: when they hold, and what they save."""

from webviz.engine.watch.observation import TopicObserver, WatchedMoment
from webviz.engine.watch.rules import RuleWatcher

__all__ = ["RuleWatcher", "TopicObserver", "WatchedMoment"]
