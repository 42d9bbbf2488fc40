"""What a case is worth: the same collision with a halved mesh, and seen from axes that move.

    python3 check_model.py WORK --solver OpenRadioss [--only NAME...]

A halved mesh takes eight times as long or more. Results are compared by impulse, peak and duration.
"""

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

import scenarios
from collect import CONTACT_FORCE_N
from results import Result
from run import compute


def figures(folder, name):
    """Impulse along both axes, peak force, duration of contact."""
    result = Result.read(folder / name, name)
    time, force, _ = result.force()
    size = np.hypot(force[:, 0], force[:, 1])
    touching = time[size > CONTACT_FORCE_N]
    return dict(impulse_x=result.impulse[-1, 0], impulse_y=result.impulse[-1, 1], peak=size.max(),
                duration=touching[-1] - touching[0])


def moving(case, m_s):
    """The same collision seen from axes that move along X: nothing may change but the rounding."""
    velocities = tuple((vx + m_s, vy) for vx, vy in case.velocities)
    return replace(case, name=f"{case.name}_moving", velocities=velocities)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("work", type=Path)
    parser.add_argument("--solver", type=Path, required=True)
    parser.add_argument("--only", nargs="*", default=["d001"])
    args = parser.parse_args()
    for case in scenarios.sample(264, 20261127, "d"):
        if case.name not in args.only:
            continue
        fine = replace(case, name=f"{case.name}_fine")
        shifted = moving(case, 5.0)
        for run, parts in ((case, 1), (shifted, 1), (fine, 2)):
            print(run.name, compute(run, args.work, args.solver.resolve(), parts), flush=True)
        usual = figures(args.work, case.name)
        for other in (shifted, fine):
            changed = figures(args.work, other.name)
            told = ", ".join(f"{key} {100 * (changed[key] / usual[key] - 1):+.1f} %" for key in usual)
            print(f"{other.name} against {case.name}: {told}")


if __name__ == "__main__":
    main()
