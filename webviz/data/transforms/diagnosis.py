"""The state of the whole tree: publishers, rates, ages and faults."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice, pairwise

from webviz.data.transforms.buffer import TransformBuffer
from webviz.data.transforms.cache import Cache, TimeCache
from webviz.data.transforms.errors import NS_PER_S
from webviz.data.transforms.quarrels import quarrels
from webviz.data.transforms.reasons import YEAR_NS, in_words
from webviz.data.transforms.tree import ancestors

GAP_NS = NS_PER_S // 2
GAP_PERIODS = 10
"""A moving frame has a gap if one of its periods is as long as this and as many usual ones."""
GAP_SAMPLES = 200
"""Newest samples searched for gaps."""
STALE_NS = NS_PER_S
STALE_PERIODS = 5
"""A moving frame is stale after a second and five of its periods without a transform."""


@dataclass(frozen=True)
class FrameReport:
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


@dataclass(frozen=True)
class Diagnosis:
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
    def problems(self) -> list[str]:
        """All faults, one sentence each."""
        found = [
            f"The frames form a loop: {' → '.join(loop)}. Two publishers disagree about the "
            "parents; stop one of them."
            for loop in self.loops
        ]
        if len(self.roots) > 1:
            found.append(
                f"No transform connects the {len(self.roots)} trees with the roots "
                f"{', '.join(self.roots)}."
            )
        return found + [problem for report in self.frames for problem in report.problems]


def diagnose(buffer: TransformBuffer, now_ns: int = 0) -> Diagnosis:
    """Diagnose every frame.

    Args:
        buffer: the transforms.
        now_ns: the current ROS time; 0 for the newest of all stamps.
    """
    tree = buffer.tree
    now_ns = now_ns or max((cache.newest_stamp for cache in tree.caches.values()), default=0)
    roots: list[str] = []
    loops: dict[frozenset[str], tuple[str, ...]] = {}
    for name in tree.names:
        cache = tree.caches.get(name)
        if cache is None or cache.newest is None:
            roots.append(name)
            continue
        chain = ancestors(tree, name)
        if chain[-1] == name:
            loops.setdefault(frozenset(chain), tuple(chain))
    frames = [
        _report(buffer, name, tree.caches[name], now_ns)
        for name in tree.names
        if name in tree.caches
    ]
    return Diagnosis(tuple(roots), tuple(loops.values()), tuple(frames))


def tree_text(buffer: TransformBuffer, now_ns: int = 0) -> str:
    """The tree as indented lines, each frame with its kind, rate, age and publisher."""
    diagnosis = diagnose(buffer, now_ns)
    reports = {report.frame: report for report in diagnosis.frames}
    children: dict[str, list[str]] = {}
    for report in diagnosis.frames:
        children.setdefault(report.parent, []).append(report.frame)

    def lines(frame: str, lead: str, below: str, path: tuple[str, ...]) -> Iterator[str]:
        if frame in path:
            yield f"{lead}{frame} (loop)"
            return
        yield f"{lead}{frame}{_facts(reports.get(frame))}"
        own = children.get(frame, [])
        for i, child in enumerate(own):
            is_last = i == len(own) - 1
            yield from lines(
                child,
                f"{below}{'└─ ' if is_last else '├─ '}",
                f"{below}{'   ' if is_last else '│  '}",
                (*path, frame),
            )

    starts = [*diagnosis.roots, *(loop[0] for loop in diagnosis.loops)]
    return "\n".join(line for start in starts for line in lines(start, "", "", ()))


def _facts(report: FrameReport | None) -> str:
    if report is None:
        return ""
    if report.is_static:
        facts = ["static"]
    elif not report.samples:
        facts = ["no data"]
    else:
        facts = [f"{report.rate_hz:.1f} Hz"] if report.rate_hz else ["one sample"]
        if report.age_ns is not None:
            facts.append(_age(report.newest_ns, report.age_ns))
    if report.publishers:
        facts.append(f"from {', '.join(report.publishers)}")
    flag = "  !" if report.problems else ""
    return f"  [{', '.join(facts)}]{flag}"


def _age(stamp_ns: int, age_ns: int) -> str:
    if stamp_ns < YEAR_NS and age_ns > YEAR_NS:
        return f"simulated time {stamp_ns / NS_PER_S:.1f} s"
    return f"{in_words(age_ns)} {'ahead' if age_ns < 0 else 'old'}"


def _gap(cache: Cache) -> int:
    """The longest of the recent times without a transform, 0 if none is unusual."""
    if not isinstance(cache, TimeCache) or len(cache) <= GAP_PERIODS:
        return 0
    stamps = islice(cache.stamps, max(0, len(cache) - GAP_SAMPLES), None)
    periods = sorted(after - before for before, after in pairwise(stamps))
    usual, longest = periods[len(periods) // 2], periods[-1]
    return longest if longest >= max(GAP_NS, GAP_PERIODS * usual) else 0


def _report(buffer: TransformBuffer, frame: str, cache: Cache, now_ns: int) -> FrameReport:
    newest = cache.newest
    publishers = buffer.publishers[frame]
    history_ns = cache.newest_stamp - cache.oldest_stamp
    rate_hz = (len(cache) - 1) * NS_PER_S / history_ns if history_ns else 0.0
    age_ns = now_ns - cache.newest_stamp if isinstance(cache, TimeCache) and cache.stamps else None
    problems = [*quarrels(buffer, frame)]
    if newest is None:
        problems.append(f'No transform of "{frame}" has arrived since the transforms were cleared.')
    if age_ns is not None and age_ns > STALE_NS and age_ns * rate_hz > STALE_PERIODS * NS_PER_S:
        problems.append(
            f'"{frame}" has stopped: its last transform is {in_words(age_ns)} old, previously '
            f"{rate_hz:.1f} Hz. Restart its publisher."
        )
    rejection = buffer.rejections.get(frame)
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
        delay_ns=publishers.delay_ns,
        samples=len(cache),
        history_ns=history_ns,
        problems=tuple(problems),
        gap_ns=_gap(cache),
    )
