"""Motions of 4 s by the 4DOF model in steps of 1 ms: impactlab against numpy and numba.

    python benches/peers/simulate.py target/release/impactlab

All simulate the 100 cases of datasets/trajectories-fea from their recorded starts and forces with the
vehicle reference-2000, and have to agree within 1 mm at every 10 ms, or nothing is timed. The time of
impactlab is that of the command `simulate` of all cases less that of one case, which reads the same
files; comparing with the records is part of it. Compiling is not counted for numba.
"""

import argparse
import csv
import tempfile
import tomllib
from pathlib import Path

from common import in_turn, of_call, of_command, row

import numpy as np

from vehicle import car, numba_motion, numpy_motions

STATE = ["vx_m_s", "vy_m_s", "yaw_rad", "yaw_rate_rad_s"]
STATE += ["roll_rad", "roll_rate_rad_s", "x_m", "y_m"]
FORCE = ["fx_body_n", "fy_body_n", "mz_nm"]
TOLERANCE_M = 1e-3


def columns(path, names):
    with path.open(newline="") as file:
        rows = csv.DictReader(file)
        return np.array([[float(line[name]) for name in names] for line in rows])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("impactlab", type=Path)
    parser.add_argument("--runs", type=int, default=5)
    arguments = parser.parse_args()
    data = Path(__file__).resolve().parents[2] / "datasets/trajectories-fea"
    program = arguments.impactlab.resolve()
    with (data / "cases.csv").open(newline="") as file:
        cases = {line["case"]: float(line["contact_height_m"]) for line in csv.DictReader(file)}
    records = [data / "trajectories" / f"{case}.csv" for case in cases]
    starts = np.stack([columns(path, STATE)[0] for path in records])
    forces = np.stack([columns(path, FORCE) for path in records])
    heights = np.array(list(cases.values()))
    vehicle = car(tomllib.loads(of_command([program, "vehicles", "reference-2000"])[0].decode()))
    simulate = [program, "simulate", "--dataset", data, "--vehicle", "reference-2000", "--json"]
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "motions"
        of_command([*simulate, "--out", out])
        ours = np.stack([columns(out / f"{case}.csv", STATE) for case in cases])

    def by_numba():
        motions = zip(starts, forces, heights)
        return np.stack([numba_motion(vehicle, *motion) for motion in motions])

    def by_numpy(n):
        start, force = starts[:n].T.copy(), forces[:n].transpose(1, 2, 0).copy()
        return numpy_motions(vehicle, start, force, heights[:n]).transpose(2, 0, 1)

    for name, theirs in ("numba", by_numba()), ("numpy", by_numpy(len(cases))):
        apart = np.hypot(*(ours - theirs)[:, :, 6:].transpose(2, 0, 1)).max()
        print(f"{name}: at most {1e3 * apart:.2g} mm from impactlab", flush=True)
        if not apart <= TOLERANCE_M:
            raise SystemExit(f"{name} computes something else: {apart} m apart")
    measures = [
        lambda: of_command(simulate)[1] - of_command([*simulate, "--case", next(iter(cases))])[1],
        lambda: of_call(by_numba)[1],
        lambda: of_call(lambda: by_numpy(len(cases)))[1],
        lambda: of_call(lambda: by_numpy(1))[1],
    ]
    ours, numba, numpy, numpy_one = in_turn(arguments.runs, measures)
    n = len(cases)
    ours /= n - 1
    row("a motion of 4 s", "numba, one by one", ours, numba / n)
    row("a motion of 4 s", f"numpy, {n} side by side", ours, numpy / n)
    row("a motion of 4 s", "numpy, one car", ours, numpy_one)


main()
