"""The firmware of a motor board, compiled for two microcontrollers: its sizes, and what it calls."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCES = sorted((ROOT / "firmware").glob("*.c"))
MAX_CODE, MAX_MEMORY = 16 * 1024, 2 * 1024
"""bytes, the stack included"""
TARGETS = {"arm-none-eabi": ("-mcpu=cortex-m0plus", "-mthumb"), "avr": ("-mmcu=atmega2560",)}
PROGRAM = """
#include "board.h"
static struct board board;
static uint32_t time_us(void* c) { (void)c; return 0; }
static void counts(void* c, uint32_t* n) { (void)c; n[0] = 0; }
static void drive(void* c, uint8_t w, enum board_mode m, int32_t v) { (void)c; (void)w; (void)m; (void)v; }
static void sensors(void* c, uint8_t o, struct board_sensors* s) { (void)c; (void)o; (void)s; }
static void put(void* c, const uint8_t* b, uint8_t s) { (void)c; (void)b; (void)s; }
void* memset(void* to, int value, __SIZE_TYPE__ size) {
  for (__SIZE_TYPE__ i = 0; i < size; ++i) ((volatile char*)to)[i] = (char)value;
  return to;
}
void* memcpy(void* to, const void* from, __SIZE_TYPE__ size) {
  for (__SIZE_TYPE__ i = 0; i < size; ++i) ((volatile char*)to)[i] = ((const char*)from)[i];
  return to;
}
int main(void) {
  struct board_config config = {0};
  config.functions = (struct board_functions){time_us, counts, drive, sensors, put};
  config.wheels = BOARD_MAX_WHEELS;
  config.velocity_loop = 1;
  board_begin(&board, &config);
  for (;;) board_step(&board, 0, 0);
}
"""
"""As a user's, with functions that do nothing. It links against the compiler's own library alone."""


@pytest.fixture(params=TARGETS)
def program(request, tmp_path):
    """The linked program with its stack usage; skipped where the compiler is absent."""
    compiler = shutil.which(f"{request.param}-gcc")
    if compiler is None:
        pytest.skip(f"needs {request.param}-gcc: scripts/setup --firmware")
    main = tmp_path / "main.c"
    main.write_text(PROGRAM)
    file = tmp_path / "program.elf"
    flags = ["-std=c11", "-Os", "-ffreestanding", "-Wall", "-Wextra", "-Werror", "-ffunction-sections", "-fstack-usage"]
    link = ["-nostdlib", "-Wl,--gc-sections", "-Wl,--entry=main", "-lgcc"]
    command = [compiler, *TARGETS[request.param], *flags, "-I", ROOT / "firmware", main, *SOURCES, *link, "-o", file]
    result = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, check=False)
    assert result.returncode == 0, result.stderr
    return request.param, file


def test_it_fits_into_16_kib_of_code_and_2_kib_of_memory(program):
    target, file = program
    sizes = subprocess.run([f"{target}-size", file], capture_output=True, text=True, check=True).stdout
    text, data, bss = (int(number) for number in sizes.splitlines()[1].split()[:3])
    frames = [int(line.split()[1]) for path in file.parent.glob("*.su") for line in path.read_text().splitlines()]
    assert frames
    # The sum over all functions bounds each chain of calls, for none calls itself.
    memory = data + bss + sum(frames)
    print(f"{target}: {text + data} bytes of code, {memory} bytes of memory")
    assert text + data <= MAX_CODE
    assert memory <= MAX_MEMORY


def test_it_uses_no_heap_and_no_floating_point(program):
    target, file = program
    symbols = subprocess.run([f"{target}-nm", file], capture_output=True, text=True, check=True).stdout
    found = re.findall(r"\b(?:malloc|calloc|realloc|free|_sbrk|__aeabi_[fd]\w+|__\w+[sd]f[23]?)\b", symbols)
    assert found == []
