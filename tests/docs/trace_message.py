#!/usr/bin/python3
"""Writes msg/Trace.msg from the table of its fields in src/log.

tests/docs/trace_message.py      after a build with tests; then build again
"""

import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "build" / "robot_control" / "tests" / "log" / "print_trace_message"

if __name__ == "__main__":
    text = subprocess.run([PROGRAM], check=True, capture_output=True, text=True).stdout
    (ROOT / "msg" / "Trace.msg").write_text(text)
