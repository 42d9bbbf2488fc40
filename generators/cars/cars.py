"""The sample of cars: a Latin hypercube over the cars that people drive, class by class.

    python3 cars.py [--cars 60] [--seed 20261128]       prints the sample

Car i of a seed is always the same one, however many are asked for. Ranges and how they hang together follow the
data sheets of some thirty cars of 2003 to 2021: a class says what is tall, heavy and long at once. The first
design has 60 cars (`classes.json`). The next one has 24 (`classes-wide.json`), for what the first one leaves
out: the dynamic index of the cars that were measured (1.1 in the median of Heydinger 1999; the first one has 0.85
to 1.10), wheelbases up to 3.8 m, wide tracks, soft front tires. Those after it have 24 each
(`classes-edge.json`), for what a data sheet leaves open: front axles that yield as much as 11 deg/g or as little
as 2.6, light or heavy noses, tires that slide at once or hardly lose grip.
"""

import argparse
import json
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from scipy.stats import qmc

import layouts

FOLDER = Path(__file__).resolve().parent
# Cars of the first Latin hypercube, and of each of those after it.
DESIGN_CARS, LATER_CARS = 60, 24
FRONT_DRIVEN, REAR_DRIVEN = 0, 1
# Largest height of the centre of gravity over the track: a taller car falls over in a curve.
TALLEST_OVER_TRACK = 0.535
# The rear axle is stiffer than the front one by so much, so that every car is stable.
REAR_OVER_FRONT_STIFFNESS = (1.20, 1.50)
RIDE_FREQUENCY_HZ = (1.05, 1.60)
# From this mass on the inner joints of the E90 rear tie rods are raised: less roll oversteer.
HEAVY_KG, TIE_ROD_RAISE_M = 1500.0, 0.006


@dataclass(frozen=True)
class CarClass:
    """Ranges of a class, SI units.

    - `n_of_design`: how many cars of a design are of the class.
    - `cornering_stiffness_over_load`: of the front tires, 1/rad.
    - `least_rear_stiffness_over_load`, `largest_rear_stiffness_over_load`: of the rear tires, 1/rad.
    - `sliding_over_peak`: friction of the sliding tire over its peak.
    - `bar_over_wheel_rate`: front anti-roll bar over the wheel rate of the springs.
    - `front_driven_share`: share of the cars whose front axle is driven.
    - `pairs`: plausible pairs of axles (front, rear).
    """

    n_of_design: int
    mass_kg: tuple
    wheelbase_m: tuple
    track_m: tuple
    front_share: tuple
    cg_height_m: tuple
    tire_radius_m: tuple
    drag_area_m2: tuple
    yaw_inertia_ratio: tuple
    cornering_stiffness_over_load: tuple
    least_rear_stiffness_over_load: float
    bar_over_wheel_rate: tuple
    front_driven_share: float
    spring_free_travel_m: float
    pairs: tuple
    largest_rear_stiffness_over_load: float = 23.0
    sliding_over_peak: tuple = (0.72, 0.95)


def _classes(file):
    return {name: CarClass(**ranges) for name, ranges in json.loads((FOLDER / file).read_text()).items()}


# Classes of the first design, of the second, and of all others.
CLASSES, WIDE_CLASSES, EDGE_CLASSES = map(_classes, ("classes.json", "classes-wide.json", "classes-edge.json"))

# What a car is made of; a coordinate of the hypercube each.
COORDINATES = ("mass", "wheelbase", "track", "track_difference", "front_share", "cg_height", "yaw_inertia",
               "roll_inertia", "tire_radius", "wheel_mass", "front_frequency", "rear_frequency", "front_bar",
               "rear_bar", "damping", "stiffness", "stiffness_ratio", "front_slip", "rear_slip", "sliding",
               "drag", "pair", "driven", "front_overhang", "rear_overhang")


@dataclass(frozen=True)
class Car:
    """A car as it is sampled; SI units. Pairs are front and rear axle.

    - `front_share`: share of the weight on the front axle.
    - `yaw_inertia_ratio`: yaw inertia over mass times both distances of the axles from the centre of gravity.
    - `roll_gyration2_m2`: roll inertia over mass.
    - `cornering_stiffness_over_load`, `slip_at_peak`: of the tires, at their mean load and a friction of 1.
    """

    name: str
    index: int
    kind: str
    front: str
    rear: str
    wheelbase_m: float
    track_front_m: float
    track_rear_m: float
    mass_kg: float
    front_share: float
    cg_height_m: float
    yaw_inertia_ratio: float
    roll_gyration2_m2: float
    tire_radius_m: float
    wheel_mass_kg: float
    ride_frequencies_hz: tuple
    bar_over_wheel_rate: tuple
    damping_ratio: float
    cornering_stiffness_over_load: tuple
    slip_at_peak: tuple
    sliding_over_peak: float
    link_mass_factors: tuple
    driven_axle: int
    drag_area_m2: float
    spring_free_travel_m: float
    rear_tie_rod_raise_m: float
    front_overhang_m: float
    rear_overhang_m: float

    @property
    def axle_distances_m(self):
        """From the centre of gravity to the front and to the rear axle."""
        return (1 - self.front_share) * self.wheelbase_m, self.front_share * self.wheelbase_m

    @property
    def half_width_m(self):
        """Of the body."""
        return self.track_rear_m / 2 + 0.15

    @property
    def length_m(self):
        return self.front_overhang_m + self.wheelbase_m + self.rear_overhang_m

    @property
    def is_symmetric(self):
        return layouts.is_symmetric(self.front, self.rear)

    @property
    def text(self):
        front, rear = layouts.FRONTS[self.front].text, layouts.REARS[self.rear].text
        return f"{self.kind}: front {front}; rear {rear}"


def between(limits, share):
    return float(limits[0] + (limits[1] - limits[0]) * share)


def clipped(value, limits):
    return float(min(limits[1], max(limits[0], value)))


def sample(n, seed):
    """The first `n` cars of a seed."""
    return [car(index, seed) for index in range(n)]


def car(index, seed):
    block, row = 0, index
    if index >= DESIGN_CARS:
        block, row = divmod(index - DESIGN_CARS, LATER_CARS)
        block += 1
    kinds, shares = _design(seed, block)
    return _car(index, kinds[row], _classes_of(block)[kinds[row]], dict(zip(COORDINATES, shares[row])))


def _classes_of(block):
    return (CLASSES, WIDE_CLASSES, EDGE_CLASSES)[min(block, 2)]


@lru_cache
def _design(seed, block):
    """Classes and coordinates of the cars of a design. The cars of a class spread over every range."""
    classes, n_cars = _classes_of(block), LATER_CARS if block else DESIGN_CARS
    rng = np.random.default_rng([seed, block])
    kinds = [name for name, of in classes.items() for _ in range(of.n_of_design)]
    assert len(kinds) == n_cars, "the classes fill the design"
    shares = np.empty((n_cars, len(COORDINATES)))
    for name in classes:
        rows = [row for row, kind in enumerate(kinds) if kind == name]
        shares[rows] = qmc.LatinHypercube(d=len(COORDINATES), rng=rng).random(len(rows))
    order = rng.permutation(n_cars)
    return [kinds[row] for row in order], shares[order]


def _car(index, kind, of, u):

    def with_mass(name):
        """Long, wide cars on large tires are the heavy ones of a class."""
        return 0.5 * (u["mass"] + u[name])

    mass = between(of.mass_kg, u["mass"])
    wheelbase = between(of.wheelbase_m, with_mass("wheelbase"))
    track = between(of.track_m, with_mass("track"))
    radius = between(of.tire_radius_m, with_mass("tire_radius"))
    height = min(between(of.cg_height_m, u["cg_height"]), TALLEST_OVER_TRACK * track)
    front, rear = of.pairs[min(len(of.pairs) - 1, int(len(of.pairs) * u["pair"]))]
    front_stiffness = between(of.cornering_stiffness_over_load, u["stiffness"])
    rear_stiffness = front_stiffness * between(REAR_OVER_FRONT_STIFFNESS, u["stiffness_ratio"])
    limits = of.least_rear_stiffness_over_load, of.largest_rear_stiffness_over_load
    rear_stiffness = clipped(rear_stiffness, limits)
    front_frequency = between((1.05, 1.45), u["front_frequency"])
    rear_frequency = clipped(front_frequency * between((1.04, 1.20), u["rear_frequency"]), RIDE_FREQUENCY_HZ)
    front_bar = between(of.bar_over_wheel_rate, u["front_bar"])
    # Roll gyration over the track, squared: a tall body has more.
    gyration2_over_track2 = 0.150 + 0.16 * (height - 0.5)
    scale = wheelbase / 2.757
    return Car(
        name=f"car-{index:03d}", index=index, kind=kind, front=front, rear=rear, wheelbase_m=wheelbase,
        track_front_m=track, track_rear_m=track + between((-0.03, 0.02), u["track_difference"]), mass_kg=mass,
        front_share=between(of.front_share, u["front_share"]), cg_height_m=height,
        yaw_inertia_ratio=between(of.yaw_inertia_ratio, u["yaw_inertia"]),
        roll_gyration2_m2=track**2 * gyration2_over_track2 * between((0.92, 1.08), u["roll_inertia"]),
        tire_radius_m=radius,
        wheel_mass_kg=(14 + 200 * (radius - 0.28)) * between((0.88, 1.12), u["wheel_mass"]),
        ride_frequencies_hz=(front_frequency, rear_frequency),
        bar_over_wheel_rate=(front_bar, front_bar * between((0.0, 0.55), u["rear_bar"])),
        damping_ratio=between((0.22, 0.40), u["damping"]),
        cornering_stiffness_over_load=(front_stiffness, rear_stiffness),
        # A stiff tire reaches its peak at a smaller slip.
        slip_at_peak=(between((2.25, 2.60), u["front_slip"]) / front_stiffness,
                      between((2.70, 3.10), u["rear_slip"]) / rear_stiffness),
        sliding_over_peak=between(of.sliding_over_peak, u["sliding"]),
        link_mass_factors=(layouts.link_mass_factor(layouts.FRONTS[front], mass),
                           layouts.link_mass_factor(layouts.REARS[rear], mass)),
        driven_axle=FRONT_DRIVEN if u["driven"] < of.front_driven_share else REAR_DRIVEN,
        drag_area_m2=between(of.drag_area_m2, u["drag"]), spring_free_travel_m=of.spring_free_travel_m,
        rear_tie_rod_raise_m=TIE_ROD_RAISE_M if rear == "e90" and mass > HEAVY_KG else 0.0,
        front_overhang_m=between((0.70, 0.95), u["front_overhang"]) * scale**0.5,
        rear_overhang_m=between((0.70, 1.05), u["rear_overhang"]) * scale)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--cars", type=int, default=DESIGN_CARS)
    parser.add_argument("--seed", type=int, default=20261128)
    args = parser.parse_args()
    for of in sample(args.cars, args.seed):
        print(f"{of.name} {of.mass_kg:5.0f} kg, wheelbase {of.wheelbase_m:.2f} m, "
              f"track {of.track_front_m:.2f} m, CG {of.cg_height_m:.2f} m, front {of.front_share:.2f}, "
              f"{of.text}")


if __name__ == "__main__":
    main()
