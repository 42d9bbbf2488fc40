"""A placed collision with the numbers of its nodes, elements and parts, for the writers of decks."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bodies import MATERIALS, PANEL_NAMES, PANELS, Body
from scenarios import CONTACT_GAP_M, Placed, rotation

# Interval of the histories that are written, s.
INTERVAL_S = 0.0005


@dataclass
class Car:
    """One of the two cars: 1 the struck one, 2 the striking one.

    - `at`, `heading`: pose of its axes in the world; `velocity`: of its centre of gravity, in the axes that
      move with the model, m/s.
    - `first_node`, `first_element`: numbers before its own.
    """

    number: int
    body: Body
    at: np.ndarray
    heading: float
    velocity: tuple
    yaw_rate: float
    first_node: int
    first_element: int

    @property
    def base(self):
        return 100 * self.number

    @cached_property
    def parts(self):
        """Panels that the car has, each with the number of its part."""
        used = {element[0] for element in self.body.elements}
        return {name: self.base + i + 1 for i, name in enumerate(PANEL_NAMES) if name in used}

    @cached_property
    def places(self):
        return self._in_world(self.body.nodes)

    @property
    def main_node(self):
        return self.first_node + len(self.body.nodes) + 1

    @property
    def main_place(self):
        return self._in_world(self.body.inertia.place[None])[0]

    def _in_world(self, places):
        world = places.copy()
        world[:, :2] = world[:, :2] @ rotation(self.heading).T + self.at
        return world

    def numbered_nodes(self):
        return [(self.first_node + i + 1, place) for i, place in enumerate(self.places)]

    def numbered_elements(self):
        """Number, panel and nodes of each element, panel by panel."""
        ordered = sorted(self.body.elements, key=lambda element: PANEL_NAMES.index(element[0]))
        return [(self.first_element + i + 1, panel, [self.first_node + node + 1 for node in nodes])
                for i, (panel, *nodes) in enumerate(ordered)]

    def core_nodes(self):
        return sorted(self.first_node + node + 1 for node in self.body.core)

    def all_nodes(self):
        return range(self.first_node + 1, self.main_node + 1)

    def density(self, panel):
        return MATERIALS[PANELS[panel][0]].density * self.body.density_factor[panel]

    def velocity_at_origin(self):
        """Velocity of the rotating car at the origin of the world: v - w x r of its centre of gravity."""
        (vx, vy), (x, y) = self.velocity, self.at
        return vx + self.yaw_rate * y, vy - self.yaw_rate * x

    def facts(self):
        inertia = self.body.inertia
        return dict(mass=self.body.mass, yaw_inertia=self.body.shape.gyration2 * self.body.mass,
                    added_mass=inertia.mass, added_place=list(map(float, inertia.place)), core_place=list(map(float, inertia.core_place)),
                    added_about_z=inertia.about_z,
                    core_products=inertia.products, deformable_mass=inertia.deformable_mass, parts=self.parts,
                    heading=float(self.heading), at=list(map(float, self.at)), main_node=self.main_node,
                    n_nodes=len(self.body.nodes), n_elements=len(self.body.elements))


@dataclass
class Model:
    """Both cars of a collision."""

    name: str
    placed: Placed
    gap_m: float = CONTACT_GAP_M

    @cached_property
    def frame_velocity(self):
        """Velocity of the model's axes along X, m/s."""
        return self.placed.collision.velocities[0][0]

    @cached_property
    def cars(self):
        placed, collision = self.placed, self.placed.collision
        (struck_vx, struck_vy), (vx, vy) = collision.velocities
        frame = self.frame_velocity
        struck = Car(1, placed.struck, np.zeros(2), 0.0, (struck_vx - frame, struck_vy), collision.yaw_rates[0], 0, 0)
        striking = Car(2, placed.striking, placed.at, collision.heading, (vx - frame, vy), collision.yaw_rates[1],
                       struck.main_node, len(placed.struck.elements))
        return struck, striking

    def facts(self):
        """What is needed to read the results."""
        return dict(name=self.name, frame_velocity=self.frame_velocity, contact=list(map(float, self.placed.contact)),
                    cars=[car.facts() for car in self.cars])
