"""The extension module: the library behind Python's types. Use it through `linkwright`."""

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Union, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Path = Union[str, os.PathLike[str]]
_Array = NDArray[np.float64]
_Progress = Callable[[dict[str, Any]], object]

__all__ = [
    "Chain",
    "FourBar",
    "InternalError",
    "Positions",
    "Problem",
    "ProblemError",
    "Rates",
    "Run",
    "SliderLinkage",
    "SliderRates",
    "__version__",
    "_panic",
    "_panic_here",
    "_time_positions",
    "_time_synth",
    "analyze",
    "balance",
    "build",
    "certify",
    "compare",
    "export",
    "export_formats",
    "inverted_slider_crank",
    "load",
    "main",
    "open",
    "parse_linkage",
    "parse_run",
    "schema",
    "slider_crank",
    "snap",
    "suite",
    "sweep_merge",
    "sweep_missing",
    "sweep_open",
    "sweep_plan",
    "sweep_run",
    "synth",
    "verify",
]

__version__: str

class ProblemError(ValueError):
    """Bad input: a problem, linkage, result or setting that linkwright refuses.

    The text is that of the command line: the place, the fault and the remedy.
    """

class InternalError(RuntimeError):
    """A bug of linkwright. Please report it with the input that shows it."""

@final
class Problem:
    """A checked problem, from :func:`linkwright.path` and its like or from a file."""

    @staticmethod
    def load(path: _Path) -> Problem:
        """Reads the problem of a file."""
    @staticmethod
    def of(keys: Mapping[str, Any]) -> Problem:
        """Reads the problem of a dict with the keys of a problem file."""
    @staticmethod
    def parse(text: str) -> Problem:
        """Reads the problem of a text in the format of a problem file."""
    @property
    def name(self) -> str:
        """The name."""
    @property
    def source(self) -> str | None:
        """The source of the problem, in words."""
    @property
    def unit(self) -> str | None:
        """The unit of its lengths: mm, cm, m or in."""
    @property
    def resolved(self) -> dict[str, Any]:
        """Every key with its default filled in."""
    @property
    def best_known_objective(self) -> float | None:
        """The least objective known, of a motion or a function that states it."""
    @property
    def best_known_sum_sq(self) -> float | None:
        """The least sum of squares known, of a problem that states it."""
    @property
    def warnings(self) -> list[str]:
        """Warnings about values that are ignored or cannot succeed."""
    @property
    def digest(self) -> str:
        """SHA-256 of everything that determines a search."""
    @property
    def text(self) -> str:
        """The text of its file."""
    def points(self) -> list[list[float]]:
        """Returns the points of the target; none of a function."""
    def __reduce__(self) -> tuple[Callable[..., Problem], tuple[str]]: ...

@final
class Positions:
    """Positions of the moving joints; NaN where the loop does not close. Shape: that of the crank angles, and 2."""

    @property
    def C(self) -> _Array:
        """The crank pin."""
    @property
    def D(self) -> _Array:
        """The follower pin, or the slider's."""
    @property
    def P(self) -> _Array:
        """The coupler point."""

@final
class Rates:
    """Velocities or accelerations; NaN where the loop does not close and at toggles."""

    @property
    def C(self) -> _Array:
        """Of the crank pin: length a second, or a second squared; shape (n, 2)."""
    @property
    def D(self) -> _Array:
        """Of the follower pin."""
    @property
    def P(self) -> _Array:
        """Of the coupler point."""
    @property
    def coupler(self) -> _Array:
        """Of the coupler: rad/s, or rad/s^2; shape (n,)."""
    @property
    def follower(self) -> _Array:
        """Of the follower: rad/s, or rad/s^2; shape (n,)."""

@final
class FourBar:
    """A planar four-bar linkage.

    A, B: fixed pivots of crank and follower. C, D: moving pins. P: coupler point. a = |AC| crank, b = |CD| coupler,
    c = |BD| follower, d = |CP|, e = |DP|. t1 = 1: D lies left of the line from C to B; t2 = 1: P lies left of the line
    from C to D.

    Raises ProblemError for lengths of no linkage.

    >>> import linkwright as lw, math
    >>> linkage = lw.FourBar((0, 0), (4, 1), 2, 5, 5, 5, 5, t1=1, t2=1)
    >>> linkage.type
    'crank-rocker'
    >>> at = linkage.positions([0.3, math.nan])
    >>> at.C.round(3).tolist()
    [[1.911, 0.591], [nan, nan]]
    """

    def __new__(
        cls,
        A: tuple[float, float] | Sequence[float],
        B: tuple[float, float] | Sequence[float],
        a: float,
        b: float,
        c: float,
        d: float,
        e: float,
        t1: int = 1,
        t2: int = -1,
        *,
        name: str = "linkage",
        unit: str | None = None,
    ) -> FourBar: ...
    @property
    def name(self) -> str:
        """The name."""
    @property
    def unit(self) -> str | None:
        """The unit of its lengths: mm, cm, m or in."""
    @property
    def A(self) -> tuple[float, float]:
        """The fixed pivot of the crank."""
    @property
    def B(self) -> tuple[float, float]:
        """The fixed pivot of the follower."""
    @property
    def a(self) -> float:
        """|AC|, the crank."""
    @property
    def b(self) -> float:
        """|CD|, the coupler."""
    @property
    def c(self) -> float:
        """|BD|, the follower."""
    @property
    def d(self) -> float:
        """|CP|."""
    @property
    def e(self) -> float:
        """|DP|."""
    @property
    def ground(self) -> float:
        """|AB|."""
    @property
    def t1(self) -> int:
        """1: D lies left of the line from C to B; -1: right."""
    @property
    def t2(self) -> int:
        """1: P lies left of the line from C to D; -1: right."""
    @property
    def type(self) -> str | None:
        """crank-rocker, rocker-crank, double-crank, double-rocker, triple-rocker or change-point; None: no linkage."""
    @property
    def grashof_margin(self) -> float:
        """p + q - s - l, a length."""
    @property
    def link_ratio(self) -> float:
        """The longest over the shortest of ground, a, b, c."""
    @property
    def mobility(self) -> dict[str, Any]:
        """Type, range of the input, toggles, circuits, branches, transmission angles (degrees)."""
    def positions(self, phi: ArrayLike) -> Positions:
        """Computes the position at crank angles (radians from the x axis, any shape)."""
    def velocities(self, phi: ArrayLike, omega: float = 1.0) -> Rates:
        """Computes velocities at crank angles, for a crank speed in rad/s."""
    def accelerations(self, phi: ArrayLike, omega: float = 1.0, alpha: float = 0.0) -> Rates:
        """Computes accelerations at crank angles, for a crank's speed (rad/s) and acceleration (rad/s^2)."""
    def transmission_deg(self, phi: ArrayLike) -> _Array:
        """Computes the transmission angle at crank angles, in [0, 180] degrees; NaN where the loop does not close."""
    def coupler_curve(self, at: float = 0.0, samples: int = 720) -> _Array:
        """Samples the coupler curve of the circuit that holds the position at the crank angle `at`; shape (m, 2)."""
    def to_toml(self) -> str:
        """Returns the text of its linkage file."""
    def cognates(self) -> list[FourBar]:
        """Returns the other linkages of the same coupler curve."""
    def __eq__(self, value: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[Callable[[str], FourBar | SliderLinkage | Chain], tuple[str]]: ...

@final
class SliderRates:
    """Velocities or accelerations of a linkage with a slider; NaN where the loop does not close and at toggles."""

    @property
    def C(self) -> _Array:
        """Of the crank pin: length a second, or a second squared; shape (n, 2)."""
    @property
    def D(self) -> _Array:
        """Of the slider's pin."""
    @property
    def P(self) -> _Array:
        """Of the coupler point."""
    @property
    def coupler(self) -> _Array:
        """Of the coupler: rad/s, or rad/s^2; shape (n,)."""
    @property
    def slider(self) -> _Array:
        """Of the slider along its line, or of the block along the coupler; shape (n,)."""

@final
class SliderLinkage:
    """A linkage with a slider: a slider-crank or an inverted slider-crank.

    A: fixed pivot of the crank, a = |AC|; P = C + (coupler_x + i coupler_y) u, u the coupler's direction. Of a slider-crank D
    slides along the line through line_point at line_deg, b = |CD|; of an inverted one the coupler slides through a block that
    turns about B, which lies `offset` to the left of the coupler's line through C, and D is the foot of B on that line.
    Results give them, and :func:`linkwright.load` reads them; :func:`linkwright.slider_crank` and
    :func:`linkwright.inverted_slider_crank` make them.
    """

    @property
    def kind(self) -> str:
        """slider-crank or inverted-slider-crank."""
    @property
    def name(self) -> str:
        """The name."""
    @property
    def unit(self) -> str | None:
        """The unit of its lengths: mm, cm, m or in."""
    @property
    def A(self) -> tuple[float, float]:
        """The fixed pivot of the crank."""
    @property
    def B(self) -> tuple[float, float] | None:
        """The fixed pivot of the block; None of a slider-crank."""
    @property
    def a(self) -> float:
        """|AC|, the crank."""
    @property
    def b(self) -> float | None:
        """|CD|, the coupler; None of an inverted slider-crank."""
    @property
    def offset(self) -> float | None:
        """The distance of B to the left of the coupler's line; None of a slider-crank."""
    @property
    def line_point(self) -> tuple[float, float] | None:
        """A point of the slider's line; None of an inverted slider-crank."""
    @property
    def line_deg(self) -> float | None:
        """The direction of the slider's line, degrees; None of an inverted slider-crank."""
    @property
    def coupler_x(self) -> float:
        """P along the coupler from C."""
    @property
    def coupler_y(self) -> float:
        """P to the left of the coupler."""
    @property
    def t1(self) -> int:
        """1: D is the further of its two places along the line, or the block is ahead of C; -1: the other."""
    @property
    def link_ratio(self) -> float:
        """The longest over the shortest of a and b, or of a and |AB|."""
    @property
    def mobility(self) -> dict[str, Any]:
        """Whether the crank turns fully (input_turns_fully), and where it can stand (input_arcs_deg)."""
    def positions(self, phi: ArrayLike) -> Positions:
        """Computes the position at crank angles (radians from the x axis, any shape)."""
    def places(self, phi: ArrayLike) -> _Array:
        """Computes the slider's place at crank angles: along its line from the foot of the perpendicular from A, or of the block
        along the coupler from C; NaN where the loop does not close."""
    def velocities(self, phi: ArrayLike, omega: float = 1.0) -> SliderRates:
        """Computes velocities at crank angles, for a crank speed in rad/s."""
    def accelerations(self, phi: ArrayLike, omega: float = 1.0, alpha: float = 0.0) -> SliderRates:
        """Computes accelerations at crank angles, for a crank's speed (rad/s) and acceleration (rad/s^2)."""
    def transmission_deg(self, phi: ArrayLike) -> _Array:
        """Computes the transmission angle at crank angles, degrees; NaN where the loop does not close."""
    def coupler_curve(self, at: float = 0.0, samples: int = 720) -> _Array:
        """Samples the coupler curve of the circuit that holds the position at the crank angle `at`; shape (m, 2)."""
    def to_toml(self) -> str:
        """Returns the text of its linkage file."""
    def __eq__(self, value: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[Callable[[str], FourBar | SliderLinkage | Chain], tuple[str]]: ...

def slider_crank(
    A: tuple[float, float] | Sequence[float],
    a: float,
    b: float,
    line_point: tuple[float, float] | Sequence[float],
    line_deg: float,
    coupler_x: float | None = None,
    coupler_y: float = 0.0,
    t1: int = 1,
    *,
    name: str = "linkage",
    unit: str | None = None,
) -> SliderLinkage:
    """Makes a slider-crank."""

def inverted_slider_crank(
    A: tuple[float, float] | Sequence[float],
    B: tuple[float, float] | Sequence[float],
    a: float,
    offset: float = 0.0,
    coupler_x: float = 0.0,
    coupler_y: float = 0.0,
    t1: int = 1,
    *,
    name: str = "linkage",
    unit: str | None = None,
) -> SliderLinkage:
    """Makes an inverted slider-crank."""

@final
class Chain:
    """A compound mechanism of a crank and stages, from :func:`linkwright.load`; six-bars and eight-bars of results are chains."""

    @property
    def name(self) -> str:
        """The name."""
    @property
    def unit(self) -> str | None:
        """The unit of its lengths: mm, cm, m or in."""
    @property
    def names(self) -> list[str]:
        """The names of the points: pivots, the crank's joint, then one point a stage."""
    @property
    def trace(self) -> str:
        """The name of the point whose path is shown."""
    @property
    def links(self) -> list[list[str]]:
        """The links, each as the names of its points."""
    def positions(self, phi: ArrayLike) -> dict[str, _Array]:
        """Computes every point at crank angles (radians); NaN of and after a stage that does not close."""
    def velocities(self, phi: ArrayLike, omega: float = 1.0) -> dict[str, _Array]:
        """Computes the velocity of every point, for a crank speed in rad/s."""
    def accelerations(self, phi: ArrayLike, omega: float = 1.0, alpha: float = 0.0) -> dict[str, _Array]:
        """Computes the acceleration of every point."""
    def to_toml(self) -> str:
        """Returns the text of its linkage file."""
    def __reduce__(self) -> tuple[Callable[[str], FourBar | SliderLinkage | Chain], tuple[str]]: ...

@final
class Run:
    """A record with everything that follows from it; :class:`linkwright.Result` is the class to use."""

    @property
    def name(self) -> str:
        """The name."""
    @property
    def folder(self) -> os.PathLike[str] | None: ...
    @property
    def candidates(self) -> int: ...
    @property
    def members(self) -> int: ...
    @property
    def timing(self) -> dict[str, Any] | None: ...
    def record_json(self) -> bytes: ...
    def linkage(self, which: str) -> Any: ...
    def svg(self, which: str) -> str: ...
    def text(self) -> str: ...
    def summary_html(self) -> str: ...
    def candidate_html(self, index: int) -> str: ...
    def report_html(self) -> str: ...
    def candidates_csv(self) -> str: ...
    def front_csv(self) -> str: ...
    def save(self, folder: _Path) -> None: ...
    def __reduce__(self) -> tuple[Callable[[bytes], Run], tuple[bytes]]: ...

def load(path: _Path) -> FourBar | SliderLinkage | Chain:
    """Reads the linkage of a file: a four-bar or a chain.

    Raises ProblemError: the file is refused; the text names the line, the fault and the remedy.
    """

def synth(
    problem: Problem,
    set: Mapping[str, Any] | None = None,
    threads: int | None = None,
    progress: _Progress | None = None,
    out: _Path | None = None,
    resume: bool = False,
    front: tuple[list[str], int] | None = None,
) -> Run: ...
def open(path: _Path) -> Run: ...
def parse_run(text: bytes) -> Run: ...
def parse_linkage(text: str) -> FourBar | SliderLinkage | Chain: ...
def verify(result: Run, certificate: bool = False, leaves: bool = False) -> dict[str, Any]: ...
def certify(
    result: Run,
    gap: float | None = None,
    time_limit_s: float | None = None,
    threads: int | None = None,
    progress: _Progress | None = None,
    resume: bool = False,
) -> Run: ...
def compare(
    subjects: Sequence[tuple[Any, str | None, str]],
    target: Problem | None = None,
    sort: Sequence[str] = ...,
    reference: int | None = None,
) -> list[str]: ...
def analyze(
    subject: Any,
    which: str | None,
    crank_deg: list[float] | None,
    cycle: int,
    omega: float | None,
    alpha: float,
    methods: list[str],
    all_configurations: bool,
    loads: Any = None,
) -> list[str]: ...
def balance(
    subject: Any,
    which: str | None,
    means: str,
    names: list[str],
    over_deg: list[float] | None,
    rates: list[float],
    least_free_length: float,
    radius: float | None,
    even: str,
    omega: float | None,
    loads: Any = None,
) -> tuple[list[str], dict[str, Any]]: ...
def build(
    subject: Any,
    which: str | None = None,
    hole: float | None = None,
    margin: float | None = None,
    tolerance: float | None = None,
    shop: Any = None,
) -> tuple[dict[str, Any], str]: ...
def snap(
    subject: Any,
    which: str | None,
    grid: float | None,
    lengths: list[float] | None,
    pitches: _Path | None,
    snap: list[str] | None,
    keep: list[str],
    set: list[tuple[str, float]],
    threads: int | None = None,
) -> tuple[Run, str]: ...
def export(
    subject: Any, which: str | None, format: str, settings: list[tuple[str, str]], shop: Any = None
) -> tuple[bytes, list[str]]: ...
def export_formats() -> list[str]: ...
def suite(
    filter: str,
    seeds: int,
    problems: _Path | None = None,
    certify: bool = False,
    progress: _Progress | None = None,
) -> list[str]: ...
def schema(kind: str) -> dict[str, Any]: ...
def sweep_plan(sweep: _Path, out: _Path, shard_size: int | None, records: bool, force: bool) -> None: ...
def sweep_open(folder: _Path) -> dict[str, Any]: ...
def sweep_missing(folder: _Path) -> list[int]: ...
def sweep_run(
    folder: _Path, shard: int | None, threads: int | None, progress: _Progress | None
) -> tuple[int, int, int, int, int]: ...
def sweep_merge(folder: _Path) -> tuple[int, int]: ...
def main(words: list[str]) -> int: ...
def _time_positions(linkage: FourBar, phi: ArrayLike) -> tuple[float, float]: ...
def _time_synth(problem: Problem, times: int, threads: int) -> float: ...
def _panic() -> None: ...
def _panic_here() -> None: ...
