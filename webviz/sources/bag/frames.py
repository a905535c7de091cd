"""The frames of a bag, before anything is played."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Sequence

from webviz.data.messages import MessageError, TFMessage, decode, peek_header
from webviz.sources.bag.file import BagChannel
from webviz.sources.bag.files import BagFiles
from webviz.sources.bag.time import TF

MAX_READ = 1000
"""Messages of each kind."""


def links_of(file: BagFiles) -> Sequence[tuple[str, str]]:
    """Parents and children of the first transforms, each once."""
    found: dict[tuple[str, str], None] = {}
    for topic in ("/tf_static", "/tf"):
        channels = [c for c in file.channels if (c.topic, c.type) == (topic, TF)]
        for recorded in itertools.islice(file.messages(channels, file.start_ns), MAX_READ):
            try:
                message: TFMessage = decode(TF, recorded.cdr)
            except MessageError:
                continue
            for each in message.transforms:
                found[each.parent.removeprefix("/"), each.child.removeprefix("/")] = None
    return list(found)


def frames_of(file: BagFiles, channels: Collection[BagChannel]) -> Sequence[str]:
    """The frames of the first messages of some channels, each once."""
    found: dict[str, None] = {}
    for recorded in itertools.islice(file.messages(channels, file.start_ns), MAX_READ):
        try:
            header = peek_header(recorded.type, recorded.cdr)
        except MessageError:
            continue
        if header and header[0]:
            found[header[0].removeprefix("/")] = None
    return list(found)
