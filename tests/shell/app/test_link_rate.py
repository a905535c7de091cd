"""The rate of --link."""

from __future__ import annotations

import pytest

from webviz.api.errors import Error
from webviz.shell.app.arguments import bytes_per_second


@pytest.mark.parametrize(
    ("text", "bits"), [("5Mbit/s", 5e6), ("500 kbit/s", 5e5), ("1.5Mbit/s", 1.5e6)]
)
def test_rates_are_read_in_decimal_units(text: str, bits: float) -> None:
    assert bytes_per_second(text) == bits / 8


@pytest.mark.parametrize(
    "text", ["5", "5Mbps", "-1Mbit/s", "nan Mbit/s", "0Mbit/s", f"{10**400}bit/s"]
)
def test_invalid_rates_are_refused(text: str) -> None:
    with pytest.raises(Error, match=r"[Tt]he rate of (a|the) link"):
        bytes_per_second(text)
