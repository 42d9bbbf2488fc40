"""Motions and contact of a pair as drive_pair writes them."""

import math
from dataclasses import dataclass

import numpy as np

import scenarios  # noqa: F401: makes the modules of the other generator known

import records

# The motions have a row every 10 ms, the contact one every millisecond.
ROW_S, CONTACT_ROW_S = 0.01, 0.001
# Words for the struck and the striking car in the names of columns.
CARS = ("target", "bullet")
# What is compared of two records: so long from the first contact on.
COMPARED_S, COMPARED_IMPULSE_S = 1.0, 0.3
# Force under which a pulse is over, N; its first milliseconds may lie under it.
PULSE_ENDS_N, PULSE_BEGINS_S = 100.0, 0.004
# Resolution of the contact in a data set: milliseconds in the first part of an interval, then means of five.
FINE_S, COARSE_ROWS = 0.25, 5


def read(path):
    """Columns of a file by their names; what is empty is not a number."""
    with open(path) as file:
        names = file.readline().strip().split(",")
    values = np.genfromtxt(path, delimiter=",", skip_header=1, ndmin=2)
    return dict(zip(names, values.reshape(-1, len(names)).T))


def compared(one, other, first_s, sign=1):
    """Largest of both cars' mean distances of two records in the second that follows first contact, m, the same
    over the path, and the relative difference of the impulse of the first 0.3 s; `sign` -1 for a mirror image."""
    start = int(first_s / ROW_S)
    end = min(start + round(COMPARED_S / ROW_S), len(one["time_s"]), len(other["time_s"]))
    apart_m, over_path = [], []
    for car in CARS:
        x, y = f"{car}_x_m", f"{car}_y_m"
        part, second = ({name: record[name][start:end] for name in (x, y)} for record in (one, other))
        part, second = ({"x_m": of[x], "y_m": of[y]} for of in (part, second))
        apart_m.append(records.distance(part, second, sign))
        over_path.append(apart_m[-1] / max(records.path_length(part), 1.0))
    end = start + round(COMPARED_IMPULSE_S / ROW_S)
    x, y = ([float(record[f"contact_f{axis}_n"][start:end].sum()) for record in (one, other)] for axis in "xy")
    impulse = math.hypot(x[0] - x[1], y[0] - sign * y[1]) / math.hypot(x[0], y[0])
    return max(apart_m), max(over_path), impulse


@dataclass
class Pulse:
    """The force from the first contact until it is gone for the first time, and the impulse that follows, N s."""

    length_s: float
    impulse_n_s: tuple
    later_n_s: float


def first_pulse(contact, first_s):
    """The first pulse of a contact."""
    time, force = contact["time_s"], np.hypot(contact["fx_n"], contact["fy_n"])
    ends = np.flatnonzero((force < PULSE_ENDS_N) & (time > first_s + PULSE_BEGINS_S))
    gaps = np.flatnonzero(np.diff(time) > 1.5 * CONTACT_ROW_S) + 1
    n = int(min([len(force), *ends[:1], *gaps[:1]]))
    impulse = [contact[name] * CONTACT_ROW_S for name in ("fx_n", "fy_n")]
    later = math.hypot(*(float(of[n:].sum()) for of in impulse))
    return Pulse(n * CONTACT_ROW_S, tuple(float(of[:n].sum()) for of in impulse), later)


def thinned_contact(contact):
    """Rows of the contact for a data set: its columns after `dt_s`. Forces are means, so that times `dt_s` they
    sum to the impulse; points are weighted with the force."""
    names = [name for name in contact if name not in ("interval", "time_s")]
    rows = np.stack([contact[name] for name in names], 1)
    weights = np.hypot(contact["fx_n"], contact["fy_n"])
    forces = [not name.endswith("_m") for name in names]
    interval, time = contact["interval"], contact["time_s"]
    begins = {number: time[interval == number][0] for number in np.unique(interval)}
    thinned, i = [], 0
    while i < len(time):
        n = 1
        while (time[i] - begins[interval[i]] > FINE_S and n < COARSE_ROWS and i + n < len(time)
               and interval[i + n] == interval[i] and abs(time[i + n] - time[i] - n * CONTACT_ROW_S) < 1e-6):
            n += 1
        part, weight = rows[i:i + n], weights[i:i + n]
        weight = weight / weight.sum() if weight.sum() > 0 else np.full(n, 1 / n)
        means = np.where(forces, part.mean(0), (part * weight[:, None]).sum(0))
        thinned.append((int(interval[i]), float(time[i]), n * CONTACT_ROW_S, *map(float, means)))
        i += n
    return ["interval", "time_s", "dt_s", *names], thinned
