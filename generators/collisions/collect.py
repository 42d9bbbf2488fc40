"""Makes a force data set of finished collisions: cases.csv and forces/CASE.csv, in SI units.

    python3 collect.py WORK DATASET [--part learn] [--cases 264] [--seed 20261127] [--prefix d]

Of a collision from the left the mirror image was computed; it is mirrored back here. A case whose balances do
not hold, or whose cars did not touch, is left out and named. A case that the data set has already and whose run
is no longer there stays as it is. A quarter of the cases is held out by the hash of its name, so that more cases
move none of them from one part to the other.
"""

import argparse
import csv
import hashlib
import json
from pathlib import Path

import numpy as np

import scenarios
from results import Result

# Force from which on the cars are in contact, N.
CONTACT_FORCE_N = 200.0
# What a run must keep, in percent.
LIMITS = dict(momentum_residual_target_x_percent=1.0, momentum_residual_target_y_percent=1.0,
              momentum_residual_bullet_percent=1.0, energy_error_max_percent=3.0, hourglass_percent=5.0)
# End of the main pulse: the mean force over 5 ms falls under this share of its peak.
MAIN_PULSE_SHARE = 0.05
# More impulse than this after the main pulse: the cars stay hooked or meet again.
HOOKED_SHARE = 0.10
SETTLED_S = 0.005
HEADER = ("time_s,fx_n,fy_n,mz_nm,target_vx_m_s,target_vy_m_s,target_yaw_rate_rad_s,target_yaw_rad,"
          "bullet_vx_m_s,bullet_vy_m_s,bullet_yaw_rate_rad_s,bullet_yaw_rad")


def is_held_out(name):
    """Whether a case is kept for tests alone."""
    return int(hashlib.sha256(f"0:{name}".encode()).hexdigest(), 16) % 4 == 0


def middle(values):
    return .5 * (values[1:] + values[:-1])


def refusal(result):
    """Why a run is left out; None for one that is used."""
    _, force, _ = result.force()
    if not np.isfinite(force).all():
        return "not finite"
    if np.hypot(force[:, 0], force[:, 1]).max() <= CONTACT_FORCE_N:
        return "the cars do not touch"
    balances = result.balances()
    broken = [f"{name} {balances[name]:.2f}" for name, limit in LIMITS.items() if abs(balances[name]) > limit]
    return ", ".join(broken) or None


def row(collision, result, wall_s):
    """The row of a case in the table."""
    sign = collision.sign
    time, force, moment = result.force()
    steps = np.diff(result.time)
    size = np.hypot(force[:, 0], force[:, 1])
    touching = np.flatnonzero(size > CONTACT_FORCE_N)
    smooth = np.convolve(size, np.ones(10) / 10, "same")
    peak = int(smooth.argmax())
    after = np.flatnonzero(smooth[peak:] < MAIN_PULSE_SHARE * smooth[peak])
    main_end = peak + after[0] if len(after) else len(size) - 1
    main = result.impulse[main_end + 1]
    rest = (force[main_end:] * steps[main_end:, None]).sum(0)
    settled = result.time > result.time[-1] - SETTLED_S
    (m_t, m_b), (struck, striking) = collision.masses, collision.velocities
    facts, frame = result.facts, result.facts["frame_velocity"]
    out = dict(case=collision.name, kind=collision.kind, target_body=collision.bodies[0],
               bullet_body=collision.bodies[1], side=collision.side, m_t_kg=m_t, m_b_kg=m_b, v_tx_m_s=struck[0],
               v_ty_m_s=struck[1], v_bx_m_s=striking[0], v_by_m_s=striking[1],
               target_yaw_rate_rad_s=collision.yaw_rates[0], bullet_yaw_rate_rad_s=collision.yaw_rates[1],
               theta_b_rad=collision.heading, izz_t_kg_m2=facts["cars"][0]["yaw_inertia"],
               izz_b_kg_m2=facts["cars"][1]["yaw_inertia"], contact_x_m=facts["contact"][0],
               contact_y_m=sign * facts["contact"][1], contact_z_m=facts["contact"][2],
               contact_normal_rad=0.0 if collision.kind == "rear" else sign * np.pi / 2,
               bullet_x0_m=facts["cars"][1]["at"][0], bullet_y0_m=sign * facts["cars"][1]["at"][1],
               impulse_x_n_s=result.impulse[-1, 0], impulse_y_n_s=sign * result.impulse[-1, 1],
               yaw_impulse_n_m_s=sign * float((moment * steps).sum()), peak_force_n=size.max(),
               t_peak_s=time[size.argmax()], t_start_s=time[touching[0]], t_end_s=time[touching[-1]],
               t_sim_s=result.time[-1], t_end_main_s=time[main_end], impulse_main_x_n_s=main[0],
               impulse_main_y_n_s=sign * main[1], main_pulse_complete=int(len(after) > 0),
               hooked=int(np.hypot(*rest[:2]) > HOOKED_SHARE * np.hypot(*main[:2])),
               separated=int(result.time[-1] - time[touching[-1]] > .008))
    for name, car in zip(("target", "bullet"), result.cars):
        out |= {f"{name}_vx_end_m_s": car.velocity[-1, 0] + frame, f"{name}_vy_end_m_s": sign * car.velocity[-1, 1],
                f"{name}_yaw_rate_end_rad_s": sign * car.yaw_rate[settled].mean(),
                f"{name}_yaw_end_rad": sign * car.yaw[-1]}
    return out | result.balances() | dict(wall_s=wall_s)


def histories(collision, result):
    """The columns of a case's file."""
    sign, frame = collision.sign, result.facts["frame_velocity"]
    time, force, moment = result.force()
    columns = [time, force[:, 0], sign * force[:, 1], sign * moment]
    for car in result.cars:
        columns += [middle(car.velocity[:, 0]) + frame, sign * middle(car.velocity[:, 1]),
                    sign * middle(car.yaw_rate), sign * middle(car.yaw)]
    return np.stack(columns, 1)


def present(dataset, cases):
    """Rows of a data set for cases that are the same as those that are sampled, by name."""
    table = dataset / "cases.csv"
    if not table.exists():
        return {}
    with open(table, newline="") as file:
        rows = {row["case"]: row for row in csv.DictReader(file)}
    return {case.name: rows[case.name] for case in cases if case.name in rows and is_of(rows[case.name], case)}


def is_of(row, case):
    """Whether a row is of this collision and not of another one of the same name."""
    told = [row[key] for key in ("m_t_kg", "m_b_kg", "v_tx_m_s", "v_by_m_s", "theta_b_rad", "target_yaw_rate_rad_s")]
    (struck_vx, _), (_, striking_vy) = case.velocities
    expected = *case.masses, struck_vx, striking_vy, case.heading, case.yaw_rates[0]
    return np.allclose([float(value) for value in told], expected, rtol=1e-4, atol=1e-6)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("work", type=Path)
    parser.add_argument("dataset", type=Path)
    parser.add_argument("--cases", type=int, default=264)
    parser.add_argument("--seed", type=int, default=20261127)
    parser.add_argument("--prefix", default="d")
    parser.add_argument("--part", choices=["all", "learn", "held-out"], default="all")
    args = parser.parse_args()
    forces = args.dataset / "forces"
    forces.mkdir(parents=True, exist_ok=True)
    rows, left_out = [], {}
    cases = [case for case in scenarios.sample(args.cases, args.seed, args.prefix)
             if args.part == "all" or is_held_out(case.name) == (args.part == "held-out")]
    before = present(args.dataset, cases)
    for collision in cases:
        folder = args.work / collision.name
        if collision.name in before and not (folder / "done.json").exists():
            rows.append(before[collision.name])
            continue
        if not (folder / "done.json").exists():
            left_out[collision.name] = "not computed"
            continue
        result = Result.read(folder, collision.name)
        reason = refusal(result)
        if reason:
            left_out[collision.name] = reason
            continue
        wall_s = json.loads((folder / "done.json").read_text())["wall_s"]
        rows.append(row(collision, result, wall_s))
        np.savetxt(forces / f"{collision.name}.csv", histories(collision, result), delimiter=",", header=HEADER,
                   comments="", fmt=["%.6f"] + ["%.2f"] * 3 + ["%.6f"] * 8)
    with open(args.dataset / "cases.csv", "w", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]))
        table.writeheader()
        for of_case in rows:
            table.writerow({key: f"{value:.6g}" if isinstance(value, float) else value
                            for key, value in of_case.items()})
    print(f"{len(rows)} cases")
    for name, reason in left_out.items():
        print(f"left out: {name}: {reason}")


if __name__ == "__main__":
    main()
