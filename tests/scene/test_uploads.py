"""Files that a browser sends: only where a button takes them, and only so much."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
import viser

from webviz.edges.scene.uploads import MAX_BYTES, MAX_OPEN, PART_BYTES, Uploads


def start(transfer: str = "a", size: int = 3, parts: int = 1, **changes: Any) -> dict[str, Any]:
    message = {
        "type": "FileTransferStartUpload",
        "transfer_uuid": transfer,
        "source_component_uuid": "button",
        "filename": "lab.yaml",
        "mime_type": "",
        "size_bytes": size,
        "part_count": parts,
    }
    return message | changes


def part(transfer: str = "a", number: Any = 0, content: Any = b"abc") -> dict[str, Any]:
    return {
        "type": "FileTransferPart",
        "transfer_uuid": transfer,
        "source_component_uuid": "button",
        "part_index": number,
        "content": content,
    }


def test_a_file_comes_in_its_parts() -> None:
    uploads = Uploads()
    assert uploads.accepts(start(size=PART_BYTES + 1, parts=2))
    assert uploads.accepts(part(number=0, content=bytes(PART_BYTES)))
    assert uploads.accepts(part(number=1, content=b"x"))
    assert not uploads.accepts(part(number=1, content=b"x"))


@pytest.mark.parametrize(
    "message",
    [
        start(size=MAX_BYTES + 1, parts=33),
        start(size=-1, parts=0),
        start(size=3, parts=2),
        start(size=3, parts=0),
        start(size=0, parts=1000),
        start(size_bytes="3"),
        start(part_count=True),
        start(filename=None),
        start(filename="x" * 1000),
        start(mime_type=[]),
        start(transfer_uuid=["a"]),
        start(transfer_uuid="x" * 1000),
    ],
)
def test_a_file_that_is_announced_wrongly_or_is_too_large_is_refused(message: Any) -> None:
    assert not Uploads().accepts(message)


@pytest.mark.parametrize(
    "message",
    [
        part("other"),
        part(number=1),
        part(number=-1),
        part(number=0.0),
        part(number=None),
        part(content="abc"),
        part(content=b"abcd"),
        part(content=None),
    ],
)
def test_a_part_that_was_not_announced_is_refused(message: Any) -> None:
    uploads = Uploads()
    assert uploads.accepts(start())
    assert not uploads.accepts(message)
    assert uploads.accepts(part())


def test_files_that_never_end_cannot_pile_up() -> None:
    uploads = Uploads()
    half = start("a", MAX_BYTES // 2, MAX_BYTES // 2 // PART_BYTES)
    assert uploads.accepts(half)
    assert not uploads.accepts(half)
    assert uploads.accepts(half | {"transfer_uuid": "b"})
    assert not uploads.accepts(start("c"))
    small = Uploads()
    accepted = [small.accepts(start(str(i))) for i in range(MAX_OPEN + 1)]
    assert accepted == [True] * MAX_OPEN + [False]


def test_a_button_takes_a_file_and_nothing_else_does(
    server: viser.ViserServer,
    call: Callable[..., Any],
    wait_until: Callable[[Callable[[], bool]], None],
) -> None:
    taken: list[bytes] = []
    button = server.gui.add_upload_button("Upload")
    button.on_upload(lambda event: taken.append(event.target.value.content))
    off = server.gui.add_upload_button("Not now", disabled=True)
    text = server.gui.add_text("Text", "")
    peer = call()
    peer.look()
    wait_until(lambda: len(server.get_clients()) == 1)
    for transfer, handle in (("a", text), ("b", off), ("c", button)):
        source = {"source_component_uuid": handle._impl.uuid}
        peer.send(start(transfer) | source)
        peer.send(part(transfer, content=transfer.encode() * 3) | source)
    wait_until(lambda: bool(taken))
    assert taken == [b"ccc"]
    assert text.value == ""
    assert off.value.content == b""
