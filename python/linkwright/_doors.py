"""Everything else that the command line does: verify, certify, compare, analyze, cognates, build, snap, export, suite."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    import os
    from collections.abc import Mapping, Sequence
    from typing import Any, Union

    import pandas

    from ._linkwright import Chain, FourBar, Problem, SliderLinkage
    from ._result import Progress

    Path = Union[str, os.PathLike[str]]
    OfFourBars = Union["Result", "Candidate", FourBar, Path]
    Subject = Union[OfFourBars, SliderLinkage, Chain]

from . import _linkwright
from ._files import write
from ._problems import as_problem
from ._result import Candidate, Result, _frame, listener, open, wrap


def _split(subject: Any) -> tuple[Any, str | None]:
    """Returns the extension's object of an argument, and the name of the candidate that is meant."""
    if isinstance(subject, Candidate):
        return subject.result._run, subject.which
    if isinstance(subject, Result):
        return subject._run, None
    return subject, None


def _result(given: Any) -> Result:
    if isinstance(given, Result):
        return given
    if isinstance(given, Candidate):
        return given.result
    return open(given)


class Verification:
    """The outcome of recomputing a record; true if every figure and verdict agrees."""

    __slots__ = ("held_to_limits", "leaves", "mismatches", "not_checked")

    #: What differs: dicts with ``rank``, ``what``, ``recorded``, ``found`` and the sentence ``text``.
    mismatches: list[dict[str, Any]]
    #: What the leaves of the certificate show, if that was asked for: ``shown``, the number of ``leaves`` and of the
    #: ``boxes`` into which they were halved; or why they do not show it (``text``), and whether it is ``refuted``.
    leaves: dict[str, Any] | None
    #: The keys that are held to limits only.
    held_to_limits: list[str]
    #: The keys that are not recomputed.
    not_checked: list[str]

    def __init__(self, found: dict[str, Any]) -> None:
        self.mismatches, self.leaves = found["mismatches"], found["leaves"]
        self.held_to_limits, self.not_checked = found["held_to_limits"], found["not_checked"]

    @property
    def ok(self) -> bool:
        """Whether the record is true, and its leaves, if they were checked, show its certificate."""
        return not self.mismatches and (self.leaves is None or bool(self.leaves["shown"]))

    def __bool__(self) -> bool:
        return self.ok

    def __repr__(self) -> str:
        if self.ok:
            return "<Verification: true>"
        faults, untrue = [m["text"] for m in self.mismatches], bool(self.mismatches)
        if self.leaves is not None and not self.leaves["shown"]:
            faults.append("leaves: " + self.leaves["text"])
            untrue = untrue or self.leaves["refuted"]
        return f"<Verification: NOT {'true' if untrue else 'shown'}: " + "; ".join(faults) + ">"


def verify(result: Result | Path, *, certificate: bool = False, leaves: bool = False) -> Verification:
    """Recomputes every figure and verdict of a result from its problem and its linkages.

    Args:
        result: a result, its folder or its ``record.json``.
        certificate: works out the certificate again too, box by box: as long as :func:`certify` took.
        leaves: checks the leaves of the certificate with arithmetic of their own, some minutes: those of a result of
            :func:`certify`, or ``certificate.leaves`` in the result's folder.

    Raises:
        ProblemError: there is no record, its problem is none, or it has no certificate or no leaves.

    >>> import linkwright as lw
    >>> bool(lw.verify(lw.synth(lw.path([[0, 0], [1, 1], [2, 1.5], [3, 1]]))))
    True
    """
    return Verification(_linkwright.verify(_result(result)._run, certificate, leaves))


def certify(
    result: Result | Path,
    *,
    gap: float | None = None,
    time_limit_s: float | None = None,
    threads: int | None = None,
    progress: Progress = None,
    resume: bool = False,
) -> Result:
    """Proves that no linkage whose input turns fully is better than a result by more than a gap (prescribed timing).

    Args:
        result: a result, its folder or its ``record.json``. It is not changed.
        gap: how far below the best candidate the proved bound may be, relative, in (0, 1); 1e-4 where silent.
        time_limit_s: seconds at most; what is proved by then counts. 300 where silent.
        threads, progress: as for :func:`linkwright.synth`.
        resume: goes on where a proof with the same gap was stopped: that of `result`, if :func:`certify` returned it, else
            that of ``certificate.checkpoint`` in its folder. If none was stopped, it begins anew.

    Returns:
        The result with its :attr:`Result.certificate`, unless the one that it had proves more: that one stays then.
        :meth:`Result.save` writes beside it the decided boxes (``certificate.leaves``), which :func:`verify` checks with
        ``leaves=True``, and, if the proof is not at its end, the checkpoint for `resume`.

    Raises:
        ProblemError: nothing can be proved about such a task, or the checkpoint is of another proof.
        KeyboardInterrupt: Ctrl-C; its attribute ``result`` has what was proved by then.
    """
    found = _result(result)
    callback, close = listener(progress, found.name)
    try:
        return Result(_linkwright.certify(found._run, gap, time_limit_s, threads, callback, resume))
    except BaseException as interrupt:
        wrap(interrupt)
        raise
    finally:
        close()


class _Sheet:
    """Data with the forms in which the command line shows it."""

    __slots__ = ("_json", "csv", "data", "svg", "text")

    #: The data, as the command prints them with ``--json``.
    data: dict[str, Any]
    #: The table that the command prints.
    text: str
    #: The table as CSV.
    csv: str
    #: The drawing as SVG.
    svg: str

    def __init__(self, json: str, text: str, csv: str, svg: str) -> None:
        from json import loads

        self.data, self.text, self.csv, self.svg = loads(json), text, csv, svg

    def to_frame(self) -> pandas.DataFrame:
        """Returns the table as a pandas frame."""
        return _frame(self.csv)

    def __repr__(self) -> str:
        return self.text


class Analysis(_Sheet):
    """Positions, velocities, accelerations and mobility of a linkage."""

    __slots__ = ()

    def _repr_html_(self) -> str:
        return self.svg


def analyze(
    linkage: Subject | Chain,
    *,
    angle_deg: Any = None,
    cycle: int = 12,
    omega: float | None = None,
    alpha: float = 0.0,
    method: Sequence[str] = (),
    all_configurations: bool = False,
    loads: Mapping[str, Any] | Path | None = None,
) -> Analysis:
    """Analyses a linkage: positions, velocities, accelerations, transmission angles, mobility, and under loads its forces.

    Args:
        linkage: a linkage, a candidate, a result (its first candidate) or a path.
        angle_deg: the crank angles, degrees from the x axis, shape (n,); or `cycle`: so many over a turn.
        omega, alpha: speed (rad/s) and acceleration (rad/s^2) of the crank; where `omega` is silent, the speed of the loads
            (``speed_rpm``, also over the crank angle: then the acceleration follows from it), else 0.
        method: other methods beside: ``natural``, ``algebraic``, ``complex``, ``fixed-point``.
        all_configurations: all four assemblies (t1, t2), not the linkage's own alone.
        loads: the keys of ``[loads]`` in a linkage file, lengths in the linkage's unit, or the path of a loads file; where silent,
            those of a linkage file that is given by its path. Each row then has ``loads`` with ``torque_N_m`` and the joints'
            ``forces``, and ``data["loads"]`` has the figures over the range of the crank.

    Raises:
        ProblemError: the linkage, the loads or a setting is refused.

    >>> import linkwright as lw
    >>> rows = lw.analyze(lw.FourBar((0, 0), (4, 1), 2, 5, 5, 5, 5), cycle=4).data["configurations"][0]["rows"]
    >>> [row["status"] for row in rows]
    ['ok', 'ok', 'ok', 'ok']
    """
    subject, which = _split(linkage)
    angles = None if angle_deg is None else _numbers(angle_deg)
    methods = [method] if isinstance(method, str) else list(method)
    found = _linkwright.analyze(subject, which, angles, cycle, omega, alpha, methods, all_configurations, loads)
    return Analysis(*found)


class Balance:
    """A spring or counter-masses that balance a loaded linkage, with what is left."""

    __slots__ = ("data", "loads", "text")

    #: The figures of ``linkwright balance --json``, in SI units: of a spring ``spring``, ``span``, ``largest``, ``before``,
    #: ``after``, ``residual_percent``, ``residual_rms_percent``; of counter-masses ``masses``, ``before``, ``after``,
    #: ``ripple_percent``, ``shaking_percent``.
    data: dict[str, Any]
    #: The loads with the balance: the keys of ``[loads]``, lengths in the linkage's unit, as :func:`analyze` takes them.
    loads: dict[str, Any]
    #: The text that ``linkwright balance`` prints.
    text: str

    def __init__(self, json: str, text: str, loads: dict[str, Any]) -> None:
        from json import loads as parsed

        self.data, self.text, self.loads = parsed(json), text, loads

    def __repr__(self) -> str:
        return self.text


def balance(
    linkage: Subject | Chain,
    *,
    spring: tuple[Any, Any] | None = None,
    torsion: str | tuple[str, str] | None = None,
    masses: str | Sequence[str] | None = None,
    over_deg: tuple[float, float] | None = None,
    rates: Any = (),
    least_free_length: float = 0.0,
    radius: float | None = None,
    even: str = "torque",
    omega: float | None = None,
    loads: Mapping[str, Any] | Path | None = None,
) -> Balance:
    """Balances a loaded linkage: by a spring that holds it where it is put, or by counter-masses for an even torque.

    Args:
        linkage: a linkage, a candidate, a result (its first candidate) or a path.
        spring: the two ends of a spring: each a joint's name, a fixed point ``(50, 80)``, or a place on a body
            ``("coupler", (20, 5))``; or `torsion`: the body on which a torsion spring acts, or that and the body that bears it
            (else the ground); or `masses`: the bodies with counter-masses, ``"crank"``, ``"follower"`` or both. One of the
            three. Lengths in the linkage's unit.
        over_deg: the crank angles over which a spring is to hold, degrees; where silent, all that the crank reaches.
        rates: the rates of the springs that can be bought, N/m or N m/rad; where empty, any.
        least_free_length: of a spring, in the linkage's unit.
        radius: the distance of counter-masses from the fixed pivots, in the linkage's unit.
        even: what counter-masses make even: ``torque``, ``shaking-force`` or ``both``.
        omega: speed of the crank for counter-masses, rad/s; where silent, that of the loads.
        loads: as of :func:`analyze`.

    The torque T of a spring of rate k and free length l0 between ends at a distance l is k (l - l0) dl/dphi; rate and free
    length leave the least root mean square of the static torque. Counter-masses leave the least root mean square over time of
    the torque or the shaking force less its mean.

    Raises:
        ProblemError: the linkage has no unit or no loads, a name or a number is refused, or nothing is gained.

    >>> import linkwright as lw
    >>> lamp = lw.FourBar((0, 0), (500, 0), 300, 520, 400, 100, 450, unit="mm")
    >>> arm = {"gravity": [0, -9.81], "body": {"crank": {"mass_kg": 1, "center": [300, 0]}}}
    >>> held = lw.balance(lamp, spring=(("crank", (150, 0)), (0, 120)), over_deg=(20, 70), loads=arm)
    >>> round(held.data["spring"]["extension"]["rate_N_per_m"], 6)
    163.5
    """
    given = {"spring": spring, "torsion": torsion, "masses": masses}
    asked = [(means, of) for means, of in given.items() if of is not None]
    if len(asked) != 1:
        raise _linkwright.ProblemError("give one of spring=, torsion= and masses=")
    means, of = asked[0]
    names = [of] if isinstance(of, str) else [_end(end) for end in of]
    over = None if over_deg is None else _numbers(over_deg)
    if over is not None and len(over) != 2:
        raise _linkwright.ProblemError("over_deg: two crank angles in degrees are needed")
    subject, which = _split(linkage)
    (json, text), balanced = _linkwright.balance(
        subject, which, means, names, over, _numbers(rates), least_free_length, radius, even, omega, loads
    )
    return Balance(json, text, balanced)


def _end(end: Any) -> str:
    """Returns an end of a spring, or a body's name, as the command line writes it."""
    if isinstance(end, str):
        return end
    first, second = end
    if isinstance(first, str):
        return f"{first}:{_end(second)}"
    return f"{float(first)!r},{float(second)!r}"


def _numbers(given: Any) -> list[float]:
    plain = given.tolist() if hasattr(given, "tolist") else given
    return [float(x) for x in (plain if hasattr(plain, "__iter__") else [plain])]


def cognates(linkage: OfFourBars) -> list[FourBar]:
    """Returns the other two linkages of the same coupler curve (Roberts, Chebyshev); fewer if they do not exist.

    >>> import linkwright as lw
    >>> len(lw.cognates(lw.FourBar((0, 0), (4, 1), 2, 5, 5, 5, 5)))
    2
    """
    return as_four_bar(linkage).cognates()


def as_four_bar(linkage: Any) -> FourBar:
    """Returns the four-bar of an argument."""
    subject, which = _split(linkage)
    if isinstance(subject, _linkwright.Run):
        return as_four_bar(subject.linkage(which or "1"))
    if isinstance(subject, _linkwright.FourBar):
        return subject
    if isinstance(subject, _linkwright.SliderLinkage):
        raise _linkwright.ProblemError(f"a {subject.kind} is not a four-bar, and a four-bar is needed here")
    if isinstance(subject, _linkwright.Chain):
        raise _linkwright.ProblemError("a chain is not a four-bar, and a four-bar is needed here")
    loaded = _linkwright.load(subject)
    return as_four_bar(loaded)


class Comparison(_Sheet):
    """Results and linkages side by side."""

    __slots__ = ("html",)

    #: The page with curves and tables.
    html: str

    def __init__(self, json: str, text: str, csv: str, svg: str, html: str) -> None:
        super().__init__(json, text, csv, svg)
        self.html = html

    def _repr_html_(self) -> str:
        from ._show import preformatted

        return self.svg + preformatted(self.text)


def compare(
    *subjects: Subject,
    target: Problem | Mapping[str, Any] | Path | None = None,
    sort: Sequence[str] = (),
    reference: Subject | None = None,
) -> Comparison:
    """Puts results and linkages side by side; every figure is computed anew.

    Args:
        subjects: results, candidates, linkages or paths.
        target: the problem on whose target everything is measured; where silent, runs on their own.
        sort: the figures that rank, the first first: ``sum_sq``, ``rms``, ``max``, ``to_curve``, ``transmission``,
            ``link_ratio``, ``size``, ``extent``, ``objective``.
        reference: one of the subjects, from which the differences in per cent are taken.

    Raises:
        ProblemError: an input is refused, or none of them can be compared.
    """
    found = []
    for i, one in enumerate(subjects, 1):
        subject, which = _split(one)
        label = str(subject) if isinstance(subject, str) or hasattr(subject, "__fspath__") else f"linkage {i}"
        found.append((subject, which, label))
    index = None
    if reference is not None:
        same = [i for i, one in enumerate(subjects) if one is reference or one == reference]
        index = same[0] if same else len(subjects)
    keys = sort.split(",") if isinstance(sort, str) else list(sort)
    problem = None if target is None else as_problem(target)
    json, text, csv, svg, html = _linkwright.compare(found, problem, keys, index)
    return Comparison(json, text, csv, svg, html)


class Build:
    """What it takes to build a linkage: layers, least distances, sensitivities."""

    __slots__ = ("data", "text")

    #: The figures: ``layers``, ``distances``, ``sensitivity``, ``hole``, ``margin``, ``tolerance``; lengths in the file's
    #: unit, ``crank_deg`` in degrees.
    data: dict[str, Any]
    #: The text that ``linkwright build`` prints.
    text: str

    def __init__(self, data: dict[str, Any], text: str) -> None:
        self.data, self.text = data, text

    def __repr__(self) -> str:
        return self.text


def build(
    linkage: Subject,
    *,
    hole: float | None = None,
    margin: float | None = None,
    tolerance: float | None = None,
    shop: Mapping[str, Any] | Path | None = None,
) -> Build:
    """Works out what it takes to build a linkage.

    Args:
        linkage: a linkage, a candidate, a result (its first candidate) or a path.
        hole: the holes' diameter; margin: the material around a hole; tolerance: the standard deviation of every
            dimension. Lengths in the file's unit.
        shop: the keys of ``[shop]`` in a linkage file, lengths in the linkage's unit, or the path of a shop file; where silent,
            those of a linkage file that is given by its path. `hole` and `margin` go before them.

    Raises:
        ProblemError: the linkage cannot be assembled, or a size is refused.
    """
    subject, which = _split(linkage)
    data, text = _linkwright.build(subject, which, hole, margin, tolerance, shop)
    return Build(data, text)


def snap(
    linkage: Subject,
    *,
    grid: float | None = None,
    lengths: Any = None,
    pitches: Path | None = None,
    snap: Sequence[str] | None = None,
    keep: Sequence[str] = (),
    set: Mapping[str, float] | None = None,  # noqa: A002
    threads: int | None = None,
) -> Result:
    """Brings the lengths of a linkage to stock sizes and fits the rest again.

    Args:
        linkage: a candidate, a result (its first candidate), a linkage (measured on its own curve) or a path.
        grid: the stock: multiples of this; or `lengths`: these lengths, shape (n,); or `pitches`: the lengths in this text
            file, one a line or separated by commas. One of the three.
        snap: the hole distances that are snapped: ``ground, a, b, c, d, e``, of a six-bar also two joints, such as ``X2F2``;
            where silent, all that the linkage has.
        keep: what stays exactly as it is: hole distances, ``A, B, ground_angle_deg``, of a six-bar also its third pivot, such
            as ``Y2``.
        set: dimensions with values of their own.

    Returns:
        A result of the snapped linkages, under the same problem.

    Raises:
        ProblemError: nothing fits, or a setting is refused.
    """
    subject, which = _split(linkage)
    stock = None if lengths is None else _numbers(lengths)
    values = [(key, float(value)) for key, value in (set or {}).items()]
    chosen = None if snap is None else list(snap)
    try:
        run, _ = _linkwright.snap(subject, which, grid, stock, pitches, chosen, list(keep), values, threads)
    except BaseException as interrupt:
        wrap(interrupt)
        raise
    return Result(run)


def formats() -> list[str]:
    """Returns the names of the export formats.

    >>> import linkwright as lw
    >>> "dxf-plates" in lw.formats()
    True
    """
    return _linkwright.export_formats()


def export(linkage: Subject, format: str, *, shop: Mapping[str, Any] | Path | None = None, **settings: Any) -> bytes:
    """Returns a linkage as a file to build from.

    Args:
        linkage: a linkage, a candidate, a result (its first candidate) or a path.
        format: one of :func:`formats`.
        settings: sizes in millimetres and the like, as ``--set`` of ``linkwright export``: ``scale``, ``unit``,
            ``hole_mm``, ``motor_hole_mm``, ``margin_mm``, ``kerf_mm``, ``thickness_mm``, ``sheet_mm="600x300"``, ..
        shop: as of :func:`build`; `settings` go before it.

    Raises:
        ProblemError: the format or a setting is refused; the text has the remedy.

    >>> import linkwright as lw
    >>> lw.export(lw.FourBar((0, 0), (4, 1), 2, 5, 5, 5, 5), "scad", unit="cm")[:2]
    b'//'
    """
    subject, which = _split(linkage)
    pairs = [(key, _setting(value)) for key, value in settings.items()]
    return _linkwright.export(subject, which, format, pairs, shop)[0]


def _setting(value: Any) -> str:
    if isinstance(value, (tuple, list)):
        return "x".join(str(part) for part in value)
    return str(value)


#: The formats of the endings of file names.
_ENDINGS = {"txt": "cut-list"}


def write_file(linkage: Any, path: Path, format: str | None, settings: Mapping[str, Any]) -> None:
    """Writes a linkage to a file, in the format of the name's ending where none is given."""
    import os

    if format is None:
        ending = os.path.splitext(os.fspath(path))[1].lstrip(".").lower()
        format = _ENDINGS.get(ending, ending)
        if format not in formats():
            listed = ", ".join(formats())
            raise _linkwright.ProblemError(
                f"{os.fspath(path)}: no format has this ending; give format=, one of {listed}"
            )
    write(path, export(linkage, format, **settings))


class Suite:
    """The figures of a suite: problems with a known answer, many seeds each."""

    __slots__ = ("data", "markdown", "text")

    #: The figures, as ``linkwright suite --json`` prints them.
    data: dict[str, Any]
    #: The tables that ``linkwright suite`` prints.
    text: str
    #: The tables as Markdown.
    markdown: str

    def __init__(self, json: str, text: str, markdown: str) -> None:
        from json import loads

        self.data, self.text, self.markdown = loads(json), text, markdown

    def __repr__(self) -> str:
        return self.text


def suite(
    filter: str = "",  # noqa: A002
    *,
    seeds: int = 10,
    problems: Path | None = None,
    certify: bool = False,
    progress: Progress = None,
) -> Suite:
    """Runs problems whose answer is known from many seeds, beside what was published; one thread.

    Args:
        filter: only problems whose name or file name holds this.
        seeds: seeds 1 to this.
        problems: a folder of problem files, of paths and of motions; where silent, the literature's.
        certify: proves the best answer of each problem that can be proved.
        progress: as for :func:`linkwright.synth`.

    Raises:
        ProblemError: there are no such problems, or one of them is refused.
        KeyboardInterrupt: Ctrl-C; its attribute ``result`` has the runs that are over.
    """
    callback, close = listener(progress, "suite")
    try:
        return Suite(*_linkwright.suite(filter, seeds, problems, certify, callback))
    except BaseException as interrupt:
        found = getattr(interrupt, "result", None)
        if isinstance(found, (list, tuple)):
            interrupt.result = Suite(*found)  # type: ignore[attr-defined]
        raise
    finally:
        close()


def schema(kind: str) -> dict[str, Any]:
    """Returns the JSON Schema of a file: ``"problem"``, ``"linkage"`` or ``"record"``."""
    return _linkwright.schema(kind)
