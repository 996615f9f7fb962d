import json

import numpy as np
import pytest
from robot_control.data.demo import run_picture
from robot_control.data.demo.run_picture import draw_run
from robot_control.data.demo.run_summary import summarize, to_json, to_table
from robot_control.loop.signal_names import mask_of, number_of
from support.recordings.synthetic_run import ANGULAR, BEGIN, END, LINEAR, SECONDS, brake_at, healthy_run


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
    run["supervisor_state"][6000:] = number_of("SupervisorState", "STOPPED")
    run["permit_causes"][6000:] = mask_of("StopCause", "controller_lost", "e_stop_topic")
    safety = summary_of(run).safety
    assert safety.states == ("INIT", "READY", "DRIVE", "STOPPED")
    assert safety.state == "STOPPED"
    assert safety.causes == ("e_stop_topic", "controller_lost")


def test_lateness_is_named_before_what_follows_from_it(run):
    run["permit_causes"][6000:] = mask_of("StopCause", "controller_lost", "impact")
    assert to_table(summary_of(run)).startswith("stopped: the loop was late, because other programs used the CPU: ")
    run["permit_causes"][6000:] = mask_of("StopCause", "impact")
    assert "was late" not in to_table(summary_of(run))


EXPIRED, NO_COMMAND, PERMIT_BRAKE = (
    mask_of("GateReason", name) for name in ("permit_expired", "no_command", "permit_brake")
)


def test_a_brake_in_mid_drive_is_in_the_table_with_its_time_and_reason(run):
    assert "brakes of the gate while driving  none" in to_table(summary_of(run))
    brake_at(run, 5000, EXPIRED)
    for cycle in (6000, 6001):
        brake_at(run, cycle, NO_COMMAND)
    summary = summary_of(run)
    assert [(brake.begin, brake.cycles, brake.reasons) for brake in summary.brakes] == [
        (5.0, 1, ("permit_expired",)),
        (6.0, 2, ("no_command",)),
    ]
    table = to_table(summary)
    assert "brakes of the gate while driving  2, 3 cycles in all" in table
    assert "at 5.000 s                      1 cycle, permit_expired" in table
    assert json.loads(to_json(summary))["brakes"][1]["cycles"] == 2


def test_a_brake_at_rest_is_none_in_mid_drive(run):
    for cycle in (*range(BEGIN), *range(END + 600, len(run["cycle"]))):
        brake_at(run, cycle, mask_of("GateReason", "controller_brake"))
    brake_at(run, BEGIN, 0)  # the request of this cycle acts in the next
    assert summary_of(run).brakes == ()


def test_a_stop_in_mid_drive_lasts_to_its_end_in_the_table(run):
    run["gate_verdict"][6000:], run["gate_reasons"][6000:] = 0, PERMIT_BRAKE
    run["requested_linear"][6100:] = run["requested_angular"][6100:] = 0
    (brake,) = summary_of(run).brakes
    assert (brake.begin, brake.end, brake.reasons) == (6.0, run["time"][-1], ("permit_brake",))


def test_many_brakes_still_fit_a_terminal(run):
    for cycle in range(3000, 7000, 100):
        brake_at(run, cycle, (1 << 19) - 1)
    table = to_table(summary_of(run)).splitlines()
    assert max(map(len, table)) <= 80
    assert "and 36 more" in table[-1]


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


@pytest.fixture
def panels(monkeypatch, tmp_path):
    """Draws a log; its axes: path, speed, yaw rate, torque."""

    def draw(log):
        figures = []
        monkeypatch.setattr(run_picture.plt, "close", figures.append)
        draw_run(log, summary_of(log), "title", tmp_path / "run.png")
        monkeypatch.undo()
        run_picture.plt.close(figures[-1])
        return figures[-1].axes

    return draw


def test_a_brake_is_named_in_the_picture_as_in_the_table(run, panels):
    brake_at(run, 5000, EXPIRED)
    run["limited_linear"][5000] = 0
    _, *right = panels(run)
    for axes in right:
        assert "gate braked, 1 ×" in [text.get_text() for text in axes.get_legend().get_texts()]
    (name,) = [text.get_text() for text in right[0].texts]
    assert name == "5.00 s: 1 cycle, permit_expired"
    (brake,) = summary_of(run).brakes
    assert brake.describe() in name
    (limited,) = [line for line in right[0].lines if line.get_label() == "within limits"]
    assert np.isnan(limited.get_ydata()[5000]), "no grey bar in its place"


def test_the_names_of_many_brakes_do_not_overlap(run, panels):
    for cycle in range(3000, 7000, 100):
        brake_at(run, cycle, EXPIRED)
    speed = panels(run)[1]
    assert 1 <= len(speed.texts) <= run_picture.BRAKES_NAMED
    assert "gate braked, 40 ×" in [text.get_text() for text in speed.get_legend().get_texts()]


@pytest.mark.parametrize("measured", [True, False])
def test_a_torque_that_no_drive_measures_is_not_in_the_legend(run, panels, measured):
    efforts = {
        name: values if measured else values * np.nan for name, values in run.items() if name.endswith("_effort")
    }
    *_, torque = panels(run | efforts)
    labels = torque.get_legend_handles_labels()[1]
    assert any(label.endswith("commanded") for label in labels)
    assert any(label.endswith("actual") for label in labels) == measured


def test_the_truth_is_drawn_over_the_noise_of_its_estimate(run, panels):
    for axes in panels(run)[1:3]:
        order = [line.get_label() for line in axes.lines]
        assert order.index("true") > order.index("estimated")


@pytest.mark.parametrize("moves", [True, False])
def test_a_picture_is_drawn_of_any_run(run, tmp_path, moves):
    if not moves:
        run["requested_linear"][:] = 0
        for name in run:
            if name.startswith(("truth", "estimate")):
                run[name][:] = np.nan
    draw_run(run, summary_of(run), "title", tmp_path / "run.png")
    assert (tmp_path / "run.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
