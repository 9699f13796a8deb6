"""Simulates a sweep on a Dask cluster: how large shards have to be, and what scheduler and shared file system bear.

A task costs the scheduler a share of its one thread (measured: 0.65 to 0.94 ms; 2 ms are assumed as the worst), half
of it when the task is handed out and half when its end is reported. Each worker runs one shard at a time and holds a
queue of its own, so that it need not wait for the scheduler between two shards. The time of a shard varies from one to
the next (lognormal). Efficiency is the work of all shards over workers times the time from start to end.

    python benches/python/cluster.py                 # the tables of docs/python.md
    python benches/python/cluster.py --problems 1e6 --workers 200 --problem-ms 40

Nothing but the standard library is needed.
"""

from __future__ import annotations

import argparse
import heapq
import math
import random


def efficiency(
    workers: int, shards: int, shard_s: float, task_ms: float, spread: float, queue: int, seed: int = 1
) -> float:
    """Returns the efficiency of a sweep, by discrete events."""
    draw = random.Random(seed)
    # Lognormal with mean 1: the mean of exp(N(m, s)) is exp(m + s^2/2).
    lengths = [shard_s * math.exp(draw.gauss(-spread * spread / 2, spread)) for _ in range(shards)]
    cost = task_ms / 1000 / 2
    # The scheduler's work, first come first served: (ready, order, kind, worker).
    inbox: list[tuple[float, int, str, int]] = []
    order = 0
    # One task for each worker first, then the second ones, as workers ask.
    for _ in range(1 + queue):
        for worker in range(workers):
            heapq.heappush(inbox, (0.0, order, "hand out", worker))
            order += 1
    free_at = [0.0] * workers
    busy_until = end = 0.0
    given = 0
    while inbox:
        ready, _, kind, worker = heapq.heappop(inbox)
        now = max(ready, busy_until)
        busy_until = now + cost
        if kind == "report":
            end = max(end, busy_until)
            heapq.heappush(inbox, (busy_until, order, "hand out", worker))
            order += 1
        elif given < shards:
            # The worker begins it when it has ended the ones before.
            begun = max(busy_until, free_at[worker])
            free_at[worker] = begun + lengths[given]
            given += 1
            heapq.heappush(inbox, (free_at[worker], order, "report", worker))
            order += 1
    assert given == shards
    return sum(lengths) / (workers * end)


def check() -> None:
    """Cases with a known answer."""
    # One worker, no scheduler: nothing is lost.
    assert abs(efficiency(1, 100, 1.0, 0.0, 0.0, 1) - 1.0) < 1e-12
    # A scheduler of 2 ms a task hands out 500 shards a second: 1,000 workers with shards of 1 s are half idle.
    assert abs(efficiency(1000, 100_000, 1.0, 2.0, 0.0, 1) - 0.5) < 0.01
    # 150 shards of one length on 100 workers take two rounds.
    assert abs(efficiency(100, 150, 10.0, 0.0, 0.0, 0) - 0.75) < 1e-9


def table(heads: list[str], rows: list[list[str]]) -> str:
    """Returns rows as Markdown."""
    lines = ["| " + " | ".join(heads) + " |", "|" + " ---: |" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--problems", type=float, default=1e7)
    parser.add_argument("--workers", type=int, default=1000)
    parser.add_argument("--problem-ms", type=float, default=25.0, help="time of a problem on one thread")
    parser.add_argument("--row-bytes", type=float, default=600.0, help="a job's line in shards/K.jsonl")
    parser.add_argument("--task-ms", type=float, nargs="+", default=[0.94, 2.0], help="the scheduler's cost of a task")
    parser.add_argument("--spread", type=float, default=0.25, help="standard deviation of the logarithm of a shard's time")
    parser.add_argument("--queue", type=int, default=1, help="shards that wait at a worker")
    parser.add_argument("--file-operations", type=float, default=6.0, help="metadata operations of a shard's file")
    a = parser.parse_args()
    check()
    work_s = a.problems * a.problem_ms / 1000
    print(f"{a.problems:.0f} problems of {a.problem_ms:g} ms: {work_s / 3600:.1f} hours of one core, "
          f"{work_s / a.workers / 60:.1f} minutes of {a.workers}\n")
    rows = []
    for shard_s in (0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0):
        shards = max(1, round(work_s / shard_s))
        # Beyond 100 shards a worker the efficiency does not change, and the simulation takes long.
        simulated = min(shards, 200 * a.workers)
        found = [efficiency(a.workers, simulated, shard_s, task, a.spread, a.queue) for task in a.task_ms]
        problems = a.problems / shards
        minutes = work_s / a.workers / found[-1] / 60
        rate = shards / (60 * minutes)
        rows.append([
            f"{shard_s:g}", f"{problems:.0f}", f"{shards:,}", f"{shards / a.workers:.0f}",
            *(f"{e:.3f}" for e in found), f"{minutes:.1f}", f"{rate:.0f}",
            f"{rate * problems * a.row_bytes / 1e6:.2f}", f"{rate * a.file_operations:.0f}",
        ])  # fmt: skip
    heads = ["shard, s", "problems a shard", "shards", "shards a worker",
             *(f"efficiency at {task:g} ms" for task in a.task_ms),
             "minutes", "shards a second", "MB a second", "file operations a second"]  # fmt: skip
    print(table(heads, rows))
    print("\nThe tail: shards of 5 s and what is lost while the last ones run.\n")
    rows = [
        [str(each), f"{efficiency(a.workers, each * a.workers, 5.0, a.task_ms[0], a.spread, a.queue):.3f}"]
        for each in (5, 10, 20, 50, 100, 200)
    ]
    print(table(["shards a worker", "efficiency"], rows))


if __name__ == "__main__":
    main()
