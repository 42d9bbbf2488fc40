"""The sample of motions of a car: how fast it drives, on what road, what strikes it, what its driver does.

A motion begins with the impact at time 0. Twelve motions are a Latin hypercube of a seed and a car. The force
is a pulse along the heading of the car and across it, at one point of its flank; half of the time it is
struck on the left.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import qmc

from cars import between
from description import GRAVITY_M_S2, loaded_radius_m, static_loads_n

# What each of a car's twelve motions does beside coasting.
KINDS = ("coast", "driver-brake", "coast", "rear-wheel-drag", "steer", "coast", "engine-brake", "coast",
         "driver-brake", "rear-wheel-lock", "coast", "steer-brake")
N_MOTIONS = len(KINDS)
LONGEST_S = 12.0
SPEED_M_S = (3.0, 45.0)
USUAL_FRICTION, ANY_FRICTION = (0.6, 0.9), (0.2, 1.0)
# Lateral impulse over the mass, log-uniform, and the impulse along the heading over it.
LATERAL_DELTA_V_M_S = (0.5, 6.0)
ALONG_OVER_ACROSS = (-0.4, 0.4)
PULSE_S = (0.06, 0.20)
# No pulse pushes harder than that, N/kg; it lasts longer instead.
LARGEST_FORCE_N_KG = 75.0
# A pulse of two bumps: share of the impulse of the first, its length, the gap behind it over its length.
FIRST_SHARE, FIRST_LENGTH, GAP = (0.25, 0.75), (0.35, 0.65), (-0.25, 0.15)
PULSE_STEP_S = 5e-4
# Where a rear quarter is struck: ahead of the rear axle, for a wheelbase of 2.757 m; a quarter of the motions
# is struck anywhere from the front axle to there.
REAR_QUARTER_M = (-0.75, 0.30)
REFERENCE_WHEELBASE_M = 2.757
ANYWHERE_SHARE = 0.25
# Height of the point above the road, and that on cars with large tires.
HEIGHT_M, TALL_HEIGHT_M, LARGE_TIRE_M = (0.42, 0.60), (0.48, 0.68), 0.34
# A driver who brakes: when, deceleration that the torques ask for over that of gravity, share in front, rise.
BRAKE_START_S, BRAKE_DEMAND_G, BRAKE_FRONT_SHARE, BRAKE_RISE_S = (0.5, 1.5), (0.3, 1.2), (0.58, 0.68), 0.3
# A rear wheel that drags: torque over that which the road can hold; twice the load locks it.
DRAG_START_S, DRAG_RISE_S, DRAG_SHARE, LOCKING_SHARE = 0.03, 0.05, (0.15, 0.60), 2.0
ENGINE_G = (0.03, 0.08)
# A driver who steers: the front wheels turn from a time on, at a rate, to an angle that is held.
STEER_START_S, STEER_RAD = (0.2, 1.0), tuple(np.radians((2.0, 20.0)))
STEER_RATE_RAD_S = tuple(np.radians((10.0, 45.0)))
# Share of the range of a steering that is used: its linkage is far from folding over.
STEERING_RANGE = 0.95

COORDINATES = ("speed", "friction", "side", "delta_v", "along", "pulse", "shape", "first_share",
               "first_length", "gap", "place", "height", "brake_start", "brake_demand", "brake_front", "drag",
               "engine", "steer_start", "steer_angle", "steer_rate", "steer_side")


@dataclass(frozen=True)
class Motion:
    """A motion as it is sampled; SI units, rad, body axes of the car from its centre of gravity.

    - `brake_torque_n_m`: at the wheels front left, front right, rear left, rear right.
    - `steer_rad`: angle of the front wheels, positive to the left; 0 for a driver who does not steer.
    """

    name: str
    kind: str
    speed_m_s: float
    friction: float
    side: str
    shape: str
    impulse_n_s: tuple
    time_s: tuple
    force_n: tuple
    point_m: tuple
    brake_start_s: float = 0.0
    brake_rise_s: float = 0.0
    brake_torque_n_m: tuple = (0.0, 0.0, 0.0, 0.0)
    locked_wheel: int | None = None
    engine_axle: int | None = None
    engine_torque_n_m: float = 0.0
    steer_start_s: float = 0.0
    steer_rad: float = 0.0
    steer_rate_rad_s: float = 0.0

    def request(self, steering_table):
        """What the driver is asked to compute."""
        asked = {"speed_m_s": self.speed_m_s, "friction": self.friction, "longest_s": LONGEST_S,
                 "force": {"time_s": list(self.time_s), "fx_n": [force[0] for force in self.force_n],
                           "fy_n": [force[1] for force in self.force_n], "point_m": list(self.point_m)}}
        if any(self.brake_torque_n_m):
            asked["brakes"] = {"start_s": self.brake_start_s, "rise_s": self.brake_rise_s,
                               "torque_n_m": list(self.brake_torque_n_m)}
        if self.engine_axle is not None:
            asked["engine"] = {"axle": self.engine_axle, "torque_n_m": self.engine_torque_n_m}
        angle = self.steered_rad(steering_table)
        if angle:
            end = self.steer_start_s + abs(angle) / self.steer_rate_rad_s
            asked["steer"] = {"time_s": [0.0, self.steer_start_s, end], "angle_rad": [0.0, 0.0, angle]}
        return asked

    def steered_rad(self, steering_table):
        """The angle that is held: that of the sample, or what the steering of the car can reach."""
        if self.steer_rad == 0.0:
            return 0.0
        right, left = steering_table["angle_rad"][0], steering_table["angle_rad"][-1]
        return min(STEERING_RANGE * left, max(STEERING_RANGE * right, self.steer_rad))


def sample(car, seed):
    """The motions of a car; the same seed gives the same ones."""
    rng = np.random.default_rng([seed, car.index, 1])
    shares = qmc.LatinHypercube(d=len(COORDINATES), rng=rng).random(N_MOTIONS)
    return [_motion(f"{car.name}_{i:02d}", KINDS[i], car, dict(zip(COORDINATES, share)))
            for i, share in enumerate(shares)]


def mirrored(request):
    """The same motion seen in a mirror."""
    image = {**request, "force": {**request["force"], "fy_n": [-force for force in request["force"]["fy_n"]]}}
    x, y, z = request["force"]["point_m"]
    image["force"]["point_m"] = [x, -y, z]
    if "brakes" in request:
        left_front, right_front, left_rear, right_rear = request["brakes"]["torque_n_m"]
        swapped = [right_front, left_front, right_rear, left_rear]
        image["brakes"] = {**request["brakes"], "torque_n_m": swapped}
    if "steer" in request:
        steer = request["steer"]
        image["steer"] = {**steer, "angle_rad": [-angle for angle in steer["angle_rad"]]}
    return image


def haversine(time, start, length):
    """A bump of one oscillation, 0 at both ends."""
    inside = (time > start) & (time < start + length)
    return np.where(inside, 1 - np.cos(2 * np.pi * (time - start) / length), 0.0)


def pulse(shape, length, first_share, first_length, gap):
    """Time and force of a pulse with the impulse 1."""
    if shape == "haversine":
        time = np.arange(0, length + PULSE_STEP_S / 2, PULSE_STEP_S)
        force = haversine(time, 0, length)
    else:
        one = length * first_length
        second_start = one + gap * one
        two = max(length - second_start, 0.3 * length)
        time = np.arange(0, second_start + two + PULSE_STEP_S / 2, PULSE_STEP_S)
        force = (first_share * haversine(time, 0, one) / one
                 + (1 - first_share) * haversine(time, second_start, two) / two)
    return time, force / np.trapezoid(force, time)


def _motion(name, kind, car, u):
    left = u["side"] < 0.5
    sign = 1 if left else -1
    friction = between(USUAL_FRICTION, 2 * u["friction"]) if u["friction"] < 0.5 else \
        between(ANY_FRICTION, 2 * u["friction"] - 1)
    shape = "haversine" if u["shape"] < 0.5 else "two-bump"
    lateral = car.mass_kg * float(np.exp(between(np.log(LATERAL_DELTA_V_M_S), u["delta_v"])))
    length = between(PULSE_S, u["pulse"])
    while True:
        time, force = pulse(shape, length, between(FIRST_SHARE, u["first_share"]),
                            between(FIRST_LENGTH, u["first_length"]), between(GAP, u["gap"]))
        if lateral * force.max() < LARGEST_FORCE_N_KG * car.mass_kg:
            break
        length *= 1.15
    along = between(ALONG_OVER_ACROSS, u["along"]) * lateral
    friction = round(friction, 2)
    impulse = (along, -sign * lateral)
    forces = tuple((float(impulse[0] * f), float(impulse[1] * f)) for f in force)
    return Motion(name=name, kind=kind, speed_m_s=round(between(SPEED_M_S, u["speed"]), 3), friction=friction,
                  side="left" if left else "right", shape=shape, impulse_n_s=tuple(map(float, impulse)),
                  time_s=tuple(map(float, time)), force_n=forces, point_m=_point(car, sign, u),
                  **_controls(kind, car, left, friction, u))


def _point(car, sign, u):
    front, rear = car.axle_distances_m
    scale = car.wheelbase_m / REFERENCE_WHEELBASE_M
    rearmost = -rear + REAR_QUARTER_M[0] * scale
    if u["place"] < ANYWHERE_SHARE:
        x = between((rearmost, front), u["place"] / ANYWHERE_SHARE)
    else:
        share = (u["place"] - ANYWHERE_SHARE) / (1 - ANYWHERE_SHARE)
        x = between((rearmost, -rear + REAR_QUARTER_M[1] * scale), share)
    height = between(TALL_HEIGHT_M if car.tire_radius_m > LARGE_TIRE_M else HEIGHT_M, u["height"])
    return round(x, 3), round(sign * car.half_width_m, 3), round(height, 3)


def _controls(kind, car, left, friction, u):
    """Brakes, engine and steering of a kind of motion."""
    weight, radius = car.mass_kg * GRAVITY_M_S2, loaded_radius_m(car)
    controls = {}
    if kind in ("driver-brake", "steer-brake"):
        force = between(BRAKE_DEMAND_G, u["brake_demand"]) * weight
        front = between(BRAKE_FRONT_SHARE, u["brake_front"])
        torque = round(force * front / 2 * radius), round(force * (1 - front) / 2 * radius)
        controls |= {"brake_start_s": round(between(BRAKE_START_S, u["brake_start"]), 3),
                     "brake_rise_s": BRAKE_RISE_S,
                     "brake_torque_n_m": (torque[0], torque[0], torque[1], torque[1])}
    if kind in ("rear-wheel-drag", "rear-wheel-lock"):
        is_locked = kind == "rear-wheel-lock"
        share = LOCKING_SHARE if is_locked else friction * between(DRAG_SHARE, u["drag"])
        wheel = 2 if left else 3
        torque = [0.0] * 4
        torque[wheel] = round(share * static_loads_n(car)[1] * radius)
        controls |= {"brake_start_s": DRAG_START_S, "brake_rise_s": DRAG_RISE_S,
                     "brake_torque_n_m": tuple(torque), "locked_wheel": wheel if is_locked else None}
    if kind == "engine-brake":
        controls |= {"engine_axle": car.driven_axle,
                     "engine_torque_n_m": round(between(ENGINE_G, u["engine"]) * weight * radius / 2, 1)}
    if kind in ("steer", "steer-brake"):
        side = 1 if u["steer_side"] < 0.5 else -1
        controls |= {"steer_start_s": round(between(STEER_START_S, u["steer_start"]), 3),
                     "steer_rad": round(float(side * between(STEER_RAD, u["steer_angle"])), 4),
                     "steer_rate_rad_s": round(float(between(STEER_RATE_RAD_S, u["steer_rate"])), 3)}
    return controls
