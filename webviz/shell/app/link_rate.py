"""Rates of links as people write them."""

from __future__ import annotations

import re

from webviz.api.errors import Error

FACTORS = {"": 1.0, "k": 1e3, "M": 1e6, "G": 1e9}
"""Decimal prefixes of ISO 80000."""
LEAST_BITS = 100e3
_RATE = re.compile(r"(\d+(?:\.\d*)?)\s*([kMG]?)bit/s")


def bytes_per_second(text: str) -> float:
    """Return the rate of a link in bytes a second, of a text such as "5Mbit/s".

    Raises:
        Error: the text is not such a rate, or the rate is below 100 kbit/s.
    """
    match = _RATE.fullmatch(text.strip())
    if match is None:
        raise Error(f"{text!r} is not the rate of a link. Write it as 5Mbit/s or 500kbit/s.")
    bits = float(match[1]) * FACTORS[match[2]]
    if not LEAST_BITS <= bits < float("inf"):
        raise Error(f"The rate of the link is {text}; the least is 100kbit/s.")
    return bits / 8
