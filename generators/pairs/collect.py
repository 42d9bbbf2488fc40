"""Makes a data set of pairs of finished cases: cases.csv, cases/, contacts/, vehicles/, in SI units.

    python3 collect.py WORK DATASET [--part learn|held-out|all] [--cases 48] [--seed 20261129]

A quarter of the cases is held out by the hash of their names, so that more cases move none of them from one part
to the other; a case and its twin with stability control stay together. What does not hold is left out and named.
A case that DATASET has and whose run is no longer there stays as it is. Every file is there whole or not at all,
and the table, which says what belongs to the data set, comes last.
"""

import argparse
import math
import os
from pathlib import Path

import numpy as np

import histories
import scenarios
from run import asked, is_answer, is_checked, refusal_by_checks

from preparation import read_json
from tables import is_held_out, read_table, write_number, write_table

# An interval of contact with less impulse does not count, N s.
LEAST_IMPULSE_N_S = 20.0
SUSTAINED_S = 0.3
CONTACT_DIGITS = {"time_s": 4, "dt_s": 3, "point_x_m": 3, "point_y_m": 3, "bullet_point_x_m": 3,
                  "bullet_point_y_m": 3}


def listed(values, digits):
    return ";".join(f"{value:.{digits}f}" for value in values)


def starts(motions):
    """Initial states of both cars."""
    row = {}
    for car in histories.CARS:
        for name, unit in (("x", "m"), ("y", "m"), ("yaw", "rad"), ("vx", "m_s"), ("vy", "m_s"),
                           ("yaw_rate", "rad_s")):
            row[f"{car}_{name}0_{unit}"] = float(motions[f"{car}_{name}_{unit}"][0])
    return row


def drivers(pair, motions, first_s):
    """What the drivers were to do."""
    struck, striking = pair.struck_driver, pair.striking_driver
    steers = "steer_rad" in striking
    before = motions["time_s"] <= first_s + 1e-9
    away = striking.get("away_rad")
    return {"bullet_steering_peak_rad": float(abs(motions["bullet_steering_wheel_rad"][before]).max()),
            "bullet_steering_rise_s": striking.get("steer_rise_s"),
            "bullet_straightens": int(striking["straightens"]) if steers else None,
            "bullet_driver": striking["kind"], "bullet_release_after_contact_s": striking.get("release_s"),
            "bullet_steer_held_after_contact_s": striking.get("steer_after_contact_s", 0.0) if steers else None,
            "bullet_steers_away_rad": away and away * scenarios.STEERING_RATIO,
            "bullet_steers_away_for_s": striking.get("away_s"), "bullet_brake_g": striking.get("brake_g"),
            "target_driver": struck["kind"], "target_reaction_s": struck.get("reaction_s"),
            "target_brake_g": struck.get("brake_g"),
            "target_abs": int(struck["anti_lock"] or pair.has_stability_control),
            "countersteer_gain": struck.get("steer_gain"),
            "countersteer_rate_gain_s": struck.get("steer_rate_gain_s"),
            "countersteer_delay_s": struck.get("steer_delay_s")}


def contacts(told, pulse, rear_axle_m):
    """When, where and how hard the cars touch."""
    intervals = told["intervals"]
    impulse = np.array([interval["impulse_n_s"] for interval in intervals])
    start, end, moment, peak = (np.array([interval[name] for interval in intervals])
                                for name in ("start_s", "end_s", "moment_n_m_s", "peak_n"))
    counted = np.hypot(*impulse.T) > LEAST_IMPULSE_N_S
    later = counted & (start > end[counted][0]) if counted.any() else counted
    longest = float((end - start).max())
    (x, y, height), (closing_x, closing_y) = told["contact_m"], told["closing_m_s"]
    return {"first_contact_s": told["first_contact_s"], "contact_x_m": x, "contact_y_m": y,
            "contact_height_m": height, "axle_offset_m": x + rear_axle_m, "closing_x_m_s": closing_x,
            "closing_y_m_s": closing_y, "bullet_heading_at_contact_rad": told["heading_rad"],
            "contact_intervals": int(counted.sum()), "contact_start_s": listed(start, 4),
            "contact_end_s": listed(end, 4), "interval_impulse_x_n_s": listed(impulse[:, 0], 1),
            "interval_impulse_y_n_s": listed(impulse[:, 1], 1), "interval_yaw_impulse_n_m_s": listed(moment, 1),
            "interval_peak_force_n": listed(peak, 0), "first_pulse_s": pulse.length_s,
            "first_pulse_x_n_s": pulse.impulse_n_s[0], "first_pulse_y_n_s": pulse.impulse_n_s[1],
            "contact_total_s": float((end - start).sum()), "contact_longest_s": longest,
            "sustained_over_0_3_s": int(longest > SUSTAINED_S), "second_contact": int(later.any()),
            "second_contact_s": listed(start[later], 3), "impulse_x_n_s": float(impulse[:, 0].sum()),
            "impulse_y_n_s": float(impulse[:, 1].sum()), "yaw_impulse_n_m_s": float(moment.sum()),
            "peak_force_n": float(peak.max()), "target_crush_m": told["struck_crush_m"],
            "bullet_crush_m": told["striking_crush_m"]}


def outcomes(told, motions):
    """What became of the cars."""
    time, yaw = motions["time_s"], abs(motions["target_yaw_rad"])
    speed = np.hypot(motions["target_vx_m_s"], motions["target_vy_m_s"])
    moving = speed > 1.0
    sideslip = abs(np.arctan2(motions["target_vy_m_s"], motions["target_vx_m_s"]))[moving]
    roll = max(abs(motions[f"{car}_roll_rad"]).max() for car in histories.CARS)
    last = {name: float(values[-1]) for name, values in motions.items()}
    row = {}
    for degrees in (90, 180):
        beyond = np.flatnonzero(yaw > math.radians(degrees))
        row |= {f"turned_over_{degrees}": int(len(beyond) > 0),
                f"t_{degrees}_s": float(time[beyond[0]]) if len(beyond) else None}
    row |= {"yaw_max_deg": math.degrees(yaw.max()),
            "yawrate_max_degs": math.degrees(abs(motions["target_yaw_rate_rad_s"]).max()),
            "beta_max_deg": math.degrees(sideslip.max()) if len(sideslip) else 0.0,
            "roll_max_deg": math.degrees(roll)}
    for car, prefix in zip(histories.CARS, ("", "bullet_")):
        row |= {f"{prefix}x_end_m": last[f"{car}_x_m"], f"{prefix}y_end_m": last[f"{car}_y_m"],
                f"{prefix}yaw_end_rad": last[f"{car}_yaw_rad"],
                f"{prefix}speed_end_m_s": math.hypot(last[f"{car}_vx_m_s"], last[f"{car}_vy_m_s"])}
    return row | {"target_at_rest": int(speed[-1] < 0.05), "duration_s": last["time_s"],
                  "roll_over": int(told["rolled_over"]), "linkage_folded": int(told["linkage_folded"]),
                  "esc_active_s": float(motions["target_esc_active"].sum() * histories.ROW_S)}


def row(pair, told, motions, contact):
    """The row of a case in the table."""
    struck, striking = pair.sampled
    first_s = told["first_contact_s"]
    gap = float(motions["gap_m"][0])
    residual = max(told[f"{car}_momentum_residual_n_s"] for car in ("struck", "striking"))
    return {"case": pair.name, "kind": pair.kind, "esc_twin_of": pair.twin_of, "target": struck.name,
            "bullet": striking.name, "mu": pair.friction, "side": pair.side,
            "esc": int(pair.has_stability_control), **starts(motions),
            "gap0_m": None if math.isnan(gap) else gap, **drivers(pair, motions, first_s),
            **contacts(told, histories.first_pulse(contact, first_s), struck.axle_distances_m[1]),
            **outcomes(told, motions), "energy_residual_target_j": told["struck_energy_residual_j"],
            "energy_residual_bullet_j": told["striking_energy_residual_j"], "momentum_residual_n_s": residual,
            "contact_work_j": told["struck_contact_work_j"] + told["striking_contact_work_j"],
            "target_stiffness_scale": pair.stiffness[0], "bullet_stiffness_scale": pair.stiffness[1],
            "contact_friction": pair.contact_friction, "elastic_stiffness_scale": pair.elastic}


def sheet(text, car):
    """The data sheet of a car with its plan view and steering ratio."""
    body = (f"width = {2 * car.half_width_m:.3f}\n"
            f"rear_overhang = {car.rear_overhang_m:.3f}\n"
            f"bumper_height = {scenarios.bumper_height_m(car):.3f}  # middle of bumper and sill above the road\n")
    head, line, rest = text.partition("[wheel]\n")
    if not line:
        raise ValueError(f"{car.name}: the data sheet has no [wheel]")
    return (head + body + line + rest.rstrip("\n")
            + f"\n[steering]\nratio = {scenarios.STEERING_RATIO}  # steering wheel over front wheels, nominal\n")


def write_whole(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    waiting = path.with_name(path.name + ".part")
    waiting.write_text(text)
    os.replace(waiting, path)


def contact_text(contact):
    names, rows = histories.thinned_contact(contact)

    def shown(name, value):
        digits = CONTACT_DIGITS.get(name)
        if name == "interval":
            return str(value)
        return write_number(value, digits) if digits else ("0" if abs(value) < 1e-9 else f"{value:.5g}")
    lines = [",".join(shown(name, value) for name, value in zip(names, values)) for values in rows]
    return "\n".join([",".join(names), *lines]) + "\n"


def reason_to_leave_out(work, pair):
    """Why a case is not collected; None for one that is."""
    told = read_json(work / "pairs" / f"{pair.name}.json")
    if not told:
        return "not computed"
    if not is_answer(told, asked(pair, work)[0]):
        return "what was computed is another case"
    if told["refused"]:
        return told["refused"]
    # The checks of a case are also those of its twin.
    checks = read_json(work / "checks" / f"{pair.base}.json")
    if not checks and is_checked(pair):
        return "not checked yet"
    return refusal_by_checks(checks)


def collect_pair(pair, work, destination):
    """Writes the files of a case and its cars; returns its row."""
    told = read_json(work / "pairs" / f"{pair.name}.json")
    source = work / "pairs" / f"{pair.name}.csv"
    contact = histories.read(work / "pairs" / f"{pair.name}.contact.csv")
    write_whole(destination / "cases" / f"{pair.name}.csv", source.read_text())
    write_whole(destination / "contacts" / f"{pair.name}.csv", contact_text(contact))
    for car in pair.sampled:
        text = (work / "cars" / car.name / "vehicle.toml").read_text()
        write_whole(destination / "vehicles" / f"{car.name}.toml", sheet(text, car))
    return row(pair, told, histories.read(source), contact)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("work", type=Path)
    parser.add_argument("destination", type=Path)
    parser.add_argument("--part", choices=["all", "learn", "held-out"], default="all")
    parser.add_argument("--cases", type=int, default=scenarios.DESIGN_CASES, help="without the twins")
    parser.add_argument("--seed", type=int, default=scenarios.SEED)
    args = parser.parse_args()
    before = {of_row["case"]: of_row for of_row in read_table(args.destination / "cases.csv")}
    pairs = scenarios.sample(args.cases, args.seed)
    rows, left_out = [], {}
    for pair in pairs:
        if args.part != "all" and is_held_out(pair.base) != (args.part == "held-out"):
            continue
        is_computed = (args.work / "pairs" / f"{pair.name}.json").exists()
        if pair.name in before and not is_computed and pair.is_row(before[pair.name]):
            rows.append(before[pair.name])
            continue
        reason = reason_to_leave_out(args.work, pair)
        if reason:
            left_out[pair.name] = reason
        else:
            rows.append(collect_pair(pair, args.work, args.destination))
    names = {pair.name for pair in pairs}
    rows += [of_row for name, of_row in before.items() if name not in names]
    if rows:
        args.destination.mkdir(parents=True, exist_ok=True)
        write_table(rows, args.destination / "cases.csv.part")
        os.replace(args.destination / "cases.csv.part", args.destination / "cases.csv")
    print(f"{len(rows)} cases")
    for name, reason in left_out.items():
        print(f"left out: {name}: {reason}")


if __name__ == "__main__":
    main()
