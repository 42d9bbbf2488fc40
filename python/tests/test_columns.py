"""Arrays hold the numbers of the program's own files, and are not copied."""

import csv
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from conftest import FORECAST, RECONSTRUCTION, SIMULATION, Run

import impactlab


def check_are_moved(arrays: Iterable[Any]) -> None:
    """The memory of an array is what the program has computed into, and no copy of numpy."""
    for array in arrays:
        assert array.dtype == np.float64
        assert not array.flags.owndata
        assert array.base is not None
        assert array.flags.c_contiguous


def test_a_motion_is_that_of_the_report() -> None:
    motion = impactlab.simulate(SIMULATION)
    assert motion.striking is not None
    assert motion.recorded is None
    for columns in [motion.columns, motion.striking]:
        check_are_moved(columns.values())
        assert list(columns)[:3] == ["time_s", "x_m", "y_m"]
        assert {array.shape for array in columns.values()} == {columns["time_s"].shape}
    end = motion.report["end"]
    assert motion.columns["x_m"][-1] == end["x_m"]
    assert motion.columns["y_m"][-1] == end["y_m"]


def test_a_forecast_has_bands_and_paths_of_both_vehicles() -> None:
    forecast = impactlab.predict(FORECAST)
    assert forecast.striking_bands is not None
    assert forecast.striking_paths is not None
    for bands, paths in [
        (forecast.bands, forecast.paths),
        (forecast.striking_bands, forecast.striking_paths),
    ]:
        check_are_moved([*bands.values(), *paths.values()])
        n = bands["time_s"].size
        assert bands["time_s"][-1] == 2.0
        for name in ["x_m", "y_m", "yaw_rad", "vx_m_s", "vy_m_s", "yaw_rate_rad_s"]:
            edges = [bands[f"{name}_{edge}"] for edge in ["low_90", "low_50", "high_50", "high_90"]]
            assert all(edge.shape == (n,) for edge in edges)
            assert np.all(np.diff(edges, axis=0) > -1e-9)
            assert np.all(bands[f"{name}_std"] >= 0.0)
        for name in ["x_m", "y_m", "yaw_rad"]:
            assert paths[name].shape == (8, paths["time_s"].size)
            assert np.all(np.isfinite(paths[name]))


def test_particles_are_those_of_the_file(run: Run, tmp_path: Path) -> None:
    particles = impactlab.reconstruct(RECONSTRUCTION).particles
    check_are_moved(particles.values())
    out = tmp_path / "out"
    evidence = RECONSTRUCTION["evidence"]["file"]
    run("reconstruct", evidence, "--particles", "100", "--out", out)
    with (out / "particles.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 100
    assert set(rows[0]) - set(particles) <= {"restrictions"}
    for name, values in particles.items():
        np.testing.assert_array_equal(values, [float(row[name]) for row in rows])
