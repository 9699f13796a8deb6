"""Problems from points, poses or functions."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    import os
    from collections.abc import Mapping
    from typing import Any

from ._linkwright import Problem


def load_problem(path: str | os.PathLike[str]) -> Problem:
    """Reads the problem of a file.

    Args:
        path: a problem file (TOML), or a bare target: points (CSV) or a drawing (SVG).

    Raises:
        ProblemError: the file is refused; the text names the line, the fault and the remedy.
    """
    return Problem.load(path)


def _problem(kind: str, task: dict[str, Any], crank_deg: Any = None, offset: str | None = None, **tables: Any) -> Problem:
    if crank_deg is not None or offset is not None:
        task["timing"] = {"crank_deg": crank_deg, "offset": offset}
    return Problem.of({"format": 1, "task": {kind: task}, **tables})


def _file(given: Any) -> str | None:
    """Returns the path that an argument names; None if it holds the values themselves."""
    named = given.__fspath__() if hasattr(given, "__fspath__") else given
    return named if isinstance(named, str) else None


def path(
    points: Any,
    *,
    closed: bool | None = None,
    tolerance: Any = None,
    weight: Any = None,
    crank_deg: Any = None,
    offset: str | None = None,
    samples: int | None = None,
    smooth: float | None = None,
    design: Mapping[str, Any] | None = None,
    require: Mapping[str, Any] | None = None,
    solve: Mapping[str, Any] | None = None,
    certify: Mapping[str, Any] | None = None,
    name: str | None = None,
    source: str | None = None,
    unit: str | None = None,
) -> Problem:
    """Makes a problem of a path to trace.

    Args:
        points: the target points in their order, shape (n, 2), or the path of a points file (CSV) or a drawing (SVG).
        closed: whether the target is a closed curve.
        tolerance: the largest error accepted, a length: one for all points, or shape (n,).
        weight: the weights of the squared errors, shape (n,).
        crank_deg: prescribed crank angles in degrees, counter-clockwise positive, shape (n,). Without them the timing is
            free.
        offset: the reference of `crank_deg`: ``"free"`` (only increments count), ``"fixed"`` (from the x axis) or
            ``"ground"`` (from the line A -> B).
        samples: the number of points taken evenly along the path.
        smooth: smooths digitised points; the standard deviation of the window, a length.
        design, require, solve, certify: the tables of a problem file with these names, as dicts.
        name, source, unit: the keys of a problem file; `unit` is ``"mm"``, ``"cm"``, ``"m"`` or ``"in"``.

    Raises:
        ProblemError: a value is refused; the text names the key, the fault and the remedy.
        TypeError: a value is of a type that no problem file can hold.

    >>> import linkwright as lw
    >>> problem = lw.path([[0, 0], [1, 1], [2, 1.5], [3, 1]], tolerance=0.1, name="arc")
    >>> problem.name, problem.resolved["solve"]["candidates"]
    ('arc', 5)
    >>> lw.path([[0, 0], [1, 1]], require={"transmission_deg_min": 100})  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    linkwright.ProblemError: problem:...: ...
    """
    task: dict[str, Any] = {
        "closed": closed, "tolerance": tolerance, "weight": weight, "samples": samples, "smooth": smooth,
    }  # fmt: skip
    file = _file(points)
    task["points" if file is None else "svg" if file.lower().endswith(".svg") else "file"] = file or points
    return _problem(
        "path", task, crank_deg, offset, name=name, source=source, unit=unit, design=design, require=require,
        solve=solve, certify=certify,
    )  # fmt: skip


def motion(
    poses: Any,
    *,
    angle_weight: float | None = None,
    tolerance: Any = None,
    tolerance_deg: Any = None,
    weight: Any = None,
    exact: Any = None,
    closed: bool | None = None,
    crank_deg: Any = None,
    offset: str | None = None,
    design: Mapping[str, Any] | None = None,
    require: Mapping[str, Any] | None = None,
    solve: Mapping[str, Any] | None = None,
    name: str | None = None,
    source: str | None = None,
    unit: str | None = None,
) -> Problem:
    """Makes a problem of poses to pass.

    Args:
        poses: x, y and the angle of the body in degrees, shape (n, 3); a list may hold ``[x, y]`` where only the point is
            asked for. Or the path of a CSV file.
        angle_weight: a length: an angle error of 1 rad counts like this length.
        tolerance, tolerance_deg: the largest errors of position and angle accepted.
        weight: the weights of the poses' squared errors, shape (n,).
        exact: the indices (from 0) of poses that must be met exactly.
        closed, crank_deg, offset, design, require, solve, name, source, unit: as for :func:`path`.

    Raises:
        ProblemError: a value is refused, or this version of linkwright has no such task.
    """
    task: dict[str, Any] = {
        "angle_weight": angle_weight, "tolerance": tolerance, "tolerance_deg": tolerance_deg,
        "weight": weight, "exact": exact, "closed": closed,
    }  # fmt: skip
    file = _file(poses)
    task["poses" if file is None else "file"] = file or poses
    return _problem(
        "motion", task, crank_deg, offset, name=name, source=source, unit=unit, design=design, require=require,
        solve=solve,
    )  # fmt: skip


def function(
    input_deg: Any = None,
    output_deg: Any = None,
    *,
    output: Any = None,
    of: str | None = None,
    over: Any = None,
    input_range_deg: Any = None,
    output_range_deg: Any = None,
    output_range: float | None = None,
    samples: int | None = None,
    file: str | os.PathLike[str] | None = None,
    input_offset: str | None = None,
    output_offset: str | None = None,
    sense: str | None = None,
    tolerance: Any = None,
    tolerance_deg: Any = None,
    weight: Any = None,
    design: Mapping[str, Any] | None = None,
    require: Mapping[str, Any] | None = None,
    solve: Mapping[str, Any] | None = None,
    name: str | None = None,
    source: str | None = None,
    unit: str | None = None,
) -> Problem:
    """Makes a problem of a function to generate: the output link's angle, or a slider's place, for the crank's angle.

    Args:
        input_deg: how far the crank has turned, degrees, shape (n,).
        output_deg: how far the follower has turned, degrees, shape (n,).
        output: how far a slider has moved, lengths, shape (n,), in place of ``output_deg``.
        of, over, samples: a formula such as ``"log10(x)"`` in place of a table.
        input_range_deg, output_range_deg: how far crank and follower turn over the formula's range, degrees; ``"free"``
            or ``[least, greatest]``, also of a table: that is found too.
        output_range: how far a slider moves over the formula's range, a length, in place of ``output_range_deg``.
        file: a CSV file in place of a table.
        input_offset, output_offset: ``"free"`` or ``"ground"``.
        sense: ``"same"``, ``"opposite"`` or ``"any"``.
        tolerance, tolerance_deg, weight: the largest errors accepted (lengths of ``output``, degrees of ``output_deg``), and
            weights.
        design, require, solve, name, source, unit: as for :func:`path`.

    Raises:
        ProblemError: a value is refused, or this version of linkwright has no such key.

    >>> import linkwright as lw
    >>> problem = lw.function(of="x^2", over=[0, 1], input_range_deg=90, output_range_deg=90, sense="same")
    >>> best = lw.synth(problem).candidates[0]
    >>> round(best.error["output"]["rms_deg"], 4)
    0.0425
    """
    task = {
        "input_deg": input_deg, "output_deg": output_deg, "output": output, "of": of, "over": over,
        "input_range_deg": input_range_deg, "output_range_deg": output_range_deg, "output_range": output_range,
        "samples": samples, "file": file, "input_offset": input_offset, "output_offset": output_offset, "sense": sense,
        "tolerance": tolerance, "tolerance_deg": tolerance_deg, "weight": weight,
    }  # fmt: skip
    return _problem(
        "function", task, name=name, source=source, unit=unit, design=design, require=require, solve=solve
    )  # fmt: skip


def as_problem(given: Any) -> Problem:
    """Returns the problem of an argument: a Problem, a dict with the keys of a problem file, or a path."""
    if isinstance(given, Problem):
        return given
    if hasattr(given, "keys"):
        return Problem.of(given if "format" in given else {"format": 1, **given})
    if isinstance(given, str) or hasattr(given, "__fspath__"):
        return Problem.load(given)
    kind = type(given).__name__
    raise TypeError(f"a problem, a dict with the keys of a problem file, or a path is needed, not {kind}")
