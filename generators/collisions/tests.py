"""Tests of what needs no solver: python3 -m unittest tests"""

import tempfile
import unittest
from dataclasses import replace
from pathlib import Path

import numpy as np

import collect
import lsdyna
import radioss
import scenarios
from bodies import MATERIALS, PANELS, SHAPES, Body
from model import Model


def model(case):
    return Model(case.name, scenarios.placed(case.mirrored()))


class Sample(unittest.TestCase):
    def test_a_seed_gives_the_same_cases_and_another_one_others(self):
        first, again, other = (scenarios.sample(24, seed, "d") for seed in (1, 1, 2))
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)

    def test_the_sample_covers_its_ranges(self):
        cases = scenarios.sample(264, 1, "d")
        kinds = [case.kind for case in cases]
        self.assertEqual([kinds.count(kind) for kind in scenarios.KINDS], [220, 22, 22])
        for car in (0, 1):
            rates = np.array([case.yaw_rates[car] for case in cases])
            self.assertLess(rates.min(), -.95)
            self.assertGreater(rates.max(), .95)
        heading = np.degrees([abs(case.heading) for case in cases if case.kind == "pit"])
        self.assertTrue(heading.min() < 2 and 43 < heading.max() <= 45)

    def test_the_cars_approach_each_other(self):
        for case in scenarios.sample(60, 3, "d"):
            (vx, vy), (bx, by) = case.mirrored().velocities
            approach = bx - vx if case.kind == "rear" else by - vy
            self.assertGreater(approach, 0, case)

    def test_turning_does_not_part_the_points_of_contact(self):
        for case in scenarios.sample(120, 3, "d"):
            if case.kind == "rear":
                continue
            mirrored = case.mirrored()
            (_, vy), (_, by) = mirrored.velocities
            struck, striking = (SHAPES[name] for name in case.bodies)
            approach = scenarios._approach(struck, striking, mirrored.heading, case.place, by - vy, mirrored.yaw_rates)
            # A car that closes more slowly than that does so by its velocity.
            self.assertGreater(approach, min(by - vy, scenarios.LEAST_APPROACH_M_S), case)

    def test_the_mirror_image_of_a_mirror_image_is_the_collision(self):
        case = next(case for case in scenarios.sample(60, 1, "d")
                    if case.side == "left" and case.kind == "rear")
        once = case.mirrored()
        self.assertEqual(once.heading, -case.heading)
        self.assertEqual(replace(once, side="left").mirrored(), replace(case, side="right"))


    def test_a_quarter_is_held_out(self):
        for prefix in ("d", "w"):
            n = sum(collect.is_held_out(f"{prefix}{i:03}") for i in range(1, 1001))
            self.assertTrue(200 < n < 300, n)


class Bodies(unittest.TestCase):
    def test_a_car_has_the_mass_the_centre_and_the_yaw_inertia_that_it_says(self):
        for shape, end, core_x in (("A", "rear", -.5), ("B", "rear", .85), ("C", "front", -.5)):
            body = Body(SHAPES[shape], end, -1 if end == "rear" else 1, 1750.0, core_x=core_x)
            masses = np.zeros(len(body.nodes))
            for panel, *nodes in body.elements:
                masses[nodes] += body._shell_mass(panel, nodes) * body.density_factor[panel] / 4
            places = np.vstack([body.nodes, body.inertia.place])
            masses = np.append(masses, body.inertia.mass)
            self.assertAlmostEqual(masses.sum(), 1750.0, 6)
            centre = (masses[:, None] * places).sum(0) / masses.sum()
            np.testing.assert_allclose(centre[:2], 0, atol=1e-9)
            core = np.append(np.isin(np.arange(len(body.nodes)), list(body.core)), True)
            about = (masses * (places[:, 0]**2 + places[:, 1]**2)).sum() + body.inertia.about_z
            self.assertAlmostEqual(about / (SHAPES[shape].gyration2 * 1750.0), 1, 9)
            self.assertTrue(core.any())

    def test_panels_name_materials_that_exist(self):
        self.assertTrue({material for material, _ in PANELS.values()} <= MATERIALS.keys())


class Decks(unittest.TestCase):
    def test_the_skins_stand_a_clearance_apart(self):
        for case in scenarios.sample(12, 5, "d"):
            placed = scenarios.placed(case.mirrored())
            along = 0 if case.kind == "rear" else 1
            skin = placed.striking.skin()
            skin[:, :2] = skin[:, :2] @ scenarios.rotation(case.mirrored().heading).T + placed.at
            gap = np.linalg.norm(skin - placed.contact, axis=1).min()
            expected = scenarios.CONTACT_GAP_M + scenarios.CLEARANCE_M
            self.assertLess(abs(gap - expected), 1e-6, (case, along))

    def test_a_deck_is_the_same_each_time(self):
        case = scenarios.sample(6, 1, "d")[0]
        texts = []
        for _ in range(2):
            with tempfile.TemporaryDirectory() as folder:
                radioss.write(model(case), Path(folder), 0.1)
                texts.append((Path(folder) / f"{case.name}_0000.rad").read_text())
        self.assertEqual(*texts)

    def test_a_turning_car_has_the_velocity_of_its_centre_of_gravity(self):
        case = replace(scenarios.reference(), yaw_rates=(0.5, -0.7))
        striking = model(case).cars[1]
        vx, vy = striking.velocity_at_origin()
        x, y = striking.at
        np.testing.assert_allclose((vx + 0.7 * y, vy - 0.7 * x), striking.velocity, atol=1e-12)

    def test_both_formats_have_the_same_nodes_and_shells(self):
        of = model(scenarios.sample(6, 1, "d")[0])
        n_nodes = sum(len(car.body.nodes) + 1 for car in of.cars)
        n_shells = sum(len(car.body.elements) for car in of.cars)
        with tempfile.TemporaryDirectory() as folder:
            lsdyna.write(of, Path(folder) / "deck.k")
            radioss.write(of, Path(folder), 0.1)
            keyword = (Path(folder) / "deck.k").read_text().split("\n*")
            deck = (Path(folder) / f"{of.name}_0000.rad").read_text().split("\n/")

        def count(blocks, name):
            return sum(len(block.strip().split("\n")) - 1 for block in blocks if block.startswith(name))

        self.assertEqual((count(keyword, "NODE\n"), count(keyword, "ELEMENT_SHELL")), (n_nodes, n_shells))
        self.assertEqual((count(deck, "NODE\n"), count(deck, "SHELL/")), (n_nodes, n_shells))


if __name__ == "__main__":
    unittest.main()
