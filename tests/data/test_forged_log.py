"""replay.py on logs that were changed with ROS's own tools detects values that the laws did not compute."""

import pytest
from robot_control import ClosedLoop
from robot_control.data.replay.main import main
from support.programs import module_of

rosbag = pytest.importorskip("rosbag", reason="logs are changed with Debian's python3-rosbag")

EXACT, NOT_COMPARED, REFUSED, DIFFERENT = 0, 1, 2, 3
STOPPED = 400  # cycle of the emergency stop
LATER = 450


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """A log of a drive with an emergency stop."""
    folder = tmp_path_factory.mktemp("log")
    loop = ClosedLoop()
    loop.log_into(folder)
    loop.run(STOPPED * 1e-3, command=(0.4, 0.3))
    loop.e_stop()
    loop.run(0.2, command=(0.0, 0.0))
    loop.end_log()
    return folder / "run.bag"


def forged(log, folder, edit, later=0):
    """A copy in which `edit(topic, message)` changes each message, or leaves it out by False; all are `later`, s."""
    changed = folder / "changed.bag"
    with rosbag.Bag(str(log)) as source, rosbag.Bag(str(changed), "w", compression="lz4") as target:
        for topic, message, time in source.read_messages():
            if edit(topic, message) is not False:
                target.write(topic, message, type(time)(time.secs + later, time.nsecs))
    return changed


@pytest.fixture
def replayed(log, tmp_path, capsys):
    """Exit code for a forged copy, and the printed text."""

    def judge(edit, later=0):
        changed = forged(log, tmp_path, edit, later)
        with pytest.raises(SystemExit) as end:
            main([str(changed)])
        printed = capsys.readouterr()
        return end.value.code, printed.out + printed.err

    return judge


def rows(edit, cycles=None):
    """An edit that calls `edit(row)` for each row, or each row of `cycles`."""

    def of_trace(topic, message):
        if topic == "trace" and (cycles is None or message.cycle in cycles):
            return edit(message)
        return None

    return of_trace


def moved(row):
    row.estimate_position = [row.estimate_position[0] + 1, *row.estimate_position[1:]]


def test_a_copy_is_as_good_as_its_log(replayed):
    code, text = replayed(lambda *_: None)
    assert code == EXACT, text


def test_a_changed_field_is_noticed(replayed):
    code, text = replayed(rows(moved, [LATER]))
    assert code == DIFFERENT, text
    assert f"differs: row, run 0, cycle {LATER}: " in text


def test_a_changed_time_is_noticed(replayed):
    code, text = replayed(lambda *_: None, later=3600)
    assert code == DIFFERENT, text


def test_rows_that_are_missing_are_the_first_line_and_an_exit_code_of_their_own(replayed):
    code, text = replayed(rows(lambda _: False, [LATER]))
    assert code == NOT_COMPARED, text
    assert "rows NOT COMPARED" in text.splitlines()[0]


@pytest.fixture
def hostile_log(log, tmp_path):
    """A log whose names must not reach a terminal unescaped."""
    name = "\x1b[2J\x07\nexact\x9b"

    def edit(topic, message):
        if topic == "trace_header":
            message.robot = message.missing = message.processor = message.host = message.libraries = name
            message.joints = [name + joint for joint in message.joints]

    return forged(log, tmp_path, edit)


@pytest.mark.parametrize(
    ("program", "arguments"),
    [("replay", ["%"]), ("report", ["%", "--ci"]), ("estimate", ["%"]), ("export", ["%", "--csv", "%.csv"])],
)
def test_text_of_a_log_reaches_no_terminal_as_control_characters(hostile_log, capsys, program, arguments):
    entry = module_of(program).main
    try:
        entry([argument.replace("%", str(hostile_log)) for argument in arguments])
        said = ""
    except SystemExit as end:
        said = str(end.code)
    printed = capsys.readouterr()
    lines = (printed.out + printed.err + said).splitlines()
    assert all(line.isprintable() for line in lines), lines
    assert not any(line.startswith("exact") for line in lines)


@pytest.fixture(params=[5e-324, 0.0, -0.001, float("nan"), 1e300])
def timeless_log(log, tmp_path, request):
    """A log whose header has the period of no loop."""

    def edit(topic, message):
        if topic == "trace_header":
            message.period = request.param

    return str(forged(log, tmp_path, edit))


@pytest.mark.parametrize(
    ("program", "arguments"),
    [
        ("replay", ["%"]),
        ("report", ["%"]),
        ("estimate", ["%"]),
        ("export", ["%", "--csv", "%.csv"]),
        ("identify", ["--log=%", "--output=%.yaml"]),
    ],
)
def test_a_period_of_no_loop_is_refused_in_one_sentence(timeless_log, monkeypatch, capsys, program, arguments):
    entry = module_of(program).main
    words = [argument.replace("%", timeless_log) for argument in arguments]
    monkeypatch.setattr("sys.argv", [program, *words])
    with pytest.raises(SystemExit) as end:
        entry() if program == "identify" else entry(words)
    said = str(end.value.code) + capsys.readouterr().err
    assert "the period of TraceHeader" in said
    assert "of no loop" in said


def test_a_log_of_another_layout_is_refused_with_the_version_that_wrote_it_and_the_remedy(log, tmp_path, capsys):
    other = tmp_path / "other.bag"
    with rosbag.Bag(str(log)) as source, rosbag.Bag(str(other), "w", compression="lz4") as target:
        version = ""
        for topic, message, time in source.read_messages(raw=True):
            name, data, md5sum, _, kind = message
            if topic == "trace_header":
                version = kind().deserialize(data).version
            if topic == "trace":
                text = "uint64 of_another_version\n" + kind._full_text
                kind = type("Trace", (), {"_full_text": text, "_type": name, "_md5sum": md5sum})
            target.write(topic, (name, data, md5sum, None, kind), time, raw=True)
    with pytest.raises(SystemExit) as end:
        main([str(other)])
    printed = capsys.readouterr()
    assert end.value.code == REFUSED
    assert f"version {version}, build " in printed.err
    assert "replay with that build" in printed.err
