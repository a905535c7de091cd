"""Protocol client of a display: topics, services and publishers at run time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

T = TypeVar("T")


@dataclass(frozen=True)
class ReceivedMessages:
    """Events on a topic since the last call.

    Args:
        messages: serialised with the encapsulation header, oldest first; each is passed once.
        publishers: labels of the nodes that publish it with the right type.
        endpoints: identities of these publishers; those of a node that is started again are new.
        is_ready: whether a subscription exists, so that no message is missed from now on.
        has_gap: whether messages were dropped, or missed without a subscription.
        is_recorded: whether they are of a bag, which has no services.
    """

    messages: Sequence[bytes] = ()
    publishers: tuple[str, ...] = ()
    endpoints: frozenset[bytes] = frozenset()
    is_ready: bool = False
    has_gap: bool = False
    is_recorded: bool = False


class GraphConnection(Protocol):
    """The connection of a protocol client to the graph; names are resolved like those of topics.

    Passed to `ProtocolClient.communicate` and `Draggable.drag`. Topics that one call of
    `communicate` does not name any more are unsubscribed and not published.
    """

    @property
    def clock_s(self) -> float:
        """Monotonic time in seconds."""
        ...

    @property
    def node(self) -> str:
        """Full name of the viewer's node."""
        ...

    def listen(self, topic: str, type: str, depth: int) -> ReceivedMessages:
        """Subscribe to a topic, reliable and volatile.

        Raises:
            ValueError: it is not a valid topic name; one sentence.
        """
        ...

    def query(
        self, service: str, type: str, timeout_s: float, request: Mapping[str, Any] | None = None
    ) -> Future[bytes]:
        """Call a service that changes nothing; its serialised response.

        Viewers that may not publish can do so, too. Without a request its fields have their
        defaults.

        Raises:
            ValueError: it is not a valid name; one sentence.
        """
        ...

    def advertise(self, topic: str, type: str, depth: int) -> str:
        """Create a publisher ahead of the first message, reliable and volatile.

        Returns:
            Why nothing may be published there, a sentence; "" if it may.

        Raises:
            ValueError: it is not a valid topic name; one sentence.
        """
        ...

    def publish(self, topic: str, values: Mapping[str, Any]) -> None:
        """Publish a message on a topic that is advertised."""
        ...

    def run(self, fn: Callable[..., T], *args: Any) -> Future[T]:
        """Run slow work in a thread, such as reading a large message.

        `communicate` is called after it. Unlike that of `Context.background`, it goes on if a
        drawing does not ask for it.

        Args:
            fn: must not touch the state of the frame loop.
            args: for `fn`.
        """
        ...

    def wake(self) -> None:
        """Have `communicate` called again soon, though nothing arrives."""
        ...
