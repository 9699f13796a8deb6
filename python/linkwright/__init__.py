"""Linkages that draw the path you ask for, with every figure checked and every run repeatable to the digit.

>>> import linkwright as lw
>>> problem = lw.path([[0, 0], [1, 1], [2, 1.5], [3, 1]], require={"transmission_deg_min": 30})
>>> result = lw.synth(problem, seed=1)
>>> best = result.candidates[0]
>>> best.accepted, best.error["rms"] < 1e-9
(True, True)
>>> at = best.linkage.positions([0.0, 0.1])
>>> at.P.shape
(2, 2)

Angles are in radians where a function takes or returns arrays of them, and in degrees wherever a name ends in ``_deg``, as
in files. Lengths are in the unit of the problem. Bad input raises :class:`ProblemError` with the text of the command line.

numpy is imported when the first array is made; matplotlib, pandas, tqdm and dask when something needs them.
"""

from __future__ import annotations

from ._doors import (
    Analysis,
    Balance,
    Build,
    Comparison,
    Suite,
    Verification,
    analyze,
    balance,
    build,
    certify,
    cognates,
    compare,
    export,
    formats,
    schema,
    snap,
    suite,
    verify,
)
from ._linkwright import (
    Chain,
    FourBar,
    InternalError,
    Positions,
    Problem,
    ProblemError,
    Rates,
    SliderLinkage,
    SliderRates,
    __version__,
    inverted_slider_crank,
    load,
    slider_crank,
)
from ._problems import function, load_problem, motion, path
from ._result import Candidate, Front, Result, front, open, synth

__all__ = [
    "Analysis",
    "Balance",
    "Build",
    "Candidate",
    "Chain",
    "Comparison",
    "FourBar",
    "Front",
    "InternalError",
    "Positions",
    "Problem",
    "ProblemError",
    "Rates",
    "Result",
    "SliderLinkage",
    "SliderRates",
    "Suite",
    "Verification",
    "__version__",
    "analyze",
    "balance",
    "build",
    "certify",
    "cognates",
    "compare",
    "export",
    "formats",
    "front",
    "function",
    "inverted_slider_crank",
    "load",
    "load_problem",
    "motion",
    "open",
    "path",
    "schema",
    "slider_crank",
    "snap",
    "suite",
    "synth",
    "verify",
]
