"""Amounts of the command line."""

from __future__ import annotations

import pytest

from webviz.files.config.model import MemorySettings
from webviz.shell.cli.amounts import bytes_of, memory_of
from webviz.shell.cli.viewing_options import ViewingOptions


@pytest.mark.parametrize(
    ("text", "fields"),
    [
        ("120s", {"seconds": 120.0}),
        ("2min,1.5GB", {"seconds": 120.0, "megabytes": 1500.0}),
        ("0s", {"seconds": 0.0}),
    ],
)
def test_memory_is_a_duration_and_perhaps_a_size(text: str, fields: dict[str, float]) -> None:
    assert memory_of(text) == fields


@pytest.mark.parametrize("text", ["", "120", "s", "-1s", "1e9s", "nans", "5h", "60s,", "60s,5"])
def test_anything_else_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="Write it like"):
        memory_of(text)


@pytest.mark.parametrize("text", ["", "5", "MB", "infGB", "-1MB", "0.1"])
def test_invalid_sizes_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match="is not a size"):
        bytes_of(text)


def test_the_option_overrides_the_config() -> None:
    config = ViewingOptions(memory="90s").read(None)
    assert config.settings.memory == MemorySettings(seconds=90.0)
