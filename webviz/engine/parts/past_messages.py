"""Messages of a topic before the moment that is shown, for panels that begin to show it."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import replace

from webviz.api.declared import Topic
from webviz.api.lookback import Lookback
from webviz.sources import Raw, Subscription
from webviz.sources.history import NeededMessages
from webviz.sources.player import Player

MAX_MESSAGES = 20_000
"""Largest number of messages; at 400 Hz, decoding these takes a third of a second, which the frame
loop waits for."""


def past_messages(player: Player, topic: str, type_: str, lookback: Lookback) -> Iterable[Raw]:
    """Return messages of the memory or the recording until the moment that is shown, oldest first.

    At most the newest `MAX_MESSAGES`.

    Args:
        player: of what is shown; it is not seeking.
        topic: full name.
        type_: of the messages; there are none of another type.
        lookback: which of them; of live topics only its count and seconds matter.
    """
    memory, count = player.memory, min(lookback.count or MAX_MESSAGES, MAX_MESSAGES)
    if not player.is_live:
        return _recorded(player, topic, type_, replace(lookback, count=count))
    channel = memory.recorded_channels.find(topic) if memory else None
    if memory is None or channel is None or channel.type != type_:
        return ()
    known = memory.recent.last(lookback.seconds or math.inf).whole
    return deque((raw for name, raw in known if name == topic), maxlen=count)


def _recorded(player: Player, topic: str, type_: str, lookback: Lookback) -> Iterator[Raw]:
    history, at_ns = player.history, player.reached_ns
    wanted = {topic: Subscription(type_, Topic(topic), lookbacks=(lookback,))}
    channels = [each for each in history.channels(wanted) if each.topic == topic]
    if not channels or at_ns < history.start_ns:
        return
    clock = history.time()
    clock.seek(at_ns)
    for recorded in NeededMessages(history, channels, wanted, at_ns).messages():
        received_ns = clock.at(recorded.stamp_ns)
        yield Raw(recorded.cdr, received_ns, recorded_ns=recorded.stamp_ns, types=recorded.types)
