"""The 4DOF vehicle that coasts under a collision force: the formulas of crates/core/src/vehicle/
{four_dof,tire,loads}.rs, by numpy for several cars side by side and by numba for one car.
They are written twice so that each peer has what is fastest for it: numpy the four wheels of all cars in
one array, numba one number after the other. With the tire in functions of both, to the same last bit,
numba took 6.4 ms a motion instead of 5.6.

States are v_x, v_y, ψ, r, φ, φ̇, X, Y; forces F_x, F_y, M_z in body axes, held over 10 ms.
"""

import math
from typing import NamedTuple

import numba
import numpy as np

STEP_S, STEPS_PER_SAMPLE = 1e-3, 10
G, ROLLING_SPEED, SLIP_SPEED, SLIDING_SLIP, LAG_SLIP, LAGGING = 9.80665, 0.05, 0.5, 0.5, 0.2, 0.2


class Car(NamedTuple):
    mass: float
    izz: float
    ixx: float
    ixz: float
    front: float
    rear: float
    half_track: float
    height: float
    roll_axis: float
    sprung: float  # m_s h
    roll_stiffness: float
    roll_damping: float
    front_share: float
    front_cornering: float
    rear_cornering: float
    friction: float
    sliding: float
    resistance: tuple
    wheel_mass: float


def car(toml):
    """A car from a vehicle file without a slope whose wheels hold alike in all directions."""
    mass, geometry = toml["mass"], toml["geometry"]
    suspension, tires = toml["suspension"], toml["tires"]
    assert tires.get("longitudinal_friction_ratio", 1.0) == 1.0
    resistance = [tires["rolling_resistance" + unit] for unit in ("", "_s_m", "_s2_m2")]
    return Car(
        mass=mass["mass_kg"], izz=mass["yaw_inertia_kg_m2"], ixx=mass["roll_inertia_kg_m2"],
        ixz=mass["roll_yaw_product_kg_m2"], front=geometry["cg_to_front_axle_m"],
        rear=geometry["cg_to_rear_axle_m"], half_track=geometry["track_width_m"] / 2,
        height=geometry["cg_height_m"], roll_axis=suspension["roll_axis_height_m"],
        sprung=mass["sprung_mass_kg"] * suspension["roll_arm_m"],
        roll_stiffness=suspension["roll_stiffness_n_m_rad"],
        roll_damping=suspension["roll_damping_n_m_s_rad"],
        front_share=suspension["front_roll_stiffness_share"],
        front_cornering=tires["cornering_coefficient_front_per_rad"],
        rear_cornering=tires["cornering_coefficient_rear_per_rad"], friction=tires["friction"],
        sliding=tires["sliding_friction_ratio"], resistance=tuple(resistance),
        wheel_mass=tires["wheel_inertia_kg_m2"] / tires["rolling_radius_m"] ** 2,
    )


def numpy_derivative(car, x, force, contact_height):
    """- `x`: [8, n]; `force`: [3, n]; `contact_height`: [n]."""
    vx, vy, yaw, r, roll, roll_rate, _, _ = x
    fx, fy, mz = force
    wheel_x = np.array([car.front, car.front, -car.rear, -car.rear])[:, None]
    wheel_y = car.half_track * np.array([1.0, -1.0, 1.0, -1.0])[:, None]
    cornering = np.repeat([car.front_cornering, car.rear_cornering], 2)[:, None]
    u, w = vx - r * wheel_y, vy + r * wheel_x
    speed = np.abs(u)
    slip = -np.arctan(w / (speed + SLIP_SPEED))
    loss = (1 - car.sliding) * (1 - np.exp(-((slip / SLIDING_SLIP) ** 2)))
    friction = (1 - loss) * car.friction
    stiffness = slip * (cornering / car.friction)
    constant, linear, square = car.resistance
    rolling = -(constant + speed * (linear + speed * square)) * np.tanh(u / ROLLING_SPEED)
    along = np.clip(rolling, -friction, friction)
    room = np.maximum(friction**2 - rolling**2, 0)
    side = stiffness * np.sqrt(room / (stiffness**2 + 1))
    size = np.sqrt(side**2 + (LAGGING * friction) ** 2 + 1e-30)
    drag = side**2 / size
    rest = w * w + LAG_SLIP**2
    across = np.sqrt(rest)
    arm = contact_height - car.height
    leaning = np.sin(roll) * car.sprung * G
    weight = car.mass * G
    to_right = np.zeros_like(vx)
    front_load = np.full_like(vx, weight * car.rear / (car.front + car.rear))
    for passed in range(3):
        if passed:
            to_front = fx * arm - along_n.sum(0) * car.height
            front_load = (to_front + weight * car.rear) / (car.front + car.rear)
            front_load = np.clip(front_load, 0, weight)
            to_right = leaning - fy * arm + across_n.sum(0) * car.height
        halves = []
        rear_load, rear_share = weight - front_load, 1 - car.front_share
        for load, share in (front_load, car.front_share), (rear_load, rear_share):
            half = load / 2
            shift = np.clip(to_right * share / (2 * car.half_track), -half, half)
            halves += [half - shift, half + shift]
        load = np.stack(halves)
        tire_n = size * load + 1e-6
        lag, lag_slip, below = 0.0, across, 1.0
        for _ in range(2):
            a, b = car.wheel_mass * r * lag_slip, tire_n * below
            below = a * a + b * b
            lag = a * (u * a + w * b)
            lag_slip = np.sqrt(lag * lag + rest * below * below)
        along_n = (along - drag * lag / lag_slip) * load
        across_n = side * (across * below / lag_slip) * load
        squared, limit = along_n**2 + across_n**2, (friction * load) ** 2 + 1e-12
        scale = np.sqrt(np.minimum(limit / np.maximum(squared, 1e-300), 1))
        along_n, across_n = along_n * scale, across_n * scale
    ax, ay = (along_n.sum(0) + fx) / car.mass, (across_n.sum(0) + fy) / car.mass
    yaw_moment = (across_n * wheel_x - along_n * wheel_y).sum(0) + mz
    roll_moment = leaning + ay * car.sprung - roll * car.roll_stiffness
    roll_moment -= roll_rate * car.roll_damping + fy * (contact_height - car.roll_axis)
    determinant = car.izz * car.ixx - car.ixz**2
    r_dot = (yaw_moment * car.ixx - roll_moment * car.ixz) / determinant
    roll_dot = (roll_moment * car.izz - yaw_moment * car.ixz) / determinant
    sin, cos = np.sin(yaw), np.cos(yaw)
    across, along = vx * sin + vy * cos, vx * cos - vy * sin
    return np.stack([ax + vy * r, ay - vx * r, r, r_dot, roll_rate, roll_dot, along, across])


def numpy_motions(car, start, forces, contact_height):
    """Motions side by side, [samples, 8, n]. - `forces`: [samples, 3, n]."""
    x, motion = start, [start]
    for force in forces[:-1]:
        f = lambda at: numpy_derivative(car, at, force, contact_height)
        for _ in range(STEPS_PER_SAMPLE):
            k1 = f(x)
            k2 = f(x + k1 * (STEP_S / 2))
            k3 = f(x + k2 * (STEP_S / 2))
            k4 = f(x + k3 * STEP_S)
            x = x + (k1 + 2 * (k2 + k3) + k4) * (STEP_S / 6)
        motion.append(x)
    return np.stack(motion)


@numba.njit
def numba_derivative(car, x, force, contact_height, out):
    vx, vy, yaw, r, roll, roll_rate = x[0], x[1], x[2], x[3], x[4], x[5]
    fx, fy, mz = force
    arm = contact_height - car.height
    leaning = math.sin(roll) * car.sprung * G
    weight, wheelbase = car.mass * G, car.front + car.rear
    front_load, to_right = weight * car.rear / wheelbase, 0.0
    along_sum, across_sum, moment = 0.0, 0.0, 0.0
    slips = np.empty((4, 9))
    for i in range(4):
        y = car.half_track if i % 2 == 0 else -car.half_track
        place = car.front if i < 2 else -car.rear
        cornering = car.front_cornering if i < 2 else car.rear_cornering
        u, w = vx - r * y, vy + r * place
        speed = abs(u)
        slip = -math.atan(w / (speed + SLIP_SPEED))
        loss = (1 - car.sliding) * (1 - math.exp(-((slip / SLIDING_SLIP) ** 2)))
        friction = (1 - loss) * car.friction
        stiffness = slip * (cornering / car.friction)
        constant, linear, square = car.resistance
        rolling = -(constant + speed * (linear + speed * square)) * math.tanh(u / ROLLING_SPEED)
        along = min(max(rolling, -friction), friction)
        room = max(friction**2 - rolling**2, 0.0)
        side = stiffness * math.sqrt(room / (stiffness**2 + 1))
        size = math.sqrt(side**2 + (LAGGING * friction) ** 2 + 1e-30)
        rest = w * w + LAG_SLIP**2
        slips[i, 0], slips[i, 1], slips[i, 2], slips[i, 3] = u, w, friction, along
        slips[i, 4], slips[i, 5], slips[i, 6], slips[i, 7] = side, size, side**2 / size, rest
        slips[i, 8] = math.sqrt(rest)
    for passed in range(3):
        if passed:
            to_front = fx * arm - along_sum * car.height
            front_load = min(max((to_front + weight * car.rear) / wheelbase, 0.0), weight)
            to_right = leaning - fy * arm + across_sum * car.height
        along_sum, across_sum, moment = 0.0, 0.0, 0.0
        for i in range(4):
            axle = front_load if i < 2 else weight - front_load
            share = car.front_share if i < 2 else 1 - car.front_share
            half = axle / 2
            shift = min(max(to_right * share / (2 * car.half_track), -half), half)
            load = half - shift if i % 2 == 0 else half + shift
            u, w, friction = slips[i, 0], slips[i, 1], slips[i, 2]
            along, side, size = slips[i, 3], slips[i, 4], slips[i, 5]
            drag, rest, across = slips[i, 6], slips[i, 7], slips[i, 8]
            tire_n = size * load + 1e-6
            lag, lag_slip, below = 0.0, across, 1.0
            for _ in range(2):
                a, b = car.wheel_mass * r * lag_slip, tire_n * below
                below = a * a + b * b
                lag = a * (u * a + w * b)
                lag_slip = math.sqrt(lag * lag + rest * below * below)
            along_n = (along - drag * lag / lag_slip) * load
            across_n = side * (across * below / lag_slip) * load
            squared, limit = along_n**2 + across_n**2, (friction * load) ** 2 + 1e-12
            if squared > limit:
                scale = math.sqrt(limit / squared)
                along_n, across_n = along_n * scale, across_n * scale
            y = car.half_track if i % 2 == 0 else -car.half_track
            place = car.front if i < 2 else -car.rear
            along_sum, across_sum = along_sum + along_n, across_sum + across_n
            moment += across_n * place - along_n * y
    ax, ay = (along_sum + fx) / car.mass, (across_sum + fy) / car.mass
    yaw_moment = moment + mz
    roll_moment = leaning + ay * car.sprung - roll * car.roll_stiffness
    roll_moment -= roll_rate * car.roll_damping + fy * (contact_height - car.roll_axis)
    determinant = car.izz * car.ixx - car.ixz**2
    sin, cos = math.sin(yaw), math.cos(yaw)
    out[0], out[1], out[2] = ax + vy * r, ay - vx * r, r
    out[3] = (yaw_moment * car.ixx - roll_moment * car.ixz) / determinant
    out[4] = roll_rate
    out[5] = (roll_moment * car.izz - yaw_moment * car.ixz) / determinant
    out[6], out[7] = vx * cos - vy * sin, vx * sin + vy * cos


@numba.njit
def numba_motion(car, start, forces, contact_height):
    """One motion, [samples, 8]. - `forces`: [samples, 3]."""
    n = len(forces)
    motion = np.empty((n, 8))
    motion[0] = start
    x, at = start.copy(), np.empty(8)
    k1, k2, k3, k4 = np.empty(8), np.empty(8), np.empty(8), np.empty(8)
    for sample in range(n - 1):
        force = (forces[sample, 0], forces[sample, 1], forces[sample, 2])
        for _ in range(STEPS_PER_SAMPLE):
            numba_derivative(car, x, force, contact_height, k1)
            for i in range(8):
                at[i] = x[i] + k1[i] * (STEP_S / 2)
            numba_derivative(car, at, force, contact_height, k2)
            for i in range(8):
                at[i] = x[i] + k2[i] * (STEP_S / 2)
            numba_derivative(car, at, force, contact_height, k3)
            for i in range(8):
                at[i] = x[i] + k3[i] * STEP_S
            numba_derivative(car, at, force, contact_height, k4)
            for i in range(8):
                x[i] += (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]) * (STEP_S / 6)
        motion[sample + 1] = x
    return motion
