"""All attacks for some seconds, and that a seed gives them again."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import pytest

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from tests.attack.attack import Case, Outcome, random_of
from tests.attack.run import CORPUS, KINDS, local_attacks, remote_attacks, run
from tests.attack.sockets import kind_of
from tests.attack.target import INTERNAL, Target
from webviz.api.roles import Role

SECONDS = 6.0
SEED = 11
"""One seed, so that a failure is due to a change; `make attack` takes another each time."""


def test_a_viewer_withstands_all_attacks(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    report = run(SEED, SECONDS, tmp_path)
    with capsys.disabled():
        print(f"\n{report}")
    again = f"Again: make attack ARGS='--seed {report.seed}'"
    assert report.breaches == [], f"{report}\n{again}"
    assert report.counts.keys() == set(KINDS)
    assert report.counts[kind_of(Role.OWNER)][Outcome.DONE] > 0


def test_each_case_of_the_corpus_is_documented() -> None:
    text = (CORPUS / "README.md").read_text()
    cases = [path for path in CORPUS.rglob("*__*") if path.is_file()]
    assert cases
    for path in cases:
        assert f"`{path.relative_to(CORPUS)}`" in text
        assert path.parent.name.replace("_", " ") in KINDS
        assert path.stat().st_size < 10_000


def test_a_seed_gives_the_same_attack_again(tmp_path: Path) -> None:
    first, again, other = (
        _draw(tmp_path / name, seed) for name, seed in zip("abc", (7, 7, 8), strict=True)
    )
    assert first.keys() == set(KINDS)
    assert first == again
    for kind, cases in first.items():
        assert cases != other[kind], kind


def _draw(folder: Path, seed: int) -> dict[str, list[Case]]:
    folder.mkdir()
    # Cases depend on no viewer.
    nobody = cast(Target, None)
    attacks = [*local_attacks(folder), *remote_attacks(nobody, domain=0)]
    return {
        attack.kind: [attack.draw(random_of(seed, attack.kind, number)) for number in range(20)]
        for attack in attacks
    }


def test_traces_of_internal_errors_in_the_log_are_recognised() -> None:
    assert INTERNAL.search("webviz: ok\nTraceback (most recent call last):\n")
    assert INTERNAL.search("webviz.server: connection handler failed: TypeError: unhashable\n")
    assert not INTERNAL.search("webviz: Ignored a message of a browser: unknown kind.\n")
