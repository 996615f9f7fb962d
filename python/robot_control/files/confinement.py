"""Limits of a process that reads a file from outside with a library."""

import ctypes
import resource
import struct

NEW_USERS, NEW_NETWORK = 0x10000000, 0x40000000  # CLONE_NEWUSER, CLONE_NEWNET of unshare(2)
CREATE_RULESET, RESTRICT_SELF, NO_NEW_PRIVILEGES = 444, 446, 38  # landlock(7), prctl(2)
CHANGES = (0x7FF3, 0x3FF3, 0x1FF3)  # all accesses but READ_FILE and READ_DIR, of landlock's versions 3, 2 and 1


def limit(kind: int, value: int) -> None:
    """Sets a limit of this process, such as resource.RLIMIT_AS."""
    resource.setrlimit(kind, (value, resource.getrlimit(kind)[1]))


def confine() -> None:
    """Gives up network, changes of files and starts of programs, as far as the kernel permits that."""
    kernel = ctypes.CDLL(None, use_errno=True)
    if kernel.unshare(NEW_NETWORK) != 0:
        kernel.unshare(NEW_USERS | NEW_NETWORK)
    kernel.prctl(NO_NEW_PRIVILEGES, 1, 0, 0, 0)
    for changes in CHANGES:  # a kernel refuses what it does not know
        rules = kernel.syscall(CREATE_RULESET, struct.pack("Q", changes), 8, 0)
        if rules >= 0 and kernel.syscall(RESTRICT_SELF, rules, 0) == 0:
            break
