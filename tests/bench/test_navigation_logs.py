"""Logs of lasers are read as they were written, and trajectories are judged as published."""

import numpy as np
import pytest

from bench.navigation.laser_logs import read_folder
from bench.navigation.odometry_model import SCALE, made
from bench.navigation.trajectories import absolute_error, between, composed, relation_errors

TIME = np.arange(50.0)
CIRCLE = np.column_stack([3 * np.cos(TIME / 8), 3 * np.sin(TIME / 8), TIME / 8 + np.pi / 2])
CARMEN = "# a comment\nFLASER 3 1.0 2.5 81.9 9 9 9 0.1 0.2 0.3 12.5 host 12.6\nODOM 0 0 0 0 0 0 1 host 1\n"


def relations_of(poses):
    first, second = np.arange(0, 40, 3), np.arange(5, 45, 3)
    step = between(poses[first], poses[second])
    zero = np.zeros(len(first))
    return np.column_stack([TIME[first], TIME[second], step[:, 0], step[:, 1], zero, zero, zero, step[:, 2]])


def test_the_true_path_has_no_error_wherever_it_begins():
    moved = composed(np.array([5.0, -2.0, 1.0]), CIRCLE)
    assert relation_errors(TIME, moved, relations_of(CIRCLE)) == pytest.approx((0, 0), abs=1e-9)
    assert absolute_error(moved, CIRCLE) == pytest.approx(0, abs=1e-9)


def test_a_path_that_is_a_tenth_longer_errs_by_a_tenth_of_each_relation():
    longer = CIRCLE * (1.1, 1.1, 1)
    relations = relations_of(CIRCLE)
    expected = 0.1 * np.mean(np.hypot(relations[:, 2], relations[:, 3]))
    assert relation_errors(TIME, longer, relations)[0] == pytest.approx(expected)


def test_relations_beyond_the_log_are_left_out():
    relations = relations_of(CIRCLE)
    late = relations.copy()
    late[:, :2] += 1000
    late[:, 2] += 7
    assert relation_errors(TIME, CIRCLE, np.concatenate([relations, late]))[0] == pytest.approx(0, abs=1e-9)


def test_made_odometry_errs_along_the_way_by_its_scale():
    straight = np.column_stack([np.arange(20.0), np.zeros(20), np.zeros(20)])
    ends = np.array([made(straight, seed)[-1] for seed in range(300)])
    along = np.hypot(ends[:, 0], ends[:, 1]) / straight[-1, 0] - 1
    assert np.std(along) == pytest.approx(SCALE, rel=0.25)
    assert np.array_equal(made(straight, 7), made(straight, 7))


def test_archives_and_carmen_text_are_read(tmp_path):
    ranges = np.full((50, 180), 2.0, dtype=np.float32)
    ranges[0, 3:] = np.nan
    ranges[1, 7] = 81.8
    np.savez(tmp_path / "b.npz", time=TIME, ranges=ranges, reference=CIRCLE)
    (tmp_path / "a.clf").write_text(CARMEN)
    np.savetxt(tmp_path / "a.relations", [[1, 2, 3, 4, 0, 0, 0, 5]])
    carmen, archive = read_folder(tmp_path)
    assert (carmen.name, carmen.time.tolist(), carmen.odometry.tolist()) == ("a", [12.5], [[0.1, 0.2, 0.3]])
    assert carmen.scan(0)["ranges"].tolist() == [1.0, 2.5, np.inf]
    assert carmen.relations[0, 7] == 5
    assert archive.odometry is None
    assert len(archive.scan(0)["ranges"]) == 3
    assert archive.scan(1)["ranges"][7] == np.inf
    assert archive.scan(1)["angle_increment"] == pytest.approx(np.radians(1))


def test_a_folder_without_logs_and_a_broken_log_are_refused(tmp_path):
    with pytest.raises(RuntimeError, match="holds no log"):
        read_folder(tmp_path)
    (tmp_path / "a.log").write_text("FLASER 200 1.0\n")
    with pytest.raises(RuntimeError, match=r"a\.log cannot be read as a log"):
        read_folder(tmp_path)
