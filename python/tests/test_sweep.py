"""Sweeps on this machine: the same folder as that of the command."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from conftest import call

import linkwright as lw
import linkwright.sweep

ARC = """
format = 1
[task.path]
points = [[0, 0], [1, 1], [2, 1.5], [3, 1]]
"""
SWEEP = """
format = 1
problem = "arc.toml"
[vary]
solve.seed = { from = 1, to = 6, steps = 6 }
require.transmission_deg_min = [20, 30]
"""


@pytest.fixture
def sweep(tmp_path: Path) -> Path:
    (tmp_path / "arc.toml").write_text(ARC)
    (tmp_path / "sweep.toml").write_text(SWEEP)
    return tmp_path / "sweep.toml"


def test_a_sweep_has_the_bytes_of_the_command(sweep: Path, program: list[str], tmp_path: Path) -> None:
    theirs, ours = tmp_path / "theirs", tmp_path / "ours"
    for words in (["plan", str(sweep), "--out", str(theirs), "--shard-size", "5"], ["run", str(theirs)], ["merge", str(theirs)]):
        said = call([*program, "sweep", *words])
        assert said.returncode == 0, said.stderr
    plan = lw.sweep.plan(sweep, ours, shard_size=5)
    assert (plan.jobs, plan.shards, plan.shard_size) == (12, 3, 5)
    assert plan.missing() == [0, 1, 2]
    one = lw.sweep.run(ours, 2, threads=1)
    assert (one.shards, one.rows, one.before) == (1, 2, 0)
    assert plan.missing() == [0, 1]
    with pytest.raises(lw.ProblemError, match="2 of 3 shards are missing"):
        lw.sweep.merge(ours)
    told: list[dict[str, object]] = []
    rest = lw.sweep.run(ours, threads=2, progress=told.append)
    assert (rest.shards, rest.rows, rest.before) == (2, 12, 1)
    merged = lw.sweep.merge(ours)
    for name in ("sweep.csv", "sweep.jsonl", "plan.json", "shards/0.jsonl", "shards/2.jsonl"):
        assert (ours / name).read_bytes() == (theirs / name).read_bytes(), name
    frame = merged.to_frame()
    assert len(frame) == merged.rows == 12
    assert list(frame["solve.seed"])[:4] == [1, 1, 2, 2]
    assert lw.sweep.open(ours).digest == plan.digest


def test_faults_of_sweeps_are_refused(sweep: Path, tmp_path: Path) -> None:
    with pytest.raises(lw.ProblemError, match="holds no plan of a sweep"):
        lw.sweep.open(tmp_path / "none")
    lw.sweep.plan(sweep, tmp_path / "out", shard_size=5)
    with pytest.raises(lw.ProblemError, match="there is no shard 9"):
        lw.sweep.run(tmp_path / "out", 9)
    lw.sweep.run(tmp_path / "out", 0)
    with pytest.raises(lw.ProblemError, match="another plan"):
        lw.sweep.plan(sweep, tmp_path / "out", shard_size=4)
    assert lw.sweep.plan(sweep, tmp_path / "out", shard_size=4, force=True).missing() == [0, 1, 2]
    sweep.write_text(SWEEP.replace("solve.seed", "solve.sede"))
    with pytest.raises(lw.ProblemError, match="sede"):
        lw.sweep.plan(sweep, tmp_path / "other")


#: Jobs of three outcomes: something accepted, nothing acceptable, and values that contradict each other.
OUTCOMES = """
format = 1
problem = "outcomes.toml"
[vary]
design.b = [[1, 3], [6, 9]]
require.transmission_deg_min = [0, 89.5]
require.type = ["crank-rocker", "double-rocker"]
solve.advice = [true, false]
"""


def test_the_table_of_a_sweep_has_sensible_types_in_pandas(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    limits = "[design]\nd = [1, 2]\ne = [1, 2]\n[solve]\nevaluations = 3000\ncandidates = 1\n"
    (tmp_path / "outcomes.toml").write_text(ARC + limits)
    (tmp_path / "sweep.toml").write_text(OUTCOMES)
    plan = lw.sweep.plan(tmp_path / "sweep.toml", tmp_path / "out", shard_size=3)
    lw.sweep.run(plan.folder)
    merged = lw.sweep.merge(plan.folder)
    # As anybody reads it, and by the package.
    frame = pandas.read_csv(merged.csv)
    pandas.testing.assert_frame_equal(merged.to_frame(), frame)
    assert list(frame["job"]) == list(range(16))
    outcomes = frame["status"].value_counts()
    assert set(outcomes.index) == {"accepted", "nothing-acceptable", "refused"}
    assert outcomes["refused"] == 8
    kind = {name: frame[name].dtype.kind for name in frame.columns}
    assert kind["job"] == "i"
    assert kind["solve.advice"] == "b"
    assert list(frame["solve.advice"])[:2] == [True, False]
    ran = frame[frame["status"] != "refused"]
    refused = frame[frame["status"] == "refused"]
    numbers = [
        "require.transmission_deg_min", "candidates", "accepted", "evaluations", "sum_sq", "rms", "max", "max_at",
        "rms_over_size", "objective", "transmission_worst_deg", "link_ratio", "extent", "longest",
        "a", "b", "c", "d", "e",
    ]  # fmt: skip
    assert {name: kind[name] for name in numbers} == dict.fromkeys(numbers, "f")
    words = {"status", "termination", "type", "message", "design.b", "require.type"}
    assert words == {name for name in frame.columns if kind[name] not in "bif"}
    # Empty where there is nothing, and nowhere else.
    own = list(frame.columns[frame.columns.get_loc("termination") : frame.columns.get_loc("message")])
    assert refused[own].isna().all(axis=None)
    assert refused["message"].str.contains("impossible triangle").all()
    assert ran["message"].isna().all()
    found = ran[ran["candidates"] > 0]
    assert len(found) > 0
    assert not found[own].isna().any(axis=None)
    # The figures are those of the rows; older versions of pandas read some with another last bit.
    rows = [json.loads(line) for line in Path(merged.jsonl).read_text().splitlines()]
    best = [row["best"] for row in rows if row.get("best")]
    assert [one["error"]["rms"] for one in best] == pytest.approx(list(found["rms"]), rel=1e-15, abs=0)
    assert [one["linkage"]["a"] for one in best] == pytest.approx(list(found["a"]), rel=1e-15, abs=0)


def test_a_message_with_a_hash_is_whole_in_the_frame(sweep: Path, tmp_path: Path) -> None:
    pytest.importorskip("pandas")
    sweep.write_text('format = 1\nproblem = "arc.toml"\n[vary]\nname = ["one", "two # three"]\n')
    plan = lw.sweep.plan(sweep, tmp_path / "out", shard_size=2)
    lw.sweep.run(plan.folder)
    frame = lw.sweep.merge(plan.folder).to_frame()
    assert list(frame["name"]) == ["one", "two # three"]
    assert list(frame["status"]) == ["accepted", "refused"]
    assert "the name has '#' in it; a name is 1 to 64 letters" in frame["message"][1]
