"""`scripts/bench … --wheel-command` chooses drives that take torques, or speeds whose loops they close."""

from __future__ import annotations

from typing import Any

WHEEL_COMMANDS = ("torque", "velocity")


def for_drives(wheel_command: str, params: dict[str, Any]) -> dict[str, Any]:
    """`params` of a robot and of simulated drives that agree on `wheel_command`."""
    robot = {"wheel_command": wheel_command, **params.get("robot", {})}
    return params | {"robot": robot, "mujoco_plant": {"drive": wheel_command, **params.get("mujoco_plant", {})}}
