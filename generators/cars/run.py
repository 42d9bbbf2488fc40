"""Makes the cars of a seed and computes their motions, and goes on where it was stopped.

    python3 run.py WORK --driver OUT/drive_car --chrono-data OUT/chrono/data/vehicle [--cars 60]
                   [--seed 20261128] [--jobs 2] [--only car-017 ...] [--have DATA ...]

Each car has its folder in WORK: `build.json` when it is described and tuned, `figures.json` and
`vehicle.toml` when it is measured, `motions/NAME.csv` and `motions/NAME.json` for each motion, `checks.json`
for every fourth car, whose first motion is computed with a halved step and in a mirror too. Every file is
there whole or not at all; what is there is not computed again, unless the car or the motion is another one
than that of its file. Several runners may work in one WORK: a car belongs to one at a time.
"""

import argparse
import fcntl
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import cars
import layouts
import motions
import records
from description import save
from preparation import prepare, read_json, same
from solver import drive

# What a motion must keep: momentum that no force explains over the impulse; energy that no work explains over
# the energy at the start and the work of the pulse.
MOMENTUM_LIMIT, ENERGY_LIMIT = 1e-3, 4e-3
# Checks of the model: mean distance over the path with a halved step, and of the mirror image for a car
# without a rod or a drag link across, m.
CHECKED_EVERY = 4
HALVED_LIMIT, MIRROR_LIMIT_M = 0.02, 0.05
STEP_S = 5e-4


def refusal(told):
    """Why a motion is left out; None for one that is used."""
    if told["diverged"]:
        return "diverges"
    impulse = (told["impulse_n_s"][0]**2 + told["impulse_n_s"][1]**2)**0.5
    momentum = told["momentum_residual_n_s"] / impulse
    turned = told["start_energy_j"] + abs(told["work_of_outer_forces_j"])
    energy = abs(told["energy_residual_j"]) / turned
    balances = ("momentum", momentum, MOMENTUM_LIMIT), ("energy", energy, ENERGY_LIMIT)
    broken = [f"{name} {value:.2e}" for name, value, limit in balances if not value <= limit]
    return ", ".join(broken) or None


def refusal_of_car(folder):
    """Why a car is left out; None for one that is used or not checked."""
    figures = read_json(folder / "figures.json")
    if figures and "refused" in figures:
        return figures["refused"]
    checks = read_json(folder / "checks.json")
    if not checks:
        return None
    broken = []
    if not checks["halved_step_over_path"] <= HALVED_LIMIT:
        broken.append(f"halved step {checks['halved_step_over_path']:.4f}")
    if checks["is_symmetric"] and not checks["mirror_m"] <= MIRROR_LIMIT_M:
        broken.append(f"mirror image {checks['mirror_m']:.3f} m")
    return ", ".join(broken) or None


class Work:
    """Where the cars are computed, and with what."""

    def __init__(self, folder, driver, chrono_data, seed):
        self.folder, self.driver, self.seed = folder, driver, seed
        self.library = layouts.Library(chrono_data)

    def car(self, index, report):
        """All of a car that is not there yet, unless another runner is at it."""
        car = cars.car(index, self.seed)
        with open(self.folder / f"{car.name}.lock", "w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                report(car.name, "is computed by another runner")
                return
            self.compute(car, report)

    def compute(self, car, report):
        """Builds, measures, drives and checks a car. A car that no data sheet describes is not driven."""
        folder = self.folder / car.name
        prepare(car, folder, self.library, self.driver, report)
        if not (folder / "vehicle.toml").exists():
            return
        table = read_json(folder / "car.json")["steering_table"]
        requests = {motion.name: motion.request(table) for motion in motions.sample(car, self.seed)}
        for name, request in requests.items():
            self.motion(folder, name, request, report)
        if car.index % CHECKED_EVERY == 0:
            self.checks(car, folder, requests, report)

    def motion(self, folder, name, request, report):
        record = folder / "motions" / f"{name}.csv"
        answer = record.with_suffix(".json")
        before = read_json(answer)
        if before and same(before["request"], request):
            return
        began = time.time()
        try:
            told = drive(self.driver, folder, request, record)
        except RuntimeError as error:
            told = {"failed": str(error)}
        told |= {"request": request, "wall_s": time.time() - began}
        told["refused"] = told["failed"] if "failed" in told else refusal(told)
        save(answer, told)
        report(name, f"{told['wall_s']:.0f} s, {told['refused'] or 'balances hold'}")

    def checks(self, car, folder, requests, report):
        if (folder / "checks.json").exists():
            return
        name, request = next(iter(requests.items()))
        usual = records.usable(folder / "motions" / f"{name}.csv", request).record
        other = {}
        changes = {"halved": {**request, "step_s": STEP_S / 2}, "mirror": motions.mirrored(request)}
        for what, changed in changes.items():
            record = folder / "checks" / f"{what}.csv"
            drive(self.driver, folder, changed, record)
            other[what] = records.usable(record, changed).record
        checks = {"motion": name, "is_symmetric": car.is_symmetric,
                  "halved_step_over_path":
                      records.distance(usual, other["halved"]) / records.path_length(usual),
                  "mirror_m": records.distance(usual, other["mirror"], -1)}
        save(folder / "checks.json", checks)
        report(name, f"halved step {checks['halved_step_over_path']:.1e} of the path, "
                     f"mirror image {checks['mirror_m']:.3f} m")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("work", type=Path)
    parser.add_argument("--driver", type=Path, required=True, help="the executable of build_chrono.py")
    parser.add_argument("--chrono-data", type=Path, required=True, help="the folder data/vehicle of Chrono")
    parser.add_argument("--cars", type=int, default=cars.DESIGN_CARS)
    parser.add_argument("--seed", type=int, default=20261128)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", nargs="*", help="names of cars")
    parser.add_argument("--have", type=Path, nargs="*", default=[],
                        help="what collect.py made before: its cars are not computed again")
    args = parser.parse_args()
    args.work.mkdir(parents=True, exist_ok=True)
    work = Work(args.work, args.driver.resolve(), args.chrono_data, args.seed)
    names = {i: cars.car(i, args.seed).name for i in range(args.cars)}
    indices = [i for i, name in names.items() if (not args.only or name in args.only)
               and not any((data / name / "cases.csv").exists() for data in args.have)]
    failed = []

    def report(name, what):
        print(time.strftime("%H:%M:%S"), name, what, flush=True)

    def one(index):
        try:
            work.car(index, report)
        except Exception as error:  # noqa: BLE001: the other cars go on
            failed.append(cars.car(index, args.seed).name)
            report(failed[-1], f"failed: {error}")

    with ThreadPoolExecutor(args.jobs) as pool:
        list(pool.map(one, indices))
    sys.exit(f"failed: {', '.join(sorted(failed))}" if failed else 0)


if __name__ == "__main__":
    main()
