"""Sweeps on this machine: plan, run, merge, as the command ``linkwright sweep``. :mod:`linkwright.dask` runs them on many.

>>> import linkwright as lw, linkwright.sweep, os, tempfile
>>> folder = tempfile.mkdtemp()
>>> with open(os.path.join(folder, "arc.toml"), "w") as file:
...     _ = file.write("format = 1\\n[task.path]\\npoints = [[0, 0], [1, 1], [2, 1.5], [3, 1]]\\n")
>>> with open(os.path.join(folder, "seeds.toml"), "w") as file:
...     _ = file.write('format = 1\\nproblem = "arc.toml"\\n[vary]\\nsolve.seed = [1, 2, 3]\\n')
>>> plan = lw.sweep.plan(os.path.join(folder, "seeds.toml"), os.path.join(folder, "out"), shard_size=2)
>>> plan.jobs, plan.shards
(3, 2)
>>> lw.sweep.run(plan.folder).rows
3
>>> lw.sweep.merge(plan.folder).accepted
3
"""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    import os
    from typing import Any, Union

    import pandas

    from ._result import Progress

    Path = Union[str, os.PathLike[str]]

from . import _linkwright
from ._result import listener

__all__ = ["Merged", "Plan", "Ran", "merge", "open", "plan", "run"]


class Plan:
    """The plan of a sweep, as its folder has it."""

    __slots__ = ("data", "folder")

    #: The keys of ``plan.json`` but for the texts of its files.
    data: dict[str, Any]
    #: The folder.
    folder: str

    def __init__(self, folder: str, data: dict[str, Any]) -> None:
        self.folder, self.data = folder, data

    @property
    def digest(self) -> str:
        """SHA-256 of everything that decides the rows."""
        return str(self.data["digest"])

    @property
    def jobs(self) -> int:
        """The number of jobs."""
        return int(self.data["jobs"])

    @property
    def shards(self) -> int:
        """The number of shards; they have the numbers from 0."""
        return int(self.data["shards"])

    @property
    def shard_size(self) -> int:
        """The number of jobs of a shard; the last may have fewer."""
        return int(self.data["shard_size"])

    def missing(self) -> list[int]:
        """Returns the shards whose files are not there. A file is there whole or not at all."""
        return _linkwright.sweep_missing(self.folder)

    def __repr__(self) -> str:
        return f"<Plan {self.folder!r}: {self.jobs} jobs in {self.shards} shards>"


class Ran:
    """The outcome of running shards."""

    __slots__ = ("accepted", "before", "bugs", "rows", "shards")

    #: The number of rows of the shards, of those with an accepted candidate, and of those that met a bug of linkwright.
    rows: int
    accepted: int
    bugs: int
    #: The number of shards that were run, and of those that were there before.
    shards: int
    before: int

    def __init__(self, rows: int, accepted: int, bugs: int, shards: int, before: int) -> None:
        self.rows, self.accepted, self.bugs, self.shards, self.before = rows, accepted, bugs, shards, before

    def __repr__(self) -> str:
        return f"<Ran {self.shards} shards, {self.before} were there: {self.accepted} of {self.rows} rows accepted>"


class Merged:
    """The table of a sweep: ``sweep.csv`` and ``sweep.jsonl``, a row for each job in their order."""

    __slots__ = ("accepted", "folder", "rows")

    folder: str
    #: The number of rows, and of those with an accepted candidate.
    rows: int
    accepted: int

    def __init__(self, folder: str, rows: int, accepted: int) -> None:
        self.folder, self.rows, self.accepted = folder, rows, accepted

    @property
    def csv(self) -> str:
        """The path of the table."""
        import os

        return os.path.join(self.folder, "sweep.csv")

    @property
    def jsonl(self) -> str:
        """The path of the rows as lines of JSON."""
        import os

        return os.path.join(self.folder, "sweep.jsonl")

    def to_frame(self) -> pandas.DataFrame:
        """Returns the table as a pandas frame."""
        import pandas

        return pandas.read_csv(self.csv)

    def __repr__(self) -> str:
        return f"<Merged {self.csv!r}: {self.accepted} of {self.rows} rows accepted>"


def plan(
    sweep: Path, out: Path, *, shard_size: int | None = None, records: bool = False, force: bool = False
) -> Plan:
    """Plans a sweep: writes ``plan.json`` into a folder.

    Args:
        sweep: the sweep file (TOML): a problem and the keys of it that vary.
        out: the folder, on a file system that all workers share.
        shard_size: the jobs of a shard; where silent, as many as take about 5 s, which is tried out.
        records: whether rows hold the whole record of their job.
        force: replaces another plan with its shards.

    Raises:
        ProblemError: the sweep or its problem is refused, or the folder holds another plan.
    """
    import os

    _linkwright.sweep_plan(sweep, out, shard_size, records, force)
    return open(os.fspath(out))


def open(folder: Path) -> Plan:  # noqa: A001
    """Opens the plan in a folder.

    Raises:
        ProblemError: there is none, or it was changed.
    """
    import os

    return Plan(os.path.abspath(folder), _linkwright.sweep_open(folder))


def run(
    folder: Path, shard: int | None = None, *, threads: int | None = None, progress: Progress = None
) -> Ran:
    """Runs a shard, or all that are missing, on the cores of this machine.

    Args:
        folder: the folder of the plan.
        shard: its number; where silent, all shards that are missing.
        threads: 1 to 1024; all cores where silent. It changes the time, never a byte.
        progress: True for a bar, or a function that is called with a dict (``done``, ``total``).

    Raises:
        ProblemError: there is no such plan or shard.
        KeyboardInterrupt: Ctrl-C; shards that are complete stay.
    """
    callback, close = listener(progress, "sweep")
    try:
        return Ran(*_linkwright.sweep_run(folder, shard, threads, callback))
    finally:
        close()


def merge(folder: Path) -> Merged:
    """Merges the shards into ``sweep.csv`` and ``sweep.jsonl``; the same bytes whoever ran them.

    Raises:
        ProblemError: shards are missing or damaged; the text says how they are made.
    """
    import os

    return Merged(os.path.abspath(folder), *_linkwright.sweep_merge(folder))
