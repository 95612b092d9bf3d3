"""How a PostgreSQL server is reached: encrypted where it offers that, as its own programs do."""

from __future__ import annotations

import logging
import socket
import ssl
from typing import Any

from sqlalchemy import URL, Dialect, Engine, create_engine, event
from sqlalchemy.pool import NullPool

_ENCRYPT = bytes([0, 0, 0, 8]) + (80877103).to_bytes(4, "big")
"""The question that comes before all others: PostgreSQL's manual, "Message Formats", SSLRequest."""
_YES = b"S"
# a connection that was lost cannot be closed, which the pool tells with a traceback; what was lost is said by then
logging.getLogger("sqlalchemy.pool").addHandler(logging.NullHandler())


def engine_of_server(url: URL, password: str | None, timeout_s: float) -> Engine:
    """A door to a server; nothing is opened yet. No connection is kept, so that the server can be started anew."""
    said = {"timeout": timeout_s} | ({} if password is None else {"password": password})
    made = url.set(drivername="postgresql+pg8000")
    engine = create_engine(made, poolclass=NullPool, isolation_level="AUTOCOMMIT", connect_args=said)
    # rows of a table in one statement: of one each, every row is a way to the server and back
    engine.dialect.use_insertmanyvalues_wo_returning = True
    event.listen(engine, "do_connect", _reach)
    return engine


def _reach(dialect: Dialect, _: Any, __: Any, parameters: dict[str, Any]) -> Any:
    """A connection. The driver would ask for encryption as well, and for that read all authorities that this machine
    trusts, though it checks none of them: four fifths of the time that a connection takes."""
    driver: Any = dialect.loaded_dbapi
    host, port = parameters.get("host", "localhost"), parameters.get("port", 5432)
    try:
        stream = _encrypted(socket.create_connection((host, port), parameters["timeout"]), host)
    except OSError as error:
        raise driver.InterfaceError(f"no server answers at {host}, port {port}: {error.strerror or error}") from None
    return driver.Connection(**parameters, sock=stream, ssl_context=False)


def _encrypted(plain: socket.socket, host: str) -> socket.socket:
    """The connection, encrypted where the server can. Raises OSError."""
    try:
        plain.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        plain.sendall(_ENCRYPT)
        if plain.recv(1) != _YES:
            return plain
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname = False
        context.verify_mode = ssl.CERT_NONE
        return context.wrap_socket(plain, server_hostname=host)
    except BaseException:
        plain.close()
        raise
