"""The command line: cobot-lfd record, fit, run, evaluate and more."""

import sys
from collections.abc import Callable, Sequence

from tyro.extras import subcommand_cli_from_dict

from cobot_lfd.app import commands
from cobot_lfd.errors import CobotError

FAILED, INTERRUPTED = 2, 130

_COMMANDS: dict[str, Callable[..., int]] = {
    "demo": commands.demo,
    "record": commands.record,
    "fit": commands.fit,
    "run": commands.run,
    "evaluate": commands.evaluate,
    "scenes": commands.scenes,
    "robots": commands.robots,
}


def main(args: Sequence[str] | None = None) -> int:
    """Run a command.

    Args:
        args: The words after the program's name; those of the process by default.

    Returns:
        0 done, 1 done but not all succeeded, 2 an error that the user can mend, 130 interrupted.
    """
    try:
        return int(subcommand_cli_from_dict(_COMMANDS, prog="cobot-lfd", description=_DESCRIPTION, args=args))
    except CobotError as error:
        print(f"cobot-lfd: {'; '.join(str(error).splitlines())}", file=sys.stderr)
        return FAILED
    except KeyboardInterrupt:
        print("cobot-lfd: interrupted; what was reported as done is kept.", file=sys.stderr)
        return INTERRUPTED


_DESCRIPTION = "Teach a simulated cobot a table-top task, and let it perform the task in scenes it sees."
