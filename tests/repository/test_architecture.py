"""The table of folders and their dependencies. A refusal of this test is a change of architecture, not of style."""

import ast
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SRC = ROOT / "src"
PACKAGE = ROOT / "python/robot_control"

DRIVES = re.findall(r"^DRIVE\((\w+),", (SRC / "drivers/drive_table.def").read_text(), re.MULTILINE)

LAWS = {
    "signals",
    "machine",
    "machine/legs",
    "machine/wheeled",
    "estimation",
    "estimation/legged",
    "control",
    "control/legged",
    "safety",
    "safety/conditions/legged",
    "gate",
    "gate/wheeled",
}
DRIVE = {"signals", "bus", "gate", "drivers", "drivers/line", "drivers/drive", "parameters"}
LOOP = LAWS | {"rt", "bus", "timing", "drivers", "parameters", "configuration", "robots", "loop", "log"}
ALL = LOOP | {"files", "machine/description", "log/bag", "simulation", "simulation/faults", "drivers/mujoco"}
MAY_IMPORT = {  # rooms of the Python package
    "files": set(),
    "settings": {"files"},
    "ui": {"files"},
    "loop": {"files", "settings"},
    "robot": {"files", "settings", "loop"},
    "drive": {"files", "settings", "loop", "robot"},
    "data": {"files", "settings", "ui", "loop", "robot"},
    "setup": {"files", "settings", "ui", "loop", "robot", "data"},
    "watch": {"files", "settings", "ui", "loop", "robot", "drive", "data", "setup"},
    "fleet": {"files", "settings", "robot", "drive", "data", "setup"},
}
MAY_INCLUDE = {
    "signals": set(),
    "files": set(),
    # The engine; the folders that it configures include parameters/block.h alone.
    "parameters": {"files"},
    "rt": {"parameters"},
    "bus": {"signals", "rt"},
    # How punctual the loop is, from the rows of the trace.
    "timing": {"signals", "rt", "bus"},
    "machine/description": {"files"},
    "machine": {"signals", "machine/description", "files", "parameters"},
    # One robot kind on top of it; test_only_the_wheeled_kind_sees_the_drive_train says who may see it.
    "machine/wheeled": {"signals", "machine", "machine/description", "parameters"},
    "machine/legs": {"signals", "machine", "machine/description", "parameters"},
    "estimation": {"signals", "machine", "machine/wheeled", "parameters"},
    "estimation/legged": {"signals", "machine", "machine/legs"},
    "control/legged": {"signals", "machine", "machine/legs", "control", "parameters"},
    "safety/conditions/legged": {"signals", "machine", "machine/legs", "safety"},
    "control": {"signals", "machine", "machine/wheeled", "parameters"},
    "safety": {"signals", "machine", "machine/wheeled", "parameters"},
    "gate": {"signals", "bus", "parameters"},
    # The stop actions of one robot kind.
    "gate/wheeled": {"signals", "gate", "machine", "machine/wheeled"},
    "drivers": {"signals", "bus", "gate", "machine", "parameters"},
    # This holds simulated faults: of the machine in drivers/mujoco, of nodes in simulation.
    "simulation/faults": {"signals", "rt", "bus"},
    # The CAN bus and the serial port, and both in virtual time.
    "drivers/line": {"signals", "bus", "drivers", "files", "parameters", "rt"},
    # The common part of all drives of drive_table.def.
    "drivers/drive": {"signals", "bus", "gate", "drivers", "drivers/line", "parameters", "rt"},
    **{f"drivers/{name}": DRIVE | ({"drivers/unitree"} if "unitree" in name else set()) for name in DRIVES},
    # The program unitree_bridge, which that driver does not link.
    "drivers/unitree_go/bridge": {"drivers/drive", "drivers/line", "drivers/unitree_go", "files", "rt"},
    # The common part of the drives unitree_*.
    "drivers/unitree": DRIVE,
    # The table, the drive file and the drivers of real machines; simulated devices for all of them.
    "drivers/table": {
        "configuration",
        "drivers",
        "drivers/line",
        "drivers/drive",
        *(f"drivers/{name}" for name in DRIVES),
        "gate",
        "machine",
        "parameters",
    },
    # The simulated robot as one machine: the plant, and before its motors the drives, where there are some.
    "simulation/machines": {
        "signals",
        "bus",
        "configuration",
        "drivers",
        "drivers/drive",
        "drivers/mujoco",
        "drivers/table",
        "gate",
        "machine",
    },
    "drivers/mujoco": {
        "signals",
        "simulation/faults",
        "drivers",
        "gate",
        "gate/wheeled",
        "machine/description",
        "machine",
        "machine/wheeled",
        "rt",
        "files",
        "parameters",
    },
    "log/bag": {"files"},
    # The log as a ROS bag; it knows the format, not ROS.
    "log": {"signals", "files", "log/bag", "parameters"},
    # All blocks together, and the other files that a user writes.
    "configuration": LAWS | {"rt", "files", "parameters", "log", "drivers", "drivers/mujoco", "navigation"},
    # A robot of each kind, composed of its laws; the roles as interfaces.
    "robots": LAWS | {"bus", "parameters", "configuration", "drivers/drive", "drivers/table"},
    # The step of each node in one cycle, and the process around it.
    "loop": LOOP - {"loop"} | {"files"},
    # The laws of a log, run again from its rows.
    "log/replay": LOOP,
    "simulation": ALL - {"simulation"} | {"simulation/machines"},
    "bindings": ALL
    | {
        "log/replay",
        "navigation",
        "navigation/driven",
        "navigation/goals",
        "navigation/guard",
        "navigation/mapping",
        "navigation/mrpt",
    },
    "ros": LOOP | {"files", "machine/description"},
    # Maps, costmap, zones: services beside the loop, without ROS.
    "navigation": {"signals", "files", "machine", "parameters"},
    # Planner, local control, and what supervises both.
    "navigation/goals": {"navigation", "signals"},
    # The outline and the limits of each kind of robot.
    "navigation/driven": {
        "navigation",
        "navigation/goals",
        "configuration",
        "control/legged",
        "machine",
        "machine/description",
        "machine/legs",
        "robots",
    },
    "navigation/guard": {"navigation", "machine", "signals"},
    "navigation/mapping": {"navigation", "files", "signals"},
    "navigation/mrpt": {"navigation"},
    "ros/navigation": {
        "signals",
        "navigation",
        "navigation/driven",
        "navigation/goals",
        "navigation/guard",
        "navigation/mapping",
        "navigation/mrpt",
        "ros",
        "configuration",
        "files",
    },
    "main": {
        "signals",
        "ros",
        "ros/navigation",
        "configuration",
        "files",
        "robots",
        "rt",
        "drivers/table",
        "drivers/unitree_go/bridge",
        "simulation/machines",
    },
}
ROS = re.compile(r"^(ros|tf2?|tf2_\w+|\w+_msgs|std_srvs|rosgraph_msgs|robot_control)/")
"""of headers that are included in angle brackets; those of src/ros are included in quotes"""
MUJOCO = re.compile(r"^mujoco")
CLOCK = re.compile(r"\bclock_gettime\b|\bclock_nanosleep\b|\b\w*_clock::now\b|\bgettimeofday\b|\bnanosleep\b")
MONOTONIC = re.compile(r"\bmonotonic_ns\b")

BINDINGS = ROOT / "python" / "bindings"
FILES = sorted(path for root in (SRC, BINDINGS) for path in root.rglob("*") if path.suffix in (".h", ".cpp"))


def includes(path):
    """Names of the project's headers."""
    return re.findall(r'^\s*#\s*include\s*"([^"]+)"', path.read_text(), re.MULTILINE)


def foreign_includes(path):
    return re.findall(r"^\s*#\s*include\s*<([^>]+)>", path.read_text(), re.MULTILINE)


def code(path):
    """Text without comments and strings."""
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\])*"', "", path.read_text(), flags=re.DOTALL)


def room(name):
    """The room of a file that is named from the include root: the longest entry of the table that begins its path."""
    parts = name.split("/")
    names = ["/".join(parts[:count]) for count in range(len(parts) - 1, 0, -1)]
    return next((each for each in names if each in MAY_INCLUDE), parts[0])


def folder(path):
    return "bindings" if BINDINGS in path.parents else room(str(path.relative_to(SRC)))


def violations(rule):
    return [f"{path.relative_to(ROOT)}: {found}" for path in FILES for found in rule(path)]


def test_every_folder_has_its_rule():
    assert {folder(path) for path in FILES} <= set(MAY_INCLUDE)


def test_the_rules_have_no_circle():
    order, left = [], dict(MAY_INCLUDE)
    while left:
        free = [name for name, others in left.items() if others <= set(order)]
        assert free, f"these depend on each other: {sorted(left)}"
        order += free
        for name in free:
            del left[name]


def test_folders_include_only_what_they_may():
    def rule(path):
        own = folder(path)
        for name in includes(path):
            other = room(name)
            if "/" in name and other in MAY_INCLUDE and other != own and other not in MAY_INCLUDE[own]:
                yield f"{own} includes {name}"

    assert violations(rule) == []


def test_what_is_configured_sees_only_the_declaration_of_a_block():
    above = {"parameters", *(name for name, others in MAY_INCLUDE.items() if "configuration" in others | {name})}

    def rule(path):
        if folder(path) not in above:
            yield from (name for name in includes(path) if re.match(r"parameters/(?!block\.h$)", name))

    assert violations(rule) == []


COMPOSED = re.compile(
    r"src/robots/(differential_drive\.|robot_kind\.cpp)"  # the kind itself, and the choice of a kind
    r"|src/configuration/parameters\.h"  # blocks of all kinds, in one file of the user
    r"|python/bindings/(module|closed_loop|describe)\.cpp"  # bindings of all kinds, in one module
)
"""The files that compose. The interfaces beside them see no kind."""


def test_only_the_wheeled_kind_sees_the_drive_train():
    """Gate, drivers, the driver's cycle, the monitor's common conditions and the joint limits take a MachineModel."""
    seen = {
        str(path.relative_to(ROOT))
        for path in FILES
        if folder(path) != "safety"  # measurements and limits of wheels; its common conditions see no kind
        if "wheeled" not in path.parts and not COMPOSED.match(str(path.relative_to(ROOT)))
        if path.parent.name != "main"
        if any(re.match(r"(machine|gate|configuration|ros|bindings)/wheeled/", name) for name in includes(path))
    }
    assert seen == set()


KINDS = ({"wheeled"}, {"legged", "legs"})
"""Names of the folders of each kind."""
COMMON = {"signals", "bus", "loop", "log", "log/replay"}
ROLES = {"src/robots/laws.h", "src/robots/robot.h"}
ALL_KINDS = {"src/signals/command_frame.h", "src/signals/state_frame.h", "src/signals/names.h"}
"""The frames have one member per kind, and the table has the words of all bits."""
OF_KIND = re.compile(r"^(?:struct|class|enum(?: class)?|inline constexpr [\w:]+) (k?[A-Z]\w+)", re.MULTILINE)


def kinds_in(name):
    return [kind for kind in KINDS if kind & set(str(name).removeprefix(f"{ROOT}/").split("/"))]


def test_the_common_interfaces_know_no_kind():
    """Headers of signals, bus, loop and log, and the roles of a robot, use no type and no constant of a kind."""
    names = {name for path in FILES if path.suffix == ".h" and kinds_in(path) for name in OF_KIND.findall(code(path))}
    assert {"DriveTuning", "WheeledCommand", "LeggedCommand", "DriveTrain", "LegModel", "kMaxWheels"} <= names

    def rule(path):
        own = str(path.relative_to(ROOT))
        if path.suffix == ".h" and (folder(path) in COMMON or own in ROLES) and own not in ALL_KINDS:
            yield from set() if kinds_in(own) else names & set(re.findall(r"\w+", code(path)))

    assert violations(rule) == []


def test_no_kind_knows_another():
    def rule(path):
        own = kinds_in(path)
        yield from (name for name in includes(path) if own and kinds_in(name) not in ([], own))

    assert violations(rule) == []


WINGS = ("control", "estimation", "safety/conditions")
"""Folders of three: what every kind may use, and one for each kind."""
BESIDE_KINDS = ("gate", "machine", "signals")
"""In these, what every kind may use lies beside the folders of the kinds."""


def test_laws_lie_in_the_wing_of_a_kind_or_in_common():
    for name in WINGS:
        assert {path.name for path in (SRC / name).iterdir()} - {"CMakeLists.txt"} == {"common", "wheeled", "legged"}


def test_tests_mirror_the_wings():
    folders = {
        path.parent.relative_to(SRC)
        for path in FILES
        for name in ("control", "estimation")
        if SRC / name in path.parents
    }
    assert len(folders) > 10
    assert [str(name) for name in folders if not any((ROOT / "tests" / name).rglob("*_test.cpp"))] == []


def test_what_every_kind_may_use_knows_no_kind():
    def rule(path):
        own = str(path.relative_to(ROOT))
        common = own.startswith(tuple(f"src/{name}/common/" for name in WINGS))
        beside = own.startswith(tuple(f"src/{name}/" for name in BESIDE_KINDS)) and not kinds_in(own)
        if (common or beside) and own not in ALL_KINDS:
            yield from filter(kinds_in, includes(path))

    assert violations(rule) == []


WORDS_OF_KINDS = re.compile(
    r"(?<![A-Za-z])(?:leg(?!a)|stance|walk|fold|upright|foot|feet|gait|wheel)"
    r"|Leg(?!a)|Stance|Walk|Fold|Upright|Foot|Feet|Gait|Wheel"
)
"""They begin a word, or stand within a name."""


def test_the_gate_knows_no_kind():
    """It obeys the stop profile of the command. Only the folder of a kind has a word of wheels or legs."""
    assert all(WORDS_OF_KINDS.search(name) for name in ("legged.phase", "walks_", "kFold", "ContactStances"))
    assert not WORDS_OF_KINDS.search("the distance, an instance")

    def rule(path):
        if folder(path) == "gate":
            yield from (line.strip() for line in path.read_text().splitlines() if WORDS_OF_KINDS.search(line))

    assert violations(rule) == []


def test_project_headers_are_named_from_the_root():
    def rule(path):
        for name in includes(path):
            if (path.parent / name).is_file() and not (SRC / name).is_file():
                yield f"write {folder(path)}/{name}"

    assert violations(rule) == []


def test_only_ros_and_main_see_ros():
    def rule(path):
        if folder(path) not in ("ros", "ros/navigation", "main"):
            yield from (name for name in foreign_includes(path) if ROS.match(name))

    assert violations(rule) == []


def test_only_localisation_sees_mrpt():
    def rule(path):
        if folder(path) != "navigation/mrpt":
            yield from (name for name in foreign_includes(path) if name.startswith("mrpt/"))

    assert violations(rule) == []


def test_only_its_driver_sees_mujoco():
    def rule(path):
        if folder(path) != "drivers/mujoco":
            yield from (name for name in foreign_includes(path) if MUJOCO.match(name))

    assert violations(rule) == []


SIMULATED = {"drivers/mujoco", "simulation/faults", "simulation/machines"}
DEVICES = re.compile(
    r"drivers/(?:\w+/)+(?:device|\w+_device|\w+_front|simulated_\w+|virtual_\w+|answer_faults|object_dictionary|pseudo_\w+|"
    r"speed_loop)\.(?:h|cpp)"
)
"""The simulated device of a drive lies beside it, in a library of its own."""
SIMULATORS = {"main/mujoco_plant.cpp", "main/device_simulator.cpp", "configuration/parameters.h"}
"""The last one: parameters of the plant."""


def test_nothing_simulated_is_in_the_product():
    def rule(path):
        own = folder(path)
        name = str(path.relative_to(SRC)) if path.is_relative_to(SRC) else ""
        if own in SIMULATED | {"simulation", "bindings"} or name in SIMULATORS or DEVICES.fullmatch(name):
            return
        yield from (other for other in includes(path) if room(other) in SIMULATED or DEVICES.fullmatch(other))

    assert violations(rule) == []


def product_texts():
    """Texts of the files of the product, by their paths."""
    tops = ("src", "python", "launch", "scripts", "config", "cmake", "msg", "srv")
    paths = [path for top in tops for path in (ROOT / top).rglob("*") if path.is_file() and path.suffix != ".pyc"]
    return {str(path.relative_to(ROOT)): path.read_text(errors="ignore") for path in paths}


MAX_NAMING_A_DRIVE = 3
"""files of the product outside its own folder and its example in config/drives"""


def test_few_files_name_a_drive():
    """As a word, a class, a namespace, a header or its example."""
    texts = product_texts()

    def naming(name):
        names = rf"\b{name}::|[\"']{name}[\"']|\({name},|drivers/{name}/|{name}\.yaml|\b{name.capitalize()}(?=[A-Z])"
        own = re.compile(rf"src/drivers/{name}/|config/drives/{name}\.yaml")
        return sorted(path for path, text in texts.items() if re.search(names, text) and not own.match(path))

    found = {name: naming(name) for name in DRIVES}
    assert all("src/drivers/drive_table.def" in files for files in found.values())
    assert {name: files for name, files in found.items() if len(files) > MAX_NAMING_A_DRIVE} == {}


CAUSES = re.findall(
    r"^(?:CAUSE|CONDITION|CONDITION_WITHOUT_LIMIT)\((\w+), (\w+),",
    (SRC / "signals/stop_causes.def").read_text(),
    re.MULTILINE,
)
"""Identifier and name of each cause."""
CONDITIONS = "src/safety/conditions/"
CONDITION_SETS = {f"{CONDITIONS}{kind}/{kind}_conditions.h" for kind in ("wheeled", "legged")}
MAX_NAMING_A_CAUSE = 4
"""files of the product outside its own file, apart from TABLES_OF_ALL"""
TABLES_OF_ALL = ("robot_params.yaml", "zh.yaml")
"""The lines generated from stop_causes.def, and the Chinese texts: a row for each cause, which other tests require."""


def test_few_files_name_a_safety_cause():
    """A file names it in C++ by its bit or its parameter, else by its name as a string or a key. Comments do not count.

    Its row in stop_causes.def and the list of its set count, too. Its own file, in which it is measured, is one header
    of safety/conditions with its source, but no such list; a second one counts. A word with another meaning counts if
    it is written in the same way, as the column `overruns` of a report."""
    sources = {str(path.relative_to(ROOT)): code(path) for path in FILES}
    others = {
        str(path.relative_to(ROOT)): re.sub(r"#.*", "", path.read_text(errors="ignore"))
        for top in ("python", "launch", "scripts", "config")
        for path in (ROOT / top).rglob("*")
        if path.is_file() and path.suffix not in (".h", ".cpp", ".pyc") and path.name not in TABLES_OF_ALL
    }

    def using(texts, pattern, *words):
        return [path for path, text in texts.items() if any(word in text for word in words) and pattern.search(text)]

    def naming(identifier, name):
        limit = rf"\b{name}\.(?:limit|persistence|reaction)\b"
        parameter = rf"\b(?:\w*parameters|\w*safety\w*|\w*limits|given|SafetyParameters(?:\{{\}})?)(?:\.|::){name}\b"
        in_source = re.compile(rf"\bkCause{identifier}\b|{parameter}|{limit}")
        elsewhere = re.compile(rf"[\"']{name}[\"']|^\s*{name}:|{limit}", re.MULTILINE)
        found = using(sources, in_source, name, identifier)
        stems = [path.split(".")[0] for path in found if path.startswith(CONDITIONS) and path not in CONDITION_SETS]
        found += using(others, elsewhere, name)
        return ["src/signals/stop_causes.def", *(path for path in found if path.split(".")[0] not in stems[:1])]

    files = {name: naming(identifier, name) for identifier, name in CAUSES}
    assert len(files["runaway"]) == MAX_NAMING_A_CAUSE
    assert any(path in CONDITION_SETS for path in files["runaway"])
    assert {name: found for name, found in files.items() if len(found) > MAX_NAMING_A_CAUSE} == {}


GAIT_TABLE = "src/control/legged/walk/gait_table.h"
MAX_NAMING_A_GAIT = 2
"""files of the product outside the folder of the table"""


def test_few_files_name_a_gait():
    """As a word in quotes or a constant. The page for users names each of them."""
    texts = product_texts()
    gaits = re.findall(r'^    Gait\{\{"(\w+)"\}', texts[GAIT_TABLE], re.MULTILINE)
    assert gaits[0] == "stand"
    folder = str(Path(GAIT_TABLE).parent)
    for gait in gaits[1:]:
        names = re.compile(rf"[\"']{gait}[\"']|\bk{gait.title().replace('_', '')}\b")
        files = [path for path, text in texts.items() if names.search(text) and not path.startswith(folder)]
        assert len(files) <= MAX_NAMING_A_GAIT, files
        assert f"`{gait}`" in (ROOT / "docs/legs.md").read_text()


PROGRAMS = re.compile(r"\b(?:mujoco_plant|state_estimator|(?:diff_drive|leg)_controller(?!\.h)|safety_monitor)\b")
OTHER_PACKAGES = {"configuration/parameters.h", "configuration/peer_file.h"}
"""They speak of the diff_drive_controller of ros_controllers."""
NAME_TABLES = {"signals/roles.h", "signals/robot_kinds.h"}


def test_the_core_speaks_of_roles():
    """Program names stand in main, in two tables of signals and, as its block's name, in a driver's folder."""

    def rule(path):
        own = str(path.relative_to(SRC if path.is_relative_to(SRC) else ROOT))
        if own.startswith(("main/", "drivers/")) or own in OTHER_PACKAGES | NAME_TABLES:
            return
        yield from (line for line in path.read_text().splitlines() if PROGRAMS.search(line) and "#include" not in line)

    assert violations(rule) == []


def test_the_tools_speak_of_roles():
    """Texts of the tools take program names from loop/roles.py; docstrings may name a block of parameters."""
    named = []
    for path in (ROOT / "python" / "robot_control").rglob("*.py"):
        tree = ast.parse(path.read_text())
        parts = [
            node
            for parent in ast.walk(tree)
            for node in ast.iter_child_nodes(parent)
            if not isinstance(parent, ast.Expr)
        ]
        texts = [node for node in parts if isinstance(node, ast.Constant) and isinstance(node.value, str)]
        named += [f"{path.name}:{node.lineno}" for node in texts if PROGRAMS.search(node.value)]
    assert named == []


def test_only_rt_reads_clocks():
    def rule(path):
        if folder(path) != "rt":
            yield from CLOCK.findall(code(path))

    assert violations(rule) == []


def test_laws_and_drivers_are_given_their_time():
    """loop hands rt's clock to the cycles; ordinary threads of ros, log and main may read it."""

    def rule(path):
        if folder(path) not in ("rt", "loop", "ros", "main", "log"):
            yield from MONOTONIC.findall(code(path))

    assert violations(rule) == []


def test_only_ros_knows_ros_time():
    def rule(path):
        if folder(path) not in ("ros", "ros/navigation"):
            yield from re.findall(r"\bros::(?:Time|WallTime|SteadyTime)::now\b", code(path))

    assert violations(rule) == []


def test_linked_libraries_are_included_libraries():
    """The libraries that CMake links obey the same table."""
    texts = {
        str(path.parent.relative_to(SRC)): re.sub(r"#[^\n]*", "", path.read_text())
        for path in SRC.rglob("CMakeLists.txt")
        if path.parent != SRC
    }
    defined_in = {
        library: name for name, text in texts.items() for library in re.findall(r"robot_control_library\((\w+)", text)
    }
    defined_in["signals"] = "signals"  # headers alone, declared above the folders
    wrong = []
    for own, text in texts.items():
        linked = {defined_in[library] for library in re.findall(r"\brc_(\w+)", text)} - {own}
        wrong += [f"{own} links a library of {other}" for other in sorted(linked - MAY_INCLUDE.get(own, set()))]
    assert wrong == []


def file_counts():
    """Folders of the product's C++ and of the tests, each with the number of files that lie directly in it."""
    roots = [SRC, BINDINGS, ROOT / "tests"]
    folders = [*roots, *(path for root in roots for path in root.rglob("*") if path.is_dir())]
    return {
        str(path.relative_to(ROOT)): sum(item.is_file() for item in path.iterdir())
        for path in folders
        if path.name != "__pycache__"
    }


def test_folders_stay_small():
    """At most 25 files, so that a listing is read at a glance."""
    assert {name: count for name, count in file_counts().items() if count > 25} == {}


def test_no_two_headers_share_a_name():
    names = [path.name for path in FILES if path.suffix == ".h"]
    assert sorted(name for name in set(names) if names.count(name) > 1) == []


TYPE_OR_BRACE = re.compile(
    r"namespace\s*([\w:]*)\s*\{|^(?:class|struct|union|enum(?:\s+class)?)\s+(\w+)\b(?!\s*<|::)[^;{()]*\{|[{}]",
    re.MULTILINE,
)


def types_of(path):
    """Full names of the types that a file defines; those of functions, of other types and of unnamed namespaces are
    seen nowhere else.
    """
    scopes = []
    for found in TYPE_OR_BRACE.finditer(NO_CODE.sub("", path.read_text())):
        if found[0] == "}":
            scopes.pop()
            continue
        if found[2] and all(scopes):
            yield "::".join([*scopes, found[2]])
        scopes.append(found[1])  # None of a type or a function


def test_every_type_has_one_definition():
    """Two of one name would break the One Definition Rule; the generated messages are in the namespace of the code."""
    places, messages = {}, {}
    for path in FILES:
        for name in types_of(path):
            places.setdefault(name, []).append(str(path.relative_to(ROOT)))
        for message in re.findall(r"#include <robot_control/(\w+)\.h>", path.read_text()):
            messages.setdefault(f"robot_control::{message}", []).append(str(path.relative_to(ROOT)))
    assert len(places) > 700
    assert {name: found for name, found in places.items() if len(found) > 1} == {}
    assert {name: found + messages[name] for name, found in places.items() if name in messages} == {}


def test_gtest_files_are_named_after_what_they_test():
    assert sorted(str(path.relative_to(ROOT)) for path in (ROOT / "tests").rglob("test_*.cpp")) == []


def test_source_files_stay_small():
    """One concept per file; 400 lines hold one, with the header that states its law."""
    assert [str(path.relative_to(ROOT)) for path in FILES if len(path.read_text().splitlines()) > 400] == []


MAX_FUNCTION = 60
"""lines, from the line of its name to its last brace; in Python without the docstring"""
MAX_FUNCTION_IN = {SRC / "estimation": 40}
"""lines, in folders with a bound of their own; the innermost bound holds"""
MAX_LINES = {SRC / "estimation": 3700, SRC / "estimation/legged": 1130}
"""lines of a whole folder, comments included; a folder below that is listed counts by itself"""
MAX_TUNED_CONSTANTS = 13
"""in src/estimation/common/tuning.h, before the conventions of statistics"""
NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"\w*\(.*?\)\w*"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.DOTALL)
FUNCTION_HEAD = re.compile(r"\)\s*(?:const\b|noexcept\b|override\b|final\b|->|:[^:]|$)")
NO_FUNCTION = re.compile(r"^\s*(?:if|for|while|switch|do|else|try|return|namespace|struct|class|enum|union)\b")


def cpp_functions(text):
    """Name (the text before its brace) and length of every function; a lambda counts with its enclosing function."""
    code = NO_CODE.sub(lambda found: re.sub(r"[^\n]", " ", found.group()), text)
    opened, head = [], 0
    for at, sign in enumerate(code):
        if sign == "{":
            opened.append((head, code[head:at]))
            head = at + 1
        elif sign == "}":
            begin, name = opened.pop()
            if FUNCTION_HEAD.search(name) and not NO_FUNCTION.match(name):
                begin += len(name) - len(name.lstrip())
                yield name.strip().splitlines()[0], code.count("\n", begin, at) + 1
            head = at + 1
        elif sign == ";":
            head = at + 1


def python_functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            documentation = node.body[0] if ast.get_docstring(node) is not None else None
            described = documentation.end_lineno - documentation.lineno + 1 if documentation else 0
            yield node.name, node.end_lineno - node.lineno + 1 - described


def test_the_length_of_a_function_is_counted():
    body = "\n".join(["  x();"] * 5)
    text = f"namespace n {{\nstruct S {{\n  S(int a)\n      : a_(a) {{\n{body}\n  }}\n}};\nint f() {{\n{body}\n}}\n}}\n"
    assert dict(cpp_functions(text)) == {"S(int a)": 8, "int f()": 7}
    assert dict(python_functions('def f():\n    """One.\n\n    Two.\n    """\n    return 1\n')) == {"f": 2}


def test_functions_stay_short():
    sources = {path: cpp_functions(path.read_text()) for path in FILES}
    sources |= {
        path: python_functions(path.read_text())
        for name in ("scripts", "python")
        for path in (ROOT / name).rglob("*.py")
    }
    lengths = {(path, name): length for path, functions in sources.items() for name, length in functions}
    assert len(lengths) > 1000

    def longest(path):
        return next((MAX_FUNCTION_IN[folder] for folder in path.parents if folder in MAX_FUNCTION_IN), MAX_FUNCTION)

    assert {
        f"{path.relative_to(ROOT)}: {name}": length
        for (path, name), length in lengths.items()
        if length > longest(path)
    } == {}


def imported_modules(path):
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module


def test_a_folder_with_a_bound_of_its_own_stays_small():
    lines = dict.fromkeys(MAX_LINES, 0)
    for path in SRC.rglob("*"):
        own = next((folder for folder in path.parents if folder in MAX_LINES), None)
        if own is not None and path.is_file():
            lines[own] += len(path.read_text().splitlines())
    assert [(str(folder), lines[folder]) for folder, limit in MAX_LINES.items() if lines[folder] > limit] == []


def test_the_estimator_has_few_tuned_constants():
    tuned = (SRC / "estimation/common/tuning.h").read_text().split("conventions of statistics")[0]
    assert tuned.count("static constexpr") <= MAX_TUNED_CONSTANTS


def test_nothing_that_is_installed_imports_the_laboratory():
    """scripts/*.py and python/robot_control are installed; bench is for tests and scripts/bench."""
    installed = sorted(path for name in ("scripts", "python") for path in (ROOT / name).rglob("*.py"))
    assert len(installed) > 40
    wrong = [
        f"{path.relative_to(ROOT)} imports {name}"
        for path in installed
        for name in imported_modules(path)
        if name.split(".")[0] in {"bench", "tests"}
    ]
    wrong += [f"{path.name} names bench" for path in BINDINGS.rglob("*.*") if '"bench.' in path.read_text()]
    assert wrong == []


def test_every_folder_of_the_python_package_is_installed():
    folders = {path.parent for path in PACKAGE.rglob("*.py")}
    assert [str(folder) for folder in folders if not (folder / "__init__.py").is_file()] == []


def test_a_program_beside_the_loop_receives_messages_through_the_boundary_alone():
    found = {}
    for path in (ROOT / "python" / "robot_control").rglob("*.py"):
        if path.name != "boundary.py":
            calls = re.findall(r"rospy\.(?:Subscriber\(|wait_for_message|AnyMsg)", path.read_text(encoding="utf-8"))
            found |= {str(path): calls} if calls else {}
    assert found == {}


def test_no_folder_of_python_holds_more_than_25_files():
    folders = {path.parent for name in ("scripts", "python", "bench") for path in (ROOT / name).rglob("*.py")}
    assert len(folders) > 10
    counts = {str(folder.relative_to(ROOT)): sum(path.is_file() for path in folder.glob("*")) for folder in folders}
    assert {name: count for name, count in counts.items() if count > 25} == {}


def imports_of_the_package():
    """(folder of the module, imported module) of each import inside the package, both below it, with dots."""
    found = [
        (".".join(path.relative_to(PACKAGE).parts[:-1]), name.removeprefix("robot_control."))
        for path in sorted(PACKAGE.rglob("*.py"))
        for name in imported_modules(path)
        if name.startswith("robot_control.") and name.split(".")[1] not in {"msg", "srv", "_robot_control"}
    ]
    assert len(found) > 400
    return found


def test_programs_import_no_program():
    """A program is a folder with a main.py; what several of them use stands beside them in their room, or below."""
    programs = {".".join(path.parent.relative_to(PACKAGE).parts) for path in PACKAGE.rglob("main.py")}
    assert len(programs) > 20
    wrong = [
        f"{folder} imports {name}"
        for folder, name in imports_of_the_package()
        for program in programs
        if f"{name}.".startswith(f"{program}.") and not f"{folder}.".startswith(f"{program}.")
    ]
    assert wrong == []


def test_each_room_of_python_imports_only_what_is_below_it():
    wrong = [
        f"{folder} imports {name}"
        for folder, name in imports_of_the_package()
        if folder
        and name.split(".")[0] not in {folder.split(".")[0], "installed_files", *MAY_IMPORT[folder.split(".")[0]]}
    ]
    assert wrong == []
    assert set(MAY_IMPORT) == {path.parent.name for path in PACKAGE.glob("*/__init__.py")}


def test_the_laboratory_is_not_installed():
    for name in ("setup.py", "cmake/ros.cmake"):
        installs = re.findall(r"(?:package_dir|packages|install)\b[^\n]*", (ROOT / name).read_text())
        assert installs
        assert [line for line in installs if "tests" in line or "bench" in line] == []


@pytest.mark.parametrize(
    "path",
    [
        path
        for pattern in ("package.xml", "launch/*.launch", "urdf/**/*.urdf", "urdf/**/*.xml")
        for path in sorted(ROOT.glob(pattern))
    ],
    ids=lambda path: str(path.relative_to(ROOT)),
)
def test_xml_is_well_formed(path):
    ET.parse(path)
