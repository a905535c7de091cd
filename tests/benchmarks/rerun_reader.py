"""Rerun's reading of a second of messages, for `bench_bags.py`, which runs this in another Python.

Needs `pip install "rerun-sdk[catalog]"`. Reads times in ns from the input, one a line; writes the
number of rows in the second before each.
"""

from __future__ import annotations

import sys

import pyarrow as pa  # pyright: ignore[reportMissingImports]
import rerun as rr  # pyright: ignore[reportMissingImports]
from datafusion import col, lit  # pyright: ignore[reportMissingImports]

INDEX = "message_log_time"
SECOND = 1_000_000_000


def main() -> None:
    """Serve a recording, and answer until the input ends."""
    with rr.server.Server(datasets={"bag": [sys.argv[1]]}) as server:
        client = server.client()  # which the rows do not keep alive
        rows = client.get_dataset("bag").reader(index=INDEX)
        for line in sys.stdin:
            first, last = (
                lit(pa.scalar(each, pa.timestamp("ns"))) for each in (int(line) - SECOND, int(line))
            )
            found = rows.filter((col(INDEX) >= first) & (col(INDEX) <= last)).collect()
            print(sum(each.num_rows for each in found), flush=True)


if __name__ == "__main__":
    main()
