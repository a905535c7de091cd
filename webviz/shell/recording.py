"""Recording of the topics of a source."""

from __future__ import annotations

import re
import time
from collections.abc import Mapping, Sequence
from typing import Self

from webviz.api.declared import Topic
from webviz.data.recordings.folder_writing import RecordingFolder
from webviz.data.words import counted
from webviz.engine.recording import Channels
from webviz.engine.recording.recorder import FLUSH_S
from webviz.engine.sources import Offer, Raw, Source, Subscription

REST_S = 0.1
DEPTH = 100
"""Of the queues of subscriptions: messages that arrive while a file is written."""


class TopicRecorder:
    """Subscribes to topics and records them; call `turn` until the end, then `close`.

    Args:
        source: of the messages; closed at the end.
        folder: written to; closed at the end.
        patterns: names of topics, in which * matches any characters; none are all topics.
    """

    def __init__(self, source: Source, folder: RecordingFolder, patterns: Sequence[str]) -> None:
        self.folder = folder
        self._source = source
        self._patterns = [_pattern(source, text) for text in patterns]
        self._channels = Channels(source.offers)
        self._offers: Mapping[str, Offer] = {}
        self._subscriptions: dict[str, Subscription] = {}
        self._problems: dict[str, str] = {}
        self._told: set[str] = set()
        self._began_s = self._flushed_s = time.monotonic()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def wake(self) -> None:
        """End the wait of `turn`, from any thread."""
        self._source.inbox.arrived.set()

    def turn(self) -> None:
        """Record what has arrived, or wait a moment for it.

        Raises:
            RecordingError: the folder cannot be written any more.
        """
        inbox = self._source.inbox
        inbox.arrived.wait(REST_S)
        inbox.arrived.clear()
        offers = self._source.offers()
        if offers is not self._offers:
            self._offers = offers
            self._subscriptions = self._wanted(offers)
            self._source.want(self._subscriptions)
        for topic, messages in inbox.drain().items():
            self._write(topic, messages)
        now_s = time.monotonic()
        if now_s - self._flushed_s >= FLUSH_S:
            self._flushed_s = now_s
            self.folder.flush()

    def new_problems(self) -> list[str]:
        """Sentences on what cannot be recorded, each once."""
        new = [text for topic, text in self._problems.items() if topic not in self._told]
        self._told.update(self._problems)
        return new

    def progress(self) -> str:
        """The amount that was recorded, in words."""
        megabytes = self.folder.size / 1e6
        seconds = time.monotonic() - self._began_s
        messages = counted(self.folder.messages, "message")
        topics = counted(len(self._channels), "topic")
        dropped = sum(map(self._source.inbox.dropped, self._channels))
        lost = f", {dropped} dropped" if dropped else ""
        return f"recorded {messages} of {topics} in {seconds:.0f} s, {megabytes:.1f} MB{lost}"

    def close(self) -> None:
        """Write what is left, and end the recording."""
        try:
            self._source.close()
        finally:
            self.folder.close()

    def _wanted(self, offers: Mapping[str, Offer]) -> dict[str, Subscription]:
        wanted = {}
        for topic, offer in offers.items():
            if not offer.publishers or not self._is_chosen(topic):
                continue
            if offer.problem:
                reason = offer.problem.rstrip(".")
                self._problems[topic] = f"{topic} is not recorded: {reason}."
            wanted[topic] = Subscription(offer.publishers[0].type, Topic(topic, depth=DEPTH))
        return wanted

    def _is_chosen(self, topic: str) -> bool:
        if self._patterns:
            return any(each.fullmatch(topic) for each in self._patterns)
        return "/_" not in topic  # hidden, such as those of actions

    def _write(self, topic: str, messages: Sequence[Raw]) -> None:
        subscription = self._subscriptions.get(topic)
        channel = self._channels.find(topic, subscription.type if subscription else "")
        if channel is None:  # its last publisher went before its first message was read
            return
        latched = self._channels.is_latched(topic)
        for raw in messages:
            self.folder.add(channel, raw.received_ns, raw.cdr, latched)


def _pattern(source: Source, text: str) -> re.Pattern[str]:
    name = text if "*" in text else source.resolve(text)
    return re.compile(".*".join(map(re.escape, name.split("*"))))
