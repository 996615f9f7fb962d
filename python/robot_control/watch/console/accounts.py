"""console_users.py: adds, lists and removes the users of console.py."""

import argparse
import sys
import time

from robot_control.files.files import fit_for_message, in_words
from robot_control.watch.console.authority import Role
from robot_control.watch.console.users import Users, UsersError


def main() -> int:
    """Entry point of scripts/console_users.py."""
    parser = argparse.ArgumentParser(
        prog="console_users.py",
        description="Users of console.py. `add` prints the end of an address, with which the user sets a password "
        "within a day. `add` of a known user prints a new one and sets the role.",
    )
    commands = parser.add_subparsers(dest="command", required=True)
    add = commands.add_parser("add", help="adds a user, or renews the address of one")
    add.add_argument("name")
    meaning = "watch: sees; operate: drives too; maintain: tunes too"
    add.add_argument("--role", choices=[str(role) for role in Role], default="watch", help=meaning)
    remove = commands.add_parser("remove", help="removes a user and closes the user's pages")
    remove.add_argument("name")
    commands.add_parser("list", help="lists names and roles")
    given = parser.parse_args()
    users = Users()
    try:
        if given.command == "add":
            link = users.add(given.name, Role[given.role.upper()], time.time())
            print(f"open once, within a day, after the address of the console: /login#{link}")
        elif given.command == "remove":
            users.remove(given.name)
        else:
            for user in users.all().values():
                print(f"{user.name}\t{user.role}\t{'' if user.password else 'has set no password yet'}")
    except (UsersError, OSError) as error:
        print(f"console_users.py: {fit_for_message(in_words(error))}", file=sys.stderr)
        return 2
    return 0
