"""cobot-lfd report: what evaluations say, to look at or to go on with."""

from pathlib import Path

from tyro.conf import Positional

from cobot_lfd.app.commands.exit_codes import DONE
from cobot_lfd.app.report.cells import cells_text
from cobot_lfd.app.report.content import gather
from cobot_lfd.app.report.write import write_report


def report(runs: Positional[tuple[Path, ...]], *, out: tuple[Path, ...] = ()) -> int:
    """Report one evaluation, or compare several.

    Args:
        runs: Folders of evaluations, finished or not.
        out: Files ending in .html, .md, .csv or .json; by default report.html in the first folder.
    """
    content = gather(runs)
    print(cells_text(content.cells))
    for file in out or (runs[0] / "report.html",):
        print(f"the report is in {write_report(content, file)}")
    return DONE
