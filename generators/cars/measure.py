"""Static and steady tests on a car: what a data sheet says of it, `vehicle.toml` of its data set.

No value is taken from the tables of the tires: cornering stiffness, sliding friction and rolling resistance
are those of the whole car in a test, as they would be found on a real one.
"""

import math
import tempfile
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

import layouts
import records
from description import GRAVITY_M_S2, loaded_radius_m
from solver import drive, solve

STEP_S = 0.001
FRICTION = 0.8
# Circle: speed, steering rate at the road wheels, and the accelerations over which slopes are taken, g.
CIRCLE_M_S, CIRCLE_RAD_S, CIRCLE_S = 20.0, np.radians(0.5), 14.0
LINEAR_G, GRADIENT_G = (0.05, 0.30), (0.10, 0.35)
# Roll moment over mass times gravity times height of the centre of gravity, and when it is let go.
ROLL_MOMENT_SHARE, ROLL_M_S, ROLL_RELEASE_S, ROLL_S, ROLL_FIT_S = 0.10, 10.0, 3.0, 5.0, 1.2
# Sideways slide: the speeds between which the deceleration is taken.
SLIDE_M_S, SLIDE_FROM_M_S, SLIDE_TO_M_S, SLIDE_S = 12.0, 9.5, 4.0, 4.0
COAST_M_S, COAST_S = 10.0, 4.0
# Load at which impactlab expects the cornering stiffness of a tire, N.
STATED_LOAD_N = 4905.0
AIR_DENSITY_KG_M3 = 1.2


class Tests:
    """Runs the tests of a car in a folder that is gone afterwards."""

    def __init__(self, car, folder, driver):
        self.car, self.folder, self.driver = car, folder, driver

    def run(self):
        """All figures; raises ValueError for a car that no data sheet can describe."""
        figures = self.at_rest()
        figures |= self.circle(figures) | self.roll(figures) | self.slide() | self.coast()
        return figures

    def _drive(self, speed_m_s, longest_s, **more):
        request = {"speed_m_s": speed_m_s, "friction": FRICTION, "longest_s": longest_s, "step_s": STEP_S,
                   "stop_at_rest": False, **more}
        with tempfile.TemporaryDirectory() as folder:
            record = Path(folder) / "test.csv"
            drive(self.driver, self.folder, request, record)
            return records.read(record)

    def at_rest(self):
        told = solve(self.driver, "inspect", self.folder)
        x, y, load = (np.array([wheel[key] for wheel in told["wheels"]]) for key in ("x_m", "y_m", "load_n"))
        return {"mass_kg": told["mass_kg"], "links_and_wheels_kg": told["links_and_wheels_kg"],
                "cg_height_m": told["cg_height_m"], "cg_left_m": told["cg_left_m"],
                "roll_inertia_kg_m2": told["roll_inertia_kg_m2"],
                "pitch_inertia_kg_m2": told["pitch_inertia_kg_m2"],
                "yaw_inertia_kg_m2": told["yaw_inertia_kg_m2"],
                "roll_yaw_product_kg_m2": told["roll_yaw_product_kg_m2"],
                "loads_over_weight": float(load.sum() / (told["mass_kg"] * GRAVITY_M_S2)),
                "cg_to_front_axle_m": float(x[:2].mean()), "cg_to_rear_axle_m": float(-x[2:].mean()),
                "track_front_m": float(y[0] - y[1]), "track_rear_m": float(y[2] - y[3]),
                "wheel_load_n": [float(load[:2].mean()), float(load[2:].mean())]}

    def circle(self, at_rest):
        """Steered ever more at a constant speed: gradients of steer and roll angle, cornering stiffness."""
        angle = CIRCLE_RAD_S * CIRCLE_S
        record = self._drive(CIRCLE_M_S, CIRCLE_S, hold_speed=True, output_interval_s=0.05,
                             steer={"time_s": [0.0, CIRCLE_S], "angle_rad": [0.0, angle]})
        front, rear = at_rest["cg_to_front_axle_m"], at_rest["cg_to_rear_axle_m"]
        speed, rate, steer = record["vx_m_s"], record["yaw_rate_rad_s"], records.front_angle(record)
        lateral_g = speed * rate / GRAVITY_M_S2
        end = int(np.argmax(lateral_g > GRADIENT_G[1])) or int(np.argmax(lateral_g))
        start = int(np.argmax(lateral_g > GRADIENT_G[0]))
        if end <= start:
            raise ValueError(f"the car reaches {lateral_g.max():.2f} g in the circle")
        more_steer = steer - (front + rear) * rate / speed
        slip = np.array([steer - np.arctan2(record["vy_m_s"] + front * rate, speed),
                         -np.arctan2(record["vy_m_s"] - rear * rate, speed)])
        linear = (lateral_g > LINEAR_G[0]) & (lateral_g < LINEAR_G[1]) & (np.arange(len(speed)) <= end)
        over_load = [float(np.polyfit(of_axle[linear], lateral_g[linear], 1)[0]) for of_axle in slip]
        gained_g = lateral_g[end] - lateral_g[start]
        return {"understeer_rad_g": float((more_steer[end] - more_steer[start]) / gained_g),
                "roll_rad_g": float((record["roll_rad"][end] - record["roll_rad"][start]) / gained_g),
                "largest_lateral_g": float(lateral_g[record["time_s"] > 0.3].max()),
                "cornering_stiffness_over_load": over_load}

    def roll(self, at_rest):
        """A roll moment that is let go: roll stiffness, frequency, damping."""
        moment = ROLL_MOMENT_SHARE * at_rest["mass_kg"] * GRAVITY_M_S2 * at_rest["cg_height_m"]
        record = self._drive(ROLL_M_S, ROLL_S, hold_speed=True, roll_moment_n_m=moment,
                             roll_moment_until_s=ROLL_RELEASE_S)
        time, roll = record["time_s"], record["roll_rad"]
        held = roll[(time >= ROLL_RELEASE_S - 0.1) & (time < ROLL_RELEASE_S)].mean()
        free = (time >= ROLL_RELEASE_S - 1e-6) & (time < ROLL_RELEASE_S + ROLL_FIT_S)
        since, roll = time[free] - ROLL_RELEASE_S, roll[free]

        def error(of):
            frequency, ratio = abs(of[0]), min(abs(of[1]), 0.97)
            root = math.sqrt(1 - ratio**2)
            damped = frequency * root
            wave = np.cos(damped * since) + ratio / root * np.sin(damped * since)
            return held * np.exp(-ratio * frequency * since) * wave - roll

        frequency, ratio = np.abs(least_squares(error, [9.0, 0.25]).x)
        stiffness = moment / held
        damping = 2 * ratio * stiffness / frequency
        return {"roll_stiffness_n_m_rad": float(stiffness), "roll_damping_n_m_s_rad": float(damping),
                "roll_frequency_hz": float(frequency / (2 * math.pi)), "roll_damping_ratio": float(ratio)}

    def slide(self):
        """Pushed sideways: friction of tires that slide."""
        record = self._drive(0.5, SLIDE_S, sideways_kick_m_s=SLIDE_M_S, stop_at_rest=True)
        speed = np.hypot(record["vx_m_s"], record["vy_m_s"])
        start, end = int(np.argmax(speed < SLIDE_FROM_M_S)), int(np.argmax(speed < SLIDE_TO_M_S))
        if end <= start:
            raise ValueError("the car turns over when it is pushed sideways")
        slowing = (speed[start] - speed[end]) / (record["time_s"][end] - record["time_s"][start])
        return {"sliding_friction": float(slowing / GRAVITY_M_S2)}

    def coast(self):
        """Rolling straight: rolling resistance without the drag of the air, and how straight."""
        record = self._drive(COAST_M_S, COAST_S)
        speed, time = record["vx_m_s"], record["time_s"]
        slowing = (speed[0] - speed[-1]) / (time[-1] - time[0])
        drag = 0.5 * AIR_DENSITY_KG_M3 * self.car.drag_area_m2 * speed.mean()**2 / self.car.mass_kg
        return {"rolling_resistance": float((slowing - drag) / GRAVITY_M_S2),
                "sideways_in_4_s_m": float(abs(record["y_m"]).max())}


def vehicle_toml(car, built, figures):
    """The data sheet in the layout of the other trajectory data sets."""
    front, rear = layouts.FRONTS[car.front], layouts.REARS[car.rear]
    stiffness = [over_load * STATED_LOAD_N for over_load in figures["cornering_stiffness_over_load"]]
    vertical = [load / (car.tire_radius_m - loaded_radius_m(car)) for load in figures["wheel_load_n"]]
    tracks = figures["track_front_m"], figures["track_rear_m"]
    bars = [bar * track**2 for bar, track in zip(built["anti_roll_bar_n_m"], tracks)]
    understeer, roll = (math.degrees(figures[key]) for key in ("understeer_rad_g", "roll_rad_g"))
    rolling_radius = (2 * car.tire_radius_m + loaded_radius_m(car)) / 3
    return f"""\
# Multibody car put together from subsystems of Project Chrono::Vehicle (BSD-3); not a copy of any real car.
# Every value is a mass or length of the model at rest, or was measured on it in a static or steady test.
# {car.text}
name = "{car.name} ({car.kind})"
[mass]
total = {figures["mass_kg"]:.1f}  # kg
unsprung_and_links = {figures["links_and_wheels_kg"]:.1f}  # kg: wheels, hubs, arms, links, axle tubes
Ixx = {figures["roll_inertia_kg_m2"]:.1f}  # kg m2, whole car about its CG, axes x forward, y left, z up
Iyy = {figures["pitch_inertia_kg_m2"]:.1f}
Izz = {figures["yaw_inertia_kg_m2"]:.1f}
Ixz = {figures["roll_yaw_product_kg_m2"]:.1f}  # integral of x z dm
[geometry]
wheelbase = {figures["cg_to_front_axle_m"] + figures["cg_to_rear_axle_m"]:.4f}
lf = {figures["cg_to_front_axle_m"]:.4f}  # CG to front axle, m
lr = {figures["cg_to_rear_axle_m"]:.4f}
track_front = {figures["track_front_m"]:.4f}
track_rear = {figures["track_rear_m"]:.4f}
cg_height = {figures["cg_height_m"]:.4f}
half_width = {car.half_width_m:.3f}  # of the body
[body]
length = {car.length_m:.3f}
front_overhang = {car.front_overhang_m:.3f}  # front axle to the front end
[wheel]
unloaded_radius = {car.tire_radius_m:.4f}
effective_rolling_radius = {rolling_radius:.4f}
wheel_and_tyre_spin_inertia = {0.72 * car.wheel_mass_kg * car.tire_radius_m**2:.3f}  # kg m2 a wheel
static_load_front = {figures["wheel_load_n"][0]:.0f}  # N a wheel
static_load_rear = {figures["wheel_load_n"][1]:.0f}
vertical_stiffness_front = {vertical[0]:.0f}  # N/m, tire
vertical_stiffness_rear = {vertical[1]:.0f}
[suspension]
front = "{front.text}"
rear = "{rear.text}"
spring_front = {built["wheel_rate_n_m"][0]:.0f}  # N/m at the wheel
spring_rear = {built["wheel_rate_n_m"][1]:.0f}
anti_roll_bar_front = {bars[0]:.0f}  # N m/rad of body roll
anti_roll_bar_rear = {bars[1]:.0f}
[tyre]
# Circle at 20 m/s, 0.05 to 0.30 g, friction 0.8: axle side force over slip angle and load, N/rad at 4905 N.
cornering_stiffness_front = {stiffness[0]:.0f}
cornering_stiffness_rear = {stiffness[1]:.0f}
mu_definition = "peak lateral force over load at the mean static wheel load; falls with load"
sliding_over_peak = {min(1.0, figures["sliding_friction"] / FRICTION):.3f}  # pushed sideways, 9.5 to 4 m/s
rolling_resistance = {figures["rolling_resistance"]:.4f}  # coast-down from 10 m/s, air drag taken off
[aero]
CdA = {car.drag_area_m2:.3f}  # m2
[equivalent]
understeer_gradient_deg_per_g = {understeer:.2f}  # road wheels, circle, 0.10 to 0.35 g
roll_gradient_deg_per_g = {roll:.2f}
max_lateral_acceleration_g = {figures["largest_lateral_g"]:.3f}
roll_stiffness_whole_car = {figures["roll_stiffness_n_m_rad"]:.0f}  # N m/rad, with gravity
roll_damping_fit = {figures["roll_damping_n_m_s_rad"]:.0f}  # N m s/rad, roll moment that is let go
roll_frequency_hz = {figures["roll_frequency_hz"]:.2f}
roll_damping_ratio = {figures["roll_damping_ratio"]:.2f}
[powertrain]
driven = "{("front", "rear")[car.driven_axle]}"  # engine braking; otherwise neutral
"""
