"""The description of a car for the driver: subsystems, masses, springs, dampers, tires.

Springs follow from the ride frequencies and the sprung masses, which the driver finds: `build` lets it settle
the car and takes the spring forces as preloads, so that the car stands at its design height.
"""

import json
import math
import os
import shutil
from dataclasses import asdict

import layouts
from solver import solve

GRAVITY_M_S2 = 9.81
# Static deflection of every tire, m.
TIRE_DEFLECTION_M = 0.023
# Degressivity of the dampers, s/m, and their damping at rest over that of the damping ratio.
DEGRESSIVITY_S_M = 1.2
LOW_SPEED_DAMPING = 1.25
PITCH_OVER_YAW_INERTIA = 0.91
PRODUCT_OVER_YAW_INERTIA = 0.03
ROLLING_RESISTANCE = 0.010
# Settling with these finds the sprung masses.
FIRST_SPRING_N_M, FIRST_DAMPING_N_S_M, FIRST_FREE_TRAVEL_M = 60e3, 6000.0, 0.08
FIRST_PRELOAD_OVER_LOAD = 1.2
FIRST_BARS_N_M = (20e3, 5e3)


def static_loads_n(car):
    """Load of a front and of a rear wheel."""
    weight = car.mass_kg * GRAVITY_M_S2
    return weight * car.front_share / 2, weight * (1 - car.front_share) / 2


def yaw_inertia_kg_m2(car):
    front, rear = car.axle_distances_m
    return car.yaw_inertia_ratio * car.mass_kg * front * rear


def loaded_radius_m(car):
    return car.tire_radius_m - TIRE_DEFLECTION_M


def tire(car, axle):
    """Table of TMeasy's form; the peak lateral coefficient is 1 at the mean static load."""
    load = car.mass_kg * GRAVITY_M_S2 / 4
    radius = car.tire_radius_m
    lateral = (load, 1.80 * load)
    longitudinal = tuple(1.08 * force for force in lateral)
    stiffness = car.cornering_stiffness_over_load[axle] * load
    slip_stiffness = 1.45 * car.cornering_stiffness_over_load[1] * load
    peak_slip = car.slip_at_peak[axle]
    longitudinal_slip = 0.105 + 0.15 * (car.slip_at_peak[1] - 0.12)
    wide = peak_slip / 0.17
    return {
        "nominal_load_n": load, "largest_load_n": 3.2 * load, "unloaded_radius_m": radius,
        "width_m": 0.62 * radius, "rim_radius_m": 0.66 * radius,
        "vertical_stiffness_n_m": static_loads_n(car)[axle] / TIRE_DEFLECTION_M,
        "vertical_damping_n_s_m": 190.0,
        "longitudinal_stiffness_n": [slip_stiffness, 1.9 * slip_stiffness],
        "longitudinal_peak_n": list(longitudinal),
        "longitudinal_sliding_n": [car.sliding_over_peak * force for force in longitudinal],
        "longitudinal_peak_slip": [longitudinal_slip, 0.95 * longitudinal_slip],
        "longitudinal_sliding_slip": 0.95,
        "lateral_stiffness_n": [stiffness, 1.62 * stiffness], "lateral_peak_n": list(lateral),
        "lateral_sliding_n": [car.sliding_over_peak * force for force in lateral],
        "lateral_peak_slip": [peak_slip, 0.94 * peak_slip], "lateral_sliding_slip": 1.0,
        "trail_over_contact_length": [0.10, 0.14], "zero_trail_slip": [0.135 * wide, 0.155 * wide],
        "friction_of_table": 1.0,
    }


def describe(car, library, springs):
    """The files of a car: name and content.

    - `springs`: for each axle its stiffness, preload, free travel, damping, degressivity and anti-roll bar.
    """
    front, steering = layouts.front_axle(library, car.front, car.track_front_m, car.link_mass_factors[0])
    rear = layouts.rear_axle(library, car.rear, car.track_rear_m, car.link_mass_factors[1],
                             car.rear_tie_rod_raise_m)
    front_hub, rear_hub = front["Spindle"]["COM"], rear["Spindle"]["COM"]
    front_at = [-front_hub[0], 0.0, -front_hub[2]]
    rear_at = [-car.wheelbase_m - rear_hub[0], 0.0, -rear_hub[2]]
    load = car.mass_kg * GRAVITY_M_S2 / 4
    yaw_inertia = yaw_inertia_kg_m2(car)
    wheel_inertia = car.wheel_mass_kg * car.tire_radius_m**2
    axles = []
    for axle, (name, suspension, at) in enumerate((("front", front, front_at), ("rear", rear, rear_at))):
        axles.append({
            "suspension": {"template": suspension["Template"], "file": f"{name}.json", "location_m": at},
            **springs[axle],
            "wheel_mass_kg": car.wheel_mass_kg, "wheel_cross_inertia_kg_m2": 0.42 * wheel_inertia,
            "wheel_spin_inertia_kg_m2": 0.72 * wheel_inertia,
            "rolling_radius_m": car.tire_radius_m - 0.33 * TIRE_DEFLECTION_M, "tire": tire(car, axle),
        })
    description = {
        "name": car.name, "wheelbase_m": car.wheelbase_m, "mass_kg": car.mass_kg,
        "cg_to_front_axle_m": car.axle_distances_m[0], "cg_height_m": car.cg_height_m,
        "design_height_m": loaded_radius_m(car), "roll_inertia_kg_m2": car.roll_gyration2_m2 * car.mass_kg,
        "pitch_inertia_kg_m2": PITCH_OVER_YAW_INERTIA * yaw_inertia, "yaw_inertia_kg_m2": yaw_inertia,
        "roll_yaw_product_kg_m2": PRODUCT_OVER_YAW_INERTIA * yaw_inertia, "drag_area_m2": car.drag_area_m2,
        "reference_load_n": load, "rolling_resistance": ROLLING_RESISTANCE,
        "carcass": {"longitudinal_stiffness_n_m": 61 * load, "lateral_stiffness_n_m": 45 * load,
                    "longitudinal_damping_n_s_m": 0.204 * load, "lateral_damping_n_s_m": 0.204 * load},
        "steering": {"template": steering["Template"], "file": "steering.json",
                     "location_m": layouts.steering_location_m(car.front, front_at)},
        "axles": axles,
    }
    return {"front.json": front, "rear.json": rear, "steering.json": steering, "car.json": description}


def build(car, folder, library, driver):
    """Writes and tunes the description of a car; returns what was found on the way and is in `build.json`."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    loads = static_loads_n(car)
    springs = [_spring(FIRST_SPRING_N_M, FIRST_PRELOAD_OVER_LOAD * loads[axle], FIRST_FREE_TRAVEL_M,
                       FIRST_DAMPING_N_S_M, 0.0, FIRST_BARS_N_M[axle]) for axle in (0, 1)]
    files = _write(folder, describe(car, library, springs))
    suspensions = files["front.json"], files["rear.json"]
    unsprung = [layouts.unsprung_mass_kg(suspension, car.wheel_mass_kg) for suspension in suspensions]
    rest = solve(driver, "tune", folder)
    for _ in range(2):
        found = [_sprung(car, axle, rest, unsprung[axle]) for axle in (0, 1)]
        springs = [of_axle["spring"] for of_axle in found]
        _write(folder, describe(car, library, springs))
        rest = solve(driver, "tune", folder)
    for axle in (0, 1):
        springs[axle]["spring_preload_n"] = rest["spring_preload_n"][axle]
    files = describe(car, library, springs)
    _write(folder, files)
    files["car.json"]["steering_table"] = solve(driver, "steering", folder)
    _write(folder, files)
    told = {"parameters": asdict(car), "at_rest": rest, "unsprung_mass_kg": unsprung,
            "wheel_rate_n_m": [of_axle["wheel_rate_n_m"] for of_axle in found],
            "spring_over_wheel_force": [of_axle["spring_over_wheel_force"] for of_axle in found],
            "anti_roll_bar_n_m": [spring["anti_roll_bar_n_m"] for spring in springs]}
    save(folder / "build.json", told)
    return told


def save(path, content):
    """Writes JSON so that the file is there whole or not at all."""
    waiting = path.with_name(path.name + ".part")
    waiting.write_text(json.dumps(content, indent=1))
    os.replace(waiting, path)


def _spring(stiffness, preload, free_travel, damping, degressivity, bar):
    return {"spring_stiffness_n_m": stiffness, "spring_preload_n": preload,
            "spring_free_travel_m": free_travel, "damping_n_s_m": damping, "degressivity_s_m": degressivity,
            "anti_roll_bar_n_m": bar}


def _sprung(car, axle, rest, unsprung_kg):
    """Spring, damper and bar of an axle from its ride frequency and the sprung mass on a wheel."""
    sprung_kg = rest["wheel_load_n"][axle] / GRAVITY_M_S2 - unsprung_kg
    wheel_rate = (2 * math.pi * car.ride_frequencies_hz[axle])**2 * sprung_kg
    ratio = rest["spring_preload_n"][axle] / (sprung_kg * GRAVITY_M_S2)
    damping = 2 * car.damping_ratio * math.sqrt(wheel_rate * sprung_kg) * ratio**2
    spring = _spring(stiffness=wheel_rate * ratio**2, preload=rest["spring_preload_n"][axle],
                     free_travel=car.spring_free_travel_m / ratio, damping=LOW_SPEED_DAMPING * damping,
                     degressivity=DEGRESSIVITY_S_M, bar=car.bar_over_wheel_rate[axle] * wheel_rate)
    return {"spring": spring, "wheel_rate_n_m": wheel_rate, "spring_over_wheel_force": ratio}


def _write(folder, files):
    for name, content in files.items():
        (folder / name).write_text(json.dumps(content, indent=1))
    return files
