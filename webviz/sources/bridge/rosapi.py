"""The lists of rosapi: topics with their definitions, and nodes; asked for again and again."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from webviz.data.words import listed, plain
from webviz.sources.bridge import rosbridge_wire as wire
from webviz.sources.names import MAX_NAME, is_full_name

POLL_S = 2.0
"""Pause in seconds between two readings of the topics, of which rosbridge tells no changes."""
NODES_EACH = 5
"""Readings of the topics for one of the nodes."""
LATE_S = 6.0
"""Time in seconds without an answer of rosapi, after which that is said."""
MAX_TOPICS = 10_000
MAX_TEXTS = 256 << 20
"""Characters of all definitions."""
GET_PARAMETERS = "rcl_interfaces/srv/GetParameters"
START = (
    "Start rosbridge with `ros2 launch rosbridge_server rosbridge_websocket_launch.xml`, which "
    "starts rosapi, too."
)
NO_DEFINITION = "# failed to get full definition text"
"""Text in place of a definition that rosapi does not have."""

Take = Callable[[wire.RosbridgeResponse], object]


class Rosapi:
    """Lists of rosapi, bounded in number and size.

    Only services are called that no race makes fail: an exception in one ends rosapi.

    Args:
        call: calls a service with its fields, and passes the response on.
        changed: called when something else is listed.
    """

    def __init__(
        self, call: Callable[[str, Mapping[str, Any], Take], None], changed: Callable[[], object]
    ) -> None:
        self._call = call
        self._changed = changed
        self.types: Mapping[str, str] = {}
        """Types by topic."""
        self.texts: dict[str, str] = {}
        """Definitions by type, "" if rosapi has none."""
        self.nodes: tuple[str, ...] = ()
        """Full names, sorted."""
        self.with_parameters: tuple[str, ...] = ()
        """Nodes with services for parameters."""
        self._requested_s: float | None = None
        """Moment of the reading that is not answered yet."""
        self._problem = ""
        self._left_out: list[str] = []
        self._polls = 0
        self._timer: asyncio.TimerHandle | None = None

    def start(self) -> None:
        """Ask for the topics, and again and again."""
        self._requested_s = time.monotonic()
        self._call("/rosapi/topics", {}, self._take_topics)
        if self._polls % NODES_EACH == 0:
            self._call("/rosapi/nodes", {}, self._take_nodes)
            self._call("/rosapi/services_for_type", {"type": GET_PARAMETERS}, self._take_services)
        self._polls += 1

    def close(self) -> None:
        """Ask no more."""
        if self._timer is not None:
            self._timer.cancel()

    def remarks(self) -> Sequence[str]:
        """Sentences: what rosapi lacks, and what is left out of its lists."""
        late_s = 0.0 if self._requested_s is None else time.monotonic() - self._requested_s
        late = f"rosapi has not answered for {late_s:.0f} s, so topics may be missing. {START}"
        problem = [self._problem] if self._problem else []
        return [*([late] if late_s > LATE_S else []), *problem, *self._left_out]

    def _take_topics(self, response: wire.RosbridgeResponse) -> None:
        self._requested_s = None
        self._timer = asyncio.get_running_loop().call_later(POLL_S, self.start)
        if not response.result:
            reason = plain(str(response.values), 200).rstrip(".")
            self._problem = f"rosbridge cannot list its topics: {reason}. {START}"
            self._changed()
            return
        self._problem = ""
        topics = wire.converted(response.values, wire.Topics)
        types = dict(zip(topics.topics, topics.types, strict=False))
        is_new = types != self.types
        self.types = self._bounded(types)
        if not self.texts.keys() >= set(self.types.values()):
            self._call("/rosapi/topics_and_raw_types", {}, self._take_definitions)
        if is_new:
            self._changed()

    def _take_definitions(self, response: wire.RosbridgeResponse) -> None:
        topics = wire.converted(response.values, wire.Topics) if response.result else wire.Topics()
        size = 0
        for type, text in zip(topics.types, topics.typedefs_full_text, strict=False):
            size += len(text)
            if size <= MAX_TEXTS:
                self.texts[type] = "" if text.startswith(NO_DEFINITION) else text
        # What came up since is known to be missing only then, and asked for once.
        for type in self.types.values():
            self.texts.setdefault(type, "")
        self._changed()

    def _take_nodes(self, response: wire.RosbridgeResponse) -> None:
        if response.result:
            names = wire.converted(response.values, wire.Names)
            self.nodes = tuple(sorted(set(filter(is_full_name, names.nodes[:MAX_TOPICS]))))
            self._changed()

    def _take_services(self, response: wire.RosbridgeResponse) -> None:
        if response.result:
            names = wire.converted(response.values, wire.Names)
            nodes = {name.rpartition("/")[0] for name in names.services[:MAX_TOPICS]}
            self.with_parameters = tuple(sorted(filter(is_full_name, nodes)))
            self._changed()

    def _bounded(self, types: Mapping[str, str]) -> dict[str, str]:
        """Return the topics that are kept, and note what is left out."""
        valid = {t: type for t, type in types.items() if is_full_name(t) and len(type) <= MAX_NAME}
        misnamed = [plain(topic, 40) for topic in types if topic not in valid]
        bounded = dict(list(valid.items())[:MAX_TOPICS])
        more = len(valid) - len(bounded)
        self._left_out = [
            *([f"The bridge offers {more} topics more than webviz reads."] if more else []),
            *(
                [f"Topics whose names ROS does not allow are left out: {listed(misnamed, 3)}."]
                if misnamed
                else []
            ),
        ]
        return bounded
