"""What the scripts share: processor time of this process and of commands, on one thread each."""

import os
import resource
import statistics
import subprocess
import time

THREADS = ["RAYON", "OMP", "OPENBLAS", "MKL", "NUMBA"]
os.environ |= {f"{name}_NUM_THREADS": "1" for name in THREADS}
os.environ |= {"POLARS_MAX_THREADS": "1", "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false"}


def of_command(arguments):
    """Output of a command and its processor time, s; exit code 1 is that of a check with flags."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(of) for of in arguments], stdout=subprocess.PIPE)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in (0, 1) or not done.stdout:
        raise SystemExit(f"{arguments}: exit code {done.returncode}")
    spent = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    return done.stdout, spent


def of_call(call):
    """Result of a function and its processor time, s."""
    began = time.process_time()
    result = call()
    return result, time.process_time() - began


def in_turn(runs, measures):
    """Medians of the times that several functions give, each asked once in every round."""
    times = [[measure() for measure in measures] for _ in range(runs)]
    return [statistics.median(of) for of in zip(*times)]


def shown(seconds):
    return f"{seconds:.2f} s" if seconds >= 1 else f"{1e3 * seconds:.3g} ms"


def row(what, peer, ours, theirs):
    """A row of Markdown; the ratio is ours over the peer's."""
    print(f"| {what} | {peer} | {shown(ours)} | {shown(theirs)} | {ours / theirs:.3g} |", flush=True)
