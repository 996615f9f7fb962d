"""The cells of the notebooks run from top to bottom, without Jupyter."""

import json
import re

import matplotlib
import numpy as np
import pytest
from pages import ROOT

NOTEBOOKS = sorted((ROOT / "examples").glob("*.ipynb"))


def cells(notebook):
    content = json.loads(notebook.read_text())
    assert (content["nbformat"], content["nbformat_minor"]) == (4, 5)
    return content["cells"]


@pytest.fixture(params=NOTEBOOKS, ids=lambda path: path.stem)
def notebook(request):
    return cells(request.param)


def test_a_notebook_is_kept_without_its_results(notebook):
    ids = [cell["id"] for cell in notebook]
    assert len(set(ids)) == len(ids)
    assert [cell["id"] for cell in notebook if cell.get("outputs") or cell.get("execution_count")] == []


def run(notebook, names, last):
    for cell in notebook:
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), cell["id"], "exec"), names)
            if last in names:
                return


def test_the_first_drive_drives_stops_says_why_and_walks(capsys):
    """Each figure stands for what the text above its cell says."""
    matplotlib.use("Agg")
    names = {}
    run(cells(ROOT / "examples" / "first_drive.ipynb"), names, "nothing")
    printed = capsys.readouterr().out
    assert "0.50 m/s, 0.20 rad/s" in printed
    assert "state: STOPPED" in printed
    assert re.search(r"^wheel_effort: .+\. Remedy: .+", printed, re.MULTILINE)
    assert "0.30 m/s" in printed
    ends = [np.unwrap(way["truth_yaw"])[-1] for way in names["ways"].values()]
    assert ends == sorted(ends)
    walk = names["walk"]
    assert walk["truth_x"][-1] ** 2 + walk["truth_y"][-1] ** 2 > 1
