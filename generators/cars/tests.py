"""Tests of what needs no solver: python3 -m unittest tests"""

import csv
import fcntl
import json
import tempfile
import textwrap
import unittest
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

import build_chrono
import cars
import collect
import layouts
import motions
import records
import run
import solver

SEED = 1
TABLE = {"input": [-1.0, 0.0, 1.0], "angle_rad": [-0.4, 0.0, 0.4]}
# A driver that answers at once. It notes its calls; beside files of these names it fails or is killed.
FAKE_DRIVER = '''\
    #!/usr/bin/env python3
    import json, os, signal, sys
    from pathlib import Path
    command, car, *files = sys.argv[1:]
    notes = Path(__file__).parent
    with open(notes / "calls.txt", "a") as calls:
        calls.write(" ".join([command, Path(files[0]).name]) + chr(10))
    Path(files[1]).write_text("time_s,x_m" + chr(10) + "0,0" + chr(10))
    if (notes / "fail").exists():
        sys.exit("no such car")
    if (notes / "stop").exists():
        os.kill(os.getpid(), signal.SIGKILL)
    told = {"impulse_n_s": [0.0, 1000.0], "momentum_residual_n_s": 0.01, "energy_residual_j": 5.0,
            "start_energy_j": 5000.0, "work_of_outer_forces_j": 5000.0, "diverged": False,
            "rolled_over": False, "at_rest": True}
    Path(files[2]).write_text(json.dumps(told))
    '''


class Sample(unittest.TestCase):
    def test_a_seed_gives_the_same_cars_and_motions_and_another_one_others(self):
        self.assertEqual(cars.sample(5, SEED), cars.sample(5, SEED))
        self.assertNotEqual(cars.sample(5, SEED), cars.sample(5, SEED + 1))
        car = cars.car(3, SEED)
        self.assertEqual(motions.sample(car, SEED), motions.sample(car, SEED))
        self.assertNotEqual(motions.sample(car, SEED), motions.sample(car, SEED + 1))

    def test_a_car_is_the_same_however_many_are_asked_for(self):
        self.assertEqual(cars.sample(3, SEED)[2], cars.sample(90, SEED)[2])
        self.assertEqual(cars.sample(62, SEED)[61], cars.sample(90, SEED)[61])
        self.assertNotEqual(asdict(cars.car(86, SEED)), asdict(cars.car(110, SEED)))

    def test_cars_are_plausible(self):
        # Of the first design, of the second and of those after it.
        ranges = {
            "mass_kg": ((850, 2800), (850, 2950), (850, 3100)),
            "front_share": ((0.43, 0.63), (0.43, 0.63), (0.43, 0.66)),
            "cg_height_m": ((0.44, 0.80), (0.44, 0.80), (0.44, 0.86)),
            "yaw_inertia_ratio": ((0.85, 1.12), (0.85, 1.28), (0.80, 1.34)),
            "sliding_over_peak": ((0.72, 0.95), (0.72, 0.95), (0.68, 1.0)),
        }
        stiffness = ((10.0, 17.5), (8.4, 17.5), (5.2, 22.0)), ((13.0, 23.0), (11.0, 23.0), (8.4, 31.0))
        for car in cars.sample(cars.DESIGN_CARS + 3 * cars.LATER_CARS, SEED):
            with self.subTest(car=car.name, kind=car.kind):
                design = min((car.index - cars.DESIGN_CARS) // cars.LATER_CARS + 1, 2) if car.index >= cars.DESIGN_CARS else 0
                for name, of_designs in ranges.items():
                    least, largest = of_designs[design]
                    self.assertTrue(least <= getattr(car, name) <= largest, name)
                self.assertLessEqual(car.cg_height_m, cars.TALLEST_OVER_TRACK * car.track_front_m + 1e-9)
                front, rear = car.cornering_stiffness_over_load
                for value, of_designs in zip((front, rear), stiffness):
                    least, largest = of_designs[design]
                    self.assertTrue(least <= value <= largest)
                self.assertTrue(1.15 <= rear / front <= (1.65 if design == 2 else 1.5))
                self.assertTrue(all(1.05 <= frequency <= 1.6 for frequency in car.ride_frequencies_hz))
                self.assertLess(car.half_width_m * 2, 2.15)
                self.assertTrue(3.3 < car.length_m < 6.7, car.length_m)
                # What is sampled as the roll inertia is that of a body of this width and height.
                self.assertTrue(0.24 < car.roll_gyration2_m2 < 0.68)

    def test_the_sample_covers_its_ranges(self):
        sample = cars.sample(cars.DESIGN_CARS, SEED)
        masses = [car.mass_kg for car in sample]
        self.assertTrue(min(masses) < 950 and max(masses) > 2500)
        self.assertGreaterEqual(len({(car.front, car.rear) for car in sample}), 12)
        self.assertEqual({car.driven_axle for car in sample}, {0, 1})

    def test_later_designs_have_what_those_before_leave_out(self):
        wide = [cars.car(cars.DESIGN_CARS + i, SEED) for i in range(cars.LATER_CARS)]
        self.assertGreater(max(car.yaw_inertia_ratio for car in wide), 1.22)
        self.assertGreater(max(car.wheelbase_m for car in wide), 3.7)
        self.assertGreater(max(car.track_front_m for car in wide), 1.74)
        self.assertLess(min(car.cornering_stiffness_over_load[0] for car in wide), 9.2)
        edge = [cars.car(cars.DESIGN_CARS + cars.LATER_CARS + i, SEED) for i in range(cars.LATER_CARS)]
        front = [car.cornering_stiffness_over_load[0] for car in edge]
        self.assertTrue(min(front) < 5.8 and max(front) > 20.5, front)
        self.assertGreater(max(car.front_share for car in edge), 0.64)
        sliding = [car.sliding_over_peak for car in edge]
        self.assertTrue(min(sliding) < 0.70 and max(sliding) > 0.97, sliding)

    def test_tall_cars_are_no_saloons(self):
        for car in cars.sample(cars.DESIGN_CARS, SEED):
            if car.kind in ("city", "compact", "saloon", "sports"):
                self.assertLess(car.cg_height_m, 0.57)
            if car.kind in ("suv", "van", "off-road"):
                self.assertGreater(car.cg_height_m, 0.64)

    def test_pairs_of_axles_are_layouts(self):
        for of in (*cars.CLASSES.values(), *cars.WIDE_CLASSES.values(), *cars.EDGE_CLASSES.values()):
            for front, rear in of.pairs:
                self.assertIn(front, layouts.FRONTS)
                self.assertIn(rear, layouts.REARS)


class Motions(unittest.TestCase):
    def setUp(self):
        self.car = cars.car(7, SEED)
        self.motions = motions.sample(self.car, SEED)

    def test_a_dozen_has_the_kinds_it_should(self):
        kinds = [motion.kind for motion in self.motions]
        self.assertEqual([kinds.count(kind) for kind in ("coast", "driver-brake", "rear-wheel-drag",
                                                         "rear-wheel-lock", "engine-brake", "steer",
                                                         "steer-brake")], [5, 2, 1, 1, 1, 1, 1])
        self.assertEqual([motion.side for motion in self.motions].count("left"), 6)
        self.assertTrue(any(self.motions[i].brake_torque_n_m[0] for i in (1, 8, 11)))

    def test_the_impulse_of_the_force_is_that_of_the_table(self):
        for motion in self.motions:
            of_force = np.trapezoid(motion.force_n, motion.time_s, axis=0)
            np.testing.assert_allclose(of_force, motion.impulse_n_s, rtol=1e-12, atol=1e-9)
            push = max(np.hypot(*force) for force in motion.force_n) / self.car.mass_kg
            self.assertLess(push, motions.LARGEST_FORCE_N_KG * 1.1)
            self.assertEqual(motion.force_n[0], (0.0, 0.0))

    def test_motions_are_in_their_ranges(self):
        seen = [motion for index in range(20) for motion in motions.sample(cars.car(index, SEED), SEED)]
        speeds, frictions = ([getattr(motion, name) for motion in seen] for name in ("speed_m_s", "friction"))
        self.assertTrue(3 <= min(speeds) < 5 and 43 < max(speeds) <= 45)
        self.assertTrue(0.2 <= min(frictions) < 0.3 and 0.9 < max(frictions) <= 1.0)
        self.assertGreater(np.mean([0.6 <= friction <= 0.9 for friction in frictions]), 0.5)
        for motion in seen:
            car = cars.car(int(motion.name[4:7]), SEED)
            front, rear = car.axle_distances_m
            x, y, _ = motion.point_m
            self.assertTrue(-rear - car.rear_overhang_m - 0.2 < x <= front, motion.name)
            self.assertEqual(y > 0, motion.side == "left")
            self.assertLess(motion.impulse_n_s[1] * y, 0, "the car is pushed away from its struck side")

    def test_the_front_wheels_turn_no_further_than_the_steering(self):
        steered = replace(self.motions[4], steer_rad=0.35)
        self.assertEqual(steered.steered_rad(TABLE), 0.35)
        narrow = {"input": [-1.0, 1.0], "angle_rad": [-0.2, 0.2]}
        self.assertAlmostEqual(steered.steered_rad(narrow), 0.19)
        request = steered.request(narrow)["steer"]
        self.assertEqual(request["angle_rad"][-1], steered.steered_rad(narrow))
        self.assertEqual(request["time_s"][1], steered.steer_start_s)

    def test_the_mirror_image_of_a_mirror_image_is_the_motion(self):
        for motion in self.motions:
            request = motion.request(TABLE)
            self.assertEqual(motions.mirrored(motions.mirrored(request)), request)
            self.assertNotEqual(motions.mirrored(request), request)

    def test_a_locked_wheel_is_on_the_struck_side(self):
        locked = self.motions[9]
        self.assertEqual(locked.locked_wheel, 2 if locked.side == "left" else 3)


class Records(unittest.TestCase):
    def record(self, n=21):
        time = np.arange(n) * 0.01
        names = [*collect.COLUMNS, "steer_fl_rad", "steer_fr_rad", *(f"fz_{w}_n" for w in records.WHEELS)]
        record = {name: np.zeros(n) for name in names if name != "steer_rad"}
        force = np.where(time < 0.07, 1000.0, 0.0)
        return record | {"time_s": time, "vx_m_s": np.full(n, 10.0), "fy_body_n": force}

    def test_thinning_keeps_the_impulse(self):
        record = self.record()
        thin = records.thinned(record, 2)
        self.assertAlmostEqual(thin["fy_body_n"].sum() * 0.02, record["fy_body_n"].sum() * 0.01)
        np.testing.assert_allclose(thin["time_s"], np.arange(11) * 0.02)

    def test_a_record_ends_where_the_linkage_folds_over(self):
        record = self.record()
        record["steer_fl_rad"][10:] = 0.5
        cut = records.cut_where_folded(record, None)
        self.assertTrue(cut.is_folded)
        self.assertEqual(len(cut.record["time_s"]), 10)
        steer = [0.0, 0.099, 0.1, 1.0], [0.0, 0.0, 0.5, 0.5]
        self.assertTrue(records.cut_where_folded(record, steer).is_folded, "the right wheel does not follow")
        record["steer_fr_rad"][10:] = 0.5
        self.assertFalse(records.cut_where_folded(record, steer).is_folded)

    def test_numbers_are_short(self):
        self.assertEqual([collect.write_number(value, 3) for value in (1.5, -0.0001, 120.0, 0.1234)],
                         ["1.5", "0", "120", "0.123"])

    def test_a_trajectory_has_the_columns_of_impactlab(self):
        with tempfile.TemporaryDirectory() as folder:
            collect.write_trajectory(self.record(), Path(folder) / "a.csv")
            with open(Path(folder) / "a.csv") as file:
                rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0]), list(collect.COLUMNS))
        self.assertEqual(len(rows), 11)


class Split(unittest.TestCase):
    def test_a_quarter_of_the_cars_is_held_out(self):
        n = sum(collect.is_held_out(f"car-{i:03d}") for i in range(1000))
        self.assertTrue(200 < n < 300, n)

    def test_braking_is_told_as_impactlab_reads_it(self):
        told = {motion.kind: collect.braking(motion) for motion in motions.sample(cars.car(0, SEED), SEED)}
        self.assertEqual(told["coast"], ("none", None, None))
        self.assertRegex(told["driver-brake"][2], r"^front \d+ rear \d+ a wheel$")
        self.assertRegex(told["rear-wheel-lock"][2], r"^R[LR] \d+ locked$")
        self.assertRegex(told["rear-wheel-drag"][2], r"^R[LR] \d+$")
        self.assertRegex(told["engine-brake"][2], r"^(front|rear) \d+ a wheel$")


class Resumption(unittest.TestCase):
    """The runner with a driver that answers at once, and axles without files of Chrono."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.driver = self.folder / "driver.py"
        self.driver.write_text(textwrap.dedent(FAKE_DRIVER))
        self.driver.chmod(0o755)
        self.work = run.Work(self.folder / "work", self.driver, self.folder, SEED)
        self.car = cars.car(0, SEED)
        self.car_folder = self.folder / "work" / self.car.name
        self.car_folder.mkdir(parents=True)
        (self.car_folder / "car.json").write_text("{}")
        self.request = motions.sample(self.car, SEED)[0].request(TABLE)
        self.said = []

    def compute(self, name="a", request=None):
        self.work.motion(self.car_folder, name, request or self.request, lambda *what: self.said.append(what))

    def calls(self):
        return (self.folder / "calls.txt").read_text().splitlines()

    def test_a_motion_that_is_there_is_not_computed_again(self):
        self.compute()
        self.compute()
        self.assertEqual(len(self.calls()), 1)
        self.assertTrue((self.car_folder / "motions/a.csv").exists())
        self.assertIsNone(json.loads((self.car_folder / "motions/a.json").read_text())["refused"])

    def test_another_motion_of_the_same_name_is_computed(self):
        self.compute()
        self.compute(request={**self.request, "friction": 0.3})
        self.assertEqual(len(self.calls()), 2)

    def test_a_driver_that_is_stopped_leaves_nothing_that_looks_finished(self):
        (self.folder / "stop").touch()
        self.assertRaises(solver.Stopped, self.compute)
        self.assertFalse((self.car_folder / "motions/a.csv").exists())
        self.assertFalse((self.car_folder / "motions/a.json").exists())
        (self.folder / "stop").unlink()
        self.compute()
        self.assertTrue((self.car_folder / "motions/a.csv").exists())

    def test_a_driver_that_fails_says_why(self):
        (self.folder / "fail").touch()
        self.compute()
        told = json.loads((self.car_folder / "motions/a.json").read_text())
        self.assertEqual(told["refused"], "no such car")

    def test_a_car_belongs_to_one_runner(self):
        with open(self.folder / "work" / f"{self.car.name}.lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            self.work.car(0, lambda *what: self.said.append(what))
        self.assertEqual(self.said, [(self.car.name, "is computed by another runner")])

    def test_balances_that_do_not_hold_are_named(self):
        told = {"diverged": False, "impulse_n_s": [0.0, 1000.0], "momentum_residual_n_s": 0.0,
                "energy_residual_j": 1.0, "start_energy_j": 1000.0, "work_of_outer_forces_j": 0.0}
        self.assertIsNone(run.refusal(told))
        self.assertIn("momentum", run.refusal({**told, "momentum_residual_n_s": 2.0}))
        self.assertIn("energy", run.refusal({**told, "energy_residual_j": 50.0}))
        self.assertIn("energy", run.refusal({**told, "energy_residual_j": float("nan")}))
        self.assertEqual(run.refusal({**told, "diverged": True}), "diverges")


class Chrono(unittest.TestCase):
    def test_every_driver_has_its_sources(self):
        for folders in build_chrono.DRIVERS.values():
            self.assertTrue((folders[0] / "main.cpp").exists(), folders[0])

    def test_options_of_the_build_system_are_off(self):
        template = "@CHRONO_VEHICLE@\n@CHRONO_FEA@\n#define CHRONO_VERSION \"@CHRONO_VERSION@\"\n"
        self.assertEqual(build_chrono.configured(template),
                         "#define CHRONO_VEHICLE\n\n#define CHRONO_VERSION \"10.0.0\"\n")

    def test_a_name_leads_to_its_file(self):
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder)
            (source / "chrono/fea").mkdir(parents=True)
            (source / "chrono_vehicle").mkdir()
            for name in ("ChBody.cpp", "ChBody.h", "Wheels.cpp", "fea/ChMesh.cpp"):
                (source / "chrono" / name).write_text("")
            header = "class ChApi Rim : public Round {};\nvoid Inflate(double bar);\n"
            (source / "chrono/Wheels.h").write_text(header)
            definitions = build_chrono.Definitions(source)
        self.assertEqual(definitions.of("chrono::ChBody::Update(double)"), ["ChBody"])
        self.assertEqual(definitions.of("vtable for chrono::Rim"), ["Wheels"])
        self.assertEqual(definitions.of("chrono::Inflate(double)"), ["Wheels"])
        self.assertEqual(definitions.of("chrono::fea::ChMesh::ChMesh()"), [])


if __name__ == "__main__":
    unittest.main()
