"""Makes a car ready to be driven: its description, tuned, and its data sheet, measured on it."""

import json
import os
import time
from dataclasses import asdict

from description import build, save
from measure import Tests, vehicle_toml


def read_json(path):
    """The content of a file; None where there is none."""
    return json.loads(path.read_text()) if path.exists() else None


def same(one, other):
    """Whether two values are the same once they are written as JSON."""
    return json.dumps(one) == json.dumps(other)


def prepare(car, folder, library, driver, report):
    """Builds and measures a car unless its folder has it. One that no data sheet describes has no `vehicle.toml`,
    and `figures.json` says why."""
    built = read_json(folder / "build.json")
    if not built or not same(built["parameters"], asdict(car)):
        began = time.time()
        built = build(car, folder, library, driver)
        report(car.name, f"built in {time.time() - began:.0f} s")
    _measure(car, folder, built, driver, report)


def _measure(car, folder, built, driver, report):
    if (folder / "vehicle.toml").exists() or "refused" in (read_json(folder / "figures.json") or {}):
        return
    began = time.time()
    try:
        figures = Tests(car, folder, driver).run()
    except ValueError as reason:
        figures = {"refused": str(reason)}
    if figures.get("understeer_rad_g", 1) <= 0:
        figures["refused"] = "oversteers"
    save(folder / "figures.json", figures)
    if "refused" not in figures:
        waiting = folder / "vehicle.toml.part"
        waiting.write_text(vehicle_toml(car, built, figures))
        os.replace(waiting, folder / "vehicle.toml")
    report(car.name, f"measured in {time.time() - began:.0f} s: {figures.get('refused', 'sound')}")
