"""Keys that were typed while teleop.py did not run, in virtual time."""

from robot_control.drive.teleop.backlog import LATE, Backlog


def test_all_that_was_typed_during_a_gap_is_old_until_a_look_finds_nothing():
    backlog = Backlog(0.0)
    assert not backlog.late(b"w", LATE)
    begin = 2 * LATE + 0.1
    assert backlog.late(b"w" * 4096, begin)
    assert backlog.late(b"w" * 4096, begin + 0.001)
    assert not backlog.late(b"", begin + 0.002)
    assert not backlog.late(b"w", begin + 0.003)
