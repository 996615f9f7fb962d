"""The list of recorded runs, whatever the names of the files are."""

import json
import os

import pytest
from robot_control.watch.console.runs import Runs, RunsError


@pytest.mark.parametrize("name", [b"\xff.bag", b"\xfe.bag", "\u2028.bag".encode(), b"a\n.bag"])
def test_a_name_that_is_no_text_is_listed_and_found_by_its_own_id(tmp_path, name):
    for each in (b"run.bag", b"\xfd.bag", name):
        (tmp_path / os.fsdecode(each)).write_bytes(each)
    runs = Runs(tmp_path)
    listed = runs.list()
    json.dumps(listed).encode()
    assert [row["name"].isprintable() for row in listed] == [True] * 3
    assert {runs.file(row["id"]).read_bytes() for row in listed} == {b"run.bag", b"\xfd.bag", name}


def test_what_is_not_in_the_list_is_not_found(tmp_path):
    with pytest.raises(RunsError, match="run not found"):
        Runs(tmp_path).file("../run.bag")
