"""Subscription of /tf and /tf_static: fills the transform buffer, and reports problems."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping, Sequence

from webviz.api.declared import Topic
from webviz.api.lookback import Lookback
from webviz.api.robots import NamespacedRobot
from webviz.api.status import Level, Status
from webviz.data.messages import MessageError, TFMessage, decode
from webviz.data.messages.transform_layout import Layouts, TransformBatch
from webviz.data.transforms import TransformBuffer
from webviz.data.transforms.buffer import MAX_FRAMES
from webviz.data.transforms.clocks import clock_problem
from webviz.data.transforms.records import RECENT_NS
from webviz.data.words import joined
from webviz.sources import Offer, Raw, Subscriber, Subscription

TOPICS = {"tf": False, "tf_static": True}
TYPE = "tf2_msgs/msg/TFMessage"

Names = Sequence[tuple[str, str]]
"""Parents and children."""

STATIC, MOVING = Lookback(), Lookback(seconds=15.0)
"""Lookbacks at the transforms of a recording; the buffer holds 10 s, and frames that are older turn
grey for some seconds."""
BACK_NS = 1_000_000_000
BACK_S = 2.0
BACK_MESSAGES = 10
"""Time starts over when this many messages in this time, and no others, are stamped further back
than the newest transform of their frame: a bag that loops without /clock. A machine whose clock
lags does not match, as its stamps follow its own."""
REVIEW_S = 1.0
ASK_S = 2.0
"""Minimum time between two subscriptions to /tf_static."""
MAX_PROBLEMS = 3

log = logging.getLogger("webviz")


class TransformListener:
    """Fills a buffer from raw messages.

    Static transforms are sent once. When one is replaced, this subscribes to /tf_static again, so
    that all running publishers repeat theirs. That distinguishes a restart from a second publisher.

    Args:
        buffer: to fill.
        clock: monotonic time in seconds.
    """

    def __init__(self, buffer: TransformBuffer, clock: Callable[[], float]) -> None:
        self._buffer = buffer
        self._clock = clock
        self._layouts = Layouts()
        self._faults: dict[str, Status] = {}
        self._is_recorded = False
        self._began_ns = 0
        """Time of the first message of a bag, as far as they are known."""
        self._back_since: float | None = None
        self._back_messages = 0
        self._offers: Mapping[str, Offer] | None = None
        self._topics = _topics(())
        self._names: dict[str, tuple[Names, Names]] = {}
        self._publishers: dict[str, tuple[str, ...]] = {}
        self._static_publishers: list[tuple[str, ...]] = []
        self._subscriber = Subscriber()
        self._asked_at = 0.0
        self._settled_changes = 0
        self._settled_structure = -1
        self._reviewed_at: float | None = None
        self._reviewed_ns = self._asked_ns = 0
        """ROS time of the last review, and of the last call of `statuses`."""
        self._statuses: dict[str, Status] = {}

    def follow(self, robots: Sequence[NamespacedRobot]) -> None:
        """Read the topics of these robots as well."""
        self._topics = _topics(robots)
        self._names.clear()
        self._offers = None

    def subscriptions(self) -> dict[str, Subscription]:
        """Return the topics of tf2."""
        return self._subscriber.subscribe(
            {
                topic: Subscription(
                    TYPE, Topic(topic), is_static, lookbacks=(STATIC if is_static else MOVING,)
                )
                for topic, (is_static, _) in self._topics.items()
            }
        )

    def take(self, batches: Mapping[str, Iterable[Raw]], offers: Mapping[str, Offer]) -> bool:
        """Insert what arrived; whether the transforms started over in the past."""
        if offers is not self._offers:  # else nothing has changed
            self._offers = offers
            self._publishers = {topic: _nodes(offers, topic) for topic in self._topics}
            begins = [offers[topic].begins for topic in self._topics if topic in offers]
            is_recorded = any(offer.is_recorded for offer in offers.values())
            self._is_recorded = is_recorded
            none = "the bag has none" if is_recorded else ""
            self._buffer.recorded = next((b for b in begins if b and b != none), none)
            self._buffer.none_recorded = is_recorded and self._buffer.recorded == none
            self._buffer.nodes = {
                topic: nodes[0] for topic, nodes in self._publishers.items() if len(nodes) == 1
            }
        for topic, (is_static, robot) in self._topics.items():
            for raw in batches.get(topic, ()):
                self._insert(topic, raw, is_static, robot)
        self._watch_static()
        return (
            self._back_since is not None
            and self._clock() - self._back_since > BACK_S
            and self._back_messages >= BACK_MESSAGES
        )

    def reset(self) -> None:
        """Discard the moving transforms; static ones stay and are requested again."""
        self._buffer.clear()
        self._back_since = self._reviewed_at = None
        self._ask()

    def statuses(self, offers: Mapping[str, Offer], now_ns: int) -> dict[str, Status]:
        """Problems with the transforms, by key."""
        clock = self._clock()
        stands_still, self._asked_ns = now_ns == self._asked_ns, now_ns
        is_due = self._reviewed_at is None or clock - self._reviewed_at > REVIEW_S
        if is_due or (stands_still and now_ns != self._reviewed_ns):
            self._reviewed_at, self._reviewed_ns = clock, now_ns
            self._statuses = self._review(offers, now_ns)
        return self._faults | self._statuses

    def _insert(self, topic: str, raw: Raw, is_static: bool, robot: NamespacedRobot | None) -> None:
        named = robot.frame if robot else _as_sent
        if not is_static and (layout := self._layouts.of(raw.cdr)) is not None:
            batch = layout.read(raw.cdr)
            self._faults.pop(topic, None)
            names = self._names_of(topic, batch, robot)
            self._notice_time(names[0][1], batch.stamps_ns[0])
            received_ns = self._received_ns(raw)
            self._buffer.set_moving(names, batch.stamps_ns, batch.poses, topic, received_ns)
            return
        try:
            message: TFMessage = decode(TYPE, raw.cdr)
        except MessageError as error:
            self._faults[topic] = Status(Level.ERROR, f"{topic}: {error}")
            return
        self._faults.pop(topic, None)
        if message.transforms and not is_static:
            self._layouts.learn(raw.cdr, message)
            self._notice_time(named(message.transforms[0].child), message.transforms[0].stamp_ns)
        received_ns = raw.received_ns if is_static else self._received_ns(raw)
        for t in message.transforms:
            self._buffer.set_transform(
                named(t.parent),
                named(t.child),
                t.stamp_ns,
                t.translation,
                t.rotation,
                is_static,
                topic,
                received_ns,
            )

    def _received_ns(self, raw: Raw) -> int:
        """Return when a moving transform was received, 0 if unknown.

        At the beginning of a slice of a bag, those of the seconds before are repeated.
        """
        if not self._is_recorded:
            return raw.received_ns
        self._began_ns = min(self._began_ns or raw.received_ns, raw.received_ns)
        return 0 if raw.received_ns == self._began_ns else raw.received_ns

    def _names_of(self, topic: str, batch: TransformBatch, robot: NamespacedRobot | None) -> Names:
        """Return the frames of a batch by their names in the viewer, cached for equal messages."""
        if robot is None:
            return batch.names
        entry = self._names.get(topic)
        if entry is None or entry[0] is not batch.names:
            names = [(robot.frame(parent), robot.frame(child)) for parent, child in batch.names]
            entry = self._names[topic] = batch.names, names
        return entry[1]

    def _notice_time(self, child: str, stamp_ns: int) -> None:
        """Note whether a message is from the past, by its first transform."""
        link = self._buffer.link(child.removeprefix("/"))
        newest_ns = link.transform.stamp_ns if link else 0
        if stamp_ns >= newest_ns - BACK_NS:
            self._back_since = None
        elif self._back_since is None:
            self._back_since, self._back_messages = self._clock(), 1
        else:
            self._back_messages += 1

    def _watch_static(self) -> None:
        """Subscribe again when static transforms or the publishers of contested ones changed."""
        publishers = [self._publishers[t] for t, (static, _) in self._topics.items() if static]
        if publishers != self._static_publishers:
            self._static_publishers = publishers
            if any(p.contest for p in self._buffer.publishers.values()):
                self._settled_changes = self._settled_structure = -1
            self._buffer.forget_publishers()
            self._reviewed_at = None
        structure = self._buffer.structure_version  # changes with every static transform
        # The time of a bag may stand still; what it repeats depends on its messages alone.
        is_due = self._buffer.recorded or self._clock() - self._asked_at > ASK_S
        if structure != self._settled_structure and is_due:
            self._settled_structure = structure
            changes = sum(p.changes for p in self._buffer.publishers.values())
            if changes != self._settled_changes:
                self._settled_changes = changes
                self._ask()

    def _ask(self) -> None:
        self._subscriber.ask()
        self._asked_at = self._clock()

    def _review(self, offers: Mapping[str, Offer], now_ns: int) -> dict[str, Status]:
        buffer = self._buffer
        problems = [str(conflict.problem) for _, conflict in buffer.conflicts.all()]
        if problems:
            who = [
                f"{topic}: {', '.join(_nodes(offers, topic)) or 'no publisher'}"
                for topic in self._topics
            ]
            problems = [*_few(problems), f"Publishers of {'; of '.join(who)}."]
        refused = [
            f'{rejection.count} transforms of "{child}" were refused, the last because '
            f"{rejection.sentence}"
            + (
                ". If a bag was restarted, press Reset."
                if rejection.reason == "TF_OLD_DATA"
                else ". Fix the publisher."
            )
            for child, rejection in buffer.refusals.rejections.items()
            if rejection.is_current(now_ns)
        ]
        surplus = buffer.refusals.surplus
        if surplus is not None and now_ns - surplus.received_ns < RECENT_NS:
            problems.append(
                f'{surplus.count} transforms, the last of "{surplus.child}", were ignored, because '
                f"there are more than {MAX_FRAMES} frames. Stop the publisher that keeps naming "
                "new frames."
            )
        is_recorded = any(offer.is_recorded for offer in offers.values())
        texts = {
            "Transforms": joined(*problems, *_few(refused)),
            "Clocks": str(clock_problem(buffer, now_ns, is_recorded) or ""),
        }
        return {key: Status(Level.WARN, text) for key, text in texts.items() if text}


def _topics(robots: Sequence[NamespacedRobot]) -> dict[str, tuple[bool, NamespacedRobot | None]]:
    """Return the topics of tf2: whether each is static, and whose it is."""
    roots: list[tuple[str, NamespacedRobot | None]] = [
        ("/", None),
        *((each.root, each) for each in robots),
    ]
    return {
        root + name: (is_static, robot)
        for root, robot in roots
        for name, is_static in TOPICS.items()
    }


def _as_sent(frame: str) -> str:
    return frame


def _few(sentences: list[str]) -> list[str]:
    more = len(sentences) - MAX_PROBLEMS
    return sentences if more <= 0 else [*sentences[:MAX_PROBLEMS], f"And {more} more."]


def _nodes(offers: Mapping[str, Offer], topic: str) -> tuple[str, ...]:
    """Return the nodes that publish a topic, with duplicates."""
    publishers = offers[topic].publishers if topic in offers else ()
    return tuple(publisher.label for publisher in publishers)
