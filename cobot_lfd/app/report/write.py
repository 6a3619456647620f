"""Writing a report in the form that its file's ending asks for."""

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType

from cobot_lfd.app.disk import write_file
from cobot_lfd.app.report.content import Report
from cobot_lfd.app.report.html import to_html
from cobot_lfd.app.report.markdown import to_markdown
from cobot_lfd.app.report.tables import to_csv, to_json
from cobot_lfd.errors import CobotError

FORMS: Mapping[str, Callable[[Report], str]] = MappingProxyType(
    {".html": to_html, ".md": to_markdown, ".csv": to_csv, ".json": to_json}
)
"""Endings of files, and what they hold."""


def write_report(report: Report, file: Path) -> Path:
    """Write a report and return its file.

    Raises:
        CobotError: If the file's ending is not known.
        DataError: If the file cannot be written.
    """
    if file.suffix not in FORMS:
        raise CobotError(f"cannot write {file}: a report's name must end in one of: {', '.join(FORMS)}.")
    write_file(file, FORMS[file.suffix](report).encode())
    return file
