"""The changes that scripts/test --mutants makes."""

import subprocess

from mutation.mutate import CONSTANT, Source

SAMPLE = """\
#include <cstdio>
#include "a + b.h"
// a < b, 5
constexpr int kSize = 2 * 3;
static_assert(1 + 1 == 2);
enum class Kind { kOne = 1 };
struct State { int count = 7; };
bool between(double value, double low) {
  int unused = 3;
  unused += 1;
  if (unused > 9) return false;
  return value > low && !(value > low + 4);
}
void print() {
  int numbers[kSize] = {};
  numbers[0] = 8;
  std::printf("%d%d%d%d", between(5, 1), between(5.5, 1), State().count, numbers[0]);
}
"""


def sample() -> Source:
    return Source("src/sample.cpp", SAMPLE, set(), 0, set())


def test_changes_stand_neither_in_comments_and_texts_nor_in_what_the_compiler_evaluates():
    assert {change.line for change in sample().changes} == {7, 9, 10, 11, 12, 16, 17}


def test_constants_that_share_a_declaration_stay_constants():
    text = "constexpr int kOne = larger(1, 2);\nconstexpr int kTwo = 1, kThree = 4;\n"
    assert [match["name"] for match in CONSTANT.finditer(text)] == ["kOne"]


def test_of_a_line_each_operator_number_and_condition_is_changed():
    changes = [(change.what, change.after) for change in sample().changes if change.line in {11, 12}]
    assert changes == [
        ("negated", "if (!(unused > 9)) return false;"),
        ("never", "if (false) return false;"),
        (">=", "if (unused >= 9) return false;"),
        ("<=", "if (unused <= 9) return false;"),
        ("doubled", "if (unused > 18) return false;"),
        ("0", "if (unused > 0) return false;"),
        ("true", "if (unused > 9) return true;"),
        (">=", "return value >= low && !(value > low + 4);"),
        ("<=", "return value <= low && !(value > low + 4);"),
        ("||", "return value > low || !(value > low + 4);"),
        ("without !", "return value > low && (value > low + 4);"),
        (">=", "return value > low && !(value >= low + 4);"),
        ("<=", "return value > low && !(value <= low + 4);"),
        ("-", "return value > low && !(value > low - 4);"),
        ("doubled", "return value > low && !(value > low + 8);"),
        ("0", "return value > low && !(value > low + 0);"),
    ]


def test_a_change_in_the_copy_does_what_its_text_says(tmp_path):
    source = sample()
    (tmp_path / "a + b.h").touch()

    def build(name: str, text: str) -> None:
        (tmp_path / f"{name}.cpp").write_text(text)
        options = ["-std=c++20", "-w", "-I", tmp_path, "-I", "tests"]
        subprocess.run(["g++", *options, "-o", tmp_path / name, tmp_path / f"{name}.cpp"], check=True)

    # Each change by its text, in a namespace of its own.
    texts, calls = [], []
    for change in source.changes:
        lines = SAMPLE.splitlines()
        lines[change.line - 1] = change.after
        texts.append(f"namespace change{change.number} {{\n" + "\n".join(lines[2:]) + "\n}")
        calls.append(f'change{change.number}::print(); std::puts("");')
    build("apart", "\n".join(["#include <cstdio>", *texts, "int main() {", *calls, "}"]))
    build("together", source.changed() + "\nint main() { print(); }\n")

    apart = subprocess.check_output([tmp_path / "apart"], text=True).splitlines()
    for change, expected in zip(source.changes, apart, strict=True):
        chosen = {"MUTANT": str(change.number)}
        assert subprocess.check_output([tmp_path / "together"], env=chosen, text=True) == expected, change
    assert subprocess.check_output([tmp_path / "together"], text=True) == "1078"
