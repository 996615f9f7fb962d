"""The result of doctor.py as the console shows it."""

import threading

import pytest
from robot_control.watch.console import doctor_run
from robot_control.watch.console.doctor_run import DoctorRun
from robot_control.watch.console.runs import RunsError


def test_the_findings_come_with_the_worst_first():
    order = ["fault", "warning", "note", "unseen", "ok"]
    found = DoctorRun().result()
    verdicts = [order.index(check["verdict"]) for check in found]
    assert verdicts == sorted(verdicts)
    assert {"preemption", "shared_memory"} <= {check["name"] for check in found}


def test_a_program_that_prints_nothing_is_one_message(monkeypatch):
    monkeypatch.setattr(doctor_run, "PROGRAM", "import sys; sys.exit('it is broken')")
    with pytest.raises(RunsError, match="it is broken"):
        DoctorRun().result()


def test_a_program_that_hangs_is_given_up(monkeypatch):
    monkeypatch.setattr(doctor_run, "PROGRAM", "import time; time.sleep(60)")
    monkeypatch.setattr(doctor_run, "TIME", 0.2)
    with pytest.raises(RunsError, match="not ready within"):
        DoctorRun().result()


def test_one_examination_runs_at_a_time(monkeypatch):
    monkeypatch.setattr(doctor_run, "PROGRAM", "import time; time.sleep(60)")
    monkeypatch.setattr(doctor_run, "TIME", 2.0)
    one = DoctorRun()
    began = threading.Event()
    monkeypatch.setattr(doctor_run.subprocess, "run", hook := Signalled(doctor_run.subprocess.run, began))
    first = threading.Thread(target=given_up, args=(one,))
    first.start()
    assert began.wait(10.0)
    with pytest.raises(RunsError, match="already runs"):
        one.result()
    first.join()
    assert hook.calls == 1


def given_up(one):
    with pytest.raises(RunsError):
        one.result()


class Signalled:
    """A function that signals its first call."""

    def __init__(self, function, began):
        self.function, self.began, self.calls = function, began, 0

    def __call__(self, *arguments, **named):
        self.calls += 1
        self.began.set()
        return self.function(*arguments, **named)
