"""HTTP requests that no browser sends."""

from __future__ import annotations

import re
import select
import socket
from random import Random

from tests.attack.attack import Attack, Case, Outcome, Violation, mutated
from tests.attack.target import ANSWER_S, Target
from webviz.api.roles import Role

METHODS = (b"HEAD", b"POST", b"PUT", b"OPTIONS", b"TRACE", b"get", b"")
PATHS = (
    b"/", b"/", b"/", b"/", b"/index.html", b"/webviz/main.js", b"/webviz/channel",
    b"/webviz/../../etc/passwd", b"/%2e%2e/%2e%2e/etc/passwd", b"/..\\..\\x", b"//evil.example/",
    b"http://evil.example/", b"*", b"/?websocket=ws://evil.example", b"/?own=" + 60 * b"a", b"/%00",
    b"/\xff", b"/" + 3000 * b"a", b"/?" + 900 * b"a=b&",
)  # fmt: skip
HEADERS = (
    b"Host: evil.example", b"Host: localhost:1", b"Host:", b"Origin: null", b"Origin: http://evil",
    b"Upgrade: websocket", b"Connection: Upgrade", b"Sec-WebSocket-Version: 13",
    b"Sec-WebSocket-Key: a", b"Sec-WebSocket-Protocol: viser-v0", b"Content-Length: 5",
    b"Content-Length: -1", b"Transfer-Encoding: chunked", b"Expect: 100-continue",
    b"Accept-Encoding: gzip;q=1, *", b"X-Forwarded-For: 127.0.0.1",
    b"X-Forwarded-Host: evil.example",
    b"X-Forwarded-Proto: https", b"Cookie: " + 4000 * b"a=b; ", b"Cookie: webviz_1=\xff",
    b"X: " + 9000 * b"x", b" folded: yes", b"no colon", b"Range: bytes=0-,0-,0-",
    b"If-None-Match: *", b"Forwarded: for=127.0.0.1",
)  # fmt: skip
COOKIE = b"Cookie: of-the-owner"
"""Stands for the one of an owner, which every viewer makes anew."""
MORE_S = 0.3
STATUS = re.compile(rb"HTTP/1\.1 (\d{3}) ")


class Requests(Attack):
    """Sends requests as they are drawn, whole or in part.

    Args:
        target: the viewer.
    """

    kind = "http"

    def __init__(self, target: Target) -> None:
        self._target = target

    def draw(self, random: Random) -> Case:
        def mostly(usual: bytes, odd: tuple[bytes, ...]) -> bytes:
            return random.choice(odd) if random.random() < 0.2 else usual

        version = mostly(b"HTTP/1.1", (b"HTTP/1.0", b"HTTP/2", b"", b"x"))
        line = b" ".join((mostly(b"GET", METHODS), random.choice(PATHS), version))
        hosts = [b"Host: localhost"] * random.choice((0, 1, 1, 1, 1, 1, 1, 2))
        headers = hosts + random.sample(HEADERS, random.choice((0, 0, 1, 1, 2)))
        random.shuffle(headers)
        ending = mostly(b"\r\n", (b"\n", b"\r"))
        if random.random() < 0.7:
            headers.append(COOKIE)
        request = ending.join([line, *headers, b"", b""])
        if random.random() < 0.2:
            request = mutated(random, request)
        if random.random() < 0.2:
            request += random.randbytes(random.choice((5, 5000, 200_000)))
        return Case("request.bin", request * random.choice((1, 1, 1, 3)))

    def strike(self, case: Case) -> Outcome:
        answer = b""
        cookie = f"Cookie: {self._target.headers(Role.OWNER)['Cookie']}".encode()
        try:
            with socket.create_connection(("127.0.0.1", self._target.port), ANSWER_S) as client:
                client.sendall(case.data.replace(COOKIE, cookie))
                # What is not complete waits for more, so it is ended.
                if not select.select([client], [], [], MORE_S)[0]:
                    client.shutdown(socket.SHUT_WR)
                while part := client.recv(1 << 16):
                    answer += part
        except TimeoutError as error:
            raise Violation(f"no answer within {ANSWER_S:g} s") from error
        except ConnectionError:
            return Outcome.REFUSED
        status = int(match[1]) if (match := STATUS.match(answer)) else 0
        if status >= 500 and status not in (503, 505):
            raise Violation(f"status {status}: {answer[-300:]!r}")
        if answer and b"\r\nX-Content-Type-Options: nosniff" not in answer and status != 101:
            raise Violation(f"a response without the security headers: {answer[:300]!r}")
        if b"root:x:0:0:" in answer:
            raise Violation("a file of the machine was served")
        return Outcome.SURVIVED if status in (101, 200) else Outcome.REFUSED
