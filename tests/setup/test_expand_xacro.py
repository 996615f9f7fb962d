"""A .xacro file is a program: what its expressions may be, and what the process that runs it may do."""

from __future__ import annotations

import subprocess
import sys

import pytest
from robot_control.setup.expand_xacro import require_values

VALUES = (
    "0.1 / 2",
    "-mass**2 if not name in ['a', 'b'] else radius * pi",
    "' '.join([str(2 * x) for x in config['origin'][1:] if x > 1])",
    "xacro.load_yaml(file)['joints'].left.radius",
    "dict(a=1, b=(1, 2))",
    "f'{prefix}_link'",
    "python.sum(map(abs, [1, -2]))",
    "{'a': 1}['a']",
)
PROGRAMS = (
    "[c for c in ().__class__.__base__.__subclasses__() if c.__name__ == 'Popen']",
    "[x for x in [1] if __import__('os').system('true')]",
    "(lambda: 0).__globals__",
    "(x for x in [1]).gi_frame",
    "[x.gi_frame.f_back for x in [(y for y in [1])]]",
    "python.vars(python.type(python.type(0)))['__sub' + 'classes__']",
    "python.type(0)",
    "'{0.__class__}'.format(0)",
    "max.__self__",
    "(x := 1)",
    "x._private",
    "__builtins__",
)


@pytest.mark.parametrize("expression", VALUES)
def test_expressions_of_values_are_admitted(expression: str) -> None:
    require_values(expression)


@pytest.mark.parametrize("expression", PROGRAMS)
def test_expressions_that_lead_to_a_program_are_refused(expression: str) -> None:
    with pytest.raises(ValueError, match="is refused in an expression"):
        require_values(expression)


ACTS = {
    "writes a file": "open(folder + '/new', 'w')",
    "changes a file": "open(folder + '/old', 'r+')",
    "empties a file": "os.truncate(folder + '/old', 0)",
    "removes a file": "os.unlink(folder + '/old')",
    "makes a folder": "os.mkdir(folder + '/folder')",
    "starts a program": "os.execv('/bin/true', ['true'])",
    "reaches the network": "socket.create_connection(('127.0.0.1', int(sys.argv[2])))",
}
PROGRAM = """
import os, socket, sys
from robot_control.setup.expand_xacro import confine
folder = sys.argv[1]
confine()
assert open(folder + '/old').read() == 'text'
try:
    {act}
except OSError:
    print('refused')
"""


@pytest.mark.parametrize("act", ACTS)
def test_the_process_of_xacro_reads_and_does_nothing_else(act: str, tmp_path, tcp_port: int) -> None:
    (tmp_path / "old").write_text("text")
    command = [sys.executable, "-c", PROGRAM.format(act=ACTS[act]), str(tmp_path), str(tcp_port)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    if "refused" not in done.stdout:
        pytest.skip("this kernel has no landlock, or permits no user namespace")


@pytest.fixture
def tcp_port():
    import socket

    with socket.create_server(("127.0.0.1", 0)) as server:
        yield server.getsockname()[1]
