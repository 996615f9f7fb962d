"""The bus of python-can, for canopen."""


class Wire:
    """python-can's bus, as far as canopen uses it: keeps what the drive sends, as identifier and data."""

    def __init__(self):
        self.sent = []

    def send(self, message, timeout=None):
        self.sent.append((message.arbitration_id, bytes(message.data)))

    def send_periodic(self, message, period):
        """The drive's own heartbeat; nothing happens here by itself."""
        self.send(message)
        return self

    def stop(self):
        pass

    def shutdown(self):
        pass
