"""Writes a collision as an LS-DYNA keyword deck, for those who have that solver.

    python3 lsdyna.py FOLDER [--cases 264] [--seed 20261127] [--prefix d] [--only NAME...]

The same nodes, shells, steels, rigid cores and velocities as the decks for OpenRadioss, in kg, m, s. Shells are
fully integrated (16); the contact law and the time step control are those of LS-DYNA, so that forces differ in
detail. The contact force is in `rcforc` (contact 1: on the struck car as its surface A), `impactlab` reads CSV.
"""

import argparse
from pathlib import Path

import scenarios
from bodies import MATERIALS, PANELS, SELF_CONTACT
from model import INTERVAL_S, Model
from radioss import FRICTION, INTEGRATION_POINTS, SELF_FRICTION, TIME_STEP_S
from run import LONGEST_S

FULLY_INTEGRATED = 16


def card(*values):
    """Fields of ten columns."""
    def field(value):
        if isinstance(value, str):
            return f"{value:>10}"
        if isinstance(value, int):
            return f"{value:10d}"
        return next(text.rjust(10) for digits in range(7, 1, -1) if len(text := f"{value:.{digits}g}") <= 10)

    return "".join(field(value) for value in values)


def lists(numbers):
    numbers = list(numbers)
    return [card(*numbers[i:i + 8]) for i in range(0, len(numbers), 8)]


def write(model: Model, path: Path, end_s: float = LONGEST_S):
    """Writes the deck."""
    lines = ["*KEYWORD", "*TITLE", f"{model.name}: a collision of two cars; kg, m, s"]
    lines += ["*CONTROL_TERMINATION", card(end_s), "*CONTROL_ENERGY", card(2, 2, 2, 2)]
    lines += ["*CONTROL_TIMESTEP", card(0.0, 0.9, 0, 0.0, -TIME_STEP_S)]
    for table in ("RCFORC", "GLSTAT", "MATSUM", "NODOUT"):
        lines += [f"*DATABASE_{table}", card(INTERVAL_S)]
    lines += ["*DATABASE_HISTORY_NODE", card(*(car.main_node for car in model.cars))]
    for car in model.cars:
        lines += _car(car)
    first, second = (car.base for car in model.cars)
    lines += ["*CONTACT_AUTOMATIC_SURFACE_TO_SURFACE_ID", card(1) + "struck car, striking car"]
    lines += _contact(first + 1, second + 1, FRICTION)
    for number, car in enumerate(model.cars, 2):
        lines += ["*CONTACT_AUTOMATIC_SINGLE_SURFACE_ID", card(number) + f"car {car.number} on itself"]
        lines += _contact(car.base + 2, 0, SELF_FRICTION)
    path.write_text("\n".join([*lines, "*END"]) + "\n")


def _contact(surface_a, surface_b, friction):
    part_set = 2
    return [card(surface_a, surface_b, part_set, part_set if surface_b else 0), card(friction, friction), card(0.0)]


def _car(car):
    lines = ["*NODE"]
    nodes = [*car.numbered_nodes(), (car.main_node, car.main_place)]
    lines += [f"{number:8d}" + "".join(f"{value:16.8e}" for value in place) for number, place in nodes]
    for panel, part in car.parts.items():
        lines += _panel(car, panel, part)
    lines.append("*ELEMENT_SHELL")
    lines += [f"{number:8d}{car.parts[panel]:8d}" + "".join(f"{node:8d}" for node in of)
              for number, panel, of in car.numbered_elements()]
    base, inertia = car.base, car.body.inertia
    lines += ["*SET_PART_LIST", card(base + 1), *lists(car.parts.values())]
    lines += ["*SET_PART_LIST", card(base + 2), *lists(p for name, p in car.parts.items() if name in SELF_CONTACT)]
    lines += ["*SET_NODE_LIST", card(base + 3), *lists([*car.core_nodes(), car.main_node])]
    lines += ["*SET_NODE_LIST", card(base + 4), *lists(car.all_nodes())]
    # What is added to the shells of the core; the body moves in the plane of the road.
    about_xy = .35 * inertia.core_about_z, inertia.core_about_z
    lines += ["*ELEMENT_INERTIA", f"{10_000_000 + car.number:8d}{car.main_node:8d}{0:8d}",
              card(about_xy[0], 0.0, 0.0, about_xy[1], 0.0, float(inertia.about_z), float(inertia.mass))]
    lines += ["*CONSTRAINED_NODAL_RIGID_BODY_SPC", card(base + 99, 0, base + 3, car.main_node), card(1.0, 3, 4)]
    (vx, vy), (x, y) = car.velocity, car.at
    rotation = [card(base + 4, 3, car.yaw_rate, vx, vy, 0.0), card(float(x), float(y), 0.0, 0.0, 0.0, 1.0, 0, 1)]
    return [*lines, "*INITIAL_VELOCITY_GENERATION", *rotation]


def _panel(car, panel, part):
    material, density = MATERIALS[PANELS[panel][0]], float(car.density(panel))
    thickness = float(car.body.thickness[panel])
    lines = ["*PART", f"{car.body.shape.name}_{panel}", card(part, part, part)]
    lines += ["*SECTION_SHELL", card(part, FULLY_INTEGRATED, 0.833, INTEGRATION_POINTS), card(*[thickness] * 4)]
    if material.is_void:
        return lines + ["*MAT_NULL", card(part, 1e-3, 0.0, 0.0, 0.0, 0.0, material.modulus, material.poisson)]
    elastic = card(part, density, material.modulus, material.poisson)
    if material.yield_stress == 0:
        return lines + ["*MAT_ELASTIC", elastic]
    plastic = card(material.yield_stress, material.hardening, material.exponent, material.rate, 1e17, material.largest,
                   1e28, 1.0)
    return lines + ["*MAT_SIMPLIFIED_JOHNSON_COOK", elastic, plastic]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--cases", type=int, default=264)
    parser.add_argument("--seed", type=int, default=20261127)
    parser.add_argument("--prefix", default="d")
    parser.add_argument("--only", nargs="*", help="names of cases")
    args = parser.parse_args()
    args.folder.mkdir(parents=True, exist_ok=True)
    for collision in scenarios.sample(args.cases, args.seed, args.prefix):
        if not args.only or collision.name in args.only:
            write(Model(collision.name, scenarios.placed(collision.mirrored())), args.folder / f"{collision.name}.k")


if __name__ == "__main__":
    main()
