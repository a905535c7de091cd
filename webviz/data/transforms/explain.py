"""Reasons why a frame has no pose at a time, with numbers and a remedy."""

from __future__ import annotations

from dataclasses import replace
from difflib import get_close_matches

from webviz.data.transforms.buffer import TransformBuffer
from webviz.data.transforms.errors import ConnectivityException, LookupException, TransformException
from webviz.data.transforms.explain_time import explain_time
from webviz.data.transforms.geometry import REACH_M, is_within_reach
from webviz.data.transforms.reasons import Explanation, Kind, listed
from webviz.data.transforms.tree import FrameTree, ancestors

SLIP = 0.85
"""Similarity, by difflib, from which a name counts as a misspelling of another."""
MAX_COMPARED = 200
"""Characters of names that are compared: 70 000 of two names would take a second in each turn."""


def explain(
    buffer: TransformBuffer, fixed_frame: str, frame: str, stamp_ns: int, now_ns: int = 0
) -> Explanation:
    """Explain why `frame` has no pose in `fixed_frame` at a stamp.

    Args:
        buffer: the transforms.
        fixed_frame: frame in which everything is drawn.
        frame: frame of the data.
        stamp_ns: time of the data; 0 means the latest.
        now_ns: the current ROS time; 0 if unknown.
    """
    reason = _reason(buffer, fixed_frame, frame, stamp_ns, now_ns)
    return replace(reason, frame=frame)


def _reason(
    buffer: TransformBuffer, fixed_frame: str, frame: str, stamp_ns: int, now_ns: int
) -> Explanation:
    if frame == fixed_frame and frame:
        return Explanation(Kind.AVAILABLE, "Transform OK")
    faulty = _invalid(buffer, fixed_frame, frame)
    if faulty:
        return faulty
    tree = buffer.tree
    try:
        pose, stamp_ns = tree.resolve(fixed_frame, frame, stamp_ns)
    except LookupException:
        return _loop(tree, fixed_frame, frame)
    except ConnectivityException:
        for root in (ancestors(tree, frame)[-1], ancestors(tree, fixed_frame)[-1]):
            if root in buffer.refusals.rejections:
                return _refused(buffer, fixed_frame, frame, root) or _not_connected(
                    tree, fixed_frame, frame
                )
        return _not_connected(tree, fixed_frame, frame)
    except TransformException as error:
        return explain_time(buffer, fixed_frame, frame, stamp_ns, now_ns, str(error))
    if not is_within_reach(pose):
        return _out_of_reach(tree, fixed_frame, frame, stamp_ns)
    return Explanation(Kind.AVAILABLE, "Transform OK")


def _invalid(buffer: TransformBuffer, fixed_frame: str, frame: str) -> Explanation | None:
    """Faults of the names alone."""
    if not frame:
        return Explanation(
            Kind.EMPTY_FRAME,
            "The frame_id is empty. The publisher must name the frame of its data "
            "(header.frame_id).",
        )
    if not fixed_frame:
        return Explanation(Kind.EMPTY_FRAME, "No fixed frame. Choose one.")
    for name, what in ((frame, "The frame_id"), (fixed_frame, "The fixed frame")):
        if name[0] == "/":
            return Explanation(
                Kind.LEADING_SLASH,
                f'{what} "{name}" starts with a slash, which ROS 2 does not allow in frame ids: '
                f'use "{name.lstrip("/")}".',
                other_frame=fixed_frame.lstrip("/") if name == fixed_frame else "",
            )
    names = buffer.tree.names
    for name in (frame, fixed_frame):
        if name not in names and (refused := _refused(buffer, fixed_frame, frame, name)):
            return refused
    if not names and buffer.recorded:
        return Explanation(
            Kind.NO_TRANSFORMS,
            f'No transforms yet, so "{frame}" has no pose in "{fixed_frame}": {buffer.recorded}.',
        )
    if not names:
        return Explanation(
            Kind.NO_TRANSFORMS,
            f'No transforms received, so "{frame}" has no pose in "{fixed_frame}". Start '
            "a publisher on /tf or /tf_static (robot_state_publisher, odometry, "
            "localisation).",
        )
    if fixed_frame not in names:
        return unknown_fixed_frame(buffer, fixed_frame)
    if frame not in names:
        text = f'Frame "{frame}" does not exist'
        near = _nearest(buffer, frame)
        if not near and buffer.recorded:
            sentence = f"{text}: no transform to it comes in the bag until this time."
        elif near:
            sentence = f'{text}. Did you mean "{near}"? Fix the frame_id of the data.'
        else:
            sentence = (
                f"{text}: no transform to it has arrived. Start the node that publishes it, such "
                "as robot_state_publisher, or fix the frame_id of the data."
            )
        return Explanation(Kind.UNKNOWN_FRAME, sentence, near=near)
    return None


def _refused(
    buffer: TransformBuffer, fixed_frame: str, frame: str, missing: str
) -> Explanation | None:
    """Explain that the transform that places a frame was refused, if it was."""
    if (refusal := buffer.refusals.naming(missing)) is None:
        return None
    child, rejection = refusal
    return Explanation(
        Kind.REFUSED,
        f'"{frame}" has no pose in "{fixed_frame}", as the transform of "{child}" was refused: '
        f"{rejection.sentence}. Fix its publisher.",
        cause=child,
        link=child,
    )


def unknown_fixed_frame(buffer: TransformBuffer, fixed_frame: str) -> Explanation:
    """Explain that the fixed frame is unknown, and suggest another one."""
    text = f'Fixed frame "{fixed_frame}" does not exist.'
    kind = Kind.UNKNOWN_FIXED_FRAME
    if near := _nearest(buffer, fixed_frame):
        return Explanation(kind, f'{text} Did you mean "{near}"?', near=near)
    root, size = buffer.largest_tree()
    if fixed_frame == "map":
        text += " Start localisation or SLAM, or use"
    else:
        text += " Use"
    return Explanation(kind, f'{text} "{root}", the root of the largest tree ({size} frames).')


def _nearest(buffer: TransformBuffer, name: str) -> str:
    """Return the frame whose name is misspelled, "" if none is similar enough.

    Frames that differ by a number, a namespace, left or right are distinct.
    """
    if len(name) > MAX_COMPARED:
        return ""
    frames = (frame for frame in buffer.frames() if len(frame) <= MAX_COMPARED)
    candidates = {frame.lower(): frame for frame in frames}
    slip = name.lower()
    for frame in candidates:
        if frame == slip or frame.rpartition("/")[-1] == slip or slip.rpartition("/")[-1] == frame:
            return candidates[frame]
    near = get_close_matches(slip, candidates, 1, SLIP)
    return candidates[near[0]] if near and _digits(near[0]) == _digits(name) else ""


def _digits(name: str) -> str:
    return "".join(filter(str.isdigit, name))


def _out_of_reach(tree: FrameTree, fixed_frame: str, frame: str, stamp_ns: int) -> Explanation:
    up, down = ancestors(tree, frame), ancestors(tree, fixed_frame)
    links: list[tuple[float, str, str]] = []
    for child in set(up) ^ set(down):
        sample = tree.caches[child].at(stamp_ns) if child in tree.caches else None
        if sample is not None:
            links.append((max(map(abs, sample[0][:3])), sample[1], child))
    text = f'"{frame}" is more than {REACH_M:.0e} m from "{fixed_frame}", too far to draw.'
    if links:
        metres, parent, child = max(links)
        text += f' The longest link on the way is "{parent}" → "{child}" with {metres:.3g} m.'
    return Explanation(Kind.OUT_OF_REACH, f"{text} Fix the publisher of that transform.")


def _loop(tree: FrameTree, fixed_frame: str, frame: str) -> Explanation:
    for start in (frame, fixed_frame):
        chain = ancestors(tree, start)
        if chain[-1] in chain[:-1]:
            frames = chain[chain.index(chain[-1]) :]
            loop = listed(frames, " → ")
            return Explanation(
                Kind.LOOP,
                f"The frames form a loop, each the child of the next: {loop}. Two publishers "
                "disagree about the parents: stop one of them.",
                cause=min(frames),
            )
    return Explanation(Kind.LOOP, "The frames formed a loop at that time.")


def _not_connected(tree: FrameTree, fixed_frame: str, frame: str) -> Explanation:
    root, fixed_root = ancestors(tree, frame)[-1], ancestors(tree, fixed_frame)[-1]
    if root == fixed_root:
        return Explanation(
            Kind.NOT_CONNECTED,
            f'At that time no transform connected "{frame}" with "{fixed_frame}"; now one does.',
        )
    for top in (root, fixed_root):
        if top in tree.caches:
            return Explanation(
                Kind.NO_DATA,
                f'No transform of "{top}" has arrived since the transforms were cleared, so '
                f'"{frame}" is not connected with "{fixed_frame}".',
                link=top,
            )
    link = _missing_link(tree, root, fixed_root)
    remedy = link or f'Publish a transform from one to the other, or use "{root}" as fixed frame.'
    return Explanation(
        Kind.NOT_CONNECTED,
        f'"{frame}" and "{fixed_frame}" are in two trees that no transform connects: one has the '
        f'root "{root}", the other "{fixed_root}". {remedy}',
        roots=(root, fixed_root),
        other_frame="" if link else root,
    )


def _missing_link(tree: FrameTree, root: str, fixed_root: str) -> str:
    """Return the usual publisher of the link between two trees (REP 105), "" for none."""
    if fixed_root == "map" and root == "odom":
        return 'Start localisation or SLAM, which publishes "map" → "odom", and initialise it.'
    if root.startswith("base") and "odom" in tree.names and tree.root("odom") == fixed_root:
        return f'Start the odometry of the robot, which publishes "odom" → "{root}".'
    return ""
