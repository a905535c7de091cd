"""Amounts that are given on the command line: sizes and durations."""

from __future__ import annotations

from webviz.data.words import number_in

UNITS = {"kB": 10**3, "MB": 10**6, "GB": 10**9, "TB": 10**12}
DURATIONS = {"min": 60.0, "s": 1.0}


def bytes_of(text: str) -> int:
    """Return a number of bytes, such as 500MB.

    Raises:
        ValueError: it is none; one sentence with a remedy.
    """
    for unit, factor in UNITS.items():
        number = _number(text, unit)
        if number is not None and number * factor >= 1:
            return round(number * factor)
    raise ValueError(f"`{text}` is not a size. Write it like 500MB or 10GB.")


def memory_of(text: str) -> dict[str, float]:
    """Fields of `memory` in the config, of a duration and perhaps a size, such as 120s,512MB.

    Raises:
        ValueError: it is none, or out of range; one sentence with a remedy.
    """
    duration, comma, size = text.partition(",")
    for unit, factor in DURATIONS.items():
        number = _number(duration, unit)
        if number is not None and 0 <= number * factor <= 3600:
            megabytes = {"megabytes": bytes_of(size) / 1e6} if comma else {}
            return {"seconds": number * factor, **megabytes}
    raise ValueError(
        f"`{text}` is not an amount of memory. Write it like 120s or 120s,512MB, up to 60min."
    )


def _number(text: str, unit: str) -> float | None:
    """Return a finite number before a unit, None if it is something else."""
    return number_in(text.removesuffix(unit)) if text.endswith(unit) else None
