"""Tests of what needs no solver: python3 -m unittest tests"""

import csv
import fcntl
import json
import math
import sys
import tempfile
import textwrap
import unittest
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import numpy as np

import collect
import histories
import run
import scenarios

import solver
from tables import is_held_out, read_table

SEED = 1
# A driver that answers at once. It notes its calls; beside files of these names it fails or is killed.
FAKE_DRIVER = '''\
    #!/usr/bin/env python3
    import json, os, signal, sys
    from pathlib import Path
    request, motions, contact, told = map(Path, sys.argv[1:])
    notes = Path(__file__).parent
    with open(notes / "calls.txt", "a") as calls:
        calls.write(request.name + chr(10))
    motions.write_text((notes / "motions.csv").read_text())
    contact.write_text((notes / "contact.csv").read_text())
    if (notes / "fail").exists():
        sys.exit("no such car")
    if (notes / "stop").exists():
        os.kill(os.getpid(), signal.SIGKILL)
    told.write_text((notes / "told.json").read_text())
    '''
SHEET = "[body]\nlength = 4.3\nfront_overhang = 0.8\n[wheel]\nunloaded_radius = 0.31\n"


def told(**other):
    """What drive_pair says of a case that holds: two intervals, the second one short."""
    cars = {f"{car}_{name}": value for car in run.CARS for name, value in {
        "start_energy_j": 1e5, "end_energy_j": 1e4, "energy_residual_j": 10.0, "work_of_outer_forces_j": -1e3,
        "contact_work_j": -500.0, "momentum_residual_n_s": 1e-9, "crush_m": 0.05}.items()}
    return {"diverged": False, "rolled_over": False, "linkage_folded": False, "at_rest": True, "touched": True,
            "first_contact_s": 0.5, "contact_m": [-1.5, 0.9, 0.5], "closing_m_s": [0.5, -2.0],
            "heading_rad": -0.1, "least_gap_before_m": 0.01, "largest_contact_gain_j": 0.0,
            "contact_moment_left_n_m_s": 1e-12,
            "intervals": [{"start_s": 0.5, "end_s": 0.6, "impulse_n_s": [100.0, -800.0],
                           "moment_n_m_s": 1200.0, "peak_n": 12000.0},
                          {"start_s": 1.0, "end_s": 1.01, "impulse_n_s": [0.0, -30.0], "moment_n_m_s": 40.0,
                           "peak_n": 4000.0}], **cars, **other}


def motions(n=200):
    """Columns of the motions: both cars drive straight ahead and are pushed between 0.5 and 0.6 s."""
    time = np.arange(n) * histories.ROW_S
    names = [f"{car}_{name}" for car in histories.CARS for name in (
        "x_m", "y_m", "yaw_rad", "roll_rad", "vx_m_s", "vy_m_s", "yaw_rate_rad_s", "roll_rate_rad_s")]
    columns = {name: np.zeros(n) for name in [
        "time_s", *names, "contact_fx_n", "contact_fy_n", "gap_m", "target_esc_active",
        "bullet_steering_wheel_rad"]}
    for car in histories.CARS:
        columns |= {f"{car}_x_m": 20.0 * time, f"{car}_vx_m_s": np.full(n, 20.0)}
    columns["bullet_y_m"] = np.full(n, 2.0)
    pushed = (time > 0.495) & (time < 0.595)
    return columns | {"time_s": time, "contact_fy_n": np.where(pushed, -8000.0, 0.0)}


def contact(n=400):
    """Milliseconds of a contact from 0.5 s on, and 20 ms of a second one a second later."""
    time = np.concatenate([0.5 + np.arange(n) * 0.001, 1.5 + np.arange(20) * 0.001])
    force = np.linspace(1000, 8000, n + 20)
    zeros = np.zeros(n + 20)
    interval = np.concatenate([np.ones(n), np.full(20, 2)])
    points = {name: np.full(n + 20, 1.5) for name in ("point_x_m", "point_y_m", "bullet_point_x_m",
                                                      "bullet_point_y_m")}
    return {"interval": interval, "time_s": time, "fx_n": zeros, "fy_n": force, "mz_nm": zeros,
            "bullet_mz_nm": zeros, **points}


def text(columns):
    rows = zip(*columns.values())
    return "\n".join([",".join(columns), *(",".join(f"{value:.6g}" for value in row) for row in rows)]) + "\n"


class Sample(unittest.TestCase):
    def setUp(self):
        self.sample = scenarios.sample(scenarios.DESIGN_CASES, SEED)

    def test_a_seed_gives_the_same_cases_and_another_one_others(self):
        self.assertEqual(scenarios.sample(5, SEED), scenarios.sample(5, SEED))
        self.assertNotEqual(scenarios.sample(5, SEED), scenarios.sample(5, SEED + 1))

    def test_a_seed_gives_the_same_requests(self):
        def requests():
            return json.dumps([pair.request(0.03) for pair in scenarios.sample(5, SEED)])
        one = requests()
        scenarios._design.cache_clear()
        self.assertEqual(one, requests())

    def test_a_case_is_the_same_however_many_are_asked_for(self):
        self.assertEqual(scenarios.sample(3, SEED), scenarios.sample(60, SEED)[:len(scenarios.sample(3, SEED))])
        one, two = (scenarios.pairs(index, SEED)[0] for index in (2, 2 + scenarios.DESIGN_CASES))
        self.assertNotEqual(replace(one, name="", index=0), replace(two, name="", index=0))

    def test_a_design_has_the_kinds_it_should(self):
        kinds = [pair.kind for pair in self.sample if not pair.twin_of]
        self.assertEqual({kind: kinds.count(kind) for kind in scenarios.KINDS}, scenarios.KINDS)

    def test_cases_are_in_their_ranges_and_cover_them(self):
        pits = [pair for pair in self.sample if pair.kind == "pit"]
        places = [pair.place_m for pair in pits]
        self.assertTrue(-0.6 <= min(places) < -0.5 and 0.5 < max(places) <= 0.6)
        speeds = [pair.speeds_m_s[0] for pair in pits]
        self.assertTrue(10 <= min(speeds) < 12 and 33 < max(speeds) <= 35)
        sides = [pair.side for pair in self.sample if not pair.twin_of]
        self.assertTrue(0.4 < sides.count("left") / len(sides) < 0.6)
        self.assertGreater(len({index for pair in self.sample for index in pair.cars}), 40)
        for pair in self.sample:
            self.assertNotEqual(*pair.cars)
            self.assertTrue(0.35 <= pair.friction <= 0.9, pair)
            self.assertTrue(all(0.65 <= factor <= 1.35 for factor in pair.stiffness))
            self.assertEqual(pair.at_m[1] < 0, pair.side == "right")
            self.assertEqual(pair.place_m is None, pair.kind == "rear-end")

    def test_the_cars_stand_apart_at_the_start(self):
        for pair in self.sample:
            struck, striking = pair.sampled
            behind = -pair.at_m[0] - (struck.length_m - struck.front_overhang_m - struck.axle_distances_m[0])
            clear = behind > striking.axle_distances_m[0] + striking.front_overhang_m
            beside = abs(pair.at_m[1]) > struck.half_width_m + striking.half_width_m
            self.assertTrue(clear or beside, pair)

    def test_a_twin_differs_in_stability_control_alone(self):
        twins = [pair for pair in self.sample if pair.twin_of]
        self.assertTrue(8 <= len(twins) <= 16, len(twins))
        by_name = {pair.name: pair for pair in self.sample}
        for twin in twins:
            one, other = by_name[twin.base].request(0.03), twin.request(0.03)
            control = other["struck"]["driver"].pop("control_understeer_rad_s2_m")
            self.assertAlmostEqual(control, 0.03 / 9.81)
            self.assertEqual(one, other)

    def test_the_mirror_image_of_a_mirror_image_is_the_case(self):
        for pair in self.sample:
            request = pair.request(0.03)
            image = scenarios.mirrored(request)
            self.assertEqual(image["striking"]["y_m"], -request["striking"]["y_m"])
            self.assertEqual(scenarios.mirrored(image), request)

    def test_a_share_falls_to_a_name_by_its_weight(self):
        weights = {"a": 0.2, "b": 0.3, "c": 0.5}
        fall = [scenarios.chosen(weights, share) for share in (0.0, 0.19, 0.21, 0.49, 0.51, 1.0)]
        self.assertEqual(fall, ["a", "a", "b", "b", "c", "c"])

    def test_a_tall_car_is_stiffer_in_front_and_higher(self):
        cars = sorted((car for pair in self.sample for car in pair.sampled), key=lambda car: car.tire_radius_m)
        low, tall = cars[0], cars[-1]
        self.assertEqual(scenarios.law(low, 1.0)["front_n_m2"], scenarios.LAW["front_n_m2"])
        self.assertEqual(scenarios.law(tall, 0.5)["front_n_m2"], 0.5 * scenarios.LAW["tall_front_n_m2"])
        self.assertEqual(scenarios.law(low, 2.0)["dent_slope"], scenarios.LAW["dent_slope"])
        self.assertLess(scenarios.bumper_height_m(low), scenarios.bumper_height_m(tall))


class Checks(unittest.TestCase):
    def test_what_does_not_hold_is_named(self):
        self.assertIsNone(run.refusal(told()))
        for name, changed in {
                "diverges": {"diverged": True}, "do not touch": {"touched": False},
                "overlap": {"least_gap_before_m": -0.05}, "gains energy": {"largest_contact_gain_j": 5e3},
                "moment of the contact": {"contact_moment_left_n_m_s": 1.0},
                "momentum of the struck": {"struck_momentum_residual_n_s": 2.0},
                "momentum of the striking": {"striking_momentum_residual_n_s": None},
                "energy of the striking": {"striking_energy_residual_j": -900.0}}.items():
            with self.subTest(name):
                self.assertIn(name, run.refusal(told(**changed)) or "")

    def test_checks_that_do_not_hold_leave_a_case_out(self):
        sound = {"is_symmetric": True, "halved_over_path": 1e-4, "halved_impulse": 1e-3, "mirror_m": 0.0}
        self.assertIsNone(run.refusal_by_checks(None))
        self.assertIsNone(run.refusal_by_checks(sound))
        self.assertIn("path", run.refusal_by_checks({**sound, "halved_over_path": 0.1}))
        self.assertIn("impulse", run.refusal_by_checks({**sound, "halved_impulse": float("nan")}))
        self.assertIn("mirror", run.refusal_by_checks({**sound, "mirror_m": 1.0}))
        self.assertIsNone(run.refusal_by_checks({**sound, "is_symmetric": False, "mirror_m": 1.0}))

    def test_records_are_compared_after_first_contact(self):
        one = motions()
        image = {**one, **{name: -one[name] for name in ("bullet_y_m", "contact_fy_n")}}
        np.testing.assert_allclose(histories.compared(one, image, 0.5, -1), (0, 0, 0), atol=1e-12)
        moved = {**one, "target_y_m": one["target_y_m"] + 0.5}
        apart_m, over_path, impulse = histories.compared(one, moved, 0.5)
        self.assertAlmostEqual(apart_m, 0.5)
        self.assertAlmostEqual(over_path, 0.5 / (20.0 * 0.99))
        self.assertEqual(impulse, 0.0)


class Histories(unittest.TestCase):
    def test_thinning_keeps_the_impulse(self):
        of = contact()
        names, rows = histories.thinned_contact(of)
        self.assertEqual(names[:5], ["interval", "time_s", "dt_s", "fx_n", "fy_n"])
        self.assertAlmostEqual(sum(row[2] * row[4] for row in rows), of["fy_n"].sum() * 0.001)
        self.assertLess(len(rows), 420 - 4 * 28)
        self.assertEqual({row[0] for row in rows}, {1, 2})
        self.assertTrue(all(abs(row[names.index("point_x_m")] - 1.5) < 1e-12 for row in rows))

    def test_the_first_pulse_ends_where_the_contact_is_interrupted(self):
        pulse = histories.first_pulse(contact(), 0.5)
        self.assertAlmostEqual(pulse.length_s, 0.4)
        self.assertAlmostEqual(pulse.impulse_n_s[1] + pulse.later_n_s, contact()["fy_n"].sum() * 0.001)

    def test_an_unknown_gap_is_not_a_number(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "a.csv"
            path.write_text("time_s,gap_m\n0,\n")
            read = histories.read(path)
        self.assertTrue(math.isnan(read["gap_m"][0]))


class Chain(unittest.TestCase):
    """Runner and collector with a driver that answers at once, and cars that are there."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        driver = self.folder / "drive_pair"
        driver.write_text(textwrap.dedent(FAKE_DRIVER))
        driver.chmod(0o755)
        (self.folder / "motions.csv").write_text(text(motions()))
        (self.folder / "contact.csv").write_text(text(contact()))
        self.answer(told())
        self.root = self.folder / "work"
        self.work = run.Work(self.root, self.folder)
        self.said = []
        self.prepared = patch.object(run, "prepare", self.prepare)
        self.prepared.start()
        self.addCleanup(self.prepared.stop)
        self.checked = next(pair for pair in scenarios.sample(12, SEED) if run.is_checked(pair))
        self.pair = next(pair for pair in scenarios.sample(12, SEED) if not run.is_checked(pair))

    def prepare(self, car, folder, library, driver, report):
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "figures.json").write_text(json.dumps({"understeer_rad_g": 0.03}))
        (folder / "vehicle.toml").write_text(SHEET)

    def answer(self, content):
        (self.folder / "told.json").write_text(json.dumps(content))

    def compute(self, pair=None):
        self.work.pair(pair or self.pair, lambda *what: self.said.append(what))

    def calls(self):
        return (self.folder / "calls.txt").read_text().splitlines()

    def collect(self, *arguments):
        data = self.folder / "data"
        command = ["collect.py", str(self.root), str(data), "--seed", str(SEED), *arguments]
        with patch.object(sys, "argv", command), patch("builtins.print") as said:
            collect.main()
        return data, [call.args[0] for call in said.call_args_list]

    def test_a_case_that_is_there_is_not_computed_again(self):
        self.compute()
        self.compute()
        self.assertEqual(self.calls(), [f"{self.pair.name}.request.json"])
        told_before = json.loads((self.root / "pairs" / f"{self.pair.name}.json").read_text())
        self.assertIsNone(told_before["refused"])
        self.assertEqual(sorted(file.suffix for file in (self.root / "pairs").iterdir()),
                         [".csv", ".csv", ".json", ".lock"])

    def test_another_case_of_the_same_name_is_computed(self):
        self.compute()
        self.compute(replace(self.pair, friction=0.3))
        self.assertEqual(len(self.calls()), 2)
        other = 1 + max(self.pair.cars) % 59
        self.compute(replace(self.pair, friction=0.3, cars=(self.pair.cars[0], other)))
        self.assertEqual(len(self.calls()), 3)

    def test_a_driver_that_is_stopped_leaves_nothing_that_looks_finished(self):
        (self.folder / "stop").touch()
        self.assertRaises(solver.Stopped, self.compute)
        self.assertFalse((self.root / "pairs" / f"{self.pair.name}.json").exists())
        self.assertFalse((self.root / "pairs" / f"{self.pair.name}.csv").exists())
        (self.folder / "stop").unlink()
        self.compute()
        self.assertTrue((self.root / "pairs" / f"{self.pair.name}.csv").exists())

    def test_a_driver_that_fails_says_why(self):
        (self.folder / "fail").touch()
        self.compute()
        answer = json.loads((self.root / "pairs" / f"{self.pair.name}.json").read_text())
        self.assertEqual(answer["refused"], "no such car")

    def test_a_case_belongs_to_one_runner(self):
        with open(self.root / "pairs" / f"{self.pair.name}.lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            self.compute()
        self.assertEqual(self.said, [(self.pair.name, "is computed by another runner")])

    def test_a_case_of_a_car_that_is_refused_is_left_out(self):
        def refuse(car, folder, library, driver, report):
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "figures.json").write_text(json.dumps({"refused": "oversteers"}))
        with patch.object(run, "prepare", refuse):
            self.compute()
        self.assertFalse((self.folder / "calls.txt").exists())
        answer = json.loads((self.root / "pairs" / f"{self.pair.name}.json").read_text())
        self.assertIn("oversteers", answer["refused"])

    def test_every_fourth_case_is_checked(self):
        self.compute(self.checked)
        name = self.checked.name
        self.assertEqual(self.calls(), [f"{name}.request.json", f"{name}-halved.request.json",
                                        f"{name}-mirror.request.json"])
        checks = json.loads((self.root / "checks" / f"{name}.json").read_text())
        self.assertEqual(checks["halved_m"], 0.0)
        self.compute(self.checked)
        self.assertEqual(len(self.calls()), 3)

    def test_what_holds_is_collected_and_the_rest_is_named(self):
        self.compute()
        data, said = self.collect("--cases", "12")
        rows = read_table(data / "cases.csv")
        self.assertEqual([row["case"] for row in rows], [self.pair.name])
        self.assertTrue(self.pair.is_row(rows[0]))
        self.assertFalse(replace(self.pair, friction=0.1).is_row(rows[0]))
        self.assertEqual(rows[0]["contact_start_s"], "0.5000;1.0000")
        self.assertEqual(rows[0]["second_contact"], "1")
        self.assertEqual(rows[0]["contact_intervals"], "2")
        for file in (f"cases/{self.pair.name}.csv", f"contacts/{self.pair.name}.csv",
                     *(f"vehicles/{car.name}.toml" for car in self.pair.sampled)):
            self.assertTrue((data / file).exists(), file)
        self.assertIn(f"left out: {self.checked.name}: not computed", said)
        self.assertFalse(list(data.rglob("*.part")))

    def test_a_case_whose_balances_do_not_hold_is_not_collected(self):
        self.answer(told(struck_momentum_residual_n_s=50.0))
        self.compute()
        data, said = self.collect("--cases", "12")
        self.assertFalse((data / "cases.csv").exists())
        self.assertTrue(any(self.pair.name in line and "momentum" in line for line in said), said)

    def test_a_case_whose_checks_do_not_hold_is_not_collected(self):
        self.compute(self.checked)
        checks = self.root / "checks" / f"{self.checked.name}.json"
        checks.write_text(json.dumps({**json.loads(checks.read_text()), "halved_impulse": 0.5}))
        _, said = self.collect("--cases", "12")
        self.assertTrue(any(self.checked.name in line and "halved step" in line for line in said), said)
        checks.unlink()
        _, said = self.collect("--cases", "12")
        self.assertIn(f"left out: {self.checked.name}: not checked yet", said)

    def test_a_case_of_another_seed_is_not_collected(self):
        self.compute()
        _, said = self.collect("--cases", "12", "--seed", str(SEED + 1))
        self.assertIn(f"left out: {self.pair.name}: what was computed is another case", said)

    def test_collected_cases_stay_without_their_runs(self):
        self.compute()
        data, _ = self.collect("--cases", "12")
        before = (data / "cases.csv").read_text()
        (self.root / "pairs" / f"{self.pair.name}.json").unlink()
        self.collect("--cases", "12")
        self.assertEqual((data / "cases.csv").read_text(), before)
        self.collect("--cases", "1")
        self.assertEqual((data / "cases.csv").read_text(), before)

    def test_cases_that_a_data_set_has_are_not_computed(self):
        self.compute()
        data, _ = self.collect("--cases", "12")
        for have, n in (([str(data)], 1), ([], 2)):
            command = ["run.py", str(self.folder / f"other-{n}"), "--build", str(self.folder), "--cases", "12",
                       "--seed", str(SEED), "--only", self.pair.name, "--jobs", "1", "--have", *have]
            with patch.object(sys, "argv", command), patch("builtins.print"):
                self.assertRaises(SystemExit, run.main)
            self.assertEqual(len(self.calls()), n)

    def test_a_table_has_the_columns_of_the_shipped_pairs(self):
        self.compute()
        data, _ = self.collect("--cases", "12")
        shipped = Path(__file__).resolve().parents[2] / "datasets/pairs"
        with open(shipped / "cases.csv", newline="") as file:
            expected = next(csv.reader(file))
        self.assertEqual(set(expected) - set(read_table(data / "cases.csv")[0]), set())
        expected, header = (path.read_text().splitlines()[0] for path in
                            (shipped / "contacts/d001.csv", data / "contacts" / f"{self.pair.name}.csv"))
        self.assertEqual(header, expected)


class Split(unittest.TestCase):
    def test_a_quarter_of_the_cases_is_held_out_with_their_twins(self):
        cases = scenarios.sample(480, SEED)
        share = np.mean([is_held_out(pair.base) for pair in cases])
        self.assertTrue(0.2 < share < 0.3, share)
        self.assertTrue(all(pair.base == pair.name.rstrip("e") for pair in cases))

    def test_a_sheet_has_the_plan_view(self):
        car = scenarios.pairs(0, SEED)[0].sampled[0]
        sheet = collect.sheet(SHEET, car)
        body = sheet[sheet.index("[body]"):sheet.index("[wheel]")]
        for name in ("length", "front_overhang", "width", "rear_overhang", "bumper_height"):
            self.assertEqual(body.count(f"{name} = "), 1)
        self.assertIn("[steering]\nratio = 16", sheet)
        self.assertRaises(ValueError, collect.sheet, "[mass]\n", car)


if __name__ == "__main__":
    unittest.main()
