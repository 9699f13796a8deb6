"""Ctrl-C, forks and panics: nothing hangs, nothing is lost, nothing aborts."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import pytest
from conftest import ARC, python

import linkwright as lw

#: The longest life of a child, seconds: it ends by itself if the tests are killed.
LIFE = 180
#: A problem whose search takes minutes. The system's own answer to the alarm ends the child, whatever it is doing. Ctrl-C
#: raises KeyboardInterrupt also where these tests are a shell's background job, which inherits that it is ignored.
LONG = textwrap.dedent(
    f"""
    import linkwright as lw, math, signal
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.alarm({LIFE})
    points = [[math.cos(t) + 0.3 * math.cos(3 * t), math.sin(t) + 0.2 * math.sin(5 * t)]
              for t in (0.1 * i for i in range(60))]
    problem = lw.path(points, solve={{"evaluations": 10**11, "method": "genetic"}})
    """
)


def interrupted(code: str, after: float = 1.5, times: int = 1) -> tuple[int, str, str, float]:
    """Runs code, sends it Ctrl-C when it has said `ready`, and returns its end and the seconds from the signal to it."""
    child = subprocess.Popen(
        [sys.executable, "-u", "-c", LONG + textwrap.dedent(code)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True,
    )  # fmt: skip
    try:
        assert child.stdout is not None
        assert child.stdout.readline() == "ready\n"
        time.sleep(after)
        begun = time.monotonic()
        for _ in range(times):
            os.kill(child.pid, signal.SIGINT)
            time.sleep(0.05)
        out, err = child.communicate(timeout=120)
        return child.returncode, out, err, time.monotonic() - begun
    finally:
        # However the test ends; a child that has ended is not signalled.
        child.kill()
        child.wait()


pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals and forks of POSIX")


def test_ctrl_c_raises_an_interrupt_with_the_best_so_far() -> None:
    code, out, err, seconds = interrupted(
        """
        print("ready")
        try:
            lw.synth(problem)
        except KeyboardInterrupt as interrupt:
            best = interrupt.result
            print(type(best).__name__, best.termination["reason"], len(best.candidates) > 0, lw.verify(best).ok)
        """
    )
    assert (code, out) == (0, "Result cancelled True True\n"), err
    assert seconds < 20, seconds


def test_a_loop_of_searches_can_be_stopped() -> None:
    code, _, err, _ = interrupted(
        """
        print("ready")
        while True:
            lw.synth(lw.path([[0, 0], [1, 1], [2, 1.5], [3, 1]]))
        """
    )
    assert code != 0
    assert "KeyboardInterrupt" in err


def test_an_uncaught_interrupt_ends_the_program_as_python_does() -> None:
    code, _, err, _ = interrupted(
        """
        print("ready")
        lw.synth(problem)
        """
    )
    assert code in (1, 130, -signal.SIGINT)
    assert err.rstrip().endswith("KeyboardInterrupt")


def test_a_handler_of_ones_own_is_obeyed() -> None:
    code, out, err, _ = interrupted(
        """
        import signal
        class Enough(Exception):
            pass
        def stop(number, frame):
            raise Enough("enough")
        signal.signal(signal.SIGINT, stop)
        print("ready")
        try:
            lw.synth(problem)
        except Enough as enough:
            print(enough, enough.result.termination["reason"])
        """
    )
    assert (code, out) == (0, "enough cancelled\n"), err


def test_a_child_does_not_outlive_killed_tests_for_long() -> None:
    life = f"signal.alarm({LIFE})"
    assert life in LONG
    code = LONG.replace(life, "signal.alarm(2)") + "lw.synth(problem)"
    parent = f"import subprocess, sys; child = subprocess.Popen([sys.executable, '-c', {code!r}]); print(child.pid); child.wait()"
    killed = subprocess.Popen([sys.executable, "-u", "-c", parent], stdout=subprocess.PIPE, text=True)
    assert killed.stdout is not None
    # The child holds the pipe's other end: it is at its end when both are gone.
    child = int(killed.stdout.readline())
    killed.kill()
    killed.wait()
    begun = time.monotonic()
    timer = threading.Timer(60, os.kill, (child, signal.SIGKILL))
    timer.start()
    assert killed.stdout.read() == ""
    timer.cancel()
    assert time.monotonic() - begun < 50
    killed.stdout.close()


def test_a_forked_child_searches_with_threads_of_its_own(literature: object) -> None:
    code = f"""
    import linkwright as lw, os, signal
    signal.alarm({LIFE})
    problem = lw.path({ARC})
    alone = lw.synth(problem, threads=2).record_json
    child = os.fork()
    if child == 0:
        signal.alarm({LIFE})
        same = lw.synth(problem, threads=2).record_json == alone
        os._exit(0 if same else 1)
    _, status = os.waitpid(child, 0)
    assert lw.synth(problem, threads=2).record_json == alone
    print(os.waitstatus_to_exitcode(status))
    """
    ran = python(textwrap.dedent(code), cwd=None)
    assert ran.stdout == "0\n", ran.stderr


def test_children_forked_in_the_middle_of_searches_do_not_hang() -> None:
    code = f"""
    import linkwright as lw, os, signal, threading
    signal.alarm({LIFE})
    problem = lw.path({ARC})
    alone = lw.synth(problem).record_json
    stop = False
    def busy():
        while not stop:
            lw.synth(problem, threads=2)
    threads = [threading.Thread(target=busy) for _ in range(2)]
    for thread in threads:
        thread.start()
    ends = []
    for _ in range(10):
        child = os.fork()
        if child == 0:
            signal.alarm({LIFE})
            os._exit(0 if lw.synth(problem, threads=2).record_json == alone else 1)
        ends.append(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
    stop = True
    for thread in threads:
        thread.join()
    print(sum(ends))
    """
    ran = python(textwrap.dedent(code))
    assert ran.stdout == "0\n", ran.stderr


@pytest.mark.parametrize("panic", ["_panic", "_panic_here"])
def test_a_panic_is_an_exception_and_the_next_call_works(panic: str, capfd: pytest.CaptureFixture[str]) -> None:
    from linkwright import _linkwright

    with pytest.raises(lw.InternalError, match="this is a bug of linkwright.*a test of the border"):
        getattr(_linkwright, panic)()
    assert issubclass(lw.InternalError, Exception)
    assert len(lw.synth(lw.path(ARC))) > 0
