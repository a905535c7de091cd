"""Statuses of a robot; all lists are bounded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from webviz import Context, OtherFixedFrame, Pose
from webviz.data.transforms import Explanation, Kind
from webviz.data.words import counted, joined, listed
from webviz_urdf import Joint, Robot

NAMED = 5
"""Missing meshes, warnings and links that are listed; the rest is counted."""


def report_robot(robot: Robot, full: Robot | None, ctx: Context) -> None:
    """Report what was read and what is missing.

    Args:
        robot: as loaded.
        full: with its collision shapes, if they are wanted and loaded.
        ctx: receives the statuses.
    """
    missing = [m for m in (full or robot).missing if full or m.kind == "visual"]
    loaded = sum(len(link.visuals) for link in robot.links.values())
    total = loaded + sum(m.kind == "visual" for m in missing)
    text = (
        f"'{robot.name}': {counted(len(robot.links), 'link')}, {loaded} of {total} visuals loaded."
    )
    (ctx.ok if total else ctx.warn)("URDF", text)
    if missing:
        reasons = _first([f"Link '{m.link}': {m.reason}" for m in missing])
        ctx.error("Meshes", f"{counted(len(missing), 'shape')} missing. {reasons}")
    if robot.warnings:
        ctx.warn("URDF warnings", _first(robot.warnings))


def report_unknown(
    kind: str, chosen: Sequence[str], all_names: Sequence[str], ctx: Context
) -> None:
    """Report settings of links or joints that the robot does not have."""
    unknown = sorted(set(chosen) - set(all_names))
    if unknown:
        names = listed(unknown, NAMED)
        ctx.warn(f"{kind} settings", f"The robot has no {kind.lower()} named {names}.")


def why_lost(robot: Robot, link: str, reason: Explanation) -> Explanation:
    """Return why a link has no pose; the description may give a better reason than `reason`."""
    joint = next((joint for joint in robot.joints.values() if joint.child == link), None)
    if reason.kind != Kind.UNKNOWN_FRAME or joint is None:
        return reason
    if joint.type == "fixed":
        return replace(
            reason,
            sentence=f"No transform to '{link}' has arrived. Start robot_state_publisher with this "
            "description.",
            cause="fixed joints",
        )
    return replace(
        reason,
        sentence=f"No transform to '{link}' has arrived: the state of its joint '{joint.name}' is "
        "probably not published. Start the driver or joint_state_publisher, which publish "
        "/joint_states.",
        cause="moving joints",
        joint=joint.name,
    )


def report_places(
    total: int,
    unplaced: Sequence[str],
    reasons: Mapping[str, Explanation],
    source: str,
    lacks: str,
    ctx: Context,
) -> None:
    """Report which links have no pose.

    Args:
        total: links that should be drawn.
        unplaced: names of the links without a pose.
        reasons: by the first link that has each reason.
        source: of the poses.
        lacks: what the lost links have not.
        ctx: receives the statuses.
    """
    if not unplaced:
        ctx.ok("Links", f"{counted(total, 'link')} placed by {source}.")
        return
    ctx.error(
        "Links",
        f"{len(unplaced)} of {counted(total, 'link')} without {lacks}: {listed(unplaced, NAMED)}. "
        "Links seen before stay in grey at their last pose.",
    )
    for link, reason in reasons.items():
        ctx.error(f"Link {link}", reason.sentence, OtherFixedFrame.of(reason), reason)


def report_joints(missing: Sequence[str], total: int, fault: str, ctx: Context) -> None:
    """Report which joints have no position.

    Args:
        missing: their names.
        total: joints that need one.
        fault: why the newest joint state is invalid, or "".
        ctx: receives the statuses.
    """
    if fault:
        ctx.error("Joint states", fault)
    if missing:
        ctx.error(
            "Joints",
            f"{len(missing)} of {counted(total, 'joint')} without a position: "
            f"{listed(missing, NAMED)}. The links that they move are grey. Start the driver or "
            "joint_state_publisher that reports these joints.",
        )
    else:
        ctx.ok("Joints", f"The positions of {counted(total, 'joint')} are known.")


def report_link(link: str, pose: Pose, ctx: Context) -> None:
    """Report the pose of a link in the fixed frame."""
    x, y, z = pose.position
    qw, qx, qy, qz = pose.wxyz
    ctx.ok(
        f"Link {link}",
        f"Position ({x:.3f}, {y:.3f}, {z:.3f}) m, "
        f"orientation x, y, z, w ({qx:.4f}, {qy:.4f}, {qz:.4f}, {qw:.4f}).",
    )


def report_joint(joint: Joint, ctx: Context) -> None:
    """Report how a joint moves."""
    unit = "m" if joint.type == "prismatic" else "rad"
    text = f"{joint.type.capitalize()}, from {joint.parent} to {joint.child}"
    if joint.limits:
        text += f", {joint.limits[0]:g} to {joint.limits[1]:g} {unit}"
    if has_axis(joint):
        text += ", axis ({:g}, {:g}, {:g})".format(*joint.axis)
    ctx.ok(f"Joint {joint.name}", text + ".")


def has_axis(joint: Joint) -> bool:
    """Return whether a joint moves along or about an axis."""
    return joint.type not in ("fixed", "floating") and any(joint.axis)


def _first(sentences: Sequence[str]) -> str:
    rest = len(sentences) - NAMED
    return joined(*sentences[:NAMED], f"And {rest} more." if rest > 0 else "")
