"""Zenoh networks that announce topics and pass on no message."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.bridge import Bridge
from webviz.api.check import Check
from webviz.api.finding import Finding, Symptom
from webviz.api.observation import Observation
from webviz.checks.graph.silence import is_silent
from webviz.checks.graph.silent_publisher import STREAMS
from webviz.data.words import listed

LEAST = 2
"""Silent topics that make a silent network; a single one is its node's."""
NAMED = 3


class ZenohSilence(Check):
    """Zenoh network that announces topics and passes on no message.

    Liveliness tokens of publishers arrive over Zenoh, but no message of any topic that its node
    sends unprompted.

    Why:
        Tokens and messages are rights of their own in the access control of a router: one that
        denies `put` still passes on the graph. Or all nodes wait, as in a simulation that is
        paused.

    Repair:
        Look for `access_control` and `downsampling` in the configs of the routers between, with
        rules for `put`, and let a viewer on the robot itself show whether its nodes publish.
    """

    id = "NET015"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each link over Zenoh from which nothing comes."""
        for bridge in observation.zenoh_links:
            yield from self._silent(bridge, observation)

    def _silent(self, bridge: Bridge, observation: Observation) -> Iterator[Finding]:
        root = f"/{bridge.robot}/" if bridge.robot else "/"
        others = [
            f"/{b.robot}/" for b in observation.bridges if b.robot and b.robot != bridge.robot
        ]
        silent = dict[str, tuple[Symptom, ...]]()
        for display, each in observation.inputs():
            if not each.topic.startswith(root) or each.topic.startswith(tuple(others)):
                continue
            if each.received:
                return
            offer = observation.offers.get(each.topic)
            if offer and {*each.types} & STREAMS and is_silent(observation, display, each, offer):
                silent[each.topic] = silent.get(each.topic, ()) + display.symptom(each.status)
        if len(silent) < LEAST:
            return
        topics = sorted(silent)
        yield self.found(
            f"{bridge.name} announces {listed(topics, NAMED)}, but passes on no message.",
            "Check `access_control` in the config of each router on the way, which may deny `put`; "
            "if it does not, look whether the nodes publish on the robot itself.",
            subject=bridge.name,
            evidence={"router": bridge.name, "topics": tuple(topics)},
            explains=tuple(symptom for each in silent.values() for symptom in each),
        )
