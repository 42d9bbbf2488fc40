"""Other threads of Python run while the program computes, and Ctrl-C ends its work."""

import _thread
import signal
import sys
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest
from conftest import RECONSTRUCTION, SIMULATION

import impactlab


@pytest.fixture(autouse=True)
def no_switching() -> Iterator[None]:
    """A thread goes on until it gives the interpreter away of itself."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1000.0)
    yield
    sys.setswitchinterval(before)


def test_other_threads_run_meanwhile() -> None:
    impactlab.simulate(SIMULATION)
    ticks, ends = 0, False
    runs = threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not ends:
            ticks += 1
            runs.set()
            time.sleep(0.0005)

    thread = threading.Thread(target=tick)
    thread.start()
    runs.wait()
    seen = False
    for _ in range(50):
        before = ticks
        impactlab.simulate(SIMULATION)
        seen = seen or ticks > before
    ends = True
    thread.join()
    # Without a switch the other thread counts only where the call gives the interpreter away.
    assert seen


def test_ctrl_c_ends_the_work() -> None:
    # A shell that runs this in the background has switched the signal off.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        check_is_interrupted()
    finally:
        signal.signal(signal.SIGINT, before)


def check_is_interrupted() -> None:
    impactlab.simulate(SIMULATION)
    held = threading.Lock()
    held.acquire()
    runs = threading.Event()

    def interrupt() -> None:
        runs.set()
        with held:
            _thread.interrupt_main()

    thread = threading.Thread(target=interrupt)
    thread.start()
    runs.wait()
    done: list[Any] = []
    question = {**RECONSTRUCTION, "particles": 2000}
    held.release()
    with pytest.raises(KeyboardInterrupt):
        # If the call came to its end, its result would be in the list before the signal is looked at.
        done.extend(map(impactlab.reconstruct, [question]))
    thread.join()
    assert not done
