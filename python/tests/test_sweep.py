"""Sweeps on this machine: the same folder as that of the command."""

from __future__ import annotations

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
