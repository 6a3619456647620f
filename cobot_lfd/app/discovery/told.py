"""What was found out about the candidate frames, as text."""

from textwrap import fill

from cobot_lfd.app.discovery.decisions import Decision
from cobot_lfd.app.discovery.discover import Discovery

_WIDTH = 100  # Columns of the text.


def told(discovery: Discovery) -> str:
    """What became of every candidate, and why."""
    n = len(discovery.demonstrations)
    lines = [f"{len(discovery.decisions)} candidate frames in {n} demonstrations:"]
    width = max(len(decision.name) for decision in discovery.decisions)
    lines += [_line(decision, width) for decision in discovery.decisions]
    lines += [fill(f"not a candidate: {sentence}", _WIDTH) for sentence in discovery.candidates.strays]
    kept = [f"{name} ({discovery.kinds[name].value})" for name in discovery.kept]
    lines.append(
        f"{len(kept)} frames matter: {', '.join(kept)}; with them, left-out demonstrations are predicted to "
        f"{1e3 * discovery.choice.errors.mean():.1f} mm."
    )
    return "\n".join(lines)


def _line(decision: Decision, width: int) -> str:
    start = f"  {decision.fate.value:<8}{decision.name:<{width}}  "
    return fill(decision.reason, _WIDTH, initial_indent=start, subsequent_indent=" " * len(start))
