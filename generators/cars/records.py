"""Records of motions as the driver writes them, and their figures."""

from dataclasses import dataclass

import numpy as np

WHEELS = ("fl", "fr", "rl", "rr")
# A front wheel that turns so far without being steered: the linkage of a solid axle has folded over.
FOLDED_RAD = np.radians(15)
# A car whose heading changes by more than that has spun.
SPIN_RAD = np.pi / 2
# Wheel load under which a wheel is taken to be in the air, N.
LIFTED_N = 1.0


def read(path):
    """Columns of a CSV file by their names."""
    with open(path) as file:
        names = file.readline().strip().split(",")
    values = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    return dict(zip(names, values.T))


def front_angle(record):
    """Mean angle of the front wheels."""
    return (record["steer_fl_rad"] + record["steer_fr_rad"]) / 2


@dataclass
class Cut:
    """A record up to where the linkage of its steering folds over."""

    record: dict
    is_folded: bool


def cut_where_folded(record, steer_history):
    """`steer_history`: times and angles that the front wheels are turned to; None without steering."""
    asked = np.interp(record["time_s"], *steer_history) if steer_history else 0.0
    off = np.maximum(abs(record["steer_fl_rad"] - asked), abs(record["steer_fr_rad"] - asked))
    folded = np.flatnonzero(off > FOLDED_RAD)
    if not len(folded):
        return Cut(record, False)
    return Cut({name: values[:folded[0]] for name, values in record.items()}, True)


def usable(path, request):
    """The record of a motion that was asked for, up to where the linkage folds over."""
    steer = request.get("steer")
    return cut_where_folded(read(path), (steer["time_s"], steer["angle_rad"]) if steer else None)


def thinned(record, every):
    """Every n-th sample; a force is the mean until the next one that stays, so that its impulse is kept."""
    n = len(record["time_s"])
    kept = {}
    for name, values in record.items():
        if name in ("fx_body_n", "fy_body_n"):
            padded = np.append(values, np.zeros(-n % every))
            kept[name] = padded.reshape(-1, every).mean(1)
        else:
            kept[name] = values[::every]
    return kept


def figures(record):
    """What became of the car, for the table of motions."""
    speed = np.hypot(record["vx_m_s"], record["vy_m_s"])
    moving = speed > 1.0
    sideslip = abs(np.arctan2(record["vy_m_s"], record["vx_m_s"]))[moving]
    yaw_change = abs(record["yaw_rad"]).max()
    loads = np.min([record[f"fz_{wheel}_n"] for wheel in WHEELS])
    return {
        "speed_start_m_s": speed[0], "x_end_m": record["x_m"][-1], "y_end_m": record["y_m"][-1],
        "yaw_end_rad": record["yaw_rad"][-1], "speed_end_m_s": speed[-1],
        "largest_sideslip_rad": sideslip.max() if len(sideslip) else 0.0,
        "largest_yaw_rate_rad_s": abs(record["yaw_rate_rad_s"]).max(),
        "largest_roll_rad": abs(record["roll_rad"]).max(), "spin": int(yaw_change > SPIN_RAD),
        "wheel_lift": int(loads < LIFTED_N), "duration_s": record["time_s"][-1],
    }


def distance(one, other, sign=1):
    """Mean distance of two records of one motion over their common time, m; `sign` -1 for a mirror image."""
    n = min(len(one["x_m"]), len(other["x_m"]))
    apart = np.hypot(one["x_m"][:n] - other["x_m"][:n], one["y_m"][:n] - sign * other["y_m"][:n])
    return float(apart.mean())


def path_length(record):
    return float(np.hypot(np.diff(record["x_m"]), np.diff(record["y_m"])).sum())
