"""Computes the pairs of a seed, and goes on where it was stopped.

    python3 run.py WORK --build OUT [--cases 48] [--seed 20261129] [--jobs 2] [--only p017 ...] [--have DATA ...]

OUT is the folder of build_chrono.py. WORK/cars has the cars that the pairs need, each built and measured once:
the cars of the seed 20261128, so that the WORK of the other generator serves as `cars` too. WORK/pairs has
`NAME.csv` and `NAME.contact.csv` of each case, and `NAME.json`: what was asked, the balances, why the case is
left out. Every fourth case is computed with a halved step and in a mirror too: WORK/checks/NAME.json. Every file
is there whole or not at all; what is there is not computed again, unless the case is another one than that of
its file. Several runners may work in one WORK: a case belongs to one at a time.
"""

import argparse
import fcntl
import json
import math
import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path

import histories
import scenarios

import layouts
from description import save
from preparation import prepare, read_json, same
from solver import call
from tables import read_table

# What a case must keep. Of each car: momentum that no force explains over the impulse of the contact, energy
# that no work explains over that at the start and the work of the outer forces. Of the contact: what both works
# may gain over that energy, moment that both forces leave over against the moment on the struck car. Overlap
# before the first contact, m.
MOMENTUM_LIMIT, ENERGY_LIMIT, GAIN_LIMIT, MOMENT_LIMIT, OVERLAP_LIMIT_M = 1e-3, 4e-3, 1e-3, 1e-6, 0.02
# Checks of every fourth case: distance of both cars over the path in the second that follows first contact, and
# impulse of its first 0.3 s, with a halved step; the same distance in a mirror, m.
CHECKED_EVERY = 4
HALVED_LIMIT, HALVED_IMPULSE_LIMIT, MIRROR_LIMIT_M = 0.005, 0.03, 0.05
CARS = ("struck", "striking")


def broken(figures):
    """The names of figures above their limits; what is not a number is above every limit."""
    def is_within(value, limit):
        return value is not None and value <= limit

    def shown(value):
        return "not finite" if value is None else f"{value:.2e}"
    return [f"{name} {shown(value)}" for name, value, limit in figures if not is_within(value, limit)]


def ratio(value, whole):
    """The size of a value over a whole; None where either is none."""
    return None if value is None or not whole else abs(value) / whole


def refusal(told):
    """Why a case is left out; None for one that is used."""
    if told["diverged"]:
        return "diverges"
    if not told["touched"]:
        return "the cars do not touch"
    impulse = sum(math.hypot(*interval["impulse_n_s"]) for interval in told["intervals"])
    moment = sum(abs(interval["moment_n_m_s"]) for interval in told["intervals"])
    energies = [told[f"{car}_start_energy_j"] + abs(told[f"{car}_work_of_outer_forces_j"] or 0.0)
                for car in CARS]
    figures = [("overlap before contact", -told["least_gap_before_m"], OVERLAP_LIMIT_M),
               ("contact gains energy", ratio(told["largest_contact_gain_j"], sum(energies)), GAIN_LIMIT),
               ("moment of the contact", ratio(told["contact_moment_left_n_m_s"], moment), MOMENT_LIMIT)]
    for car, energy in zip(CARS, energies):
        figures += [(f"momentum of the {car} car", ratio(told[f"{car}_momentum_residual_n_s"], impulse),
                     MOMENTUM_LIMIT),
                    (f"energy of the {car} car", ratio(told[f"{car}_energy_residual_j"], energy), ENERGY_LIMIT)]
    return ", ".join(broken(figures)) or None


def refusal_by_checks(checks):
    """Why a case is left out for what its checks say; None for one that holds or is not checked."""
    if not checks:
        return None
    if "failed" in checks:
        return checks["failed"]
    figures = [("halved step, path", checks["halved_over_path"], HALVED_LIMIT),
               ("halved step, impulse", checks["halved_impulse"], HALVED_IMPULSE_LIMIT)]
    if checks["is_symmetric"]:
        figures.append(("mirror image, m", checks["mirror_m"], MIRROR_LIMIT_M))
    return ", ".join(broken(figures)) or None


def is_checked(pair):
    """Whether a case that holds has checks of its own."""
    return pair.index % CHECKED_EVERY == 0 and not pair.twin_of


def asked(pair, work):
    """What is asked of a case whose cars are built, and why one of them cannot be driven."""
    figures = {car.name: read_json(work / "cars" / car.name / "figures.json") or {"refused": "is not built"}
               for car in pair.sampled}
    refused = [f"{name}: {of['refused']}" for name, of in figures.items() if "refused" in of]
    struck = figures[pair.sampled[0].name]
    request = None if refused else pair.request(struck["understeer_rad_g"])
    return {"request": request, "cars": [asdict(car) for car in pair.sampled]}, next(iter(refused), None)


def is_answer(told, wanted):
    """Whether a result is that of what is asked."""
    return told is not None and same({name: told.get(name) for name in wanted}, wanted)


def drive(driver, request, stem):
    """Computes a case: STEM.csv and STEM.contact.csv are written, what the driver says is returned."""
    asked, told, motions, contact = (stem.with_name(f"{stem.name}.{ending}") for ending in
                                     ("request.json", "told.part", "csv.part", "contact.csv.part"))
    stem.parent.mkdir(parents=True, exist_ok=True)
    asked.write_text(json.dumps(request))
    call(driver, asked, motions, contact, told)
    answer = json.loads(told.read_text())
    for file in (asked, told):
        file.unlink()
    for file in (contact, motions):
        os.replace(file, file.with_suffix(""))
    return answer


class Work:
    """Where the pairs are computed, and with what."""

    def __init__(self, folder, build):
        self.folder = folder
        self.car_driver, self.pair_driver = build / "drive_car", build / "drive_pair"
        self.library = layouts.Library(build / "chrono/data/vehicle")
        for name in ("cars", "pairs", "checks"):
            (folder / name).mkdir(parents=True, exist_ok=True)

    def pair(self, pair, report):
        """All of a case that is not there yet, unless another runner is at it."""
        with self._locked(f"pairs/{pair.name}", waits=False) as is_ours:
            if is_ours:
                self.compute(pair, report)
            else:
                report(pair.name, "is computed by another runner")

    def compute(self, pair, report):
        answer = self.folder / "pairs" / f"{pair.name}.json"
        sampled = pair.sampled
        for car in sampled:
            self.car(car, report)
        wanted, refused = asked(pair, self.folder)
        told = read_json(answer)
        if not is_answer(told, wanted):
            for file in (answer, self.folder / "checks" / answer.name):
                file.unlink(missing_ok=True)
            request = wanted["request"]
            told = {"refused": refused} if refused else self._drive(request, answer.with_suffix(""))
            save(answer, told | wanted)
            report(pair.name, told["refused"] or f"{told['wall_s']:.0f} s, balances hold")
        if is_checked(pair) and not told["refused"]:
            is_symmetric = all(car.is_symmetric for car in sampled)
            self._check(pair, told, wanted["request"], is_symmetric, report)

    def car(self, car, report):
        """Builds and measures a car; another runner that is at it is waited for."""
        with self._locked(f"cars/{car.name}", waits=True):
            prepare(car, self.folder / "cars" / car.name, self.library, self.car_driver, report)

    def _drive(self, request, stem):
        began = time.time()
        try:
            told = drive(self.pair_driver, request, stem)
        except RuntimeError as error:
            return {"refused": str(error)}
        return told | {"refused": refusal(told), "wall_s": time.time() - began}

    def _check(self, pair, told, request, is_symmetric, report):
        answer = self.folder / "checks" / f"{pair.name}.json"
        if answer.exists():
            return
        usual = histories.read(self.folder / "pairs" / f"{pair.name}.csv")
        changes = {"halved": {**request, "step_s": scenarios.STEP_S / 2}, "mirror": scenarios.mirrored(request)}
        other = {}
        try:
            for what, changed in changes.items():
                stem = self.folder / "checks" / f"{pair.name}-{what}"
                drive(self.pair_driver, changed, stem)
                other[what] = histories.read(stem.with_name(f"{stem.name}.csv"))
        except RuntimeError as error:
            checks = {"failed": f"checks: {error}"}
        else:
            halved = histories.compared(usual, other["halved"], told["first_contact_s"])
            mirror = histories.compared(usual, other["mirror"], told["first_contact_s"], -1)
            checks = {"is_symmetric": is_symmetric, "halved_m": halved[0], "halved_over_path": halved[1],
                      "halved_impulse": halved[2], "mirror_m": mirror[0]}
        save(answer, checks)
        report(pair.name, refusal_by_checks(checks) or "checks hold: " + json.dumps(checks))

    @contextmanager
    def _locked(self, name, waits):
        """Whether the lock of a car or case is ours."""
        with open(self.folder / f"{name}.lock", "w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | (0 if waits else fcntl.LOCK_NB))
            except BlockingIOError:
                yield False
            else:
                yield True


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("work", type=Path)
    parser.add_argument("--build", type=Path, required=True, help="the folder of build_chrono.py")
    parser.add_argument("--cases", type=int, default=scenarios.DESIGN_CASES, help="without the twins")
    parser.add_argument("--seed", type=int, default=scenarios.SEED)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", nargs="*", help="names of cases")
    parser.add_argument("--have", type=Path, nargs="*", default=[],
                        help="what collect.py made before: its cases are not computed again")
    args = parser.parse_args()
    work = Work(args.work.resolve(), args.build.resolve())
    have = [row for data in args.have for row in read_table(data / "cases.csv")]
    pairs = [pair for pair in scenarios.sample(args.cases, args.seed)
             if not any(map(pair.is_row, have)) and (not args.only or pair.name in args.only)]
    failed = []

    def report(name, what):
        print(time.strftime("%H:%M:%S"), name, what, flush=True)

    def one(pair):
        try:
            work.pair(pair, report)
        except Exception as error:  # noqa: BLE001: the other cases go on
            failed.append(pair.name)
            report(pair.name, f"failed: {error}")

    with ThreadPoolExecutor(args.jobs) as pool:
        list(pool.map(one, pairs))
    sys.exit(f"failed: {', '.join(sorted(failed))}" if failed else 0)


if __name__ == "__main__":
    main()
