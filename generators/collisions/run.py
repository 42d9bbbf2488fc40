"""Computes sampled collisions with OpenRadioss, several side by side, and goes on where it was stopped.

    python3 run.py WORK --solver OpenRadioss [--cases 264] [--seed 20261127] [--prefix d] [--jobs 2]

Each case has its folder in WORK. A case is finished when it has a `done.json`; a run that is stopped begins
that case anew. Cases whose balances do not hold are named in `done.json` and left out by collect.py.
"""

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from pathlib import Path

import numpy as np

import radioss
import scenarios
from history import Histories
from collect import present
from model import Model
from results import Result

LONGEST_S = 0.4
# Cars that have touched and whose impulse has been constant for so long are separated, s.
QUIET_S = 0.015
# Mean force over an interval of the histories from which on the cars are in contact, N.
CONTACT_FORCE_N = 100.0
# A run that takes longer is given up, s of wall time.
LONGEST_WALL_S = 2400
LOOK_EVERY_S = 4
STARTER, ENGINE = PROGRAMS = ("starter_linux64_gf", "engine_linux64_gf_smp")


def is_separated(path):
    """Whether the cars have touched and come apart, by the histories that are written so far."""
    try:
        histories = Histories.read(path)
        gained = np.abs(np.diff(histories.group("contact").values[:, 0:2, 0:6], axis=0)).sum((1, 2))
    except (OSError, EOFError, StopIteration, ValueError, IndexError):
        return False
    steps = np.diff(histories.time)
    touching = np.flatnonzero(gained > CONTACT_FORCE_N * steps)
    if len(touching) < 5 or histories.time[-1] < .03:
        return False
    return histories.time[-1] - histories.time[touching[-1] + 1] > QUIET_S


def solve(folder, name, solver):
    """Runs starter and engine; ends the engine when the cars are separated. Returns seconds of wall time."""
    began, exe = time.time(), solver / "exec"
    environment = dict(os.environ, RAD_CFG_PATH=str(solver / "hm_cfg_files"), LD_LIBRARY_PATH=str(exe),
                       OMP_NUM_THREADS="1", OMP_STACKSIZE="400m")

    def command(program, deck):
        return ["bash", "-c", f'ulimit -s unlimited; exec "$0" "$@"', str(exe / program), "-i", deck]

    with open(folder / "run.log", "w") as log:
        subprocess.run(command(STARTER, f"{name}_0000.rad") + ["-np", "1"], cwd=folder, env=environment,
                       stdout=log, stderr=subprocess.STDOUT, timeout=600, check=False)
        if not (folder / f"{name}_0000_0001.rst").exists():
            raise RuntimeError(f"{name}: the starter refuses the deck, see {folder / (name + '_0000.out')}")
        engine = subprocess.Popen(command(ENGINE, f"{name}_0001.rad"), cwd=folder, env=environment, stdout=log,
                                  stderr=subprocess.STDOUT)
        while engine.poll() is None:
            try:
                engine.wait(LOOK_EVERY_S)
            except subprocess.TimeoutExpired:
                too_long = time.time() - began > LONGEST_WALL_S
                if too_long or is_separated(folder / f"{name}T01"):
                    engine.send_signal(signal.SIGTERM)
                    engine.wait()
    return time.time() - began


def compute(collision, work, solver, parts=1):
    """Computes one case unless it is finished. Returns what is said of it."""
    folder = work / collision.name
    done = folder / "done.json"
    if done.exists() and json.loads(done.read_text())["case"] == json.loads(json.dumps(asdict(collision))):
        return "finished before"
    shutil.rmtree(folder, ignore_errors=True)
    model = Model(collision.name, scenarios.placed(collision.mirrored(), parts))
    radioss.write(model, folder, LONGEST_S)
    seconds = solve(folder, collision.name, solver)
    result = Result.read(folder, collision.name)
    balances = result.balances()
    told = dict(case=asdict(collision), wall_s=seconds, end_s=float(result.time[-1]), balances=balances)
    for file in folder.iterdir():
        if file.suffix == ".rst" or "A0" in file.name:
            file.unlink()
    waiting = folder / "done.json.part"
    waiting.write_text(json.dumps(told, indent=1, default=float))
    waiting.rename(done)
    size = np.hypot(*result.impulse[-1, :2])
    return (f"{seconds:.0f} s, to {told['end_s']:.3f} s, impulse {size:.0f} N s, "
            f"energy {balances['energy_error_max_percent']:.2f} %")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("work", type=Path)
    parser.add_argument("--solver", type=Path, required=True, help="the folder of OpenRadioss")
    parser.add_argument("--cases", type=int, default=264)
    parser.add_argument("--seed", type=int, default=20261127)
    parser.add_argument("--prefix", default="d")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", nargs="*", help="names of cases")
    parser.add_argument("--have", type=Path, nargs="*", default=[], help="data sets whose cases are not computed again")
    args = parser.parse_args()
    for program in PROGRAMS:
        if not (args.solver / "exec" / program).is_file():
            parser.error(f"{args.solver / 'exec' / program} is not there; build_openradioss.sh compiles it")
    cases = scenarios.sample(args.cases, args.seed, args.prefix)
    finished = {name for dataset in args.have for name in present(dataset, cases)}
    cases = [case for case in cases if case.name not in finished]
    if args.only:
        cases = [case for case in cases if case.name in args.only]
    failed = []

    def one(case):
        try:
            told = compute(case, args.work, args.solver.resolve())
        except Exception as error:  # noqa: BLE001: the other cases go on
            failed.append(case.name)
            told = f"failed: {error}"
        print(time.strftime("%H:%M:%S"), case.name, case.kind, told, flush=True)

    with ThreadPoolExecutor(args.jobs) as pool:
        list(pool.map(one, cases))
    sys.exit(f"failed: {', '.join(failed)}" if failed else 0)


if __name__ == "__main__":
    main()
