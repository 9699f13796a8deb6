"""Sweeps on a Dask cluster: on this machine, under Slurm, on Kubernetes, in a cloud.

A shard is a task. Its file on the shared folder is the result; the task returns its digest and counts alone. Futures are
released as they complete, and shards whose files are there are not run again, so that a worker that dies costs the shard
that it was running, and a scheduler or a client that goes away costs nothing that was complete.

    python -m linkwright.dask run DIR [--scheduler ADDRESS]
"""

from __future__ import annotations

import logging
import os
import sys
import time
from collections import deque
from typing import TYPE_CHECKING, Any

from . import _linkwright
from . import sweep as _sweep

if TYPE_CHECKING:
    from collections.abc import Callable

    from distributed import Client

__all__ = ["run_shard", "sweep"]

_log = logging.getLogger("linkwright.dask")

#: Tasks on their way for each thread of the cluster: enough that no worker waits for the client.
_AHEAD = 4
#: A shard on which so many workers died is not tried again.
_MOST_DEATHS = 5
#: Seconds between two looks at how many threads there are.
_LOOK_EVERY = 5.0


def run_shard(folder: str, shard: int) -> dict[str, Any]:
    """Runs a shard, unless its file is there and whole: the task of a worker. One thread."""
    rows, accepted, bugs, ran, _ = _linkwright.sweep_run(folder, shard, 1, None)
    return {"shard": shard, "rows": rows, "accepted": accepted, "bugs": bugs, "ran": ran}


def sweep(
    plan: Any,
    client: Client | None = None,
    *,
    progress: Callable[[dict[str, Any]], object] | bool | None = None,
    patience_s: float = 300.0,
    merge: bool = True,
) -> _sweep.Merged | None:
    """Runs the missing shards of a plan on a cluster and merges all.

    Args:
        plan: a folder with ``plan.json`` (:func:`linkwright.sweep.plan`), or the plan. All workers must see the folder
            under this path.
        client: a Dask client; where silent, a cluster on this machine with a worker of one thread for each core.
        progress: True for a bar, or a function that is called with a dict (``done``, ``total``, counted in shards).
        patience_s: how long a scheduler that went away is waited for.
        merge: whether the shards are merged at the end.

    Returns:
        The table in the order of the jobs; None without `merge`.

    Raises:
        ProblemError: there is no such plan, or a worker cannot use the folder.
        RuntimeError: the scheduler did not come back in time, or a shard ended the life of several workers.
    """
    if not isinstance(plan, _sweep.Plan):
        plan = _sweep.open(plan)
    callback, close = _listener(progress)
    try:
        if client is not None:
            _run(plan, client, callback, patience_s)
        elif plan.missing():
            from distributed import Client as New
            from distributed import LocalCluster

            # Workers of one thread each: one that dies takes one shard with it.
            here = {
                "n_workers": os.cpu_count() or 1, "threads_per_worker": 1, "dashboard_address": None,
                "silence_logs": logging.ERROR,
            }  # fmt: skip
            with LocalCluster(**here) as cluster, New(cluster, set_as_default=False) as own:
                _run(plan, own, callback, patience_s)
    finally:
        close()
    return _sweep.merge(plan.folder) if merge else None


def _listener(progress: Any) -> tuple[Callable[[dict[str, Any]], object], Callable[[], None]]:
    from ._result import listener

    callback, close = listener(progress, "sweep")
    return callback or (lambda told: None), close


class _Deaths:
    """The workers that died on each shard."""

    def __init__(self) -> None:
        self.of: dict[int, int] = {}

    def count(self, shard: int, why: BaseException) -> None:
        self.of[shard] = self.of.get(shard, 0) + 1
        if self.of[shard] >= _MOST_DEATHS:
            raise RuntimeError(
                f"shard {shard} was tried {_MOST_DEATHS} times and ended the life of its worker each time; look at the "
                f"workers' logs and memory, and run it alone: linkwright sweep run DIR --shard {shard}"
            ) from why


def _run(
    plan: _sweep.Plan, client: Client, told: Callable[[dict[str, Any]], object], patience_s: float
) -> None:
    from distributed import as_completed

    missing = deque(plan.missing())
    done = plan.shards - len(missing)
    deaths = _Deaths()
    attempts: dict[int, int] = {}
    told({"phase": "sweep", "done": done, "total": plan.shards})
    while missing:
        _wait_for_scheduler(client, patience_s)
        flying: dict[Any, tuple[int, Any]] = {}
        completed = as_completed(loop=client.loop)
        room, looked = _room(client), time.monotonic()
        try:
            while missing or flying:
                while missing and len(flying) < room:
                    shard = missing.popleft()
                    # The same name from another client is the same task; a later attempt is another one.
                    key = f"linkwright-{plan.digest[:16]}-{shard}-{attempts.get(shard, 0)}"
                    attempts[shard] = attempts.get(shard, 0) + 1
                    future = client.submit(run_shard, plan.folder, shard, key=key, pure=False, retries=2)
                    flying[future.key] = (shard, future)
                    completed.add(future)
                future = next(completed)
                shard, _ = flying.pop(future.key)
                ended = _outcome(future)
                # Its result is on the disk: a worker that dies later must not make it again.
                future.release()
                if ended is None:
                    done += 1
                    told({"phase": "sweep", "done": done, "total": plan.shards})
                elif isinstance(ended, _Lost):
                    missing.append(shard)
                    break
                else:
                    deaths.count(shard, ended)
                    missing.append(shard)
                if time.monotonic() - looked > _LOOK_EVERY:
                    room, looked = _room(client), time.monotonic()
        finally:
            if flying:
                _let_go(client, [future for _, future in flying.values()])
        if flying:
            # The scheduler went away with what it knew. What was complete is on the disk.
            missing = deque(plan.missing())
            done = plan.shards - len(missing)
            _log.warning("the scheduler was lost: %d shards are missing", len(missing))
    left = plan.missing()
    if left:
        raise RuntimeError(
            f"{len(left)} shards were run and their files are not in {plan.folder}: do all workers see this folder?"
        )


class _Lost(Exception):
    """The scheduler forgot the task: it was restarted, or the connection was cut."""


def _outcome(future: Any) -> BaseException | None:
    """Returns None for a complete shard, else what to do about it; raises what a retry cannot mend."""
    from distributed import KilledWorker

    if future.status == "finished":
        return None
    if future.status != "error":
        return _Lost()
    error: BaseException = future.exception(timeout=10)
    if not isinstance(error, KilledWorker):
        raise error
    died: BaseException = error
    return died


def _room(client: Client) -> int:
    try:
        threads = int(sum(client.nthreads().values()))
    except (OSError, TimeoutError):
        threads = 1
    return _AHEAD * max(threads, 1)


def _let_go(client: Client, futures: list[Any]) -> None:
    """Cancels tasks that nobody waits for any more; a scheduler that is not there forgets them by itself."""
    if client.status == "running":
        try:
            client.cancel(futures, force=True)
        except (OSError, TimeoutError) as gone:
            _log.debug("not cancelled: %s", gone)
    for future in futures:
        future.release()


def _wait_for_scheduler(client: Client, patience_s: float) -> None:
    """Waits until the client is connected and there is a worker."""
    deadline = time.monotonic() + patience_s
    while time.monotonic() < deadline:
        if client.status == "running":
            try:
                if client.nthreads():
                    return
            except (OSError, TimeoutError):
                pass
        elif client.status == "closed":
            break
        time.sleep(0.1)
    raise RuntimeError(
        f"no scheduler with a worker within {patience_s:g} s; the shards that are complete stay, and the same call goes "
        "on from there"
    )


def main(words: list[str] | None = None) -> int:
    """Runs the command line ``python -m linkwright.dask``; returns the exit code."""
    import argparse

    parser = argparse.ArgumentParser(prog="python -m linkwright.dask", description="Runs sweeps on a Dask cluster.")
    commands = parser.add_subparsers(dest="command", required=True)
    run = commands.add_parser("run", help="run the missing shards of a plan and merge all")
    run.add_argument("folder", metavar="DIR", help="the folder of `linkwright sweep plan`, which all workers see")
    run.add_argument("--scheduler", metavar="ADDRESS", help="such as tcp://10.0.0.1:8786; else a cluster on this machine")
    run.add_argument("--patience", type=float, default=300.0, metavar="SECONDS", help="wait so long for the scheduler")
    run.add_argument("--no-merge", action="store_true", help="leave the merging to `linkwright sweep merge`")
    run.add_argument("--quiet", action="store_true", help="no progress")
    asked = parser.parse_args(words)
    client = None
    try:
        plan = _sweep.open(asked.folder)
        if asked.scheduler:
            from distributed import Client

            client = Client(asked.scheduler, timeout=asked.patience, set_as_default=False)
        merged = sweep(
            plan, client, progress=not asked.quiet, patience_s=asked.patience, merge=not asked.no_merge
        )
    except (_linkwright.ProblemError, RuntimeError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted: the shards that are complete stay; the same command goes on from there", file=sys.stderr)
        return 130
    finally:
        if client is not None:
            client.close()
    if merged is not None:
        print(f"{merged.csv}: {merged.accepted} of {merged.rows} jobs have an accepted candidate")
    return 0


if __name__ == "__main__":
    sys.exit(main())
