"""Recording of the topics of a source."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Self

from webviz.api.declared import Topic
from webviz.api.display import Display
from webviz.data.recordings import RecordingError
from webviz.data.recordings.folder_writing import RecordingFolder
from webviz.data.words import counted
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.pipeline.inputs import Inputs
from webviz.files.config import Branch, Config, Item
from webviz.sources import Offer, Source, Subscription
from webviz.sources.recording import Channels, Recorder

REST_S = 0.1
DEPTH = 100
"""Depth of the queues of subscriptions: messages that arrive while others are received."""


class TopicRecorder:
    """Subscribes to topics and records them; call `turn` until the end, then `close`.

    Args:
        source: of the messages.
        folder: written to; closed at the end.
        patterns: names of topics, in which * matches any characters; none are all topics.
    """

    def __init__(self, source: Source, folder: RecordingFolder, patterns: Sequence[str]) -> None:
        self.path = folder.path
        """The folder."""
        self._source = source
        self._patterns = [_pattern(source, text) for text in patterns]
        self._channels = Channels(source.offers)
        self._offers: Mapping[str, Offer] = {}
        self._problems: dict[str, str] = {}
        self._reported_topics: set[str] = set()
        self._recorder = Recorder(folder, self._channels)
        source.inbox.readers = (self._recorder.put,)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def wake(self) -> None:
        """End the wait of `turn`, from any thread."""
        self._source.inbox.arrived.set()

    def turn(self) -> None:
        """Subscribe to new topics, once something arrives or a moment later.

        Raises:
            RecordingError: the folder cannot be written any more.
        """
        inbox = self._source.inbox
        inbox.arrived.wait(REST_S)
        inbox.arrived.clear()
        inbox.drain()  # the recorder has read along
        offers = self._source.offers()
        if offers is not self._offers:
            self._offers = offers
            self._source.want(self._subscriptions(offers))
        self._check()

    def new_problems(self) -> list[str]:
        """Sentences on what cannot be recorded, each once."""
        new = [text for topic, text in self._problems.items() if topic not in self._reported_topics]
        self._reported_topics.update(self._problems)
        return new

    def progress(self) -> str:
        """Return the amount that was recorded, in words."""
        recorder = self._recorder
        megabytes, seconds = recorder.bytes_written / 1e6, recorder.seconds
        messages = counted(recorder.messages, "message")
        topics = counted(len(self._channels), "topic")
        dropped = f", {recorder.dropped} dropped" if recorder.dropped else ""
        return f"recorded {messages} of {topics} in {seconds:.0f} s, {megabytes:.1f} MB{dropped}"

    def close(self) -> None:
        """Write what is left, and end the recording.

        Raises:
            RecordingError: the folder cannot be written any more.
        """
        self._source.inbox.readers = ()
        self._recorder.close()
        self._check()

    def _check(self) -> None:
        if self._recorder.problem:
            raise RecordingError(self._recorder.problem)

    def _subscriptions(self, offers: Mapping[str, Offer]) -> dict[str, Subscription]:
        subscriptions = {}
        for topic, offer in offers.items():
            if not offer.publishers or not self._is_chosen(topic):
                continue
            if offer.problem:
                reason = offer.problem.rstrip(".")
                self._problems[topic] = f"{topic} is not recorded: {reason}."
            subscriptions[topic] = Subscription(offer.publishers[0].type, Topic(topic, depth=DEPTH))
        return subscriptions

    def _is_chosen(self, topic: str) -> bool:
        if self._patterns:
            return any(each.fullmatch(topic) for each in self._patterns)
        return "/_" not in topic  # hidden, such as those of actions


def topics_of(config: Config, resolve: Callable[[str], str]) -> Sequence[str]:
    """Return the topics that the displays of a config read, transforms and the log of all nodes.

    Args:
        config: of which displays that are switched off are left out.
        resolve: the full name of a topic; raises ValueError.
    """
    boundary = ErrorBoundary("", strict=True)
    names = [
        name
        for display in _displays(config.displays)
        for name in Inputs(display, boundary, resolve).topics()
        if name
    ]
    return list(dict.fromkeys([*names, "/tf", "/tf_static", "/rosout"]))


def _displays(items: Sequence[Item]) -> Iterator[Display]:
    for item in items:
        if isinstance(item, Branch):
            yield from _displays(item.displays) if item.group.enabled else ()
        elif isinstance(item, Display) and item.enabled:
            yield item


def _pattern(source: Source, text: str) -> re.Pattern[str]:
    name = text if "*" in text else source.resolve(text)
    return re.compile(".*".join(map(re.escape, name.split("*"))))
