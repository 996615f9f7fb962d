import sys
from pathlib import Path

import pytest

from bench import main as bench
from bench.participants import support_program
from bench.rows import compared, plain
from bench.runs import seed_programs
from bench.runs.runner import Processes

ROW = '{"name": "gate step", "value": 88.5, "unit": "ns", "reference": 59, "reference_name": "kernel", "ratio": 1.5}'


def test_figures_stand_beside_their_ratios_below_a_table_and_above_what_is_not_judged():
    rows = [compared("gate step", 88.5, "ns", 59.0, "kernel"), plain("gate allocations", 0, "")]
    result = {"bench": "step", "rows": rows}
    name, figure, count = bench.to_table(result | {"not_judged": []}).splitlines()
    assert name.startswith("step")
    assert figure.split() == ["gate", "step", "88.5", "ns", "59", "1.500", "of", "kernel"]
    assert count.split() == ["gate", "allocations", "0"]
    result |= {"table": ["a line", "another"], "not_judged": ["kobuki", "jackal"]}
    lines = bench.to_table(result).splitlines()
    assert lines[:3] == ["a line", "another", ""]
    assert "not judged: kobuki, jackal; no descriptions here" in lines[-1]


def program(folder, text, name="bench_step"):
    path = folder / name
    path.write_text(f"#!{sys.executable}\n{text}\n")
    path.chmod(0o755)


@pytest.mark.parametrize("name", ["rc_participant", "rc_newest_stamps"])
def test_programs_of_the_tests_are_where_the_benchmarks_start_them(name):
    assert support_program(Path(__file__).parents[2] / "build/robot_control/bench", name).exists()


def test_what_the_programs_print_is_written_to_the_file(tmp_path, monkeypatch):
    program(tmp_path, f'print(\'{{"bench": "step", "rows": [{ROW}]}}\')')
    monkeypatch.setattr(
        sys, "argv", ["bench", "step", "--programs", str(tmp_path), "--json", str(tmp_path / "all.json")]
    )
    assert bench.main() == 0
    assert '"ratio": 1.5' in (tmp_path / "all.json").read_text()


@pytest.mark.parametrize("text", ["raise SystemExit(1)", "print('no JSON')"])
def test_a_program_that_fails_is_a_failure(tmp_path, monkeypatch, text):
    program(tmp_path, text)
    monkeypatch.setattr(sys, "argv", ["bench", "step", "--programs", str(tmp_path)])
    assert bench.main() == 1


def test_a_file_that_cannot_be_written_to_is_refused_before_anything_is_measured(tmp_path, capsys):
    with pytest.raises(SystemExit):
        bench.parse(["--json", str(tmp_path / "nowhere" / "all.json")])
    assert "cannot be written to" in capsys.readouterr().err


def test_the_tables_of_the_documentation_are_of_one_level_of_errors(capsys):
    assert bench.parse(["odometry", "--errors", "field"]).errors == "field"
    with pytest.raises(SystemExit):
        bench.parse(["odometry", "--errors", "field", "--markdown"])
    assert "--markdown writes the tables of data_sheet, not of --errors field" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        bench.parse(["drive", "--wheel-command", "velocity", "--markdown"])
    assert "--markdown writes the tables of --wheel-command torque" in capsys.readouterr().err


def test_scenarios_of_the_odometry_can_be_named(capsys):
    assert bench.parse(["odometry", "--only", "parts,slip"]).only == ["parts", "slip"]
    for wrong, complaint in (
        (["--only", "party"], "no scenario party; there are umbmark"),
        (["--only", "parts", "--markdown"], "--markdown writes the tables of all scenarios"),
    ):
        with pytest.raises(SystemExit):
            bench.parse(["odometry", *wrong])
        assert complaint in capsys.readouterr().err


def test_an_unknown_name_is_refused(capsys):
    with pytest.raises(SystemExit):
        bench.parse(["warp"])
    assert (
        "no benchmark warp; there are step, plant, lockstep, frames, stops, campaign, replay, driving, limiter, "
        "release, drive, slopes, legs, odometry, recordings, hostile, tuning, bags" in capsys.readouterr().err
    )


@pytest.mark.parametrize(
    ("command", "complaint"),
    [
        ("devices answers", "answers: no part of --robot quadbot, which has bridge, disturbed, losses"),
        ("devices losses slope", "slope: no part of --robot quadbot"),
        ("navigation routes guard", "routes, guard: no part of --robot quadbot, which has goals"),
        ("fleet sequences", "--robot quadbot is for campaign, devices, navigation"),
        ("devices losses", ""),
        ("devices navigation goals disturbed", ""),
        ("devices campaign", ""),
    ],
)
def test_a_part_that_the_robot_does_not_have_is_refused(capsys, command, complaint):
    words = [*command.split(), "--robot", "quadbot"]
    if not complaint:
        assert bench.parse(words).robot == "quadbot"
        return
    with pytest.raises(SystemExit) as ended:
        bench.parse(words)
    assert ended.value.code != 0
    assert complaint in capsys.readouterr().err


def test_all_parts_are_those_that_the_robot_has():
    names = ["devices", "navigation"]
    for words, parts in (([], bench.PARTS), (["--robot", "quadbot"], bench.ON_LEGS)):
        given = bench.parse([*names, *words])
        assert [bench._parts_of(name, given) for name in names] == [list(parts[name]) for name in names]


def test_recorded_lasers_without_their_folder_are_refused(capsys):
    with pytest.raises(SystemExit):
        bench.parse(["navigation", "logs"])
    assert "navigation logs needs --logs FOLDER" in capsys.readouterr().err
    assert bench.parse(["navigation"]).parts == []


@pytest.mark.parametrize(("failed", "code"), [(0, 0), (1, 1)])
def test_a_limiter_that_violates_a_property_is_a_failure(tmp_path, monkeypatch, failed, code):
    program(
        tmp_path,
        f"""import json, sys
row = {{"unit": "", "reference": 0, "reference_name": "none", "ratio": 0}}
rows = [row | {{"name": "sequences", "value": int(sys.argv[2])}}]
rows.append(row | {{"name": "sequences failed", "value": {failed}}})
print(json.dumps({{"bench": "limiter", "rows": rows}}))""",
        "bench_limiter",
    )
    monkeypatch.setattr(sys, "argv", ["bench", "limiter", "--runs", "7", "--programs", str(tmp_path)])
    assert bench.main() == code


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["step", "campaign"], "step cannot run on a cluster"),
        (["campaign"], ""),
    ],
)
def test_only_what_runs_many_seeds_runs_on_a_cluster(capsys, arguments, complaint):
    command = [*arguments, "--scheduler", "tls://far.example:8786"]
    if not complaint:
        assert bench.parse(command).scheduler == "tls://far.example:8786"
        return
    with pytest.raises(SystemExit):
        bench.parse(command)
    assert complaint in capsys.readouterr().err


def test_a_cluster_in_plain_text_is_refused_before_anything_is_measured(capsys):
    with pytest.raises(SystemExit):
        bench.parse(["campaign", "--scheduler", "tcp://192.168.1.5:8786"])
    assert "--insecure" in capsys.readouterr().err
    assert bench.parse(["campaign", "--scheduler", "tcp://192.168.1.5:8786", "--insecure"]).insecure


def test_blocks_of_seeds_of_a_program_add_up(tmp_path, monkeypatch):
    text = """import json, sys
first, runs = map(int, sys.argv[1:])
if first <= 7 < first + runs:
    print("seed 7: curvature", file=sys.stderr)
row = {"unit": "", "reference": 0, "reference_name": "none", "ratio": 0}
failed = int(first <= 7 < first + runs)
rows = [row | {"name": "sequences", "value": runs}, row | {"name": "sequences failed", "value": failed}]
print(json.dumps({"bench": "limiter", "rows": rows + [row | {"name": "speed", "value": 1}]}))"""
    program(tmp_path, text, "bench_limiter")
    monkeypatch.setattr(seed_programs, "PROGRAMS", tmp_path)
    monkeypatch.setattr(seed_programs, "BLOCKS", 3)
    lines = []
    result = seed_programs.run_seeds("limiter", 5, 10, lines.append, Processes(1))
    assert [row["value"] for row in result["rows"][:2]] == [10, 1]
    assert lines == ["seed 7: curvature"]
