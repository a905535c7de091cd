"""Bags whose chunks and messages claim, or unfold to, more than a machine has."""

from __future__ import annotations

from functools import cache
from random import Random

import lz4.frame
import zstandard
from mcap_files import Chunk, mcap, packed, plain, words

from tests.attack.attack import Case, mutated

CLAIMS = (0, 1, 300, 4 << 20, 256 << 20, (256 << 20) + 1, 2**32, 2**63, 2**64 - 1)
SIZES = (0, 22, 300, 2**32, 2**63, 2**64 - 1)


@cache
def _zeros(compression: str, is_sized: bool) -> bytes:
    """One frame of zeros."""
    if compression == "lz4":
        return lz4.frame.compress(bytes(16 << 20), store_size=is_sized)
    return zstandard.ZstdCompressor(write_content_size=is_sized).compress(bytes(64 << 20))


def _bomb(random: Random) -> Chunk:
    compression = random.choice(("zstd", "zstd", "lz4"))
    data = _zeros(compression, random.random() < 0.5) * random.choice((1, 5, 70))
    if random.random() < 0.3:  # begins as it should
        data = packed(words(3, 4), compression) + data
    span_ns = random.choice(((3, 5), (0, 9), (9, 0), (0, 2**64 - 1)))
    return Chunk(data, random.choice(CLAIMS), compression, span_ns)


def draw(random: Random) -> Case:
    """Plays bags with chunk bombs in a process of its own."""
    first = random.randrange(100)
    chunks: list[Chunk | bytes] = [plain(first, first + 1), plain(207, 209)]
    for _ in range(random.choice((1, 1, 1, 3))):
        chunks.insert(random.randrange(3), _bomb(random))
    if random.random() < 0.3:
        honest = plain(*range(random.randrange(1, 50)), compression="zstd")
        chunks.append(Chunk(honest.data, random.choice(SIZES), "zstd", honest.span_ns))
    data = mcap(chunks, with_summary=random.random() < 0.5)
    if random.random() < 0.2:
        data = mutated(random, data)
    if random.random() < 0.2:
        return Case("bomb.mcap.zst", zstandard.compress(data))
    return Case("bomb.mcap", data)
