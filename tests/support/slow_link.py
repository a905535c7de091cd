"""A slow link to a server on this machine: a proxy that limits rate and delays."""

from __future__ import annotations

import asyncio
import contextlib
import socket
import threading

CHUNK = 1 << 12
BUFFER_BYTES = 1 << 18
"""Maximum bytes waiting in the router before the link; further bytes wait at their senders."""


class SlowLink:
    """Forwards connections over one link, which all of them share.

    Args:
        port: of the server on this machine.
        rate: bytes a second, in each direction.
        delay_s: that each byte takes besides, in each direction.
    """

    def __init__(self, port: int, rate: float, delay_s: float) -> None:
        self.rate = rate
        self._server_port = port
        self._delay_s = delay_s
        self._free_at = {"down": 0.0, "up": 0.0}
        self._loop = asyncio.new_event_loop()
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._tasks: set[asyncio.Task[None]] = set()
        self._ended = asyncio.Event()
        self._thread = threading.Thread(
            target=self._loop.run_until_complete, args=(self._serve(),), daemon=True
        )
        self._thread.start()

    def get_port(self) -> int:
        """Return where it listens."""
        return self._listener.getsockname()[1]

    def close(self) -> None:
        """Ends all connections."""
        self._loop.call_soon_threadsafe(self._ended.set)
        self._thread.join()
        self._loop.close()

    async def _serve(self) -> None:
        server = await asyncio.start_server(self._forward, sock=self._listener, limit=CHUNK)
        await self._ended.wait()
        server.close()
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    async def _forward(self, near: asyncio.StreamReader, to_near: asyncio.StreamWriter) -> None:
        with socket.socket() as sock:
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, CHUNK)
            sock.setblocking(False)
            await self._loop.sock_connect(sock, ("127.0.0.1", self._server_port))
            far, to_far = await asyncio.open_connection(sock=sock, limit=CHUNK)
            ways = [(far, to_near, "down"), (near, to_far, "up")]
            tasks = [asyncio.ensure_future(self._carry(*way)) for way in ways]
            self._tasks.update(tasks)
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for task in tasks:
                task.cancel()
            for writer in (to_near, to_far):
                writer.close()

    async def _carry(
        self, source: asyncio.StreamReader, to: asyncio.StreamWriter, way: str
    ) -> None:
        with contextlib.suppress(ConnectionError):
            while data := await source.read(CHUNK):
                now = self._loop.time()
                self._free_at[way] = max(now, self._free_at[way]) + len(data) / self.rate
                at = self._free_at[way] + self._delay_s
                self._loop.call_at(at, deliver, to, data)
                excess = self._free_at[way] - now - BUFFER_BYTES / self.rate
                if excess > 0:
                    await asyncio.sleep(excess)


def deliver(to: asyncio.StreamWriter, data: bytes) -> None:
    """Write what has come over the link, if the other side is still there."""
    if not to.is_closing():
        to.write(data)
