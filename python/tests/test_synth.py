"""Searches: the bytes of the record, threads, seeds, folders."""

from __future__ import annotations

import json
import os
import pickle
import threading
from pathlib import Path

import pytest
from conftest import ARC, call, python

import linkwright as lw

FIVE = ["k18", "k18b", "a6", "e5", "v6"]


@pytest.mark.parametrize("name", FIVE)
def test_the_record_has_the_bytes_that_the_command_writes_on_any_number_of_threads(
    name: str, literature: Path, program: list[str], tmp_path: Path
) -> None:
    file = literature / f"{name}.toml"
    ran = call([*program, "synth", str(file), "--out", str(tmp_path / "out"), "--quiet"])
    assert ran.returncode in (0, 1), ran.stderr
    written = (tmp_path / "out" / "record.json").read_bytes()
    for threads in (1, 2, 4):
        assert lw.synth(file, threads=threads).record_json == written


def test_the_published_value_of_the_eighteen_points_is_found(k18: lw.Result) -> None:
    # The best known sum of squares, problems/literature/k18.toml.
    assert str(k18.candidates[0].error["sum_sq"]).startswith("0.009028884630")


def test_eight_threads_at_once_have_the_bytes_of_one(literature: Path) -> None:
    file = literature / "k18.toml"
    alone = lw.synth(file, threads=1).record_json
    found: list[bytes] = []
    searches = [
        threading.Thread(target=lambda: found.append(lw.synth(file, threads=2).record_json)) for _ in range(8)
    ]
    for search in searches:
        search.start()
    for search in searches:
        search.join()
    assert len(found) == 8
    assert set(found) == {alone}


def test_a_dict_a_problem_and_a_file_are_the_same_problem(tmp_path: Path) -> None:
    keys = {"name": "arc", "task": {"path": {"points": ARC, "tolerance": 0.1}}, "solve": {"seed": 3}}
    file = tmp_path / "arc.toml"
    points = json.dumps(ARC)
    file.write_text(f"format = 1\n[task.path]\npoints = {points}\ntolerance = 0.1\n[solve]\nseed = 3\n")
    of_dict = lw.synth(keys)
    assert of_dict.record_json == lw.synth(file).record_json
    assert of_dict.record_json == lw.synth(lw.path(ARC, tolerance=0.1, name="arc"), seed=3).record_json
    assert of_dict.record["problem"]["digest"] == lw.path(ARC, tolerance=0.1, solve={"seed": 3}).digest


def test_seed_method_and_keys_are_set() -> None:
    problem = lw.path(ARC)
    found = lw.synth(problem, seed=9, method="least-squares", set={"solve.candidates": 2, "task.path.tolerance": 0.5})
    assert found.record["seed"] == 9
    assert found.record["method"]["asked"] == "least-squares"
    assert len(found) <= 2
    assert found.record["problem"]["resolved"]["task"]["path"]["tolerance"] == [0.5] * 4


def test_a_result_is_a_folder_that_the_command_reads_and_back(
    arc: lw.Result, program: list[str], tmp_path: Path
) -> None:
    arc.save(tmp_path / "saved")
    assert (tmp_path / "saved" / "record.json").read_bytes() == arc.record_json
    checked = call([*program, "verify", str(tmp_path / "saved")])
    assert checked.returncode == 0, checked.stderr
    opened = lw.open(tmp_path / "saved")
    assert opened.record_json == arc.record_json
    assert lw.verify(tmp_path / "saved").ok
    assert opened.folder == str(tmp_path / "saved")


def test_a_folder_is_written_during_the_search_and_what_is_done_is_not_run_again(tmp_path: Path) -> None:
    place = tmp_path / "out"
    first = lw.synth(lw.path(ARC), out=place)
    assert lw.open(place).record_json == first.record_json
    assert first.timing is not None
    again = lw.synth(lw.path(ARC), out=place, resume=True)
    assert again.record_json == first.record_json
    assert again.timing is None
    (place / "mine.txt").write_text("mine")
    with pytest.raises(lw.ProblemError, match="holds mine.txt, which linkwright did not write"):
        lw.synth(lw.path(ARC), out=place)


def test_progress_is_told_and_what_it_raises_ends_the_search(literature: Path) -> None:
    told: list[dict[str, object]] = []
    lw.synth(literature / "k18.toml", progress=told.append, threads=1)
    assert told
    assert set(told[-1]) == {"phase", "evaluations", "budget", "best_sum_sq", "accepted"}

    def fails(progress: dict[str, object]) -> None:
        raise LookupError(progress["phase"])

    with pytest.raises(LookupError) as raised:
        lw.synth(literature / "k18.toml", progress=fails, threads=1)
    assert isinstance(raised.value.result, lw.Result)  # type: ignore[attr-defined]


def test_progress_as_a_bar_or_lines_needs_nothing(arc: lw.Result) -> None:
    assert lw.synth(lw.path(ARC, name="arc", unit="mm"), progress=True).record_json == arc.record_json
    hidden = "import sys; sys.modules['tqdm'] = None; sys.modules['tqdm.auto'] = None\n"
    ran = python(f"{hidden}import linkwright as lw; print(len(lw.synth(lw.path({ARC}), progress=True)))")
    assert ran.returncode == 0, ran.stderr


def test_results_problems_and_linkages_are_pickled(arc: lw.Result) -> None:
    again = pickle.loads(pickle.dumps(arc))
    assert again.record_json == arc.record_json
    linkage = arc.candidates[0].linkage
    assert pickle.loads(pickle.dumps(linkage)) == linkage
    problem = lw.path(ARC, name="arc")
    assert pickle.loads(pickle.dumps(problem)).digest == problem.digest


def test_a_front_has_members(tmp_path: Path) -> None:
    problem = lw.path([[0, 0], [1, 1], [2, 1.4], [3, 1.1], [4, 0.2], [5, -1]], solve={"evaluations": 20000})
    found = lw.front(problem, axes=("rms", "extent"), points=5, threads=2, out=tmp_path / "front")
    front = found.front
    assert front is not None
    assert front.axes == ["rms", "extent"]
    assert 1 <= len(front) <= 5
    assert [m.which for m in front.members] == [f"front-{i}" for i in range(1, len(front) + 1)]
    assert front.members[0].linkage.type is not None
    assert front.figures[0]["rms"] == front.members[0].error["rms"]
    assert len(front.to_frame()) == len(front)
    assert lw.verify(found).ok
    assert (tmp_path / "front" / "front.csv").is_file()


def test_picks_are_candidates(k18: lw.Result) -> None:
    for which, pick in k18.picks.items():
        assert which in ("smallest", "best-transmission", "buildable")
        assert pick.linkage == k18._run.linkage(which)


def test_import_is_quick_and_loads_no_numpy() -> None:
    # With its bytecode, as pip installs it; processor time, since the machine may be busy.
    code = (
        "import sys, time; t = time.process_time(); import linkwright; s = time.process_time() - t;"
        "print(s, sorted(m for m in ('numpy', 'pandas', 'matplotlib', 'dask', 'tqdm') if m in sys.modules))"
    )
    env = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    runs = [python(code, env=env).stdout.split(maxsplit=1) for _ in range(6)]
    assert all(loaded.strip() == "[]" for _, loaded in runs), runs
    assert min(float(seconds) for seconds, _ in runs) < 0.010, runs
