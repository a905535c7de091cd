"""Trees of frames that are not connected."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.api.status import OtherFixedFrame
from webviz.data.transforms.conflicts import ConflictKind
from webviz.data.transforms.reasons import Kind
from webviz.data.transforms.tree import ancestors


class TwoTrees(Check):
    """Two trees of frames.

    The frames form trees that no transform connects, and data of one tree is to be drawn in the
    other.

    Why:
        A transform exists only within a tree. The link between the trees has no publisher, or its
        frames are named differently by two nodes.

    Repair:
        Publish the missing transform. If the sensor does not move on the robot:

            ros2 run tf2_ros static_transform_publisher --frame-id base_link --child-frame-id laser
    """

    id = "TF006"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each pair of trees that displays need together."""
        contested = {frame for frame, _ in observation.conflicts(ConflictKind.TWO_PARENTS)}
        for symptom, reason in observation.unplaced(Kind.NOT_CONNECTED):
            if not reason.roots:
                continue  # it was not connected at that time, and now it is
            if contested & {*ancestors(observation.buffer.tree, reason.frame)}:
                continue  # its parent decides, on which two publishers disagree
            root, fixed_root = reason.roots
            yield self.found(
                f'No transform connects the tree of "{root}" with that of "{fixed_root}".',
                f'Publish the transform from a frame of one to "{root}".',
                subject=root,
                severity=Severity.ERROR,
                evidence={"frame": reason.frame, "root": root, "fixed_root": fixed_root},
                command="ros2 run tf2_ros static_transform_publisher "
                f"--frame-id {fixed_root} --child-frame-id {root}",
                button=OtherFixedFrame.of(reason),
                explains=(symptom,),
            )
