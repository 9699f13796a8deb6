"""Sweeps on Dask clusters: workers that are killed, schedulers and clients that go away, in any order."""

from __future__ import annotations

import os
import random
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import linkwright as lw
import linkwright.sweep

distributed = pytest.importorskip("distributed")
import linkwright.dask  # noqa: E402

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")

PATH = "format = 1\n[task.path]\npoints = [[0, 0], [1, 1], [2, 1.5], [3, 1], [4, 0.2], [5, -1]]\n"
#: 40 shards of some tenths of a second.
SWEEP = """
format = 1
problem = "path.toml"
[vary]
solve.seed = {{ from = 1, to = {jobs}, steps = {jobs} }}
solve.advice = [false]
solve.evaluations = [20000]
"""


def planned(folder: Path, jobs: int, size: int) -> lw.sweep.Plan:
    (folder / "path.toml").write_text(PATH)
    (folder / "sweep.toml").write_text(SWEEP.format(jobs=jobs))
    return lw.sweep.plan(folder / "sweep.toml", folder / "out", shard_size=size)


class Starts(distributed.WorkerPlugin):  # type: ignore[misc, name-defined]
    """Notes each task that begins in a file."""

    def __init__(self, file: str) -> None:
        self.file = file

    def setup(self, worker: object) -> None:
        self.worker = worker

    def transition(self, key: str, start: str, finish: str, **more: object) -> None:
        if finish == "executing" and str(key).startswith("linkwright-"):
            with open(self.file, "a") as file:
                file.write(f"{key}\n")


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, bytes]:
    """The merged table of the sweep, run without a cluster."""
    folder = tmp_path_factory.mktemp("alone")
    plan = planned(folder, 40, 2)
    lw.sweep.run(plan.folder)
    merged = lw.sweep.merge(plan.folder)
    return Path(merged.csv).read_bytes(), Path(merged.jsonl).read_bytes()


def bytes_of(merged: lw.sweep.Merged | None) -> tuple[bytes, bytes]:
    assert merged is not None
    return Path(merged.csv).read_bytes(), Path(merged.jsonl).read_bytes()


@pytest.fixture
def cluster() -> Iterator[object]:
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50, processes=True
    ) as made:
        yield made


def test_a_cluster_of_its_own_gives_the_table(tmp_path: Path, expected: tuple[bytes, bytes]) -> None:
    plan = planned(tmp_path, 40, 2)
    told: list[dict[str, object]] = []
    merged = lw.dask.sweep(plan.folder, progress=told.append)
    assert bytes_of(merged) == expected
    assert told[-1] == {"phase": "sweep", "done": 20, "total": 20}
    # Nothing is left to do, and no cluster is started.
    begun = time.monotonic()
    assert bytes_of(lw.dask.sweep(plan)) == expected
    assert time.monotonic() - begun < 2


def test_workers_that_are_killed_cost_a_start_each(
    cluster: object, tmp_path: Path, expected: tuple[bytes, bytes]
) -> None:
    plan = planned(tmp_path, 40, 2)
    starts = tmp_path / "starts"
    kills = 3
    with distributed.Client(cluster) as client:
        client.register_plugin(Starts(str(starts)))
        ended = threading.Event()
        killed: list[int] = []

        def kill() -> None:
            # One worker after the other, by the id that it says it has.
            while len(killed) < kills and not ended.is_set():
                time.sleep(0.7)
                pids = list(client.run(os.getpid).values())
                victim = random.Random(len(killed)).choice(pids)
                os.kill(victim, signal.SIGKILL)
                killed.append(victim)
                while len(client.nthreads()) < 2 and not ended.is_set():
                    time.sleep(0.1)

        killer = threading.Thread(target=kill)
        killer.start()
        try:
            merged = lw.dask.sweep(plan, client)
        finally:
            ended.set()
            killer.join()
    assert bytes_of(merged) == expected
    begun = starts.read_text().splitlines()
    assert plan.shards <= len(begun) <= plan.shards + len(killed), (len(begun), len(killed))
    assert killed


def test_complete_shards_are_not_run_again(cluster: object, tmp_path: Path, expected: tuple[bytes, bytes]) -> None:
    plan = planned(tmp_path, 40, 2)
    for shard in (0, 7, 19):
        lw.sweep.run(plan.folder, shard)
    starts = tmp_path / "starts"
    with distributed.Client(cluster) as client:
        client.register_plugin(Starts(str(starts)))
        merged = lw.dask.sweep(plan, client)
    assert bytes_of(merged) == expected
    assert len(starts.read_text().splitlines()) == plan.shards - 3


def test_a_fault_of_a_shard_is_raised_with_its_text(cluster: object, tmp_path: Path) -> None:
    plan = planned(tmp_path, 4, 2)
    shards = Path(plan.folder) / "shards"
    if shards.exists():
        shards.rmdir()
    shards.write_text("a file in the place of the folder")
    with distributed.Client(cluster) as client, pytest.raises(lw.ProblemError, match="shards"):
        lw.dask.sweep(plan, client)


def free_port() -> int:
    with socket.socket() as made:
        made.bind(("127.0.0.1", 0))
        port: int = made.getsockname()[1]
        return port


class Outside:
    """A scheduler and workers as processes of their own."""

    def __init__(self) -> None:
        self.address = f"tcp://127.0.0.1:{free_port()}"
        self.processes: list[subprocess.Popen[bytes]] = []

    def begin(self, words: list[str]) -> subprocess.Popen[bytes]:
        program = [sys.executable, "-m", "distributed.cli." + words[0], *words[1:]]
        process = subprocess.Popen(program, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.processes.append(process)
        return process

    def scheduler(self) -> subprocess.Popen[bytes]:
        port = self.address.rsplit(":", 1)[1]
        return self.begin(["dask_scheduler", "--host", "127.0.0.1", "--port", port, "--no-dashboard", "--no-jupyter"])

    def worker(self) -> subprocess.Popen[bytes]:
        # Without a nanny: a process that is killed is gone, as on a machine that fails.
        return self.begin(["dask_worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard"])

    def end(self) -> None:
        for process in self.processes:
            process.kill()
            process.wait()


@pytest.fixture
def outside() -> Iterator[Outside]:
    made = Outside()
    try:
        yield made
    finally:
        made.end()


def runner(folder: str, address: str) -> subprocess.Popen[str]:
    """`python -m linkwright.dask run` as a process of its own."""
    words = [sys.executable, "-m", "linkwright.dask", "run", folder, "--scheduler", address, "--quiet"]
    return subprocess.Popen([*words, "--patience", "60"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def wait_for_shards(folder: str, least: int, seconds: float = 60.0) -> None:
    deadline = time.monotonic() + seconds
    shards = Path(folder) / "shards"
    while time.monotonic() < deadline:
        if shards.is_dir() and len(list(shards.glob("*.jsonl"))) >= least:
            return
        time.sleep(0.02)
    raise AssertionError(f"no {least} shards within {seconds} s")


def test_a_scheduler_and_a_client_that_are_restarted_lose_nothing(
    outside: Outside, tmp_path: Path, expected: tuple[bytes, bytes]
) -> None:
    plan = planned(tmp_path, 40, 2)
    scheduler, workers = outside.scheduler(), [outside.worker(), outside.worker()]
    first = runner(plan.folder, outside.address)
    wait_for_shards(plan.folder, 3)
    # The client goes away.
    first.kill()
    first.communicate()
    before = set(lw.sweep.open(plan.folder).missing())
    second = runner(plan.folder, outside.address)
    wait_for_shards(plan.folder, plan.shards - len(before) + 2)
    # The scheduler goes away, and its workers with it.
    for process in (scheduler, *workers):
        process.kill()
        process.wait()
    outside.scheduler()
    outside.worker()
    outside.worker()
    out, err = second.communicate(timeout=180)
    assert second.returncode == 0, err
    assert out.strip().endswith("of 40 jobs have an accepted candidate")
    assert bytes_of(lw.sweep.merge(plan.folder)) == expected


@pytest.mark.parametrize("seed", range(int(os.environ.get("DASK_PROPERTY_CASES", "2"))))
def test_whatever_goes_away_in_whatever_order_the_table_is_the_same(
    seed: int, outside: Outside, tmp_path: Path, expected: tuple[bytes, bytes]
) -> None:
    """Kills a worker, the scheduler or the client at random, again and again."""
    draw = random.Random(seed)
    plan = planned(tmp_path, 40, 2)
    scheduler, workers = outside.scheduler(), [outside.worker() for _ in range(2)]
    client = runner(plan.folder, outside.address)
    events = []
    for _ in range(4):
        try:
            wait_for_shards(plan.folder, plan.shards - len(plan.missing()) + draw.randint(1, 3), 30)
        except AssertionError:
            break
        event = draw.choice(["worker", "scheduler", "client"])
        events.append(event)
        if event == "worker":
            gone = workers.pop(draw.randrange(len(workers)))
            gone.kill()
            gone.wait()
            workers.append(outside.worker())
        elif event == "scheduler":
            for process in (scheduler, *workers):
                process.kill()
                process.wait()
            scheduler, workers = outside.scheduler(), [outside.worker() for _ in range(2)]
        else:
            client.kill()
            client.communicate()
            client = runner(plan.folder, outside.address)
    out, err = client.communicate(timeout=240)
    assert client.returncode == 0, (events, err)
    assert bytes_of(lw.sweep.merge(plan.folder)) == expected, events
    # A row for each job, none twice.
    frame = lw.sweep.merge(plan.folder).to_frame()
    assert list(frame["job"]) == list(range(40))


def test_the_command_refuses_what_is_no_plan(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert lw.dask.main(["run", str(tmp_path)]) == 2
    assert "holds no plan of a sweep" in capsys.readouterr().err
