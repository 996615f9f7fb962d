"""report.py: figures, budgets, incidents and the page. The page needs Bokeh, its picture Chromium: scripts/setup."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import yaml
from robot_control.data.intervals import intervals, joined, runs_of
from robot_control.data.report import main as program
from robot_control.data.report.budgets import BudgetError, Verdict, judge, read_budgets
from robot_control.data.report.decimate import decimated
from robot_control.data.report.drive import Drive
from robot_control.data.report.figures import Figure, figures
from robot_control.data.report.incidents import incidents
from robot_control.data.run_log import RunLog, read_run
from robot_control.loop.roles import LEGGED, Kind
from robot_control.loop.signal_names import mask_of
from support.recordings.synthetic_run import BEGIN, CYCLES, PERIOD, brake_at, healthy_run

MUST_RUN = bool(os.environ.get("CI") and os.environ.get("ROBOT_CONTROL_NIGHTLY"))
E_STOP_SERVICE = mask_of("StopCause", "e_stop_service")
HOSTILE = "</script><script>alert(1)</script><b>joint"


@pytest.fixture
def log():
    made = healthy_run()
    made["permit_action"] = np.where(made["supervisor_state"] >= 1, 2.0, 0.0)
    made["permit_published_ns"] = np.full(CYCLES, 9_000.0)
    for name in ("evidence_cause", "permit_warnings", "command_reasons", "estimate_slip", "faults", "refused"):
        made[name] = np.zeros(CYCLES)
    made["estimate_flags"] = np.ones(CYCLES)
    made["estimate_distance"] = np.cumsum(np.abs(made["estimate_linear"])) * PERIOD
    for name in ("x", "y"):
        made[f"estimate_{name}_variance"] = np.full(CYCLES, 1e-4)
    made["estimate_xy_covariance"] = np.zeros(CYCLES)
    made["nis_gyro"], made["confidence_gyro"] = np.ones(CYCLES), np.ones(CYCLES)
    return made


def values_of(log):
    return {name: figure.value for name, figure in figures(Drive("run", log)).items()}


def test_a_healthy_run_keeps_the_budgets_of_the_package(log):
    found = figures(Drive("run", log))
    budgets = read_budgets(Path(__file__).parents[3] / program.BUDGETS, found)
    judged = {one.figure.name: one.verdict for one in judge(found, budgets)}
    assert Verdict.FAILED not in judged.values()
    assert judged["latched_stops"] is Verdict.OK
    assert judged["sensors_to_command_p99"] is Verdict.OK
    assert judged["distance"] is Verdict.UNJUDGED
    del log["command_published_ns"]
    assert {one.figure.name: one.verdict for one in judge(figures(Drive("run", log)), budgets)}[
        "sensors_to_command_p99"
    ] is Verdict.UNKNOWN


def test_figures_are_what_they_say(log):
    values = values_of(log)
    assert values["sensors_to_command_p99"] == pytest.approx(7.0)
    assert values["period_max"] == pytest.approx(1000.0)
    assert values["distance"] == pytest.approx(0.5 * 8.0, rel=0.01)
    assert values["position_error"] == 0
    # The truth follows its command two cycles later: 2 ms · 1 m/s² while the speed changes, of 8.5 s twice 0.5 s.
    assert values["linear_error_rms"] == pytest.approx(0.002 * np.sqrt(1 / 8.5), rel=0.05)
    log["right_wheel_joint_effort"][1000] = -3.5
    assert values_of(log)["largest_torque"] == 3.5
    log["missed"][2000:] = 2  # and the node restarts
    log["missed"][3000:] = 0
    log["missed"][4000:] = 1
    assert values_of(log)["missed"] == 3


def walked(log, speed=1.0):
    """The log of a trot of 0.38 s whose body follows the law of walker.h, and sways twice in each period."""
    mean, cycles = np.zeros(CYCLES), np.arange(CYCLES)
    for row in range(1, CYCLES):
        mean[row] = mean[row - 1] + PERIOD / 0.19 * (speed * log["limited_linear"][row] - mean[row - 1])
    log["legged_gait_phase"] = np.where(cycles > BEGIN, (cycles - BEGIN) * PERIOD / 0.38 % 1, 0)
    log["estimate_linear"] = mean * (1 + 0.12 * np.sin(4 * np.pi * log["legged_gait_phase"]))
    return figures(Drive("run", log, kind=Kind(LEGGED)))["linear_error_rms"].value


def test_a_walk_is_judged_by_the_mean_over_a_period_of_what_its_target_does(log):
    assert walked(log) < 0.005
    assert walked(log, speed=0.9) > 0.03


def test_rows_that_are_not_there_are_counted(log):
    kept = np.ones(CYCLES, dtype=bool)
    kept[500:520] = False
    log = {name: values[kept] for name, values in log.items()}
    assert values_of(log)["rows_lost"] == 20
    gap = next(one for one in incidents(Drive("run", log)) if one.kind == "rows lost")
    assert gap.title == "20 cycles not in the log"
    assert gap.begin == pytest.approx(0.499)


def test_moments_without_a_node_are_one_incident_and_a_longer_one_stands_alone(log):
    for row, cycles in ((1000, 1), (2000, 3), (3000, 1), (4000, 50)):
        log["estimate_x"][row : row + cycles] = np.nan
    moments, longer = [one for one in incidents(Drive("run", log)) if one.kind == "node absent"]
    assert moments.title == "at 3 moments, 3 cycles at most"
    assert moments.evidence == ["5 cycles in all; the longest at 2.00 s: 3 cycles without a row of estimator"]
    assert (moments.begin, moments.end) == (pytest.approx(1.0), pytest.approx(3.001))
    assert longer.title == "50 cycles without a row of estimator"


def test_what_was_not_to_be_recorded_is_not_lost(log):
    kept = np.ones(CYCLES, dtype=bool)
    kept[500:520] = False
    log = {name: values[kept] for name, values in log.items()}
    drive = Drive("run", log, lost=0)
    assert figures(drive)["rows_lost"].value == 0
    assert incidents(drive) == []
    assert figures(Drive("run", log, lost=7))["rows_lost"].value == 7


def test_a_stop_is_an_incident_with_its_way_to_standstill(log):
    rows = slice(2000, 5000)
    log["supervisor_state"][rows] = 4
    log["permit_action"][rows] = 0
    log["permit_causes"][rows] = E_STOP_SERVICE
    for name in ("truth_linear", "estimate_linear"):
        log[name][2000:] = np.maximum(0.5 - 2.0 * PERIOD * np.arange(CYCLES - 2000), 0)
        log[name.replace("linear", "angular")][2000:] = 0
    (stop,) = [one for one in incidents(Drive("run", log)) if one.kind == "stop"]
    assert stop.title == "e_stop_service"
    assert (stop.begin, stop.end) == (pytest.approx(2.0), pytest.approx(5.0))
    # v²/2a = 0.0625 m, v/a = 0.25 s, until 0.01 m/s
    assert any("at 0.50 m/s" in line and "standstill after 0.246 s and 0.063 m" in line for line in stop.evidence)
    assert "released after 3.00 s" in stop.evidence
    assert values_of(log)["latched_stops"] == 1


def test_a_stop_says_what_was_measured(log):
    tilt = mask_of("StopCause", "tilt")
    log["supervisor_state"][2000:] = 4
    log["permit_causes"][2000:] = tilt
    log["evidence_cause"][2000:] = tilt
    log["evidence_value"] = np.full(CYCLES, 0.61)
    log["evidence_limit"] = np.full(CYCLES, 0.52)
    (stop,) = [one for one in incidents(Drive("run", log)) if one.kind == "stop"]
    assert any(re.search(r"measured 0\.61 \S+, limit 0\.52 \S+", line) for line in stop.evidence), stop.evidence
    assert "not released until the end of the log" in stop.evidence


def test_a_brake_of_the_gate_counts_while_driving_alone(log):
    brake_at(log, 3000)
    assert values_of(log)["gate_brakes"] == 1
    (brake,) = [one for one in incidents(Drive("run", log)) if one.kind == "brake"]
    assert (brake.title, brake.begin) == ("no_command", 3.0)
    brake_at(log, BEGIN - 200)  # it stands
    assert values_of(log)["gate_brakes"] == 1


def test_a_stop_without_a_row_of_the_monitor_in_it_is_one_stop(log):
    rows = slice(2000, 5000)
    log["supervisor_state"][rows], log["permit_causes"][rows] = 4, E_STOP_SERVICE
    for row in (1999, 2500, 3000, 5000):
        for name in ("supervisor_state", "permit_causes", "permit_action"):
            log[name][row] = np.nan
    (stop,) = [one for one in incidents(Drive("run", log)) if one.kind == "stop"]
    assert (stop.begin, stop.end) == (pytest.approx(2.0), pytest.approx(5.001))
    assert values_of(log)["latched_stops"] == 1


def test_intervals():
    true = np.array([1, 1, 0, 1, 0, 0, 0, 1], dtype=bool)
    assert intervals(true) == [(0, 2), (3, 4), (7, 8)]
    assert joined(intervals(true), 1) == [(0, 4), (7, 8)]
    assert intervals(np.zeros(3, dtype=bool)) == []
    column = np.array([np.nan, 1, np.nan, 1, np.nan, 0, np.nan, 1, np.nan])
    assert intervals(column == 1, column) == [(1, 5), (7, 9)]
    assert runs_of(np.array([1, 1, np.nan, 2, 2, 1])) == [(0, 2, 1), (3, 5, 2), (5, 6, 1)]


def test_decimation_keeps_every_peak_where_it_is():
    random = np.random.default_rng(1)
    time = np.arange(100_007) * PERIOD
    values = random.normal(size=time.size)
    values[70_003], values[3] = 50.0, -60.0
    values[20_000:25_000] = np.nan
    x, y = decimated(time, values, 500)
    assert x.size <= 1000
    assert np.all(np.diff(x) > 0)
    assert (np.nanmax(y), np.nanmin(y)) == (50.0, -60.0)
    assert x[np.nanargmax(y)] == time[70_003]
    known = ~np.isnan(y)
    np.testing.assert_array_equal(y[known], values[np.round(x[known] / PERIOD).astype(int)])
    assert np.isnan(y[(x > 20.3) & (x < 24.7)]).all()
    few = decimated(time[:900], values[:900], 500)
    np.testing.assert_array_equal(few[1], values[:900])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("distanze: {most: 1}", "unknown figure distanze; there are distance"),
        ("distance: 3", "distance: 3 is not {most: NUMBER} or {least: NUMBER}"),
        ("distance: {mots: 3}", "distance: {'mots': 3} is not"),
        ("distance: {most: .nan}", "distance.most: nan is not a number"),
        ("distance: {most: yes}", "distance.most: True is not a number"),
        ("[1, 2]", "contains no budgets"),
        ("", "contains no budgets"),
        ("{}", "contains no budgets"),
        ("# most: 3", "contains no budgets"),
        ("0", "contains no budgets"),
        ("a: [", "while parsing"),
    ],
)
def test_a_wrong_budget_is_refused(tmp_path, text, said):
    path = tmp_path / "budgets.yaml"
    path.write_text(text)
    with pytest.raises(BudgetError, match=re.escape(said)):
        read_budgets(path, {"distance": Figure("distance", "m", "", 1.0)})


@pytest.fixture
def written(tmp_path, monkeypatch, log):
    """The name of a run.bag that reads as the log is when this is called."""
    monkeypatch.chdir(tmp_path)
    runs = {}
    monkeypatch.setattr(program, "read_run", lambda path: runs[path.name] if path.name in runs else read_run(path))

    def write(name="run.bag", **header):
        Path(name).write_text("")
        columns = {column: values.copy() for column, values in log.items()}
        runs[name] = RunLog(columns, columns["time"], header, 1, 0, "")
        return name

    return write


def test_ci_ends_with_the_verdict(written, log, capsys):
    Path("budgets.yaml").write_text(yaml.safe_dump({"gate_brakes": {"most": 0}, "distance": {"least": 3}}))
    program.main([written(), "--ci", "--budgets", "budgets.yaml"])
    said = capsys.readouterr().out
    assert re.search(r"gate_brakes +0 +≤ 0 +ok", said)
    assert re.search(r"distance +4\S* m +≥ 3 m +ok", said)
    brake_at(log, 3000)
    with pytest.raises(SystemExit, match="1 figures break their budget: gate_brakes"):
        program.main([written(), "--ci", "--budgets", "budgets.yaml"])
    assert not list(Path().glob("*.html"))


def test_a_ci_that_judges_nothing_is_refused(written, log, tmp_path):
    budgets = tmp_path / "budgets.yaml"
    for name in [name for name in log if name.startswith("truth")]:
        del log[name]
    for text, said in (("", "contains no budgets"), ("position_error: {most: 0.02}", "nothing was judged")):
        budgets.write_text(text)
        with pytest.raises(SystemExit, match=said):
            program.main([written(), "--ci", "--budgets", str(budgets)])


def test_what_cannot_be_read_is_refused_in_one_message(written):
    Path("text.csv").write_text("time,left\n1,2\n")
    for arguments, said in (
        (["nowhere.bag", "--ci"], "nowhere.bag"),
        (["text.csv", "--ci"], "is not a run.bag"),
        ([written(), "--ci", "--budgets", "absent.yaml"], "absent.yaml"),
    ):
        with pytest.raises(SystemExit, match=f"^report.py: .*{said}"):
            program.main(arguments)


def written_page(arguments):
    """The text of page.html, made with these arguments."""
    if not MUST_RUN:
        try:
            program.main([*arguments, "--out", "page.html"])
        except SystemExit as error:
            if "needs Bokeh" in str(error):
                pytest.skip("Bokeh, optional, is not installed: scripts/setup --report")
            raise
    else:
        program.main([*arguments, "--out", "page.html"])
    return Path("page.html").read_text()


def test_the_page_needs_no_network(written, log):
    log["supervisor_state"][2000:5000] = 4
    log["permit_causes"][2000:5000] = E_STOP_SERVICE
    text = written_page([written()])
    for section in ("Verdict", "Incidents", "Path", "States and reasons", "Speeds", "Joints", "Latency"):
        assert f"<h2>{section}</h2>" in text
    assert "e_stop_service" in text
    assert re.search(r"<(?:script|link|img)[^>]+(?:src|href)=", text) is None
    assert len(text) < 4_000_000


def test_the_page_of_a_robot_on_legs_has_no_words_of_wheels(written, log):
    log["command_reasons"][:200] = mask_of("CommandReason", "no_command", "timed_out")
    for name in ("wheel_odom_x", "wheel_odom_y", "speed_limit"):
        log[name] = np.zeros(CYCLES)
    for name in [name for name in log if "wheel_joint" in name]:
        log[name.replace("wheel", "knee")] = log.pop(name)
    of_wheels = re.compile(r"wheels alone|wheels and inertial|cmd_vel_timeout|monitor\S+ limit")
    assert len(set(of_wheels.findall(written_page([written()])))) == 4
    text = written_page([written(kind=LEGGED)])
    assert of_wheels.findall(text) == []
    assert "nothing was received on cmd_vel or body_pose" in text
    assert "older than request_timeout" in text


def test_names_in_a_log_are_no_markup(written, log):
    log[f"{HOSTILE}_effort"] = log["left_wheel_joint_effort"]
    text = written_page([written()])
    assert "<script>alert(1)" not in text
    assert text.count("</script>") == text.count("<script")


def test_two_logs_stand_beside_each_other(written, log):
    first = written("a.bag")
    log["largest"] = log["cycle"]
    log["left_wheel_joint_effort"][100] = 9.0
    brake_at(log, 3000)
    text = written_page(["--compare", first, written("b.bag")])
    assert "<h1>a against b</h1>" in text
    assert re.search(r"largest torque</td><td class=\"n\">0\.3 N·m</td><td class=\"n\">9 N·m</td>", text)
    assert re.search(r"<h3>a</h3><p class=\"how\">None", text)
    assert re.search(r"<h3>b</h3><ol><li class=\"brake\">.*no_command", text)
    assert re.search(r"gate brakes</td><td class=\"n\">0</td><td class=\"n bad\">1</td>", text)


def test_a_log_without_a_truth_or_a_clock_has_a_page(written, log):
    for name in [name for name in log if name.startswith("truth") or name.endswith("_ns")]:
        del log[name]
    text = written_page([written()])
    assert "<h2>Latency</h2>" not in text
    assert "<h2>Speeds</h2>" in text


def test_chromium_opens_the_page_without_a_complaint(written, log):
    chromium = shutil.which("chromium")
    if chromium is None and not MUST_RUN:
        pytest.skip("Chromium, optional, is not installed: scripts/setup --browser")
    log["supervisor_state"][2000:5000] = 4
    log["permit_causes"][2000:5000] = E_STOP_SERVICE
    written_page([written()])
    done = subprocess.run(
        [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--window-size=1280,4000",
         "--virtual-time-budget=10000", "--screenshot=page.png", f"file://{Path('page.html').resolve()}"],
        capture_output=True, text=True, timeout=120, check=False, stdin=subprocess.DEVNULL,
    )  # fmt: skip
    console = [line for line in done.stderr.splitlines() if "CONSOLE" in line and "source: chrome:" not in line]
    assert any("document idle" in line for line in console), done.stderr[-2000:]
    assert [line for line in console if "setting log level" not in line and "document idle" not in line] == []
    from matplotlib.image import imread

    picture = imread("page.png")[..., :3]
    assert picture.shape[:2] == (4000, 1280)
    plots = picture[2000:3600]  # curves and bars in their colours, not an empty frame
    coloured = np.ptp(plots, axis=2) > 0.3
    assert coloured.mean() > 0.002


@pytest.fixture(scope="module")
def run_bag(tmp_path_factory):
    from robot_control import ClosedLoop

    folder = tmp_path_factory.mktemp("log")
    loop = ClosedLoop()
    loop.log_into(folder)
    loop.run(0.5, (0.0, 0.0))
    loop.run(2.5, (0.5, 0.2))
    loop.end_log()
    return folder / "run.bag"


def test_a_bag_is_judged_as_a_table_is(run_bag, capsys):
    program.main([str(run_bag), "--ci"])
    said = capsys.readouterr().out
    assert re.search(r"rows_lost +0 +≤ 0 +ok", said)
    assert re.search(r"sensors_to_command_p99 +– +≤ 500 µs +not in this log", said)


def test_a_log_of_one_cycle_has_nothing_to_draw(written, log):
    for name in log:
        log[name] = log[name][:1]
    with pytest.raises(SystemExit, match="one: there are no two cycles with a time"):
        program.main([written("one.bag")])


def test_of_several_runs_the_last_one_is_judged_and_that_is_said(tmp_path, monkeypatch, capsys):
    from robot_control import ClosedLoop

    monkeypatch.chdir(tmp_path)
    loop = ClosedLoop()
    loop.log_into(tmp_path)
    loop.run(1.0, (0.5, 0.2))
    loop.reset()
    loop.run(1.0, (0.0, 0.0))
    loop.end_log()
    said = "2 runs in the file; this is the last one"
    assert f'class="part">{said}' in written_page(["run.bag"])
    assert said in capsys.readouterr().err


def test_a_bag_that_was_cut_off_is_judged_up_to_there_and_says_so(run_bag, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("run.bag").write_bytes(run_bag.read_bytes()[: run_bag.stat().st_size * 2 // 3])
    text = written_page(["run.bag"])
    assert re.search(r'class="part">the bag has no end .* Read are \d+ messages', text)
    assert "the bag has no end" in capsys.readouterr().err
