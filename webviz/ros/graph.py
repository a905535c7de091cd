"""Output of the node: publishing, service calls, goals."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection, Mapping
from concurrent.futures import Future

from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

from webviz.ros.calls import Calls
from webviz.ros.distribution import NO_EVENTS_OF_PUBLISHERS, publisher_count
from webviz.ros.types import MessageTypeError, learn, message_class
from webviz.sources.goals import Goals
from webviz.sources.graph import Advertisement, Goal
from webviz.sources.jobs import Jobs

MAX_PUBLISHERS = 100
FEEDBACK_DEPTH = 10


class FeedbackSubscriptions:
    """One subscription for the feedback of all goals of an action.

    Args:
        node: that has them.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._subscriptions: dict[str, Subscription] = {}

    def listen(self, topic: str, type: str, arrive: Callable[[bytes], None]) -> Callable[[], bool]:
        """See `webviz.sources.goals.ListenToFeedback`."""
        if topic not in self._subscriptions:
            self._subscriptions[topic] = self._node.create_subscription(
                message_class(type), topic, arrive, QoSProfile(depth=FEEDBACK_DEPTH), raw=True
            )
        subscription = self._subscriptions[topic]
        return lambda: publisher_count(self._node, subscription) > 0


class AdvertisedPublishers:
    """Publishers by advertisement, made when needed; all calls come from the node's thread.

    Args:
        node: that has them.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._publishers: dict[Advertisement, Publisher] = {}
        self._advertised: frozenset[Advertisement] = frozenset()

    def advertise(self, advertisements: Collection[Advertisement]) -> None:
        """Create these ahead of their first messages, and destroy the ones advertised before."""
        before, self._advertised = self._advertised, frozenset(advertisements)
        for advertisement in before - self._advertised:
            self._destroy(advertisement)
        for advertisement in self._advertised:
            with contextlib.suppress(MessageTypeError):  # reported by `publish`
                self._find(advertisement)

    def publish(self, advertisement: Advertisement, cdr: bytes) -> int:
        """Publish a message; the number of matched subscriptions."""
        publisher = self._find(advertisement)
        publisher.publish(cdr)
        return publisher.get_subscription_count()

    def _find(self, advertisement: Advertisement) -> Publisher:
        if advertisement not in self._publishers:
            for _ in range(len(self._publishers) - MAX_PUBLISHERS + 1):
                self._destroy(next(iter(self._publishers)))
            profile = QoSProfile(
                depth=advertisement.depth,
                reliability=ReliabilityPolicy[advertisement.reliability.upper()],
                durability=DurabilityPolicy[advertisement.durability.upper()],
            )
            self._publishers[advertisement] = self._node.create_publisher(
                message_class(advertisement.type),
                advertisement.topic,
                profile,
                event_callbacks=NO_EVENTS_OF_PUBLISHERS,
            )
        return self._publishers[advertisement]

    def _destroy(self, advertisement: Advertisement) -> None:
        if publisher := self._publishers.pop(advertisement, None):
            self._node.destroy_publisher(publisher)


class RosGraph:
    """Publishes, calls services and sends goals; see `webviz.sources.Graph`.

    Args:
        node: whose thread calls `turn` now and then, and often while calls are pending.
        wake: makes that thread call `turn` soon.
    """

    def __init__(self, node: Node, wake: Callable[[], None]) -> None:
        self._node = node
        self._jobs = Jobs(wake, "The connection to ROS has ended.")
        self._publishers = AdvertisedPublishers(node)
        self._calls = Calls(node)
        self._goals = Goals(self.call, self._calls.send, FeedbackSubscriptions(node).listen)
        self._nodes: tuple[str, ...] = ()
        self._services: Mapping[str, str] = {}

    # From any thread

    def advertise(self, advertisements: Collection[Advertisement]) -> Future[None]:
        """Create these publishers ahead of their first messages, and destroy the previous ones."""
        frozen = frozenset(advertisements)
        return self._jobs.put(lambda: self._publishers.advertise(frozen))

    def publish(self, advertisement: Advertisement, cdr: bytes) -> Future[int]:
        """Publish a message; the number of matched subscriptions."""
        return self._jobs.put(lambda: self._publishers.publish(advertisement, cdr))

    def call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        """Call a service; the serialised response."""
        answer: Future[bytes] = Future()
        self._start(answer, lambda: self._calls.send(service, type, request, timeout_s, answer))
        return answer

    def send_goal(
        self, action: str, type: str, goal: bytes, feedback: Callable[[bytes], object]
    ) -> Goal:
        """Send a goal to an action."""
        goal_handle = self._goals.new(action)

        def send() -> None:
            learn(type)
            self._goals.send(action, type, goal, goal_handle, feedback)

        self._start(goal_handle.accepted, send)
        return goal_handle

    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes of the graph, sorted."""
        return self._nodes

    def services(self) -> Mapping[str, str]:
        """Types of the services of the graph by name, without those that actions consist of."""
        return self._services

    # In the thread of the node

    def turn(self) -> bool:
        """Run the queued jobs, and advance the pending calls; whether there are any."""
        self._jobs.run()
        return self._calls.turn()

    def look(self) -> None:
        """Refresh the names of nodes and services."""
        names = self._node.get_node_names_and_namespaces()
        self._nodes = tuple(sorted(f"{space.rstrip('/')}/{name}" for name, space in names))
        services = {
            name: types[0]
            for name, types in self._node.get_service_names_and_types()
            if types and "/_action/" not in name
        }
        if services != self._services:
            self._services = services

    def close(self) -> None:
        """Fail everything that is pending."""
        self._jobs.end()
        self._calls.close()

    def _start(self, answer: Future, do: Callable[[], None]) -> None:
        """Call `do` in the thread of the node, and pass its error to the answer."""

        def pass_on(started: Future[None]) -> None:
            if (error := started.exception()) and not answer.done():
                answer.set_exception(error)

        self._jobs.put(do).add_done_callback(pass_on)
