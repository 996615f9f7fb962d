"""XML-RPC of the master and of nodes, with a time limit for answers. It needs no rospy."""

import http.client
import xmlrpc.client
from typing import Any

NO_ANSWER = (OSError, xmlrpc.client.Error, http.client.HTTPException, ValueError)


class _Transport(xmlrpc.client.Transport):
    timeout = 1.0

    def make_connection(self, host: tuple[str, dict[str, str]] | str) -> http.client.HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = self.timeout
        return connection


def timed_proxy(uri: str, timeout: float) -> Any:  # noqa: ANN401 (its methods are those of the server)
    """The methods of a server, which raise one of NO_ANSWER `timeout` s after the call at the latest."""
    transport = _Transport()
    transport.timeout = timeout
    return xmlrpc.client.ServerProxy(uri, transport=transport)
