"""Makes the data sets of finished cars in the layout of impactlab's trajectories: one folder a car.

    python3 collect.py WORK DEST [--part learn|held-out|all] [--cars 60] [--seed 20261128]

DEST/car-017 has cases.csv, vehicle.toml and trajectories/car-017_00.csv. A quarter of the CARS is held out by
the hash of their names, so that more cars move none of them from one part to the other. A motion whose
balances do not hold is left out and named, and so is a car that fails its checks, oversteers or is not
finished. A car that DEST has already stays as it is until its motions are all there again.
"""

import argparse
import shutil
from pathlib import Path

import numpy as np

import cars
import motions
import records
from preparation import read_json
from run import refusal_of_car
from tables import is_held_out, read_table, write_number, write_table

# The driver writes 100 samples a second.
EVERY = 2
COLUMNS = {"time_s": 2, "x_m": 2, "y_m": 2, "yaw_rad": 4, "roll_rad": 4, "vx_m_s": 3, "vy_m_s": 3,
           "yaw_rate_rad_s": 4, "roll_rate_rad_s": 3, "fx_body_n": 1, "fy_body_n": 1, "steer_rad": 3}
WHEEL_NAMES = ("FL", "FR", "RL", "RR")


def is_finished(folder, names):
    """Whether a car has its data sheet and all motions."""
    files = [folder / "vehicle.toml", *(folder / "motions" / f"{name}.json" for name in names)]
    return all(file.exists() for file in files)


def braking(motion):
    """The columns of impactlab for what brakes the wheels."""
    if motion.engine_axle is not None:
        axle = ("front", "rear")[motion.engine_axle]
        return "engine-brake", 0.0, f"{axle} {motion.engine_torque_n_m:.0f} a wheel"
    torques = motion.brake_torque_n_m
    if not any(torques):
        return "none", None, None
    if motion.kind in ("driver-brake", "steer-brake"):
        told = f"front {torques[0]:.0f} rear {torques[2]:.0f} a wheel"
        return "driver-brake", motion.brake_start_s, told
    wheel = int(np.argmax(torques))
    locked = " locked" if motion.locked_wheel is not None else ""
    return "rear-wheel-drag", motion.brake_start_s, f"{WHEEL_NAMES[wheel]} {torques[wheel]:.0f}{locked}"


def row(motion, told, cut, steered_rad):
    """The row of a motion in the table."""
    kind, start, torque = braking(motion)
    x, y, height = motion.point_m
    figures = records.figures(cut.record)
    return {
        "case": motion.name, "kind": motion.kind, "speed_m_s": motion.speed_m_s, "mu": motion.friction,
        "side": motion.side, "shape": motion.shape, "impulse_x_n_s": motion.impulse_n_s[0],
        "impulse_y_n_s": motion.impulse_n_s[1], "pulse_s": motion.time_s[-1],
        "peak_force_n": max(float(np.hypot(*force)) for force in motion.force_n),
        "contact_x_m": x, "contact_y_m": y, "contact_height_m": height, "frame": "heading", "braking": kind,
        "braking_start_s": start, "braking_torque_n_m": torque, "steering": "held" if steered_rad else "none",
        "steering_start_s": motion.steer_start_s if steered_rad else None,
        "steering_rad": steered_rad or None,
        "steering_rate_rad_s": motion.steer_rate_rad_s if steered_rad else None, **figures,
        "linkage_folded": int(cut.is_folded), "roll_over": int(told["rolled_over"] and not cut.is_folded),
        "at_rest": int(told["at_rest"] and not cut.is_folded),
        "energy_residual_j": told["energy_residual_j"],
        "momentum_residual_n_s": told["momentum_residual_n_s"],
    }


def write_trajectory(record, path):
    record = records.thinned({**record, "steer_rad": records.front_angle(record)}, EVERY)
    with open(path, "w") as file:
        file.write(",".join(COLUMNS) + "\n")
        for values in zip(*(record[name] for name in COLUMNS)):
            file.write(",".join(map(write_number, values, COLUMNS.values())) + "\n")


def collect_car(sampled, source, destination):
    """Writes the data set of a car, whole or not at all; returns the motions that are left out with the
    reasons."""
    rows, left_out = [], {}
    staged = destination.with_name(f".{destination.name}.new")
    shutil.rmtree(staged, ignore_errors=True)
    trajectories = staged / "trajectories"
    trajectories.mkdir(parents=True)
    table = read_json(source / "car.json")["steering_table"]
    for motion in sampled:
        told = read_json(source / "motions" / f"{motion.name}.json")
        if told["refused"]:
            left_out[motion.name] = told["refused"]
            continue
        cut = records.usable(source / "motions" / f"{motion.name}.csv", told["request"])
        write_trajectory(cut.record, trajectories / f"{motion.name}.csv")
        rows.append(row(motion, told, cut, motion.steered_rad(table)))
    if rows:
        write_table(rows, staged / "cases.csv")
        shutil.copy(source / "vehicle.toml", staged)
        shutil.rmtree(destination, ignore_errors=True)
        staged.rename(destination)
    return left_out


def facts(car, figures):
    """The row of a car in the table of cars."""
    return {"car": car.name, "class": car.kind, "front": car.front, "rear": car.rear,
            "driven": ("front", "rear")[car.driven_axle], "mass_kg": round(car.mass_kg, 1),
            "wheelbase_m": round(car.wheelbase_m, 3), "track_front_m": round(car.track_front_m, 3),
            "cg_height_m": round(car.cg_height_m, 3), "front_share": round(car.front_share, 3),
            "yaw_inertia_kg_m2": round(figures["yaw_inertia_kg_m2"], 1),
            "understeer_rad_g": round(figures["understeer_rad_g"], 5),
            "roll_rad_g": round(figures["roll_rad_g"], 5),
            "largest_lateral_g": round(figures["largest_lateral_g"], 3),
            "sliding_friction": round(figures["sliding_friction"], 3)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("work", type=Path)
    parser.add_argument("destination", type=Path)
    parser.add_argument("--part", choices=["all", "learn", "held-out"], default="all")
    parser.add_argument("--cars", type=int, default=cars.DESIGN_CARS)
    parser.add_argument("--seed", type=int, default=20261128)
    args = parser.parse_args()
    args.destination.mkdir(parents=True, exist_ok=True)
    before = {of_row["car"]: of_row for of_row in read_table(args.destination / "cars.csv")}
    table, left_out, n_motions = [], {}, 0
    for car in cars.sample(args.cars, args.seed):
        if args.part != "all" and is_held_out(car.name) != (args.part == "held-out"):
            continue
        source, destination = args.work / car.name, args.destination / car.name
        sampled = motions.sample(car, args.seed)
        is_there = is_finished(source, [motion.name for motion in sampled])
        if car.name in before and not is_there:
            table.append(before[car.name])
            continue
        reason = refusal_of_car(source) or (None if is_there else "not finished")
        if reason:
            left_out[car.name] = reason
            continue
        left_out |= collect_car(sampled, source, destination)
        n_motions += len(read_table(destination / "cases.csv"))
        table.append(facts(car, read_json(source / "figures.json")))
    if table:
        write_table(table, args.destination / "cars.csv")
    print(f"{len(table)} cars, {n_motions} motions collected now")
    for name, reason in left_out.items():
        print(f"left out: {name}: {reason}")


if __name__ == "__main__":
    main()
