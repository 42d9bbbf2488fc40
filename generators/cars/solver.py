"""Calls the driver. A result is there whole or not at all: it is written under another name and renamed."""

import json
import os
import subprocess

# A run that takes longer is given up, s of wall time.
LONGEST_WALL_S = 3600


class Stopped(Exception):
    """The driver was stopped from outside: what it computed is to be computed again."""


def call(driver, *arguments):
    """Runs the driver; raises RuntimeError with what it says where it fails."""
    command = [str(driver), *map(str, arguments)]
    try:
        ended = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST_WALL_S, check=False)
    except subprocess.TimeoutExpired as error:
        raise RuntimeError(f"takes longer than {LONGEST_WALL_S} s") from error
    if ended.returncode < 0:
        raise Stopped(f"the driver was stopped by signal {-ended.returncode}")
    if ended.returncode != 0:
        raise RuntimeError(ended.stderr.strip()[-300:] or f"the driver ends with status {ended.returncode}")


def solve(driver, command, folder):
    """The answer of the driver to `tune`, `inspect` or `steering` for the car of a folder."""
    answer = folder / f"{command}.json.part"
    call(driver, command, folder / "car.json", answer)
    told = json.loads(answer.read_text())
    answer.unlink()
    return told


def drive(driver, car_folder, request, record):
    """Computes a motion: `record` is written, what the driver says of it is returned."""
    endings = ".motion.json", ".csv.part", ".told.part"
    motion, waiting, answer = (record.with_suffix(ending) for ending in endings)
    record.parent.mkdir(parents=True, exist_ok=True)
    motion.write_text(json.dumps(request))
    call(driver, "drive", car_folder / "car.json", motion, waiting, answer)
    told = json.loads(answer.read_text())
    answer.unlink()
    motion.unlink()
    os.replace(waiting, record)
    return told
