"""The outlines of a motor board's firmware compile against declarations of what they call (tests/fixtures/firmware)."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LANGUAGES = {"arduino": ("c++", "-std=c++17"), "pico": ("c", "-std=c11"), "stm32": ("c", "-std=c11")}


@pytest.mark.parametrize("board", LANGUAGES)
def test_an_outline_compiles(board, tmp_path):
    language, standard = LANGUAGES[board]
    blocks = re.findall(r"```c\n(.*?)```", (ROOT / f"docs/firmware_{board}.md").read_text(), re.DOTALL)
    assert len(blocks) == 1
    source = tmp_path / "outline"
    source.write_text(blocks[0])
    folders = ["-I", ROOT / "firmware", "-I", ROOT / "tests/fixtures/firmware"]
    warnings = ["-Wall", "-Wextra", "-Werror"]
    command = ["c++" if language == "c++" else "cc", "-x", language, standard, "-fsyntax-only", *warnings, *folders]
    done = subprocess.run([*command, source], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
