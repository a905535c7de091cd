"""A client of Rerun's gRPC server, which recognises publications by a timeline.

A logger sets the timeline "publication" to `timeline_value(stamp)`: the stamp, scrambled, behind
three bytes that are looked for in what arrives. LZ4, by which Rerun compresses, shortens
repetitions of four bytes and more; three it leaves, and all bytes of a scrambled stamp differ from
one to the next.
"""

from __future__ import annotations

import threading
import time
from typing import Any

import grpc  # pyright: ignore[reportMissingImports]

from side_by_side.log import Sighting
from side_by_side.scenes import Scene

METHOD = "/rerun.sdk_comms.v1alpha1.MessageProxyService/ReadMessages"
SIGN = bytes([0xA7, 0x3C, 0xE9])
STAMP_BYTES = 5
CYCLE = 1 << 39
SCRAMBLE = 0x5A_C396_E1D7
UNSCRAMBLE = pow(SCRAMBLE, -1, CYCLE)
UNLIMITED = -1


def timeline_value(stamp_ns: int) -> int:
    """Return the timeline value a logger sets."""
    return stamp_ns * SCRAMBLE % CYCLE << 8 * len(SIGN) | int.from_bytes(SIGN, "little")


class RerunWatcher:
    """Reads all that a viewer would be sent.

    Args:
        port: of the server.
        scene: what is published, to be recognised; None counts bytes only.
        stalls: whether it stops reading after the first message.
    """

    def __init__(self, port: int, scene: Scene | None, stalls: bool = False) -> None:
        self.sightings: list[Sighting] = []
        self.bytes = 0
        self._scene = scene
        self._stalls = stalls
        self._stop = threading.Event()
        self._channel = grpc.insecure_channel(
            f"127.0.0.1:{port}", options=[("grpc.max_receive_message_length", UNLIMITED)]
        )
        self._stream: Any = self._channel.unary_stream(METHOD)(b"", wait_for_ready=True)
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    @property
    def is_connected(self) -> bool:
        """Return whether the stream goes on."""
        return self._thread.is_alive()

    def close(self) -> None:
        """Leave."""
        self._stop.set()
        self._stream.cancel()
        self._thread.join()
        self._channel.close()

    def _run(self) -> None:
        try:
            for data in self._stream:
                now_ns = time.time_ns()
                self.bytes += len(data)
                if self._stalls:
                    self._stop.wait()
                if self._scene is not None:
                    self._recognise(data, now_ns)
        except grpc.RpcError:
            pass

    def _recognise(self, data: bytes, now_ns: int) -> None:
        at = data.find(SIGN)
        while at >= 0:
            start = at + len(SIGN)
            key = int.from_bytes(data[start : start + STAMP_BYTES], "little")
            stamp = key * UNSCRAMBLE % CYCLE
            self.sightings.append(Sighting(now_ns, None, stamp, CYCLE))
            at = data.find(SIGN, start)
