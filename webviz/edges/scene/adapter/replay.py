"""Which messages a browser is sent when: replaces the loop of viser's message buffer."""

from __future__ import annotations

import asyncio
import contextlib
import functools
from collections.abc import AsyncGenerator, Sequence

from viser.infra._async_message_buffer import AsyncMessageBuffer
from viser.infra._messages import Message

from webviz.edges.scene.outbox import Outbox


def replay_live_messages_only(buffer: AsyncMessageBuffer, last: type[Message]) -> None:
    """Makes the cost of joining depend on the scene, not on all messages ever sent.

    viser's loop walks every message number from 0 on its event loop, which stalls all browsers for
    170 ms per million messages. This one walks the messages that still exist, both for browsers
    that join and for those that were stalled. It also sends the small messages of a tick in one
    piece, which viser cuts after 128 messages, and large ones after them (see `Outbox`).

    Args:
        buffer: of the server.
        last: type of the messages that are sent after all messages queued before them.
    """
    buffer._window_loop = functools.partial(_windows, buffer, last)


async def _windows(
    buffer: AsyncMessageBuffer,
    last: type[Message],
    client_id: int,
    backlog_last_id: int,
    backlog_done_message: Message | None,
) -> AsyncGenerator[Sequence[Message], None]:
    outbox = Outbox(last)
    end_of_backlog = backlog_done_message
    flushed = asyncio.ensure_future(buffer.flush_event.wait())
    buffer.generator_cursors[client_id] = outbox.cursor
    try:
        while not buffer.done:
            window: list[Message] = []
            with buffer.buffer_lock:
                live = buffer.message_from_id
                if buffer.atomic_counter == 0 and end_of_backlog is not None:
                    window = outbox.small(live, backlog_last_id, buffer.max_window_size)
                    if outbox.cursor >= backlog_last_id:
                        window.append(end_of_backlog)
                        end_of_backlog = None
                elif buffer.atomic_counter == 0:
                    window = outbox.small(live, buffer.message_counter - 1, None)
                    window += outbox.large(live)
            # viser's garbage collector removes messages that all cursors have passed.
            buffer.generator_cursors[client_id] = outbox.cursor
            window = [m for m in window if m.excluded_self_client != client_id]
            if window:
                yield window
            else:
                await buffer.message_event.wait()
                buffer.message_event.clear()
            is_done = outbox.cursor == buffer.message_counter - 1 and not outbox.is_waiting()
            if not window or is_done:
                done, _ = await asyncio.wait([flushed], timeout=buffer.window_duration_sec)
                if done and not buffer.done:
                    buffer.flush_event.clear()
                    flushed = asyncio.ensure_future(buffer.flush_event.wait())
    finally:
        buffer.generator_cursors.pop(client_id, None)
        flushed.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await flushed
