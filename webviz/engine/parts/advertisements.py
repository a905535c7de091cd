"""Publishing by tools and panels: names, QoS, and the sentence on the result."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import CancelledError, Future

from webviz.api.declared import Topic
from webviz.api.errors import Error
from webviz.api.status import Level, Status
from webviz.engine.parts.part import PartContext
from webviz.sources import Advertisement
from webviz.sources.graph import UNKNOWN

DEPTH = 5
"""Queue depth of a publisher, RViz's."""
Report = Callable[[Status], None]


def advertisement_of(
    context: PartContext, type: str, topic: Topic, depth: int = DEPTH
) -> Advertisement | None:
    """Return where messages of a type are published; None if the topic has no valid name."""
    try:
        name = context.player.resolve(topic.name) if topic.name else ""
    except ValueError:
        return None
    if not name:
        return None
    return Advertisement(
        name,
        type,
        "best_effort" if topic.reliability == "best_effort" else "reliable",
        "transient_local" if topic.durability == "transient_local" else "volatile",
        topic.depth or depth,
    )


def publish(context: PartContext, type: str, topic: Topic, payload: bytes, report: Report) -> bool:
    """Publish a message, and report the result; whether it may be published."""
    advertisement = advertisement_of(context, type, topic)
    if advertisement is None:
        report(Status(Level.ERROR, f"`{topic.name}` is not a valid topic. Choose another one."))
        return False
    publication = context.graph.publish(advertisement, payload)
    publication.add_done_callback(lambda publication: report(_outcome(topic.name, publication)))
    return not context.graph.refusal(advertisement.topic)


def _outcome(topic: str, future: Future[int]) -> Status:
    """Return the result of publishing a message."""
    try:
        count = future.result()
    except (Error, CancelledError) as error:
        return Status(Level.ERROR, str(error) or "The viewer has ended.")
    if count == 0:
        text = f"No subscription to {topic}. Start the node that uses it or choose another topic."
        return Status(Level.WARN, text)
    if count == UNKNOWN:
        text = f"Sent to {topic} through the bridge, which does not report its subscribers."
        return Status(Level.OK, text)
    return Status(Level.OK, f"Published to {topic}, {count} subscription{'s' * (count > 1)}.")
