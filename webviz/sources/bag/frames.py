"""The frames of a bag, before anything is played."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Sequence

from webviz.data.messages import MessageError, TFMessage, decode, peek_header
from webviz.data.recordings.latched import TF
from webviz.sources.bag.file import BagChannel
from webviz.sources.bag.files import BagFiles
from webviz.sources.history import Recorded

MAX_READ = 1000
"""Messages of each kind."""
READ_NS = 60_000_000_000
"""Of the beginning of a bag. To learn that a db3 file has no more messages of a rare topic would
take reading all of it."""


def links_of(file: BagFiles) -> Sequence[tuple[str, str]]:
    """Parents and children of the first transforms, each once."""
    found: dict[tuple[str, str], None] = {}
    for topic in ("/tf_static", "/tf"):
        channels = [c for c in file.channels if (c.topic, c.type) == (topic, TF)]
        for recorded in _first(file, channels):
            try:
                message: TFMessage = decode(TF, recorded.cdr)
            except MessageError:
                continue
            for each in message.transforms:
                found[each.parent.removeprefix("/"), each.child.removeprefix("/")] = None
    return list(found)


def frames_of(file: BagFiles, channels: Collection[BagChannel]) -> Sequence[str]:
    """Return the frames of the first messages of some channels, each once."""
    found: dict[str, None] = {}
    for recorded in _first(file, channels):
        try:
            header = peek_header(recorded.type, recorded.cdr, recorded.types)
        except MessageError:
            continue
        if header and header[0]:
            found[header[0].removeprefix("/")] = None
    return list(found)


def _first(file: BagFiles, channels: Collection[BagChannel]) -> Iterator[Recorded]:
    """Yield the first messages of some channels."""
    early = file.messages(channels, file.start_ns, file.start_ns + READ_NS)
    first = next(early, None) or next(file.messages(channels, file.start_ns), None)
    if first is not None:
        yield from itertools.islice(itertools.chain([first], early), MAX_READ)
