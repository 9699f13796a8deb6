"""Results: what a run found, with its drawings, tables and files."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from typing import Any, Union

    import pandas

    from ._linkwright import Problem

    Progress = Union[bool, Callable[[dict[str, Any]], object], None]

from . import _linkwright
from ._files import write
from ._problems import as_problem


class Candidate:
    """A linkage that a run found, with its figures. Every figure is the referee's, as in ``record.json``.

    Any key of a candidate in the record is an attribute: ``error``, ``type``, ``transmission_deg``, ``accepted``,
    ``warnings``, ``requirements``, ``crank_deg``, ``t1_at``, ``link_ratio``, ``grashof_margin``, ``defects``, ..; of a
    motion ``frame_deg`` too, the angle from C -> D to the body's x axis; of a function ``input_offset_deg``,
    ``output_offset_deg`` (the angles of crank and follower from the line A -> B at an input and an output of 0), or of a slider
    ``output_offset`` (its place at an output of 0), ``sense`` and, where ranges are free, ``input_range_deg`` and ``output_range_deg``.
    """

    __slots__ = ("data", "result", "which")

    #: The candidate's part of the record.
    data: dict[str, Any]
    #: The result that it belongs to.
    result: Result
    #: Its name after the colon of a RESULT: ``"1"``, ``"smallest"``, ``"front-2"``.
    which: str

    def __init__(self, result: Result, which: str, data: dict[str, Any]) -> None:
        self.result, self.which, self.data = result, which, data

    def __getattr__(self, name: str) -> Any:
        try:
            return self.data[name]
        except KeyError:
            if name in ("warnings", "requirements", "defects", "costs"):
                # A record leaves empty lists out.
                return []
            raise AttributeError(f"a candidate has no {name!r}; it has {', '.join(self.data)}") from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.data]

    @property
    def linkage(self) -> Any:
        """The linkage, which can be moved: a :class:`FourBar`, a :class:`SliderLinkage`, or the :class:`Chain` of a six-bar."""
        return self.result._run.linkage(self.which)

    def svg(self) -> str:
        """Returns the drawing as SVG."""
        return self.result._run.svg(self.which)

    def export(self, format: str, **settings: Any) -> bytes:
        """Returns the linkage in a format; see :func:`linkwright.export`."""
        from ._doors import export

        return export(self, format, **settings)

    def to_file(self, path: str | os.PathLike[str], format: str | None = None, **settings: Any) -> None:
        """Writes the linkage to a file; the format is that of the name's ending where none is given.

        >>> import linkwright as lw, os, tempfile
        >>> best = lw.synth(lw.path([[0, 0], [1, 1], [2, 1.5], [3, 1]])).candidates[0]
        >>> file = os.path.join(tempfile.mkdtemp(), "arc.dxf")
        >>> best.to_file(file, unit="mm", scale=20)
        >>> os.path.getsize(file) > 1000
        True
        """
        from ._doors import write_file

        write_file(self, path, format, settings)

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draws coupler curve, linkage and target with matplotlib; returns the axes."""
        from ._show import plot_candidate

        return plot_candidate(self, ax, **options)

    def animate(self, **options: Any) -> Any:
        """Returns a matplotlib animation of a turn of the crank (in a notebook it plays)."""
        from ._show import animate_candidate

        return animate_candidate(self, **options)

    def _repr_html_(self) -> str:
        return self.svg()

    def __repr__(self) -> str:
        error = self.data["error"]
        verdict = "accepted" if self.data["accepted"] else "not accepted"
        return f"<Candidate {self.which}: {self.data.get('type')}, rms {error['rms']:.6g}, {verdict}>"


class Front:
    """The trade-off of a problem: members none of which is beaten on every axis."""

    __slots__ = ("data", "result")

    def __init__(self, result: Result, data: dict[str, Any]) -> None:
        self.result, self.data = result, data

    @property
    def axes(self) -> list[str]:
        """The names of the axes."""
        return list(self.data["axes"])

    @property
    def members(self) -> list[Candidate]:
        """The linkages, in the order of the first axis."""
        members = self.data["members"]
        return [Candidate(self.result, f"front-{i}", m["candidate"]) for i, m in enumerate(members, 1)]

    @property
    def figures(self) -> list[dict[str, Any]]:
        """The figures of each member: ``rms``, ``max``, ``transmission_deg``, ``extent``, .."""
        return [m["figures"] for m in self.data["members"]]

    def to_frame(self) -> pandas.DataFrame:
        """Returns the rows of ``front.csv`` as a pandas frame."""
        return _frame(self.result._run.front_csv())

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draws the members over the first two axes with matplotlib; returns the axes."""
        from ._show import plot_front

        return plot_front(self, ax, **options)

    def __len__(self) -> int:
        return len(self.data["members"])

    def __repr__(self) -> str:
        return f"<Front of {len(self)} linkages over {', '.join(self.axes)}>"


class Result:
    """The result of a run: a record with everything that follows from it.

    In a notebook it shows the report's drawing and table.
    """

    __slots__ = ("_json", "_record", "_run")

    def __init__(self, run: _linkwright.Run) -> None:
        self._run = run
        self._json: bytes | None = None
        self._record: dict[str, Any] | None = None

    @property
    def record_json(self) -> bytes:
        """The bytes of ``record.json``: those that ``linkwright synth`` writes."""
        if self._json is None:
            self._json = self._run.record_json()
        return self._json

    @property
    def record(self) -> dict[str, Any]:
        """The record as a dict; its keys are described in docs/results.md."""
        if self._record is None:
            import json

            self._record = json.loads(self.record_json)
        return self._record

    @property
    def name(self) -> str:
        """The problem's name."""
        return self._run.name

    @property
    def candidates(self) -> list[Candidate]:
        """The distinct linkages that were found, best first."""
        found = self.record["candidates"]
        return [Candidate(self, str(i), data) for i, data in enumerate(found, 1)]

    @property
    def accepted(self) -> bool:
        """Whether a candidate meets every requirement."""
        return any(c["accepted"] for c in self.record["candidates"])

    @property
    def picks(self) -> dict[str, Candidate]:
        """The linkages beside the closest one: ``"smallest"``, ``"best-transmission"``, ``"buildable"``."""
        picks = self.record.get("picks") or {}
        found = {name.replace("_", "-"): data for name, data in picks.items() if isinstance(data, dict)}
        if self.record.get("buildable"):
            found["buildable"] = self.record["buildable"]
        return {which: Candidate(self, which, data) for which, data in found.items()}

    @property
    def front(self) -> Front | None:
        """The front, if one was asked for."""
        data = self.record.get("front")
        return None if data is None else Front(self, data)

    @property
    def certificate(self) -> dict[str, Any] | None:
        """The certificate, if there is one."""
        return self.record.get("certificate")

    @property
    def termination(self) -> dict[str, Any]:
        """Why the search ended, and whether the run can be repeated to the digit."""
        found: dict[str, Any] = self.record["termination"]
        return found

    @property
    def timing(self) -> dict[str, Any] | None:
        """The seconds of the run's parts and its threads; None of a result that was opened."""
        return self._run.timing

    @property
    def folder(self) -> str | None:
        """The folder that it was written to or read from."""
        found = self._run.folder
        return None if found is None else str(found)

    @property
    def text(self) -> str:
        """The table that ``linkwright synth`` prints."""
        return self._run.text()

    def save(self, folder: str | os.PathLike[str]) -> None:
        """Writes the folder that ``linkwright synth`` writes, as a whole or not at all.

        Raises:
            ProblemError: the folder holds something else, is in use, or cannot be written to.
        """
        self._run.save(folder)

    def export(self, format: str, **settings: Any) -> bytes:
        """Returns the best linkage in a format; see :func:`linkwright.export`."""
        return self._best().export(format, **settings)

    def to_file(self, path: str | os.PathLike[str], format: str | None = None, **settings: Any) -> None:
        """Writes the best linkage to a file; see :meth:`Candidate.to_file`. ``html`` writes the report."""
        if format == "html" or (format is None and str(path).lower().endswith(".html")):
            write(path, self._run.report_html().encode())
            return
        self._best().to_file(path, format, **settings)

    def _best(self) -> Candidate:
        candidates = self.candidates
        if not candidates:
            raise _linkwright.ProblemError(f"{self.name} has no candidate: the run found none")
        return candidates[0]

    def to_frame(self) -> pandas.DataFrame:
        """Returns the table of the candidates (``candidates.csv``) as a pandas frame."""
        return _frame(self._run.candidates_csv())

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draws the best linkage over the target with matplotlib; returns the axes."""
        return self._best().plot(ax, **options)

    def animate(self, **options: Any) -> Any:
        """Returns a matplotlib animation of the best linkage."""
        return self._best().animate(**options)

    def report_html(self) -> str:
        """Returns the page of the report, with the motion, in one text."""
        return self._run.report_html()

    def _repr_html_(self) -> str:
        from ._show import result_html

        return result_html(self)

    def __iter__(self) -> Iterator[Candidate]:
        return iter(self.candidates)

    def __len__(self) -> int:
        return self._run.candidates

    def __bool__(self) -> bool:
        return True

    def __reduce__(self) -> tuple[type[Result], tuple[_linkwright.Run]]:
        return (Result, (self._run,))

    def __repr__(self) -> str:
        n = len(self)
        best = f", best {self.candidates[0]!r}" if n else ""
        return f"<Result {self.name!r}: {n} candidate{'' if n == 1 else 's'}{best}>"


def open(path: str | os.PathLike[str]) -> Result:  # noqa: A001
    """Opens a result: a folder that ``linkwright synth`` or :meth:`Result.save` wrote, or its ``record.json``.

    Raises:
        ProblemError: there is no record, or it is none of linkwright's.
    """
    return Result(_linkwright.open(path))


def synth(
    problem: Problem | Mapping[str, Any] | str | os.PathLike[str],
    *,
    seed: int | None = None,
    method: str | None = None,
    set: Mapping[str, Any] | None = None,  # noqa: A002
    threads: int | None = None,
    progress: Progress = None,
    out: str | os.PathLike[str] | None = None,
    resume: bool = False,
) -> Result:
    """Finds linkages for a problem.

    The interpreter is free for other threads meanwhile. Ctrl-C ends the search: the KeyboardInterrupt has the best so far
    as its attribute ``result``. The same problem and seed give the same bytes on any number of threads.

    Args:
        problem: a :class:`Problem`, a dict with the keys of a problem file, or the path of a problem file (TOML), points
            (CSV) or drawing (SVG).
        seed: the seed of every draw, 0 or more; as ``set={"solve.seed": ..}``.
        method: ``"auto"``, ``"least-squares"``, ``"differential-evolution"``, ``"genetic"`` or ``"continuation"``.
        set: keys of the problem file with other values, by dotted names: ``{"solve.candidates": 9}``.
        threads: 1 to 1024; all cores where silent.
        progress: True for a bar (with tqdm) or lines, or a function that is called about every 20 ms with a dict
            (``phase``, ``evaluations``, ``budget``, ``best_sum_sq``, ``accepted``). What it raises ends the search.
        out: a folder for the result, locked and with checkpoints while the search runs, as ``--out``.
        resume: goes on from the checkpoint in `out` that an interrupted run left; what is done is not run again.

    Returns:
        The result; a search that finds nothing acceptable is a result without an accepted candidate, not an error.

    Raises:
        ProblemError: the problem, a setting or the folder is refused.
    """
    settings = dict(set or {})
    if method is not None:
        settings["solve.method"] = method
    if seed is not None:
        settings["solve.seed"] = seed
    return _run(as_problem(problem), settings, threads, progress, out, resume, None)


def front(
    problem: Problem | Mapping[str, Any] | str | os.PathLike[str],
    axes: Sequence[str] = ("rms", "transmission", "extent"),
    points: int = 20,
    *,
    seed: int | None = None,
    set: Mapping[str, Any] | None = None,  # noqa: A002
    threads: int | None = None,
    progress: Progress = None,
    out: str | os.PathLike[str] | None = None,
    resume: bool = False,
) -> Result:
    """Finds the trade-off of a problem: linkages none of which is beaten on every axis.

    Args:
        axes: two to four of ``rms``, ``max``, ``transmission``, ``extent``, ``longest``, ``link_ratio``,
            ``sensitivity``, one of them an error.
        points: how many linkages.
        problem, seed, set, threads, progress, out, resume: as for :func:`synth`.

    Returns:
        A result with a :attr:`Result.front`.

    Raises:
        ProblemError: the problem, the axes, a setting or the folder is refused.
    """
    settings = dict(set or {})
    if seed is not None:
        settings["solve.seed"] = seed
    if isinstance(axes, str):
        axes = [axis.strip() for axis in axes.split(",")]
    return _run(as_problem(problem), settings, threads, progress, out, resume, (list(axes), points))


def _run(
    problem: Problem,
    settings: dict[str, Any],
    threads: int | None,
    progress: Progress,
    out: str | os.PathLike[str] | None,
    resume: bool,
    axes: tuple[list[str], int] | None,
) -> Result:
    callback, close = listener(progress, problem.name)
    try:
        return Result(_linkwright.synth(problem, settings, threads, callback, out, resume, axes))
    except BaseException as interrupt:
        wrap(interrupt)
        raise
    finally:
        close()


def wrap(interrupt: BaseException) -> None:
    """Makes the run that an interrupt carries a Result."""
    found = getattr(interrupt, "result", None)
    if isinstance(found, _linkwright.Run):
        interrupt.result = Result(found)  # type: ignore[attr-defined]


def listener(progress: Progress, name: str) -> tuple[Callable[[dict[str, Any]], object] | None, Callable[[], None]]:
    """Returns the callback for a progress argument, and what is to be called at the end."""
    if progress is None or progress is False:
        return None, lambda: None
    if progress is not True:
        return progress, lambda: None
    from ._show import bar

    return bar(name)


def _frame(csv: str) -> pandas.DataFrame:
    import io

    import pandas

    return pandas.read_csv(io.StringIO(csv), comment="#")
