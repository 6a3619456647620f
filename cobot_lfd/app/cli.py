"""The command line: cobot-lfd record, fit, run, evaluate and more."""

import sys
from collections.abc import Callable, Sequence

from tyro.extras import subcommand_cli_from_dict

from cobot_lfd.app.commands.calibrate import calibrate
from cobot_lfd.app.commands.demo import demo
from cobot_lfd.app.commands.demos import demos
from cobot_lfd.app.commands.evaluate import evaluate
from cobot_lfd.app.commands.exit_codes import FAILED, INTERRUPTED
from cobot_lfd.app.commands.fit import fit
from cobot_lfd.app.commands.frames import frames
from cobot_lfd.app.commands.listing import robots, scenes
from cobot_lfd.app.commands.look import look
from cobot_lfd.app.commands.record import record
from cobot_lfd.app.commands.replay import replay
from cobot_lfd.app.commands.report import report
from cobot_lfd.app.commands.run import run
from cobot_lfd.app.commands.validate import validate
from cobot_lfd.errors import CobotError

_COMMANDS: dict[str, Callable[..., int]] = {
    "demo": demo,
    "record": record,
    "demos": demos,
    "frames": frames,
    "fit": fit,
    "run": run,
    "evaluate": evaluate,
    "report": report,
    "replay": replay,
    "validate": validate,
    "look": look,
    "calibrate": calibrate,
    "scenes": scenes,
    "robots": robots,
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
