"""Ctrl-C ends a long call, and only that."""
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import pytest

import joulepath as jp

LONG = """
import os, signal, threading
import joulepath as jp
robot = jp.Robot.example()
xy = [[k, (k % 2) * 0.5] for k in range(60)]
jobs = [{"robot": robot, "xy": xy, "time_s": 150.0 + k, "nodes": 2000} for k in range(200)]
threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
"""


@pytest.mark.parametrize("call", [
    "[jp.profile(**job) for job in jobs]",
    "jp.map(jp.profile, jobs, threads=2)",
])
def test_interrupt_ends_a_long_call(call):
    code = LONG + textwrap.dedent(f"""
        try:
            {call}
        except KeyboardInterrupt:
            print("interrupted", jp.profile(robot, [[0, 0], [1, 0]]).status)
        """)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300)
    assert done.stdout.split() == ["interrupted", "optimal"], done.stderr


def test_interrupt_is_seen_inside_one_call(scenarios):
    """A mission alone, so that nothing but the call itself can see the signal."""
    handled = []

    def handler(*_):
        handled.append(True)
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, handler)
    timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
    try:
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            jp.plan(scenarios / "missions" / "warehouse_pick.yaml", nodes=2000)
        assert handled
    finally:
        signal.signal(signal.SIGINT, before)


def test_other_threads_run_while_a_plan_is_made(robot):
    """The GIL is released: a Python thread counts while this one is in one call."""
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0)

    thread = threading.Thread(target=count)
    xy = [[k, (k % 2) * 0.5] for k in range(30)]
    path = jp.Path(xy)
    thread.start()
    try:
        before = counted[0]
        jp.profile(robot, path, nodes=1000)
        during = counted[0] - before
    finally:
        stop.set()
        thread.join()
    assert during > 10
