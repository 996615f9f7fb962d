import json
import re
from pathlib import Path

import numpy as np
import pytest
from robot_control.run_picture import draw_run
from robot_control.run_summary import STOP_CAUSES, SUPERVISOR_STATES, summarize, to_json, to_table
from synthetic_run import ANGULAR, LINEAR, SECONDS, healthy_run

ROOT = Path(__file__).parents[2]


@pytest.fixture
def run():
    return healthy_run()


def summary_of(log, driven=SECONDS):
    return summarize(log, LINEAR, ANGULAR, driven)


def test_a_healthy_run_has_passed(run):
    assert summary_of(run).passed


def test_deadlines_are_reported_and_not_judged(run):
    run["missed"][5000:] = 12
    run["overruns"][5000:] = 7
    summary = summary_of(run)
    assert summary.passed
    assert (summary.timing.missed, summary.timing.overruns) == (12, 7)


def test_a_log_that_ends_early_has_not_passed(run):
    early = {name: values[:4000] for name, values in run.items()}
    assert not summary_of(early).passed
    assert "not in the steady part" in summary_of(early).untracked


def test_time_that_slipped_is_not_missing_from_the_steady_part(run):
    run["slipped_ns"][500:] = 4e9
    assert summary_of(run, driven=SECONDS + 4.0).passed
    run["slipped_ns"][:] = 0
    assert not summary_of(run, driven=SECONDS + 4.0).passed


def test_states_and_causes_of_a_stop_are_named(run):
    run["supervisor_state"][6000:] = 4
    run["permit_causes"][6000:] = 1 << 5 | 1 << 0
    safety = summary_of(run).safety
    assert safety.states == ("INIT", "READY", "DRIVE", "STOPPED")
    assert safety.state == "STOPPED"
    assert safety.causes == ("e_stop_topic", "controller_lost")


def test_the_vocabulary_is_that_of_the_frames():
    names = (ROOT / "src/signals/names.h").read_text()
    states = re.search(r"name_of\(SupervisorState.*?kNames\{(.*?)\}", names, re.DOTALL).group(1)
    assert tuple(re.findall(r'"(\w+)"', states)) == SUPERVISOR_STATES
    names = (ROOT / "src/signals/cause_names.h").read_text()
    causes = re.search(r"kStopCauseNames = .*?\n\}\);", names, re.DOTALL).group(0)
    assert tuple(re.findall(r'\{kCause\w+, "(\w+)"', causes)) == STOP_CAUSES


def test_json_holds_the_figures_and_no_nan(run):
    run["driver_woke_ns"][:] = np.nan
    tree = json.loads(to_json(summary_of(run)), parse_constant=pytest.fail)
    assert tree["passed"] is True
    assert tree["tracking"]["linear"]["truth"] == pytest.approx(LINEAR)
    assert tree["timing"]["period"]["p50"] is None
    assert {check["passed"] for check in tree["tracking"]["checks"]} == {True}


def test_the_table_says_what_failed(run):
    run["truth_linear"][4000] *= 1.2
    lines = [line for line in to_table(summary_of(run)).splitlines() if "FAILED" in line]
    assert len(lines) == 1
    assert "worst steady cycle, linear" in lines[0]


def test_the_table_fits_a_terminal(run):
    assert max(len(line) for line in to_table(summary_of(run)).splitlines()) <= 80


@pytest.mark.parametrize("moves", [True, False])
def test_a_picture_is_drawn_of_any_run(run, tmp_path, moves):
    if not moves:
        run["requested_linear"][:] = 0
        for name in run:
            if name.startswith(("truth", "estimate")):
                run[name][:] = np.nan
    draw_run(run, summary_of(run), "title", tmp_path / "run.png")
    assert (tmp_path / "run.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
