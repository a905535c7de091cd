"""The viewer's ROS node: one thread that subscribes to raw messages and watches the graph."""

from __future__ import annotations

import functools
import math
import threading
import time
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import rclpy
from rclpy.clock import JumpThreshold, ROSClock
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.exceptions import InvalidTopicNameException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from rclpy.subscription import Subscription as RclpySubscription

from webviz.data.messages import typestore
from webviz.data.messages.distributions import UndefinedMessages, may_differ
from webviz.ros import distribution, qos
from webviz.ros.control import ControlNode
from webviz.ros.graph import RosGraph
from webviz.ros.guard_condition import GuardCondition
from webviz.ros.heap import Heap
from webviz.ros.shared_memory import remove_abandoned
from webviz.ros.types import learn, message_class
from webviz.sources import Endpoint, Inbox, Offer, Publisher, Raw, Subscription
from webviz.sources.inbox import MAX_TOTAL

if TYPE_CHECKING:
    from rclpy.topic_endpoint_info import TopicEndpointInfo

LOOK_S = 0.5
"""Time between two looks at the graph, of whose changes rclpy says nothing."""
LONG_LOOK_S = 2.0
"""The same of a graph that has not changed for longer."""
STEADY_SHARE = 0.1
"""Time between two looks as a share of that without a change."""
PENDING_S = 0.05
"""Time to wait while calls are pending."""
THOROUGH_EVERY = 8
"""Looks between readings of endpoints whose number has not changed."""
NO_OFFER = Offer(())
INBOX_LIMIT = 1000
MAX_MESSAGE = MAX_TOTAL
"""Bytes, the same as of a bag."""
ANY_DEADLINE_NS = 2**62
TF_TYPE = "tf2_msgs/msg/TFMessage"
ANY_JUMP = JumpThreshold(
    min_forward=Duration(nanoseconds=1),
    min_backward=Duration(nanoseconds=-1),
    on_clock_change=False,
)
TF_LIMIT = 20_000
"""Every transform counts: room for the 10 s that the buffer keeps, at 2 kHz."""


class RosSource:
    """Messages from the ROS graph, as raw bytes in an inbox.

    All rclpy calls are made in one thread of this object; the methods are thread-safe.

    Args:
        args: command line arguments for ROS (`--ros-args ...`).
        node_name: unless remapped by `args`.
        domain_id: ROS domain; None for that of the environment.
    """

    def __init__(
        self,
        args: Sequence[str] = (),
        node_name: str = "webviz",
        domain_id: int | None = None,
    ) -> None:
        self._heap = Heap()
        self.inbox = Inbox()
        self._context = Context()
        typestore.find_with(learn)
        remove_abandoned()
        rclpy.init(
            args=list(args),
            context=self._context,
            domain_id=domain_id,
            signal_handler_options=SignalHandlerOptions.NO,
        )
        # The service cannot describe types that are composed at run time (see `types`).
        silent = Parameter("start_type_description_service", value=False)
        self._node = Node(node_name, context=self._context, parameter_overrides=[silent])
        self._resolved = functools.lru_cache(maxsize=1000)(self._node.resolve_topic_name)
        self._clock = self._node.get_clock()
        self._clock_messages = 0
        self._jumps = self._clock.create_jump_callback(ANY_JUMP, post_callback=self._count_clock)
        self._guard_condition = GuardCondition()
        self.control = ControlNode(self._node, self._guard_condition.trigger)
        self._executor = distribution.executor(self._context)
        self.graph = RosGraph(self._node, self._guard_condition.trigger)
        self._subscriptions: Mapping[str, Subscription] = {}
        self._topics: dict[str, _SubscribedTopic] = {}
        self._offers: dict[str, Offer] = {}
        self._problems: dict[str, str] = {}
        self._looks = 0
        self._changed_s = time.monotonic()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name="webviz-ros", daemon=True)
        self._thread.start()

    bridges = ()
    """None: it is in the graph itself."""

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Replace all subscriptions; takes effect soon."""
        if subscriptions != self._subscriptions:
            self._subscriptions = dict(subscriptions)
            self._guard_condition.trigger()

    def offers(self) -> Mapping[str, Offer]:
        """All topics of the graph."""
        return self._offers

    def now_ns(self) -> int:
        """ROS time; 0 before the first /clock when use_sim_time is set."""
        if isinstance(self._clock, ROSClock) and self._clock.ros_time_is_active:
            return self._clock.now().nanoseconds
        return time.time_ns()

    def clock_messages(self) -> int | None:
        """Return the number of /clock messages that moved ROS time; None without use_sim_time."""
        is_simulated = isinstance(self._clock, ROSClock) and self._clock.ros_time_is_active
        return self._clock_messages if is_simulated else None

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic.

        Raises:
            ValueError: the name is invalid.
        """
        try:
            return self._resolved(topic)
        except (InvalidTopicNameException, RuntimeError, ValueError) as error:
            reason = str(error).partition(", at /")[0].rpartition("name: ")[2]
            raise ValueError(f"{topic!r} is not a valid topic name: {reason}") from error

    def close(self) -> None:
        """Destroy the node and end the thread."""
        if not self._stop.is_set():
            self._stop.set()
            self._guard_condition.trigger()
        self._thread.join()

    def _run(self) -> None:
        executor = self._executor
        executor.add_node(self._node)
        next_look = 0.0
        target: Mapping[str, Subscription] = {}
        try:
            while not self._stop.is_set():
                self._guard_condition.reset()
                now = time.monotonic()
                is_new = target is not self._subscriptions
                if is_new or now >= next_look:
                    steady_s = now - self._changed_s
                    next_look = now + max(LOOK_S, min(LONG_LOOK_S, STEADY_SHARE * steady_s))
                    target = self._subscriptions
                    if self._look(target) or is_new:
                        self._reconcile(target)
                    self.graph.look()
                self._heap.turn()
                self.control.turn()
                guard: Any = self._guard_condition  # which is no whole future
                if self.graph.turn():
                    executor.spin_once_until_future_complete(guard, PENDING_S)
                else:
                    rest_s = max(0.0, next_look - time.monotonic())
                    executor.spin_until_future_complete(guard, rest_s)
        finally:
            self.control.close()
            self.graph.close()
            executor.shutdown()
            self._node.destroy_node()
            self._context.try_shutdown()

    def _look(self, extra: Iterable[str]) -> bool:
        """Refresh the offers of the topics of the graph and of those that are wanted.

        Returns:
            Whether any of them has changed.
        """
        self._looks += 1
        is_thorough = self._looks % THOROUGH_EVERY == 0
        topics = [name for name, _ in self._node.get_topic_names_and_types()]
        offers = {
            topic: self._offer(topic, is_thorough) for topic in dict.fromkeys([*topics, *extra])
        }
        if offers == self._offers:
            return False
        self._offers, self._changed_s = offers, time.monotonic()
        self.inbox.arrived.set()
        return True

    def _offer(self, topic: str, is_thorough: bool) -> Offer:
        """Read the offer of a topic; endpoints only if they are not those that are known.

        To count them takes a tenth of the time.
        """
        former, subscribed = self._offers.get(topic, NO_OFFER), self._topics.get(topic)
        requested = subscribed.policies if subscribed else None
        is_same = requested == former.requested and not is_thorough
        node, publishers, readers = self._node, former.publishers, former.readers
        if not (is_same and _are_known(publishers, node.count_publishers(topic))):
            infos = node.get_publishers_info_by_topic(topic)
            publishers = tuple(sorted(map(_publisher, infos), key=lambda p: (p.node, p.type)))
        subscribers = node.count_subscribers(topic)
        if not (is_same and _are_known(readers, subscribers)):
            infos = node.get_subscriptions_info_by_topic(topic)
            readers = tuple(sorted(map(_endpoint, infos), key=lambda each: each.node))
        return Offer(
            publishers,
            requested,
            self._problems.get(topic, ""),
            subscribed.subscription.type if subscribed else "",
            subscribers,
            readers=readers,
        )

    def _reconcile(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Subscribe and unsubscribe to what is wanted, with the QoS that matches now."""
        for topic in [t for t in self._topics if t not in subscriptions]:
            self._release(topic)
            self.inbox.close(topic)
        for topic, subscription in subscriptions.items():
            if self._stop.is_set():  # the first subscriptions take longest
                return
            publishers = self._offers[topic].publishers if topic in self._offers else ()
            if publishers and all(p.type != subscription.type for p in publishers):
                self._release(topic)  # rclpy allows one type per topic, and none matches
                continue
            policies, is_mixed = (
                qos.adapt(subscription, publishers),
                qos.is_mixed(subscription, publishers),
            )
            if policies[1] == "volatile" and not is_mixed:
                subscription = replace(
                    subscription, resubscriptions=0
                )  # no latched message could be sent again
            fitting = _SubscribedTopic(subscription, policies, is_mixed)
            if self._topics.get(topic) != fitting:
                self._release(topic)
                self._subscribe(topic, fitting)

    def _subscribe(self, topic: str, subscribed: _SubscribedTopic) -> None:
        self.inbox.open(topic, TF_LIMIT if subscribed.subscription.type == TF_TYPE else INBOX_LIMIT)
        reliability, durability = subscribed.policies
        durabilities: list[qos.Durability] = [durability]
        if subscribed.is_mixed:
            durabilities = ["transient_local", "volatile"]
        try:
            learn(type_name := subscribed.subscription.type)
            layout = UndefinedMessages(type_name) if may_differ(type_name) else None
            subscribed.subscriptions = [
                self._node.create_subscription(
                    message_class(type_name),
                    topic,
                    functools.partial(self._arrive, topic, layout),
                    qos.profile(subscribed.subscription, reliability, each),
                    raw=True,
                    event_callbacks=distribution.NO_EVENTS_OF_SUBSCRIPTIONS,
                )
                for each in durabilities
            ]
        except Exception as error:  # rclpy, the type support and DDS raise many kinds
            self._problems[topic] = f"cannot subscribe: {' '.join(str(error).split())}"
        else:
            self._problems.pop(topic, None)
        self._topics[topic] = subscribed

    def _release(self, topic: str) -> None:
        subscribed = self._topics.pop(topic, None)
        if subscribed is None:
            return
        for subscription in subscribed.subscriptions:
            self._node.destroy_subscription(subscription)
        # The executor has to let go of it before the topic can have another type.
        never: Any = GuardCondition()
        self._executor.spin_until_future_complete(never, 0.0)

    def _count_clock(self, jump: object) -> None:
        self._clock_messages += 1

    def _arrive(self, topic: str, layout: UndefinedMessages | None, cdr: bytes) -> None:
        if len(cdr) > MAX_MESSAGE:
            self._problems[topic] = (
                f"a message of {len(cdr) / 2**20:.0f} MB is above the limit of "
                f"{MAX_MESSAGE >> 20} MB; publish smaller ones"
            )
            return
        self._heap.note(len(cdr))
        self._problems.pop(topic, None)
        if layout is not None:
            cdr = layout.to_cdr(cdr)
        self.inbox.put(topic, Raw(cdr, self.now_ns()))


@dataclass
class _SubscribedTopic:
    """A subscription; equal to another if it can be kept instead."""

    subscription: Subscription
    policies: tuple[qos.Reliability, qos.Durability]
    is_mixed: bool
    subscriptions: list[RclpySubscription] = field(default_factory=list, compare=False)


def _seconds(deadline: Duration) -> float:
    """Return a deadline in seconds; DDS writes "any" as 0 or as the longest that there is."""
    return deadline.nanoseconds / 1e9 if 0 < deadline.nanoseconds < ANY_DEADLINE_NS else math.inf


def _are_known(endpoints: Collection[Endpoint], count: int) -> bool:
    """Return whether there are as many; the node of one is known somewhat later than itself."""
    return len(endpoints) == count and all(each.node for each in endpoints)


def _publisher(info: TopicEndpointInfo) -> Publisher:
    return Publisher(**vars(_endpoint(info)))


def _endpoint(info: TopicEndpointInfo) -> Endpoint:
    # A publisher outside of ROS has a placeholder as its node name.
    name = "" if info.node_name.startswith("_") else info.node_name
    policies = info.qos_profile
    is_reliable = policies.reliability == ReliabilityPolicy.RELIABLE
    is_latched = policies.durability == DurabilityPolicy.TRANSIENT_LOCAL
    return Endpoint(
        node=f"{info.node_namespace.rstrip('/')}/{name}" if name else "",
        type=info.topic_type,
        reliability="reliable" if is_reliable else "best_effort",
        durability="transient_local" if is_latched else "volatile",
        endpoint=bytes(info.endpoint_gid),
        deadline_s=_seconds(policies.deadline),
    )
