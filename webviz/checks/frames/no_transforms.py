"""No transforms at all."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import NO_OFFER, Observation
from webviz.data.transforms.reasons import Kind


class NoTransforms(Check):
    """No transforms.

    No transform has arrived, so only data in the fixed frame itself can be drawn.

    Why:
        Every sensor measures in its own frame. Without transforms there is no place for it.

    Repair:
        Start the nodes that publish transforms: robot_state_publisher for the links of the robot,
        its odometry, and localisation or SLAM. See who publishes any with

            ros2 topic info /tf --verbose
    """

    id = "TF001"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding if nothing is known of any frame: a note if all data can be drawn."""
        explains = tuple(symptom for symptom, _ in observation.unplaced(Kind.NO_TRANSFORMS))
        if not explains or (
            observation.is_recorded and "none" not in (observation.buffer.recorded or "none")
        ):
            return
        offers = [observation.offers.get(topic, NO_OFFER) for topic in ("/tf", "/tf_static")]
        offers = [offer for offer in offers if offer.publishers]
        if (
            offers
            and not observation.is_recorded
            and all(offer.requested is None for offer in offers)
        ):
            return  # they have just been found
        elsewhere = next(
            (
                t
                for t in observation.offers
                if t.endswith("/tf") and t != "/tf" and observation.nodes_of(t)
            ),
            "",
        )
        nodes = observation.nodes_of("/tf") or observation.nodes_of("/tf_static")
        others = observation.nodes_of(elsewhere) if elsewhere else ""
        has_data = observation.is_recorded or any(observation.inputs())
        is_harmless = has_data and not any(each.display for each in explains)
        yield self.found(
            f"{nodes} publishes transforms, but none has arrived."
            if nodes
            else "The bag has no transforms."
            if observation.is_recorded
            else f"No node publishes /tf, but {others} publishes {elsewhere}."
            if elsewhere
            else "No node publishes transforms.",
            "Record /tf and /tf_static as well, or use the frame of the data as the fixed frame."
            if observation.is_recorded
            else "Let webviz listen there, or let the robot publish /tf without its namespace."
            if elsewhere
            else "Start robot_state_publisher, the odometry and localisation.",
            severity=Severity.NOTE if is_harmless else Severity.ERROR,
            evidence={"publishers": nodes, "fixed_frame": observation.fixed_frame},
            command=f"webviz --ros-args -r /tf:={elsewhere} -r /tf_static:={elsewhere}_static"
            if elsewhere
            else "ros2 topic info /tf --verbose",
            explains=explains,
        )
