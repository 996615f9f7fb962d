"""Describes how a robot that waits for a zero request (awaiting_zero_request) is released."""


def silent_long_enough(command_timeout: float) -> str:
    """After "stop the sender": " for 1.25 s", by cmd_vel_timeout [s]; empty where that is 0: off, or not known."""
    return f" for {command_timeout:g} s" if command_timeout else ""
