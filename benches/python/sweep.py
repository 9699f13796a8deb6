"""Compares a sweep of 2,000 problems on a Dask cluster of two workers with `linkwright sweep run` on two threads.

    pip install "./python[dask]"
    python benches/python/sweep.py [JOBS]

The start of the cluster does not count; the runs are interleaved, and the best of three of each is compared. The merged tables
have to be the same bytes.
"""

from __future__ import annotations

import pathlib
import shutil
import sys
import tempfile
import time

import distributed

import linkwright as lw
import linkwright.dask
import linkwright.sweep

PATH = "format = 1\n[task.path]\npoints = [[0, 0], [1, 1], [2, 1.5], [3, 1], [4, 0.2]]\n"
SWEEP = """
format = 1
problem = "path.toml"
[vary]
solve.seed = {{ from = 1, to = {jobs}, steps = {jobs} }}
solve.advice = [false]
solve.evaluations = [2000]
"""
#: The least time of a shard, seconds.
SHARD_S = 0.4


def main() -> int:
    jobs = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "path.toml").write_text(PATH)
        (folder / "sweep.toml").write_text(SWEEP.format(jobs=jobs))
        trial = lw.sweep.plan(folder / "sweep.toml", folder / "trial", shard_size=40)
        begun = time.perf_counter()
        lw.sweep.run(trial.folder, 0, threads=1)
        each = (time.perf_counter() - begun) / 40
        size = max(1, round(SHARD_S / each))
        print(f"{jobs} jobs of {1e3 * each:.1f} ms, shards of {size}")
        times: dict[str, list[float]] = {"two threads": [], "two workers": []}
        tables = set()
        with (
            distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
            distributed.Client(cluster) as client,
        ):
            client.wait_for_workers(2)
            # The workers import the package.
            client.run(lambda: __import__("linkwright.dask"))
            for round_ in range(3):
                for how in times:
                    plan = lw.sweep.plan(folder / "sweep.toml", folder / f"{round_}", shard_size=size)
                    begun = time.perf_counter()
                    if how == "two threads":
                        lw.sweep.run(plan.folder, threads=2)
                    else:
                        lw.dask.sweep(plan, client, merge=False)
                    times[how].append(time.perf_counter() - begun)
                    merged = lw.sweep.merge(plan.folder)
                    assert merged.rows == jobs
                    tables.add(pathlib.Path(merged.csv).read_bytes())
                    shutil.rmtree(plan.folder)
        assert len(tables) == 1
    best = {how: min(found) for how, found in times.items()}
    ratio = best["two workers"] / best["two threads"]
    print({how: [round(t, 2) for t in found] for how, found in times.items()})
    print(f"Dask takes {ratio:.3f} times as long")
    return 0 if ratio <= 1.10 else 1


if __name__ == "__main__":
    sys.exit(main())
