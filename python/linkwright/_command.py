"""The command ``linkwright``, run inside of this process by the extension module."""

from __future__ import annotations


def main() -> int:
    """Runs the command line with the words of ``sys.argv``; returns the exit code."""
    import sys

    from . import _linkwright

    run = getattr(_linkwright, "main", None)
    if run is None:
        print("error: this build of linkwright has no command line (feature `command`)", file=sys.stderr)
        return 2
    code: int = run(["linkwright", *sys.argv[1:]])
    return code
