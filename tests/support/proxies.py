"""The proxies of the documentation, run as they stand there on free ports."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import pytest

from webviz.shell import docs

FOLDER = docs.PAGES / "serving"
PATIENCE_S = 60.0
NGINX = """\
daemon off;
master_process off;
pid {folder}/nginx.pid;
error_log {folder}/log;
events {{}}
http {{
    client_body_temp_path {folder}/body;
    proxy_temp_path {folder}/proxy;
    fastcgi_temp_path {folder}/fastcgi;
    uwsgi_temp_path {folder}/uwsgi;
    scgi_temp_path {folder}/scgi;
{site}
}}
"""
CADDY = "{\n\tadmin off\n\tskip_install_trust\n\tauto_https off\n}\n"


@contextmanager
def running(
    name: str, folder: Path, viewer_ports: Sequence[int], certificate: Path
) -> Iterator[int]:
    """Run a proxy for https; skips the test if it is not installed.

    Args:
        name: nginx or caddy.
        folder: for its files.
        viewer_ports: where webviz listens on this machine; for nginx three of one robot, or one.
        certificate: .pem, beside its .key.

    Returns:
        Its port, at localhost, once it accepts connections.
    """
    path = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin"])
    program = shutil.which(name, path=path)
    if program is None:
        pytest.skip(f"{name} is not installed: apt install {name}")
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    write = nginx if name == "nginx" else caddy
    arguments = write(folder, viewer_ports, port, certificate)
    with (folder / "output").open("w") as output:
        process = subprocess.Popen(
            [program, *arguments],
            env={**os.environ, "HOME": str(folder), "XDG_DATA_HOME": str(folder)},
            stdout=output,
            stderr=subprocess.STDOUT,
        )
    try:
        deadline = time.monotonic() + PATIENCE_S
        while not accepts(port):
            text = (folder / "output").read_text()
            assert process.poll() is None, f"{name} has ended: {text}"
            assert time.monotonic() < deadline, f"{name} does not listen: {text}"
            time.sleep(0.05)
        yield port
    finally:
        process.terminate()
        process.wait(PATIENCE_S)


def nginx(folder: Path, viewer_ports: Sequence[int], port: int, certificate: Path) -> list[str]:
    """Write the configuration, and return the arguments."""
    is_alone = len(viewer_ports) == 1
    text = (FOLDER / ("nginx.conf" if is_alone else "nginx_watchers.conf")).read_text()
    site = substituted(
        text,
        {
            "listen 443 ssl": f"listen 127.0.0.1:{port} ssl",
            "/etc/ssl/certs/robots.example.pem": str(certificate),
            "/etc/ssl/private/robots.example.key": str(certificate.with_suffix(".key")),
            **{f"127.0.0.1:{8080 + i}": f"127.0.0.1:{each}" for i, each in enumerate(viewer_ports)},
        },
    )
    config = folder / "nginx.conf"
    config.write_text(NGINX.format(folder=folder, site=site))
    return ["-c", str(config), "-p", str(folder), "-e", str(folder / "log")]


def caddy(folder: Path, viewer_ports: Sequence[int], port: int, certificate: Path) -> list[str]:
    """Write the configuration, and return the arguments."""
    text = (FOLDER / "Caddyfile").read_text()
    hosts = f"https://localhost:{port}, https://robots.example:{port}"
    site = substituted(
        text,
        {
            "robots.example {": f"{hosts} {{\n"
            f"\tbind 127.0.0.1\n\ttls {certificate} {certificate.with_suffix('.key')}\n",
            "127.0.0.1:8080": f"127.0.0.1:{viewer_ports[0]}",
        },
    )
    config = folder / "Caddyfile"
    config.write_text(CADDY + site)
    return ["run", "--adapter", "caddyfile", "--config", str(config)]


def substituted(text: str, changes: dict[str, str]) -> str:
    """The text with changes; each must apply once."""
    for old, new in changes.items():
        assert text.count(old) == 1, f"{old!r} is not there once"
        text = text.replace(old, new)
    return text


def accepts(port: int) -> bool:
    """Return whether something listens on a port of this machine."""
    try:
        socket.create_connection(("127.0.0.1", port), timeout=5).close()
    except OSError:
        return False
    return True
