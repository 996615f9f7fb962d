"""Names that users have written down go on working."""

import json
from pathlib import Path

import public_names
import pytest
from robot_control import ClosedLoop, ParameterError

RECORDED = json.loads(Path(__file__).with_name("public_names.json").read_text())
NAMES = public_names.public_names()
RENEW = "renew the list: /usr/bin/python3 tests/behaviour/public_names.py > tests/behaviour/public_names.json"


def test_every_kind_of_name_is_found():
    assert set(NAMES) == set(RECORDED)
    assert all(len(names) >= 10 for names in NAMES.values())


@pytest.mark.parametrize("kind", RECORDED)
def test_no_public_name_is_lost(kind):
    assert [name for name in RECORDED[kind] if name not in NAMES[kind]] == []


@pytest.mark.parametrize("kind", RECORDED)
def test_a_new_public_name_is_recorded(kind):
    assert [name for name in NAMES[kind] if name not in RECORDED[kind]] == [], RENEW


def test_every_recorded_parameter_is_accepted():
    """The parameter file lists them; the program must know them, too."""
    tree = {"no_such_block": {"key": 0}}
    for name in RECORDED["parameters"]:
        *groups, key = name.split(".")
        block = tree
        for group in groups:
            block = block.setdefault(group, {})
        block[key] = [[]]  # no key has this type, so the answer names every known key
    with pytest.raises(ParameterError) as refused:
        ClosedLoop(tree)
    unknown = [line for line in str(refused.value).splitlines() if "unknown key" in line]
    assert len(unknown) == 1, "\n".join(unknown)
    assert "no_such_block" in unknown[0]
