"""The state of the whole tree: publishers, rates, ages and faults."""

from __future__ import annotations

from itertools import islice, pairwise

import msgspec

from webviz.data.names import readable
from webviz.data.transforms.buffer import TransformBuffer
from webviz.data.transforms.cache import Cache, TimeCache
from webviz.data.transforms.errors import NS_PER_S
from webviz.data.transforms.reasons import MAX_LISTED, YEAR_NS, in_words, listed
from webviz.data.transforms.tree import ancestors, roots

GAP_NS = NS_PER_S // 2
GAP_PERIODS = 10
"""A moving frame has a gap if one of its periods is as long as this and as many usual ones."""
GAP_SAMPLES = 200
"""Newest samples searched for gaps."""
STALE_NS = NS_PER_S
STALE_PERIODS = 5
"""A moving frame is stale after a second and five of its periods without a transform."""


class FrameReport(msgspec.Struct, frozen=True):
    """One child frame.

    Attributes:
        frame: its id.
        parent: its parent now; empty if its samples were cleared.
        is_static: whether it holds at all times.
        publishers: the known recent ones, the current one last.
        rate_hz: samples per second of their stamps; 0 for a static frame or a single sample.
        newest_ns: stamp of the newest sample, 0 for a static frame.
        age_ns: now minus that; None for a static frame.
        delay_ns: from the stamp of the last one to its reception; None if unknown.
        samples: number of samples kept.
        history_ns: time between the oldest and the newest of them.
        problems: sentences.
        gap_ns: the longest of the recent times without a transform; 0 if none is unusual.
        parents: between which its publishers disagree; none if they agree.
    """

    frame: str
    parent: str
    is_static: bool
    publishers: tuple[str, ...]
    rate_hz: float
    newest_ns: int
    age_ns: int | None
    delay_ns: int | None
    samples: int
    history_ns: int
    problems: tuple[str, ...]
    gap_ns: int = 0
    parents: tuple[str, ...] = ()


class Diagnosis(msgspec.Struct, frozen=True):
    """The tree as a whole.

    Attributes:
        roots: frames without a parent, in order of first mention; more than one means that some
            frames cannot be shown in some others.
        loops: cycles of parents, each from a frame back to itself.
        frames: every child frame, in order of first mention.
    """

    roots: tuple[str, ...]
    loops: tuple[tuple[str, ...], ...]
    frames: tuple[FrameReport, ...]

    @property
    def names(self) -> list[str]:
        """All frames, roots first."""
        return list(dict.fromkeys([*self.roots, *(report.frame for report in self.frames)]))

    @property
    def problems(self) -> list[str]:
        """All faults, one sentence each."""
        problems = [
            f"The frames form a loop: {listed(loop, ' → ')}. Two publishers disagree about the "
            "parents; stop one of them."
            for loop in self.loops[:MAX_LISTED]
        ]
        if len(self.roots) > 1:
            problems.append(
                f"No transform connects the {len(self.roots)} trees with the roots "
                f"{listed(self.roots)}."
            )
        return problems + [problem for report in self.frames for problem in report.problems]


def diagnose(buffer: TransformBuffer, now_ns: int = 0) -> Diagnosis:
    """Diagnose every frame.

    Args:
        buffer: the transforms.
        now_ns: the current ROS time; 0 for the newest of all stamps.
    """
    tree = buffer.tree
    now_ns = now_ns or max((cache.newest_stamp for cache in tree.caches.values()), default=0)
    tops = dict.fromkeys(roots(tree).values())
    frames = [report(buffer, name, now_ns) for name in tree.names if name in tree.caches]
    ends = tuple(name for name in tree.names if name in tops and len(ancestors(tree, name)) == 1)
    return Diagnosis(ends, loops(buffer), tuple(frames))


def loops(buffer: TransformBuffer) -> tuple[tuple[str, ...], ...]:
    """Return the cycles of parents, each from a frame back to itself."""
    tree = buffer.tree
    tops = dict.fromkeys(roots(tree).values())
    return tuple(tuple(chain) for top in tops if len(chain := ancestors(tree, top)) > 1)


def tree_text(buffer: TransformBuffer, now_ns: int = 0) -> str:
    """Return the tree as indented lines, each frame with its kind, rate, age and publisher.

    A name is one readable line, so that none forges another line.
    """
    diagnosis = diagnose(buffer, now_ns)
    reports = {report.frame: report for report in diagnosis.frames}
    children: dict[str, list[str]] = {}
    for report in diagnosis.frames:
        children.setdefault(report.parent, []).append(report.frame)

    lines: list[str] = []
    starts = [*diagnosis.roots, *(loop[0] for loop in diagnosis.loops)]
    # Not recursive: a chain of frames may be longer than Python's stack.
    pending = [(start, "", "") for start in reversed(starts)]
    met: set[str] = set()
    while pending:
        frame, lead, below = pending.pop()
        if frame in met:
            lines.append(f"{lead}{readable(frame)} (loop)")
            continue
        met.add(frame)
        report = reports.get(frame)
        suffix = f"  [{', '.join(map(readable, facts(report)))}]" if report else ""
        lines.append(
            f"{lead}{readable(frame)}{suffix}{'  !' if report and report.problems else ''}"
        )
        forks = [("├─ ", "│  ")] * (len(children.get(frame, [])) - 1) + [("└─ ", "   ")]
        own = [
            (child, f"{below}{fork}", f"{below}{rest}")
            for child, (fork, rest) in zip(children.get(frame, []), forks, strict=False)
        ]
        pending += reversed(own)
    return "\n".join(lines)


def facts(report: FrameReport) -> list[str]:
    """Kind or rate of a frame, its age and its publisher, in words."""
    if report.is_static:
        texts = ["static"]
    elif not report.samples:
        texts = ["no data"]
    else:
        texts = [f"{report.rate_hz:.1f} Hz"] if report.rate_hz else ["one sample"]
        if report.age_ns is not None:
            texts.append(_age(report.newest_ns, report.age_ns))
    if report.publishers:
        texts.append(f"from {', '.join(report.publishers)}")
    return texts


def _age(stamp_ns: int, age_ns: int) -> str:
    if stamp_ns < YEAR_NS and age_ns > YEAR_NS:
        return f"simulated time {stamp_ns / NS_PER_S:.1f} s"
    return f"{in_words(age_ns)} {'ahead' if age_ns < 0 else 'old'}"


def _gap(cache: Cache) -> int:
    """Return the longest of the recent times without a transform, 0 if none is unusual."""
    if not isinstance(cache, TimeCache) or len(cache) <= GAP_PERIODS:
        return 0
    stamps = islice(cache.stamps, max(0, len(cache) - GAP_SAMPLES), None)
    periods = sorted(after - before for before, after in pairwise(stamps))
    usual, longest = periods[len(periods) // 2], periods[-1]
    return longest if longest >= max(GAP_NS, GAP_PERIODS * usual) else 0


def report(buffer: TransformBuffer, frame: str, now_ns: int) -> FrameReport:
    """Diagnose one child frame."""
    cache = buffer.tree.caches[frame]
    newest = cache.newest
    history_ns = cache.newest_stamp - cache.oldest_stamp
    rate_hz = (len(cache) - 1) * NS_PER_S / history_ns if history_ns else 0.0
    age_ns = now_ns - cache.newest_stamp if isinstance(cache, TimeCache) and cache else None
    conflicts = buffer.conflicts.of(frame)
    problems = [str(conflict.problem) for conflict in conflicts]
    parents = dict.fromkeys(parent for conflict in conflicts for parent in conflict.parents)
    if newest is None:
        problems.append(f'No transform of "{frame}" has arrived since the transforms were cleared.')
    if age_ns is not None and age_ns > STALE_NS and age_ns * rate_hz > STALE_PERIODS * NS_PER_S:
        problems.append(
            f'"{frame}" has stopped: its last transform is {in_words(age_ns)} old, previously '
            f"{rate_hz:.1f} Hz. Restart its publisher."
        )
    rejection = buffer.refusals.rejections.get(frame)
    if rejection:
        problems.append(
            f'{rejection.count} transforms of "{frame}" were refused, the last because '
            f"{rejection.sentence} ({rejection.reason})."
        )
    return FrameReport(
        frame=frame,
        parent=newest[1] if newest else "",
        is_static=cache.is_static,
        publishers=tuple(buffer.who(frame)),
        rate_hz=rate_hz,
        newest_ns=cache.newest_stamp,
        age_ns=age_ns,
        delay_ns=cache.delay_ns,
        samples=len(cache),
        history_ns=history_ns,
        problems=tuple(problems),
        gap_ns=_gap(cache),
        parents=tuple(parents) if len(parents) > 1 else (),
    )
