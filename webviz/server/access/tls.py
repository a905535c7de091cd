"""TLS: the certificate and key of the server."""

from __future__ import annotations

import contextlib
import ssl
import time
from pathlib import Path

from webviz.api.errors import Error

SOON_S = 7 * 86400.0
"""Certificates that are renewed automatically have weeks left."""
IGNORE_TIME = 0x200000
"""OpenSSL's X509_V_FLAG_NO_CHECK_TIME, which Python does not name."""


class CertificateError(Error):
    """The server cannot use the certificate or its key; the message says why."""


class _Encrypted(Exception):
    pass


def server_context(certfile: Path, keyfile: Path | None = None) -> ssl.SSLContext:
    """Read a certificate and its key.

    Args:
        certfile: PEM file with the certificate, followed by those of intermediate authorities.
        keyfile: PEM file with the private key; None if `certfile` contains it.

    Returns:
        A context for a server of HTTP/1.1 with TLS 1.2 or later.

    Raises:
        CertificateError: a file cannot be read, they do not fit, or the key is encrypted.
    """
    key = keyfile or certfile
    for file in (certfile, key):
        try:
            file.open("rb").close()
        except OSError as error:
            raise CertificateError(f"Cannot read {file}: {error.strerror}.") from None
    context = ssl.create_default_context(ssl.Purpose.CLIENT_AUTH)
    context.set_alpn_protocols(["http/1.1"])
    try:
        context.load_cert_chain(certfile, key, password=_refuse)
    except _Encrypted:
        raise CertificateError(
            f"The key in {key} is encrypted. Decrypt it with `openssl pkey -in {key} -out NEW.key`."
        ) from None
    except (ssl.SSLError, ValueError) as error:
        raise CertificateError(_reason(error, certfile, key)) from None
    return context


def doubts(context: ssl.SSLContext, certfile: Path, now_s: float | None = None) -> list[str]:
    """Reasons for browsers to reject a certificate soon or already, as sentences.

    Args:
        context: of the server.
        certfile: from which it was read; for the sentences.
        now_s: Unix time; None for the current one.
    """
    now_s = time.time() if now_s is None else now_s
    trusting = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    trusting.check_hostname = False
    trusting.load_verify_locations(cadata=_certificate(context))
    trusting.verify_flags |= ssl.VERIFY_X509_PARTIAL_CHAIN | IGNORE_TIME
    try:
        certificate = _handshake(context, trusting).getpeercert() or {}
    except ssl.SSLError as error:
        return [f"Browsers will reject the certificate in {certfile}: {_sentence(error)}."]
    starts, ends = (
        ssl.cert_time_to_seconds(str(certificate[key])) for key in ("notBefore", "notAfter")
    )
    if now_s < starts:
        return [f"The certificate in {certfile} is not valid before {_date(starts)}."]
    if now_s > ends:
        return [f"The certificate in {certfile} expired on {_date(ends)}. Renew it."]
    if now_s > ends - SOON_S:
        return [f"The certificate in {certfile} expires on {_date(ends)}. Renew it."]
    return []


def _certificate(context: ssl.SSLContext) -> bytes:
    """Return the certificate of a server, DER."""
    trusting = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    trusting.check_hostname = False
    trusting.verify_mode = ssl.CERT_NONE
    return _handshake(context, trusting).getpeercert(binary_form=True) or b""


def _handshake(server: ssl.SSLContext, client: ssl.SSLContext) -> ssl.SSLObject:
    """Return a client that has shaken hands with a server, in memory."""
    up, down = ssl.MemoryBIO(), ssl.MemoryBIO()
    asking = client.wrap_bio(down, up)
    answering = server.wrap_bio(up, down, server_side=True)
    for _ in range(10):
        for side in (asking, answering):
            with contextlib.suppress(ssl.SSLWantReadError):
                side.do_handshake()
    return asking


def _refuse() -> str:
    # OpenSSL would ask on the terminal.
    raise _Encrypted


def _reason(error: Exception, certfile: Path, key: Path) -> str:
    if getattr(error, "reason", None) == "KEY_VALUES_MISMATCH":
        return f"The key in {key} does not belong to the certificate in {certfile}."
    if "PEM" in str(error):
        return f"{_without(certfile, key)}."
    return f"Cannot use the certificate in {certfile} with the key in {key}: {_sentence(error)}."


def _without(certfile: Path, key: Path) -> str:
    if b"-----BEGIN CERTIFICATE-----" not in certfile.read_bytes():
        return f"{certfile} contains no certificate in PEM format"
    if b"PRIVATE KEY-----" not in key.read_bytes():
        return f"{key} contains no private key in PEM format"
    return f"The certificate in {certfile} or the key in {key} is damaged"


def _sentence(error: Exception) -> str:
    text = getattr(error, "verify_message", None) or getattr(error, "reason", None) or str(error)
    return str(text).replace("_", " ").lower()


def _date(seconds: float) -> str:
    return time.strftime("%Y-%m-%d", time.gmtime(seconds))
