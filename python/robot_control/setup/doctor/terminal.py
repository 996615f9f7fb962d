"""Checks of this terminal: the package, Python, names and addresses of the network."""

import importlib.util
import ipaddress
import re
import sys
from pathlib import Path

from robot_control.setup.doctor.finding import Check, Finding, fault, note, ok, unseen, warning
from robot_control.setup.doctor.remote_master import address, remote_host
from robot_control.setup.doctor.system import System

SYSTEM_PYTHON = "/usr/bin/python3"
SOURCE = "source install/setup.bash"


def package(system: System) -> Finding:
    """rosrun and roslaunch find the package by ROS_PACKAGE_PATH."""
    listed = [entry for entry in system.environment.get("ROS_PACKAGE_PATH", "").split(":") if entry]
    folders = [folder for entry in listed for folder in (entry, f"{entry}/robot_control")]
    found = [folder for folder in folders if "robot_control" in (system.text(f"{folder}/package.xml") or "")]
    if found:
        return ok(found[0])
    value = "robot_control is not on ROS_PACKAGE_PATH" if listed else "ROS_PACKAGE_PATH is not set"
    return warning(value, f"`{SOURCE}` in this terminal, after a build", SOURCE)


def python(system: System) -> Finding:
    """ROS's Python belongs to Debian's interpreter; another one may stand first on PATH."""
    searched = [folder for folder in system.environment.get("PATH", "/usr/bin").split(":") if folder]
    first = next((f"{folder}/python3" for folder in searched if system.path(f"{folder}/python3").exists()), "")
    if not first:
        return fault("no python3 on PATH", "install Debian's", "sudo apt-get install python3")
    if system.live and not importlib.util.find_spec("yaml"):
        return fault(f"{sys.executable} lacks yaml", f"call {SYSTEM_PYTHON}; scripts/setup installs what is missing")
    if first not in (SYSTEM_PYTHON, "/bin/python3"):
        remedy = f"call {SYSTEM_PYTHON}, or put /usr/bin first"
        return warning(f"python3 is {first}", remedy, "export PATH=/usr/bin:$PATH")
    return ok(first)


def ros_python(system: System) -> Finding:
    """Programs of this package need rospy and rosgraph."""
    if not system.live:
        return unseen("not visible in a recorded folder")
    missing = [name for name in ("rospy", "rosgraph") if importlib.util.find_spec(name) is None]
    if missing:
        return warning(f"{sys.executable} finds no {', '.join(missing)}", "scripts/setup", "scripts/setup")
    return ok(f"{sys.executable} finds rospy")


def _resolves(system: System, name: str) -> bool:
    for line in (system.text("etc/hosts") or "").splitlines():
        if name in line.split("#")[0].split()[1:]:
            return True
    return bool(system.run("getent", "hosts", name))


def host_name(system: System) -> Finding:
    """Nodes announce themselves by the name of the host, unless ROS_IP or ROS_HOSTNAME is set."""
    announced = system.environment.get("ROS_HOSTNAME") or system.text("proc/sys/kernel/hostname")
    if system.environment.get("ROS_IP") and not system.environment.get("ROS_HOSTNAME"):
        return ok("not used: ROS_IP is set")
    announced = system.seen(announced or None, "proc/sys/kernel/hostname")
    if not re.fullmatch(r"[A-Za-z0-9._:-]+", announced):
        value = f"{announced!r} is not the name of a host"
        if system.environment.get("ROS_HOSTNAME"):
            return fault(value, "unset ROS_HOSTNAME", "unset ROS_HOSTNAME")
        return fault(value, "rename the computer, or set ROS_IP", "sudo hostnamectl set-hostname robot")
    if _resolves(system, announced):
        return ok(announced)
    # Launch files of this package use the loopback, unless the network is configured.
    return (warning if not remote_host(system) else fault)(
        f"{announced} has no address",
        "add it to /etc/hosts, or set ROS_IP",
        f"echo 127.0.1.1 {announced} | sudo tee -a /etc/hosts",
    )


def _own_addresses(system: System) -> set[str]:
    """Addresses of this machine, from the routing tables of the kernel."""
    found = set(re.findall(r"\|-- ([\d.]+)\s+/32 host LOCAL", system.text("proc/net/fib_trie") or ""))
    for digits in re.findall(r"^[0-9a-f]{32}", system.text("proc/net/if_inet6") or "", re.MULTILINE):
        found.add(str(ipaddress.IPv6Address(int(digits, 16))))
    return found


def ros_ip(system: System) -> Finding:
    """Other nodes connect to the address in ROS_IP."""
    given = system.environment.get("ROS_IP", "")
    if not given:
        return ok("not set")
    own = system.seen(_own_addresses(system) or None, "proc/net/fib_trie")
    if given.startswith("127.") and not remote_host(system):
        return ok(f"{given}: this computer only")
    if given.startswith("127."):
        value = f"{given}, and the master is on {remote_host(system)}: no other machine can connect"
        remedy = "set ROS_IP to an address of this machine"
        return fault(value, remedy, *(f"export ROS_IP={each}" for each in sorted(own) if not each.startswith("127.")))
    if given not in own:
        remedy = f"set it to one of {', '.join(sorted(own))}, or unset it"
        return fault(f"{given} is not an address of this computer", remedy, "unset ROS_IP")
    return ok(given)


def master_address(system: System) -> Finding:
    """The form of ROS_MASTER_URI, and whether its host has an address."""
    given = system.environment.get("ROS_MASTER_URI", "")
    found = address(system)
    if found is None:
        command = "export ROS_MASTER_URI=http://localhost:11311"
        return fault(f"ROS_MASTER_URI is {given!r}", "set it to http://HOST:11311", command)
    numeric = re.fullmatch(r"[\d.]+", found[0])
    if not numeric and remote_host(system) and not _resolves(system, found[0]):
        return fault(f"{found[0]} of ROS_MASTER_URI has no address", "add it to /etc/hosts, or use its number")
    return ok(given or "not set: localhost")


def workspace(_: System) -> Finding:
    """The compiled part beside this program, or in the install folder of its checkout."""
    here = Path(__file__).resolve().parents[2]
    inside = "lib/python3/dist-packages/robot_control"
    for folder in (here, *(here.parents[1] / "install" / name / inside for name in ("robot_control", ""))):
        if any(folder.glob("_robot_control.*.so")):
            return ok(str(folder))
    value = f"{here} has no compiled part, nor has an install folder beside it"
    return note(value, "scripts/demo, or colcon build in the checkout", "colcon build")


CHECKS = (
    Check("package", "rosrun and roslaunch find programs by this path", package),
    Check("build", "most programs of the package need its compiled part", workspace),
    Check("python", "ROS is installed only for Debian's Python", python),
    Check("ros_python", "the programs connect to nodes through it", ros_python),
    Check("host_name", "other nodes connect to the name that a node announces", host_name),
    Check("ros_ip", "other nodes connect to the address that a node announces", ros_ip),
    Check("master_address", "every node finds the others through this master", master_address),
)
