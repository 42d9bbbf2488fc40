"""What is computed: a Latin hypercube over pairs of cars that touch and push each other, kind by kind.

    python3 scenarios.py [--cases 48] [--seed 20261129]       prints the sample

A design has 48 cases; case i of a seed is always the same one, however many are asked for. The struck car stands
at the origin along X, the striking one on its right (`side` right) or left. A third of the PIT manoeuvres has a
twin, the same case with electronic stability control on the struck car.
"""

import argparse
import json
import math
import sys
from dataclasses import asdict, dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from scipy.stats import qmc

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "cars"))

import cars  # noqa: E402: a module of the other generator
from cars import between  # noqa: E402
from description import GRAVITY_M_S2  # noqa: E402

LAW = json.loads((HERE / "law.json").read_text())
# Cases of one Latin hypercube by their kinds; more cases take further designs.
KINDS = {"pit": 24, "pit-tap": 6, "pit-away": 6, "side-swipe": 4, "rear-end": 4, "t-bone": 4}
DESIGN_CASES = sum(KINDS.values())
SEED, CAR_SEED = 20261129, 20261128
LONGEST_S, STEP_S = 8.0, 5e-4

# Steering wheel over the mean angle of the front wheels.
STEERING_RATIO = 16.0
STEER_START_S = 0.1
# Half of the PIT manoeuvres on any road, the others on a usual one.
ANY_FRICTION, USUAL_FRICTION, OTHER_FRICTION = (0.35, 0.90), (0.70, 0.85), (0.45, 0.85)
# What is not known of a contact: stiffness of each car and of what springs back, over the usual one
# (log-uniform), and friction between the bodies.
STIFFNESS, ELASTIC, CONTACT_FRICTION = (0.65, 1.35), (0.6, 1.8), (0.20, 0.50)
# Height of bumper and sill over the road: 0.45 m on a tire of 0.28 m, more on larger ones. From the largest
# radius on a car has the front of a tall one.
BUMPER_M, BUMPER_AT_TIRE_M, TALL_TIRE_M = 0.45, 0.28, 0.34
# Share of the PIT manoeuvres with a twin, and up to which share they have stability control and no twin.
TWIN_SHARE, CONTROL_SHARE = 0.35, 0.45

STRUCK_DRIVERS = {"coast": 0.27, "brake": 0.25, "counter": 0.33, "hold": 0.15}
STRIKING_DRIVERS = {"push": 0.45, "brake": 0.35, "lift": 0.20}
CALM_DRIVERS = {"push": 0.20, "brake": 0.50, "lift": 0.30}
TAP_DRIVERS = {"brake": 0.70, "lift": 0.30}

COORDINATES = ("struck", "striking", "side", "friction", "any_road", "speed", "faster", "gap", "place", "heading",
               "steer", "rise", "hold", "straightens", "steer_after", "release", "brake", "driver", "away",
               "away_time", "struck_driver", "reaction", "struck_brake", "anti_lock", "gain", "rate_gain", "delay",
               "struck_stiffness", "striking_stiffness", "contact_friction", "elastic", "control")


@dataclass(frozen=True)
class Pair:
    """A case as it is sampled; SI units, rad. Pairs are struck and striking car.

    - `cars`: indices of the cars in the sample of `cars.py`.
    - `at_m`: where the centre of gravity of the striking car starts.
    - `place_m`: where the struck car is touched, ahead of its rear axle; None for a rear-end collision, which
      `at_m` decides.
    - `stiffness`, `elastic`: over the usual ones of the law of contact.
    - `twin_of`: name of the case without stability control.
    """

    name: str
    index: int
    kind: str
    side: str
    cars: tuple
    friction: float
    speeds_m_s: tuple
    at_m: tuple
    heading_rad: float
    place_m: float | None
    struck_driver: dict
    striking_driver: dict
    stiffness: tuple
    elastic: float
    contact_friction: float
    has_stability_control: bool = False
    twin_of: str | None = None

    @property
    def base(self):
        """The name that says which part of a data set the case is in: twins stay together."""
        return self.twin_of or self.name

    @property
    def sampled(self):
        """Both cars."""
        return tuple(cars.car(index, CAR_SEED) for index in self.cars)

    def is_row(self, row):
        """Whether a row of a table is of this case and not of another one of the same name."""
        texts = [self.name, self.kind, self.side, *(car.name for car in self.sampled)]
        numbers = {"mu": self.friction, "target_stiffness_scale": self.stiffness[0],
                   "contact_friction": self.contact_friction, "elastic_stiffness_scale": self.elastic}
        return [row[name] for name in ("case", "kind", "side", "target", "bullet")] == texts and all(
            math.isclose(float(row[name]), value, rel_tol=1e-4) for name, value in numbers.items())

    def request(self, understeer_rad_g):
        """What drive_pair is asked to compute; the cars are in the folder `cars` beside that of the request.

        - `understeer_rad_g`: of the struck car, as it was measured.
        """
        struck, striking = ({"car": f"../cars/{car.name}/car.json", "speed_m_s": speed, "shape": shape(car),
                             "driven_axle": car.driven_axle, "law": law(car, factor)}
                            for car, speed, factor in zip(self.sampled, self.speeds_m_s, self.stiffness))
        struck["driver"] = dict(self.struck_driver)
        if self.has_stability_control:
            struck["driver"]["control_understeer_rad_s2_m"] = understeer_rad_g / GRAVITY_M_S2
        x, y = self.at_m
        striking |= {"driver": self.striking_driver, "x_m": x, "y_m": y, "heading_rad": self.heading_rad}
        asked = {"friction": self.friction, "longest_s": LONGEST_S, "step_s": STEP_S,
                 "side": 1 if self.side == "right" else -1, "struck": struck, "striking": striking,
                 "contact": {"height_m": sum(map(bumper_height_m, self.sampled)) / 2,
                             "friction": self.contact_friction,
                             "elastic_n_m2": LAW["elastic_n_m2"] * self.elastic}}
        if self.place_m is not None:
            asked["place_m"] = self.place_m
        return asked


def mirrored(request):
    """The same case seen in a mirror."""
    striking = request["striking"]
    return {**request, "side": -request["side"],
            "striking": {**striking, "y_m": -striking["y_m"], "heading_rad": -striking["heading_rad"]}}


def bumper_height_m(car):
    return BUMPER_M + car.tire_radius_m - BUMPER_AT_TIRE_M


def shape(car):
    """Plan view of the body."""
    front, rear = car.axle_distances_m
    return {"cg_to_front_axle_m": front, "cg_to_rear_axle_m": rear, "front_overhang_m": car.front_overhang_m,
            "rear_overhang_m": car.rear_overhang_m, "width_m": 2 * car.half_width_m,
            "wheel_radius_m": car.tire_radius_m}


def law(car, factor):
    """Stiffness and forces of the body per metre of outline."""
    front = LAW["tall_front_n_m2" if car.tire_radius_m > TALL_TIRE_M else "front_n_m2"]
    scaled = {name: factor * LAW[name] for name in ("side_n_m2", "rear_n_m2", "first_force_n_m",
                                                    "largest_force_n_m")}
    others = {name: value for name, value in LAW.items()
              if name not in scaled and name not in ("front_n_m2", "tall_front_n_m2", "elastic_n_m2")}
    return {**others, **scaled, "front_n_m2": factor * front}


def sample(n, seed):
    """The first `n` cases of a seed, each followed by its twin if it has one."""
    return [pair for index in range(n) for pair in pairs(index, seed)]


def pairs(index, seed):
    """A case and its twin."""
    block, row = divmod(index, DESIGN_CASES)
    kinds, shares = _design(seed, block)
    u = dict(zip(COORDINATES, map(float, shares[row])))
    pair = _pair(index, kinds[row], u)
    if not pair.kind.startswith("pit") or u["control"] > CONTROL_SHARE:
        return [pair]
    if u["control"] > TWIN_SHARE:
        return [replace(pair, has_stability_control=True)]
    return [pair, replace(pair, name=f"{pair.name}e", has_stability_control=True, twin_of=pair.name)]


@lru_cache
def _design(seed, block):
    """Kinds and coordinates of the cases of a design. The cases of a kind spread over every range."""
    rng = np.random.default_rng([seed, block])
    kinds = [kind for kind, n in KINDS.items() for _ in range(n)]
    shares = np.concatenate([qmc.LatinHypercube(d=len(COORDINATES), rng=rng).random(n)
                             for n in KINDS.values()])
    order = rng.permutation(DESIGN_CASES)
    return [kinds[row] for row in order], shares[order]


def chosen(weights, share):
    """The name that a share falls to."""
    ends = np.cumsum(list(weights.values()))
    return list(weights)[min(len(weights) - 1, int(np.searchsorted(ends, share * ends[-1], side="right")))]


def log_between(limits, share):
    return math.exp(between((math.log(limits[0]), math.log(limits[1])), share))


def _pair(index, kind, u):
    struck_index = min(cars.DESIGN_CARS - 1, int(cars.DESIGN_CARS * u["struck"]))
    striking_index = min(cars.DESIGN_CARS - 1, int(cars.DESIGN_CARS * u["striking"]))
    if striking_index == struck_index:
        striking_index = (striking_index + 1) % cars.DESIGN_CARS
    sampled = cars.car(struck_index, CAR_SEED), cars.car(striking_index, CAR_SEED)
    side = "right" if u["side"] < 0.5 else "left"
    place = {"side-swipe": _side_swipe, "rear-end": _rear_end, "t-bone": _t_bone}.get(kind, _pit)
    rounded = {name: _rounded(value) for name, value in
               place(kind, u, sampled, 1 if side == "right" else -1).items()}
    return Pair(name=f"p{index:03d}", index=index, kind=kind, side=side, cars=(struck_index, striking_index),
                friction=round(_friction(kind, u), 3), struck_driver=_struck_driver(u),
                striking_driver=_striking_driver(kind, u),
                stiffness=tuple(round(log_between(STIFFNESS, u[name]), 3)
                                for name in ("struck_stiffness", "striking_stiffness")),
                elastic=round(log_between(ELASTIC, u["elastic"]), 3),
                contact_friction=round(between(CONTACT_FRICTION, u["contact_friction"]), 3), **rounded)


def _rounded(value):
    if isinstance(value, tuple):
        return tuple(map(_rounded, value))
    return None if value is None else round(value, 4)


def _friction(kind, u):
    if not kind.startswith("pit"):
        return between(OTHER_FRICTION, u["friction"])
    return between(ANY_FRICTION if u["any_road"] < 0.5 else USUAL_FRICTION, u["friction"])


def _pit(kind, u, sampled, sign):
    """Side by side, the striking car a little faster; its corner meets the rear quarter."""
    struck, striking = sampled
    gap, faster, place = {"pit": ((0.10, 0.60), (-1.0, 4.0), (-0.6, 0.6)),
                          "pit-tap": ((0.15, 0.40), (-0.5, 3.0), (-0.6, 0.4)),
                          "pit-away": ((0.10, 0.30), (-1.0, 2.5), (-0.6, 0.5))}[kind]
    speed = between((10.0, 35.0), u["speed"])
    behind = struck.axle_distances_m[1] + striking.axle_distances_m[0] + striking.front_overhang_m - 0.2
    apart = struck.half_width_m + striking.half_width_m + between(gap, u["gap"])
    return {"speeds_m_s": (speed, speed + between(faster, u["faster"])), "at_m": (-behind, -sign * apart),
            "heading_rad": 0.0, "place_m": between(place, u["place"])}


def _side_swipe(_, u, sampled, sign):
    struck, striking = sampled
    speed = between((12.0, 32.0), u["speed"])
    behind = struck.axle_distances_m[1] + striking.axle_distances_m[0]
    apart = struck.half_width_m + striking.half_width_m + 0.35
    return {"speeds_m_s": (speed, speed + between((-3.0, 8.0), u["faster"])), "at_m": (-behind, -sign * apart),
            "heading_rad": sign * math.radians(between((3.0, 10.0), u["heading"])),
            "place_m": between((-0.3, 2.2), u["place"])}


def _rear_end(_, u, sampled, sign):
    struck, striking = sampled
    speed = between((5.0, 22.0), u["speed"])
    behind = (struck.axle_distances_m[1] + struck.rear_overhang_m + striking.axle_distances_m[0]
              + striking.front_overhang_m + between((0.4, 1.2), u["gap"]))
    return {"speeds_m_s": (speed, speed + between((3.0, 8.0), u["faster"])),
            "at_m": (-behind, -sign * between((0.25, 1.2), u["place"])),
            "heading_rad": math.radians(between((-3.0, 3.0), u["heading"])), "place_m": None}


def _t_bone(_, u, sampled, sign):
    struck, striking = sampled
    apart = struck.half_width_m + striking.axle_distances_m[0] + striking.front_overhang_m + 0.6
    return {"speeds_m_s": (between((3.0, 14.0), u["speed"]), between((5.0, 12.0), u["faster"])),
            "at_m": (0.0, -sign * apart),
            "heading_rad": sign * math.radians(between((70.0, 110.0), u["heading"])),
            "place_m": between((-0.2, struck.wheelbase_m + 0.2), u["place"])}


def _struck_driver(u):
    driver = {"kind": chosen(STRUCK_DRIVERS, u["struck_driver"]), "anti_lock": u["anti_lock"] < 0.7}
    if driver["kind"] != "coast":
        driver["reaction_s"] = round(between((0.8, 1.5), u["reaction"]), 3)
    if driver["kind"] == "brake":
        driver["brake_g"] = round(between((0.4, 1.1), u["struck_brake"]), 3)
    if driver["kind"] == "counter":
        driver |= {"steer_gain": round(between((0.6, 1.1), u["gain"]), 3),
                   "steer_rate_gain_s": round(between((0.05, 0.25), u["rate_gain"]), 3),
                   "steer_delay_s": round(between((0.15, 0.25), u["delay"]), 3)}
    return driver


def _striking_driver(kind, u):
    if not kind.startswith("pit"):
        name = chosen(CALM_DRIVERS, u["driver"])
        return _released({"kind": name}, u, (0.5, 1.5), (0.6, 1.0))
    driver = {"kind": chosen(STRIKING_DRIVERS, u["driver"]), "straightens": True,
              "steer_start_s": STEER_START_S}
    turn, rise, hold, release, brake = (90.0, 180.0), (0.2, 0.5), (0.05, 0.30), (0.5, 1.5), (0.6, 1.0)
    if kind == "pit":
        driver["straightens"] = u["straightens"] < 0.4
        after = (0.3, 1.2) if driver["kind"] == "push" else (0.15, 0.60)
        driver["steer_after_contact_s"] = round(between(after, u["steer_after"]), 3)
    elif kind == "pit-tap":
        driver["kind"] = chosen(TAP_DRIVERS, u["driver"])
        turn, rise, hold, release, brake = (90.0, 170.0), (0.2, 0.35), (0.02, 0.12), (0.03, 0.25), (0.7, 1.0)
    else:
        driver["kind"] = "brake"
        turn, rise, hold, release, brake = (90.0, 150.0), (0.2, 0.3), (0.0, 0.06), (0.0, 0.15), (0.8, 1.0)
    steer = math.radians(between(turn, u["steer"])) / STEERING_RATIO
    driver |= {"steer_rad": round(steer, 4), "steer_rise_s": round(between(rise, u["rise"]), 3),
               "steer_hold_s": round(between(hold, u["hold"]), 3)}
    if kind == "pit-away":
        driver |= {"away_rad": round(steer * between((0.6, 1.2), u["away"]), 4),
                   "away_s": round(between((0.4, 0.8), u["away_time"]), 3)}
    return _released(driver, u, release, brake)


def _released(driver, u, release_s, brake_g):
    """When a driver lets go of the throttle, and how he brakes."""
    if driver["kind"] != "push":
        driver["release_s"] = round(between(release_s, u["release"]), 3)
    if driver["kind"] == "brake":
        driver["brake_g"] = round(between(brake_g, u["brake"]), 3)
    return driver


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--cases", type=int, default=DESIGN_CASES)
    parser.add_argument("--seed", type=int, default=SEED)
    args = parser.parse_args()
    for pair in sample(args.cases, args.seed):
        print(json.dumps(asdict(pair)))


if __name__ == "__main__":
    main()
