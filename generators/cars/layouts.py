"""Suspension layouts: descriptions of Chrono, and those in `layouts/`, that make up a front or a rear axle.

Topology and hard points are those of the descriptions. Their y is scaled to the track of a car and the masses
of their links by a factor; what a car on the road cannot have (parts of a few grams, tie rods that steer the
wheels with the roll of the body) is changed here, each with its reason. The cars are not copies of the makes.
"""

import copy
import json
import re
from dataclasses import dataclass
from pathlib import Path

OWN_FOLDER = Path(__file__).resolve().parent / "layouts"


@dataclass(frozen=True)
class Front:
    """A front axle with its steering.

    - `suspension`, `steering`: files below Chrono's `data/vehicle`, or below `layouts/` with "own:" before.
    - `steering_offset_m`: place of the steering against that of the suspension.
    - `link_mass_at_kg`: mass of the car for which the masses of the links are right.
    - `is_symmetric`: whether a car of it moves in mirror images; a drag link or a rod across does not.
    """

    text: str
    suspension: str
    steering: str
    steering_offset_m: tuple
    link_mass_at_kg: float
    is_symmetric: bool = True
    camber_deg: float | None = None


@dataclass(frozen=True)
class Rear:
    text: str
    suspension: str
    link_mass_at_kg: float
    is_symmetric: bool = True


AT_SUSPENSION = (0.0, 0.0, 0.0)
AUDI_WISHBONES = "audi/json/audi_DoubleWishbone.json"
# The Pitman arm of the Patrol folds over at high yaw rates; this rack and pinion stands in for it.
VAN_RACK = "VW_microbus/json/van_RackPinion.json"

FRONTS = {
    # Two degrees of camber belong to the car of the E90 alone.
    "e90": Front("MacPherson struts (E90 layout)", "own:e90-front-struts.json", "own:e90-steering-rack.json",
                 (-0.2, 0.0, -0.05), 1700.0, camber_deg=-0.7),
    "audi": Front("double wishbones (Audi)", AUDI_WISHBONES, "audi/json/audi_RackPinion.json",
                  (-0.2, 0.0, -0.12), 1620.0),
    "sedan": Front("double wishbones (Sedan)", "sedan/suspension/Sedan_DoubleWishbone.json",
                   "sedan/steering/Sedan_RackPinion.json", (-0.2, 0.0, -0.12), 1480.0),
    "patrol": Front("double wishbones (Nissan Patrol, with rack and pinion)",
                    "Nissan_Patrol/json/suv_DoubleWishboneFront.json", VAN_RACK, (-0.25, 0.0, 0.054),
                    2900.0),
    "microbus": Front("double wishbones (VW microbus)", "VW_microbus/json/van_DoubleWishboneFront.json",
                      VAN_RACK, (-0.25, 0.0, 0.05), 2870.0),
    "uaz": Front("solid axle on leaf springs (UAZ-469, vertical guide), drag link",
                 "uaz/suspension/UAZ469_FrontLeafspringAxle.json", "uaz/steering/UAZ469_RotaryArm.json",
                 AT_SUSPENSION, 2500.0, is_symmetric=False),
    "g500": Front("solid axle with longitudinal links and Panhard rod (G500), rotary arm",
                  "gclass/suspension/G500_FrontAxle.json", "gclass/steering/G500_RotaryArm.json",
                  AT_SUSPENSION, 2900.0, is_symmetric=False),
    "cherokee": Front("solid axle on links with track bar and bell crank (Jeep Cherokee)",
                      "own:cherokee-front-axle.json", "own:cherokee-steering-arm.json", AT_SUSPENSION, 1950.0,
                      is_symmetric=False),
}

REARS = {
    "e90": Rear("double wishbones (E90 layout)", "own:e90-rear-wishbones.json", 1850.0),
    "audi": Rear("double wishbones (Audi)", AUDI_WISHBONES, 1620.0),
    # The library does not mirror the axes of its joints: some millimetres of difference.
    "multilink": Rear("multi-link (Sedan)", "sedan/suspension/Sedan_MultiLink.json", 1550.0,
                      is_symmetric=False),
    "patrol": Rear("double wishbones (Nissan Patrol)", "Nissan_Patrol/json/suv_DoubleWishboneRear.json",
                   2750.0),
    "trailing": Rear("semi-trailing arms (VW microbus)", "VW_microbus/json/van_SemiTrailingArm.json", 1400.0),
    "uaz": Rear("solid axle on leaf springs (UAZ, vertical guide)",
                "uaz/suspension/UAZBUS_RearLeafspringAxle.json", 2800.0),
    "g500": Rear("solid axle with longitudinal links and Panhard rod (G500)",
                 "gclass/suspension/G500_RearAxle.json", 2900.0, is_symmetric=False),
    # The same axle with parts as light as those of a twist beam, which the library does not have.
    "light-panhard": Rear("light solid axle with Panhard rod, in place of a twist beam",
                          "gclass/suspension/G500_RearAxle.json", 4000.0, is_symmetric=False),
    "cherokee": Rear("solid axle on leaf springs (Jeep Cherokee)", "own:cherokee-rear-leaf-springs.json",
                     1900.0),
}

# Parts whose weights in the library are no weights of a car: section, mass in kg, inertia in kg m2.
SPINDLE = (5.0, [0.02, 0.03, 0.02])
WISHBONE_PARTS = {"Spindle": SPINDLE, "Upright": (13.0, [0.15, 0.15, 0.06]),
                  "Upper Control Arm": (3.0, [0.02, 0.01, 0.03]),
                  "Lower Control Arm": (6.0, [0.06, 0.06, 0.12])}
PARTS = {
    ("front", "audi"): WISHBONE_PARTS,
    ("rear", "audi"): WISHBONE_PARTS,
    ("front", "sedan"): WISHBONE_PARTS,
    ("rear", "multilink"): {"Spindle": SPINDLE, "Upright": (12.0, [0.15, 0.15, 0.06])},
    ("rear", "patrol"): {"Spindle": (15.9, [0.04, 0.07, 0.04]), "Upright": (22.0, [0.2, 0.2, 0.06]),
                         "Upper Control Arm": (5.45, [0.03, 0.03, 0.06]),
                         "Lower Control Arm": (16.4, [0.3, 0.3, 0.6])},
    ("rear", "trailing"): {"Spindle": (6.0, [0.02, 0.03, 0.02]), "Trailing Arm": (18.0, [0.4, 0.5, 0.8])},
}
# The inner joints of the Audi axle at the rear are higher: without a rack the library's points give roll
# oversteer.
AUDI_REAR_TIE_ROD_M = [-0.2, 0.455, -0.080]
# The drag link of the UAZ lies at the height of its axle: from the library's point, 0.2 m above it, the
# wheels steer with the roll of the body and the link folds over.
UAZ_DRAG_LINK_HEIGHT_M = 0.02
UAZ_ARM_ABOVE_LINK_M = 0.20

# Force laws of the library, in whose place the driver puts its own.
SPRING_CURVES = ("Spring Curve Data", "Minimum Length", "Maximum Length")
SHOCK_CURVES = ("Damping Curve Data", "Degressivity Compression", "Degressivity Expansion")
# Spin inertia of the half shafts of an axle, kg m2.
AXLE_SHAFT_INERTIA_KG_M2 = 0.15


class Library:
    """Chrono's descriptions of vehicles (its folder `data/vehicle`) and the ones of this generator."""

    def __init__(self, chrono_data):
        self.chrono_data = Path(chrono_data)

    def read(self, name):
        path = OWN_FOLDER / name[4:] if name.startswith("own:") else self.chrono_data / name
        text = re.sub(r"//[^\n]*", "", path.read_text())
        return json.loads(re.sub(r",(\s*[}\]])", r"\1", text))


def front_axle(library, name, track_m, link_mass_factor):
    """Suspension and steering of a front layout for a track."""
    layout = FRONTS[name]
    suspension, steering = library.read(layout.suspension), library.read(layout.steering)
    _give_parts(suspension, "front", name)
    if name == "uaz":
        suspension["Knuckle"]["Location Draglink"][2] = UAZ_DRAG_LINK_HEIGHT_M
        suspension["Draglink"]["Location Chassis"][2] = UAZ_DRAG_LINK_HEIGHT_M
        steering["Pitman Arm"]["Point to Draglink"][2] = UAZ_DRAG_LINK_HEIGHT_M
        steering["Pitman Arm"]["Point of Rotation"][2] = UAZ_DRAG_LINK_HEIGHT_M + UAZ_ARM_ABOVE_LINK_M
    if layout.camber_deg is not None:
        suspension["Camber Angle (deg)"] = layout.camber_deg
    width = track_m / (2 * suspension["Spindle"]["COM"][1])
    suspension, steering = _scaled(suspension, width, link_mass_factor), _scaled(steering, width, 1.0)
    return _without_force_laws(suspension, "FrontSusp"), steering


def rear_axle(library, name, track_m, link_mass_factor, tie_rod_raise_m=0.0):
    """Suspension of a rear layout for a track; a raised inner joint of its tie rod lessens roll oversteer."""
    suspension = library.read(REARS[name].suspension)
    _give_parts(suspension, "rear", name)
    if name == "audi":
        suspension["Tierod"]["Location Chassis"] = list(AUDI_REAR_TIE_ROD_M)
    if tie_rod_raise_m:
        suspension["Tierod"]["Location Chassis"][2] += tie_rod_raise_m
    width = track_m / (2 * suspension["Spindle"]["COM"][1])
    return _without_force_laws(_scaled(suspension, width, link_mass_factor), "RearSusp")


def steering_location_m(front_name, suspension_location_m):
    return [at + offset for at, offset in zip(suspension_location_m, FRONTS[front_name].steering_offset_m)]


def link_mass_factor(layout, mass_kg):
    """Links of a heavier car are heavier."""
    return min(1.6, max(0.25, mass_kg / layout.link_mass_at_kg))


def is_symmetric(front_name, rear_name):
    return FRONTS[front_name].is_symmetric and REARS[rear_name].is_symmetric


def unsprung_mass_kg(suspension, wheel_mass_kg):
    """Per wheel: wheel, hub, upright or knuckle, half of links and axle tube, a quarter of the rods."""
    mass = wheel_mass_kg
    for section, part in suspension.items():
        if not isinstance(part, dict) or "Mass" not in part:
            continue
        if section in ("Spindle", "Upright", "Knuckle"):
            mass += part["Mass"]
        elif section in ("Panhard Rod", "Trackbar", "Draglink", "Bell Crank", "Tierod"):
            mass += 0.25 * part["Mass"]
        else:
            mass += 0.5 * part["Mass"]
    return mass


def _give_parts(suspension, end, name):
    for section, (mass_kg, inertia_kg_m2) in PARTS.get((end, name), {}).items():
        if section in suspension:
            part = suspension[section]
            part["Mass"] = mass_kg
            part["Moments of Inertia" if "Moments of Inertia" in part else "Inertia"] = list(inertia_kg_m2)


def _scaled(value, width, mass_factor, key=""):
    """Points with their y by `width`, masses and moments of inertia by `mass_factor`."""
    if isinstance(value, dict):
        return {name: _scaled(item, width, mass_factor, name) for name, item in value.items()}
    is_point = key.startswith(("Location", "COM", "Point ")) or key in ("Pitman Side", "Idler Side")
    if isinstance(value, list) and is_point:
        return [value[0], value[1] * width, value[2]]
    if isinstance(value, list) and "Inertia" in key:
        return [item * mass_factor for item in value]
    return value * mass_factor if key == "Mass" else value


def _without_force_laws(suspension, name):
    suspension = copy.deepcopy(suspension)
    suspension["Name"] = name
    for curve in SPRING_CURVES:
        suspension["Spring"].pop(curve, None)
    for curve in SHOCK_CURVES:
        suspension["Shock"].pop(curve, None)
    suspension["Spring"]["Spring Coefficient"] = 30000.0
    suspension["Shock"]["Damping Coefficient"] = 3000.0
    suspension["Axle"]["Inertia"] = AXLE_SHAFT_INERTIA_KG_M2
    return suspension
