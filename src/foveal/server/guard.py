"""The door of the server: who may ask, and how."""

import ipaddress
import re
from collections.abc import Collection

from .asgi import App, Receive, Scope, Send, refuse, say

__all__ = ["LOCAL_HOSTS", "Guard"]

LOCAL_HOSTS = frozenset({"127.0.0.1", "localhost", "[::1]"})

_HOST = re.compile(r"(\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9._-]+)(?::[0-9]{0,5})?")


class Guard:
    """Lets through GET and HEAD, and WebSockets of our own pages, for a host that is ours.

    Without the check of Host any page on the web could point a name of its own at 127.0.0.1 and read
    what is served here (DNS rebinding). That needs a name, so a server bound to all interfaces accepts
    every address written in numbers. Browsers let any page open a WebSocket to anywhere, but say which page
    it is: its Origin must be this server, by the very name that it is asked by.

    Parameters
    ----------
    app : ASGI app
        What stands behind the door.
    hosts : collection of str
        Names accepted, in lower case, IPv6 addresses in brackets.
    is_public : bool
        Whether the server is bound to all interfaces.
    """

    def __init__(self, app: App, /, *, hosts: Collection[str] = LOCAL_HOSTS, is_public: bool = False) -> None:
        self._app = app
        self._hosts = frozenset(host.lower() for host in hosts)
        self._is_public = is_public
        self._known: set[bytes] = set()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check one request and hand it on."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        hosts = [value for name, value in scope["headers"] if name == b"host"]
        if len(hosts) != 1 or hosts[0] not in self._known:
            refusal = self._refusal(hosts)
            if refusal is not None:
                await (say(send, *refusal) if scope["type"] == "http" else refuse(send))
                return
        if scope["type"] == "websocket":
            origins = [value for name, value in scope["headers"] if name == b"origin"]
            is_ours = origins in ([b"%s://%s" % (kind, hosts[0])] for kind in (b"http", b"https"))
            await (self._app(scope, receive, send) if is_ours else refuse(send))
            return
        if scope["method"] not in ("GET", "HEAD"):
            await say(send, 405, "Only GET and HEAD are served here.", [(b"allow", b"GET, HEAD")])
            return
        await self._app(scope, receive, send)

    def _refusal(self, hosts: list[bytes]) -> tuple[int, str] | None:
        match = _HOST.fullmatch(hosts[0].decode("latin-1")) if len(hosts) == 1 else None
        if match is None:
            return 400, "The request must name one host."
        name = match[1].lower()
        if name not in self._hosts and not (self._is_public and _is_address(name)):
            return 421, f"This server does not answer for {name}. Use the address that foveal printed."
        if len(self._known) < 64:
            self._known.add(hosts[0])
        return None


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name.strip("[]"))
    except ValueError:
        return False
    return True
