"""Two demos on one machine."""

from __future__ import annotations

import os

import pytest

from webviz.shell.domains import VARIABLE, demo_domain
from webviz.shell.testing.domain import isolated_domain


def test_a_second_demo_takes_a_domain_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    with demo_domain(), demo_domain() as second:
        of_second = os.environ[VARIABLE]
        assert second.endswith(f"so this one is in its own ROS domain: ROS_DOMAIN_ID={of_second}")
        assert of_second != "0"
    assert VARIABLE not in os.environ


def test_an_explicit_domain_is_kept_and_mixed_robots_are_reported() -> None:
    with isolated_domain() as domain, demo_domain() as first:
        with demo_domain() as second:
            assert "the robots of both mix" in second
            assert os.environ[VARIABLE] == str(domain)
        assert first == ""


@pytest.mark.parametrize("named", ["none", "-1", "9999999"])
def test_a_domain_that_dds_does_not_have_is_left_to_dds(
    monkeypatch: pytest.MonkeyPatch, named: str
) -> None:
    monkeypatch.setenv(VARIABLE, named)
    with demo_domain():
        assert os.environ[VARIABLE] == named
