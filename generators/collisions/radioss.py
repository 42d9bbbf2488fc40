"""Writes a collision as a deck for OpenRadioss: NAME_0000.rad (model) and NAME_0001.rad (run).

The model moves with the struck car's first velocity along X, which changes nothing but the rounding.
"""

import json
from pathlib import Path

from bodies import MATERIALS, PANELS, SELF_CONTACT
from model import INTERVAL_S, Model

FRICTION = 0.3
SELF_FRICTION = 0.2
SELF_GAP_M = 0.004
# Time step that is held by added mass, s.
TIME_STEP_S = 1e-5
INTEGRATION_POINTS = 3
# Shells of full integration with physical stabilisation.
SHELL_FORMULATION = 24
PLANAR_CORE = "   001 110"


def real(value):
    text = f"{value:.12g}"
    return text.rjust(20) if len(text) <= 20 else f"{value:.8e}".rjust(20)


def reals(*values):
    return "".join(real(value) for value in values)


def integers(*values):
    return "".join(f"{value:10d}" for value in values)


def in_lines(numbers):
    numbers = list(numbers)
    return [integers(*numbers[i:i + 10]) for i in range(0, len(numbers), 10)]


def words(*names):
    return "".join(f"{name:<10}" for name in names)


def write(model: Model, folder: Path, end_s: float):
    """Writes both files of a deck, and NAME.json with what is needed to read the results."""
    folder.mkdir(parents=True, exist_ok=True)
    name = model.name
    lines = ["#RADIOSS STARTER", "/BEGIN", name, "      2021         0"]
    lines += ["                  kg                   m                   s"] * 2 + ["/TITLE", name]
    for car in model.cars:
        lines += _car(car)
    first, second = ([car.base + k for k in range(6)] for car in model.cars)
    pairs = [(second[4], first[1], model.gap_m, FRICTION, "striking nodes on struck car"),
             (first[4], second[1], model.gap_m, FRICTION, "struck nodes on striking car"),
             (first[5], first[2], SELF_GAP_M, SELF_FRICTION, "struck car on itself"),
             (second[5], second[2], SELF_GAP_M, SELF_FRICTION, "striking car on itself")]
    for number, pair in enumerate(pairs, 1):
        lines += _contact(number, *pair)
    lines += _histories(model, len(pairs)) + ["/END"]
    (folder / f"{name}_0000.rad").write_text("\n".join(lines) + "\n")
    run = [f"/RUN/{name}/1", f"{end_s:.6g}", "/VERS/2021", "/TFILE", f"{INTERVAL_S:.6g}", "/PRINT/-1000",
           "/PARITH/OFF", "/DT/NODA/CST", f"0.9 {TIME_STEP_S:.4g}", "/RFILE", "1000000"]
    (folder / f"{name}_0001.rad").write_text("\n".join(run) + "\n")
    (folder / f"{name}.json").write_text(json.dumps(model.facts(), indent=1))


def _car(car):
    lines = ["/NODE"] + [f"{number:10d}{reals(*place)}" for number, place in car.numbered_nodes()]
    lines.append(f"{car.main_node:10d}{reals(*car.main_place)}")
    for panel, part in car.parts.items():
        lines += _panel(car, panel, part)
    for panel, part in car.parts.items():
        lines.append(f"/SHELL/{part}")
        lines += [integers(number, *nodes) for number, of, nodes in car.numbered_elements() if of == panel]
    base, inertia = car.base, car.body.inertia
    xy, yz, xz = inertia.products
    own = [part for panel, part in car.parts.items() if panel in SELF_CONTACT]
    lines += [f"/GRNOD/NODE/{base + 1}", "core"] + in_lines(car.core_nodes())
    lines += [f"/GRNOD/NODE/{base + 2}", "main", integers(car.main_node)]
    lines += [f"/GRNOD/NODE/{base + 3}", "all"] + in_lines(car.all_nodes())
    lines += [f"/RBODY/{car.number}", f"core_{car.number}"]
    lines += [integers(car.main_node, 0, 0, 0) + real(inertia.mass) + integers(base + 1, 0, 1, 0)]
    lines += [reals(.35 * inertia.core_about_z, inertia.core_about_z, inertia.about_z), reals(xy, yz, xz),
              integers(0, 0, 0)]
    lines += [f"/BCS/{car.number}", "plane", PLANAR_CORE + integers(0, base + 2)]
    # Velocity of the axes' origin, and rotation about Z.
    vx, vy = car.velocity_at_origin()
    lines += [f"/INIVEL/AXIS/{car.number}", "v0", f"{'Z':>10}" + integers(0, base + 3), reals(vx, vy, 0, car.yaw_rate)]
    lines += [f"/SURF/PART/{base + 1}", "all"] + in_lines(car.parts.values())
    lines += [f"/SURF/PART/{base + 2}", "self"] + in_lines(own)
    lines += [f"/GRNOD/PART/{base + 4}", "allparts"] + in_lines(car.parts.values())
    return lines + [f"/GRNOD/PART/{base + 5}", "selfparts"] + in_lines(own)


def _panel(car, panel, part):
    material_name = PANELS[panel][0]
    material, density = MATERIALS[material_name], car.density(panel)
    if material.is_void:
        lines = [f"/MAT/VOID/{part}", material_name, reals(1e-3, material.modulus, material.poisson)]
    elif material.yield_stress == 0:
        lines = [f"/MAT/ELAST/{part}", material_name, real(density), reals(material.modulus, material.poisson)]
    else:
        lines = [f"/MAT/PLAS_JOHNS/{part}", material_name, real(density),
                 reals(material.modulus, material.poisson) + integers(0),
                 reals(material.yield_stress, material.hardening, material.exponent, 0, material.largest),
                 reals(material.rate, 1.0) + integers(1, 1) + reals(2000, 0), reals(0, 0, 0, 0)]
    title = f"{car.body.shape.name}_{panel}"
    lines += [f"/PROP/SHELL/{part}", title, integers(SHELL_FORMULATION, 0, 0, 0), reals(0, 0, 0, 0, 0)]
    lines += [integers(INTEGRATION_POINTS, 0) + reals(car.body.thickness[panel], 0) + " " * 10 + integers(1, 1)]
    return lines + [f"/PART/{part}", title, integers(part, part, 0)]


def _contact(number, nodes, surface, gap, friction, title):
    return [f"/INTER/TYPE7/{number}", title, integers(nodes, surface, 4, 0, 0) + " " * 10 + integers(0, 0, 0, 0),
            reals(0, 0, 0) + " " * 20 + integers(0), reals(1e6, 1e9, 0, 0) + integers(0, 0),
            reals(1, friction, gap, 0, 0), "       000" + " " * 20 + integers(6) + reals(0, 0, 0),
            integers(0, 0) + real(0) + integers(2, 0, 0) + real(0) + integers(0)]


def _histories(model, n_contacts):
    parts = [part for car in model.cars for part in car.parts.values()]
    lines = ["/TH/INTER/1", "contact", words("FNX", "FNY", "FNZ", "FTX", "FTY", "FTZ", "MX", "MY", "MZ", "CE_ELAST"),
             words("CE_FRIC", "CE_DAMP"), integers(*range(1, n_contacts + 1))]
    lines += ["/TH/NODE/2", "cores", words("DX", "DY", "VX", "VY", "VZ", "AX", "AY", "VRX", "VRY", "VRZ")]
    lines += [f"{car.main_node:10d}{0:10d}core{car.number}" for car in model.cars]
    lines += ["/TH/PART/3", "parts", words("IE", "KE", "XMOM", "YMOM", "ZMOM", "MASS", "HE", "XCG", "YCG", "ZZMOM")]
    return lines + in_lines(parts)


