"""Bad input: each class of the library's errors is a ProblemError with the text of the command line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from conftest import ARC, ROOT, call

import linkwright as lw
import linkwright.sweep

BAD = sorted((ROOT / "tests" / "bad").rglob("*.toml"))
SWEEPS = [file for file in BAD if file.parent.name == "sweeps"]

# How the tables of linkage files begin.
LINKAGES = ("[linkage]", "[vector_loop]", "[chain", "[slider_crank]", "[inverted_slider_crank]")

# Whole linkage files, which are only no problem files.
WHOLE = ("linkage-slider-crank", "linkage-inverted-slider-crank")


def read(name: str) -> object:
    """Reads a file of the folder, as what it is."""
    lines = Path(name).read_text(errors="replace").splitlines()
    linkage = any(line.strip().startswith(LINKAGES) for line in lines)
    return lw.load(name) if linkage else lw.load_problem(name)


def compared(code: int, said: str, read: object) -> None:
    """Compares what the command said with what is raised."""
    if code == 0:
        read()  # type: ignore[operator]
        return
    with pytest.raises(lw.ProblemError) as refused:
        read()  # type: ignore[operator]
    # Warnings come before the error.
    assert said.endswith(f"error: {refused.value}\n")


@pytest.mark.parametrize("file", [f for f in BAD if f not in SWEEPS and f.stem not in WHOLE], ids=lambda file: file.stem)
def test_every_bad_file_is_refused_with_the_text_of_the_command(
    file: Path, program: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(file.parent)
    said = call([*program, "check", file.name])
    compared(said.returncode, said.stderr, lambda: read(file.name))


@pytest.mark.parametrize("stem", WHOLE)
def test_whole_linkage_files_are_read(stem: str) -> None:
    assert isinstance(lw.load(ROOT / "tests" / "bad" / f"{stem}.toml"), lw.SliderLinkage)


@pytest.mark.parametrize("file", SWEEPS, ids=lambda file: file.stem)
def test_every_bad_sweep_is_refused_with_the_text_of_the_command(
    file: Path, program: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(file.parent)
    said = call([*program, "sweep", "plan", file.name, "--out", str(tmp_path / "theirs"), "--shard-size", "1"])
    compared(said.returncode, said.stderr, lambda: lw.sweep.plan(file.name, tmp_path / "ours", shard_size=1))


def refusal(call: object, *given: object, **options: object) -> str:
    with pytest.raises(lw.ProblemError) as refused:
        call(*given, **options)  # type: ignore[operator]
    assert isinstance(refused.value, ValueError)
    return str(refused.value)


def test_a_problem_that_is_no_file_is_refused_at_its_key() -> None:
    assert refusal(lw.path, ARC, design={"a": [50, 10]}) == (
        "problem:4:5: the bounds are the wrong way round: 50 is above 10\n"
        "4 | a = [50, 10]\n"
        "  |     ^^^^^^^^\n"
        "help: write [10, 50]"
    )
    assert "did you mean `transmission_deg_min`" in refusal(lw.path, ARC, require={"transmision_deg_min": 3})
    assert "a path needs at least 2 points, this one has 1" in refusal(lw.path, [[0, 0]])
    assert "nan is not a number that can be used" in refusal(lw.path, [[0, 0], [np.nan, 1], [2, 2]])
    assert "expected a point [x, y], found a list of 3" in refusal(lw.path, np.arange(9.0).reshape(3, 3))
    assert "expected a point [x, y], found the number 0.0" in refusal(lw.path, np.arange(6.0))
    assert "this program reads format 1" in refusal(lw.synth, {"format": 2, "task": {"path": {"points": ARC}}})
    assert "there is no task in this file" in refusal(lw.synth, {})


def test_points_of_any_dtype_and_layout_are_the_same_problem() -> None:
    points = np.array(ARC)
    forms = [points.astype(">f8"), points.astype("f4"), np.asfortranarray(points), np.repeat(points, 2, axis=0)[::2]]
    digests = {lw.path(form).digest for form in [ARC, points, *forms]}
    assert len(digests) == 1
    with pytest.raises(TypeError, match=r"task.path.points.0.0: a problem holds numbers.*complex"):
        lw.path(points.astype(complex))
    with pytest.raises(TypeError, match=r"solve.seed: .* beyond the whole numbers"):
        lw.path(ARC, solve={"seed": 2**80})
    with pytest.raises(TypeError, match="a key is a text, not int"):
        lw.path(ARC, solve={3: 4})  # type: ignore[dict-item]
    with pytest.raises(TypeError, match=r"task.path.weight.1: .*NoneType"):
        lw.path(ARC, weight=[1, None, 1, 1])
    with pytest.raises(TypeError, match="a problem, a dict .* or a path is needed, not int"):
        lw.synth(3)  # type: ignore[arg-type]
    deep: list[object] = []
    for _ in range(100):
        deep = [deep]
    with pytest.raises(TypeError, match="nested too deeply"):
        lw.path(deep)


def test_a_hundred_thousand_points_are_read_and_one_more_is_refused() -> None:
    t = np.linspace(0, 6, 100_001)
    points = np.stack([np.cos(t), np.sin(t)], axis=1)
    assert len(lw.path(points[:-1]).points()) == 100_000
    assert "100000" in refusal(lw.path, points).replace(",", "")


def test_tasks_that_this_version_lacks_are_refused_as_the_command_refuses_them(
    program: list[str], tmp_path: Path
) -> None:
    file = tmp_path / "motion.toml"
    file.write_text("format = 1\n[task.motion]\nposes = [[10, 9, 5], [9, 30, 35], [20, 31, 40]]\n")
    said = call([*program, "check", str(file)])
    if said.returncode == 0:
        assert len(lw.motion([[10, 9, 5], [9, 30, 35], [20, 31, 40]]).points()) == 3
        return
    first = said.stderr.splitlines()[0].split(": ", 2)[2]
    assert first in refusal(lw.motion, [[10, 9, 5], [9, 30, 35], [20, 31, 40]])
    assert "output" in refusal(lw.function, [0, 15, 30], output=[0, 11, 25])


def test_settings_are_refused() -> None:
    problem = lw.path(ARC)
    assert "with --set solve.seed=-1" in refusal(lw.synth, problem, seed=-1)
    assert "solve.method" in refusal(lw.synth, problem, method="magic")
    assert "threads = 0: a whole number from 1 to 1024" in refusal(lw.synth, problem, threads=0)
    assert "threads = -3" in refusal(lw.synth, problem, threads=-3)
    assert "threads = 2000" in refusal(lw.synth, problem, threads=2000)
    assert "\"a b\" is not a key" in refusal(lw.synth, problem, set={"a b": 1})
    assert "name 2 to 4 axes" in refusal(lw.front, problem, axes=["rms"])
    assert "rms is named twice" in refusal(lw.front, problem, axes="rms,rms")
    assert "add rms or max" in refusal(lw.front, problem, axes=["extent", "longest"])
    assert "--axes speed" in refusal(lw.front, problem, axes=["rms", "speed"])
    assert "--points 0" in refusal(lw.front, problem, points=0)
    with pytest.raises(TypeError):
        lw.synth(problem, threads="many")  # type: ignore[arg-type]


def test_folders_and_files_are_refused(tmp_path: Path, arc: lw.Result) -> None:
    assert "there is no such record" in refusal(lw.open, tmp_path / "none")
    (tmp_path / "record.json").write_text("{}")
    assert "this is not a linkwright record" in refusal(lw.open, tmp_path)
    assert "this is not a linkwright record" in refusal(lw.open, tmp_path / "record.json")
    assert "which linkwright did not write" in refusal(arc.save, ROOT / "docs")
    (tmp_path / "file").write_text("")
    assert "is a file" in refusal(arc.save, tmp_path / "file")
    assert "none.toml: there is no such file" in refusal(lw.load_problem, tmp_path / "none.toml")
    assert "the file is empty" in refusal(lw.load, tmp_path / "file")
    assert "none.toml: there is no such file" in refusal(lw.load, tmp_path / "none.toml")


def test_what_cannot_be_done_with_a_result_is_refused(arc: lw.Result) -> None:
    assert "there is no format" in refusal(arc.export, "pdf")
    assert "there is no setting `hole`" in refusal(arc.export, "dxf", hole=3)
    assert "help: dxf takes scale, unit, hole_mm" in refusal(arc.export, "dxf", hole=3)
    assert "`hole_mm` is not a number" in refusal(arc.export, "dxf", hole_mm="big")
    assert "no format has this ending" in refusal(arc.to_file, "arc.xyz")
    assert "no certificate" in refusal(lw.verify, arc, certificate=True)
    assert "no certificate is available for free timing" in refusal(lw.certify, arc)
    assert "gap = 2" in refusal(lw.certify, arc, gap=2.0)
    assert "time_limit_s = -1" in refusal(lw.certify, arc, time_limit_s=-1.0)
    assert "hole = -1" in refusal(lw.build, arc, hole=-1.0)
    assert "give the stock: one of grid, lengths and pitches" in refusal(lw.snap, arc)
    assert "0 is no stock length" in refusal(lw.snap, arc, grid=0.0)
    assert "x: a hole distance is one of" in refusal(lw.snap, arc, grid=1.0, snap=["x"])
    assert "x: what can be kept" in refusal(lw.snap, arc, grid=1.0, keep=["x"])
    assert "x: what can be set" in refusal(lw.snap, arc, grid=1.0, set={"x": 1})
    assert "no figure is called \"beauty\"" in refusal(lw.compare, arc, sort=["beauty"])
    assert "the reference is none of the inputs" in refusal(lw.compare, arc, reference="other")
    linkage = arc.candidates[0].linkage
    assert "is a linkage without a target" in refusal(lw.compare, linkage)
    assert "there is no method" in refusal(lw.analyze, linkage, method="magic")
    assert "cycle = 0" in refusal(lw.analyze, linkage, cycle=0)
    assert "has \"nothing\" in its name" in refusal(lw.suite, "nothing")
    assert "seeds = 0" in refusal(lw.suite, seeds=0)
    assert refusal(lw.schema, "everything")
    with pytest.raises(TypeError, match="a result, a candidate, a linkage or a path is needed, not int"):
        lw.build(3)  # type: ignore[arg-type]
    with pytest.raises(AttributeError, match="a candidate has no 'beauty'"):
        arc.candidates[0].beauty  # noqa: B018
    open_loop = lw.FourBar((0, 0), (100, 0), 1, 2, 3, 1, 2)
    assert "cannot be assembled" in refusal(lw.build, open_loop)
    assert "cannot be assembled" in refusal(lw.snap, open_loop, grid=1.0)
