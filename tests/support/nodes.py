"""Nodes of other programs, each in a context of its own."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from rclpy.client import Client
from rclpy.context import Context
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.node import Node
from waiting import until

RESEND_S = 10.0
"""Patience in seconds for a response, after which its request is sent again."""


@contextmanager
def node_of(domain: int, name: str, kind: Callable[..., Node] = Node) -> Iterator[Any]:
    """A node that is not spun."""
    context = Context()
    context.init(domain_id=domain)
    node = kind(name, context=context)
    try:
        yield node
    finally:
        node.destroy_node()
        context.try_shutdown()


def response_of(client: Client, request: object, executor: Executor) -> Any:
    """Call a service and return its response.

    A client is ready before the server knows where to send its responses, and DDS may lose the
    first one ("failed to send response"): such a request is sent again.
    """
    spin = functools.partial(executor.spin_once, timeout_sec=0.05)
    until(client.service_is_ready, turn=spin)
    futures = [client.call_async(request)]
    sent_at = time.monotonic()

    def response() -> Any:
        nonlocal sent_at
        if time.monotonic() > sent_at + RESEND_S:
            futures.append(client.call_async(request))
            sent_at = time.monotonic()
        return next((future for future in futures if future.done()), None)

    answered = until(response, lambda: f"no response of {client.srv_name}", turn=spin)
    for future in futures:
        client.remove_pending_request(future)
    return answered.result()


class SpunNode:
    """A node that the test spins.

    Args:
        domain: of ROS.
        name: of the node.
        executor: what spins it.
    """

    def __init__(
        self, domain: int, name: str, executor: Callable[..., Executor] = SingleThreadedExecutor
    ) -> None:
        self._context = Context()
        self._context.init(domain_id=domain)
        self.node = Node(name, context=self._context)
        self.executor = executor(context=self._context)
        self.executor.add_node(self.node)

    def turn(self) -> None:
        """Handle what has come."""
        self.executor.spin_once(timeout_sec=0.02)

    def until(self, condition: Callable[[], object], what: str = "") -> None:
        """Spin until something is so that another node or DDS does in its own time."""
        until(condition, lambda: f"not in time: {what}", turn=self.turn)

    def close(self) -> None:
        """End the node."""
        self.executor.shutdown()
        self.node.destroy_node()
        self._context.try_shutdown()
