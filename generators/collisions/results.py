"""Force, motions and balances of a finished collision, SI units, in the axes of the model."""

import json
from dataclasses import dataclass

import numpy as np

from history import Histories
from model import INTERVAL_S

# Variables of a part by their numbers in the file.
ENERGY, KINETIC, MOMENTUM_X, MOMENTUM_Y, MASS, HOURGLASS, PLACE_X, PLACE_Y, SPIN_Z = 1, 2, 3, 4, 6, 7, 9, 10, 14
# Columns of a node: displacements, velocities, accelerations, rotation velocities.
NODE_X, NODE_VX, NODE_RATE = 0, 2, 9
# Columns of the whole model.
INTERNAL, KINETIC_ALL, ROTATION_ALL, CONTACT_ALL, FRICTION_ALL, MASS_ADDED = 0, 1, 7, 10, 13, 16


def integral(values, time):
    return np.concatenate([[0.0], np.cumsum(.5 * (values[1:] + values[:-1]) * np.diff(time))])


@dataclass
class CarResult:
    """Whole car over time: shells and what is added at the core."""

    mass: float
    momentum: np.ndarray
    velocity: np.ndarray
    yaw_rate: np.ndarray
    yaw: np.ndarray
    place: np.ndarray
    spin: np.ndarray
    hourglass: np.ndarray


@dataclass
class Result:
    """A run: contact impulse on the struck car and its moment about the origin, and both cars."""

    time: np.ndarray
    impulse: np.ndarray
    impulse_moment: np.ndarray
    overall: np.ndarray
    cars: list
    facts: dict

    @classmethod
    def read(cls, folder, name):
        facts = json.loads((folder / f"{name}.json").read_text())
        histories = Histories.read(folder / f"{name}T01").even(INTERVAL_S)
        contact = histories.group("contact").values
        # Contacts 1 and 2 are those of the two cars; the first is told on the striking nodes' surface.
        pushed = contact[:, 0] - contact[:, 1]
        impulse = pushed[:, 0:3] + pushed[:, 3:6]
        cores = histories.group("cores").values
        cars = [cls._car(histories, facts["cars"][i], cores[:, i]) for i in (0, 1)]
        return cls(histories.time, impulse, pushed[:, 8], histories.overall, cars, facts)

    @staticmethod
    def _car(histories, facts, core):
        time = histories.time
        momentum, first_moment = np.zeros((len(time), 2)), np.zeros((len(time), 2))
        spin, hourglass, mass = np.zeros(len(time)), np.zeros(len(time)), 0.0
        for part in facts["parts"].values():
            of = histories.of_part[part]
            momentum += np.stack([of[MOMENTUM_X], of[MOMENTUM_Y]], 1)
            first_moment += np.stack([of[MASS] * of[PLACE_X], of[MASS] * of[PLACE_Y]], 1)
            spin += of[SPIN_Z] + of[PLACE_X] * of[MOMENTUM_Y] - of[PLACE_Y] * of[MOMENTUM_X]
            hourglass += of[HOURGLASS]
            mass += of[MASS][-1]
        rate = core[:, NODE_RATE]
        yaw = facts["heading"] + integral(rate, time)
        # What is added sits at the main node of the core.
        added = facts["added_mass"]
        cos, sin = np.cos(facts["heading"]), np.sin(facts["heading"])
        centre, place = np.array(facts["core_place"][:2]), np.array(facts["added_place"][:2])
        node = np.array([[cos, -sin], [sin, cos]]) @ centre + np.array(facts["at"]) + core[:, NODE_X:NODE_X + 2]
        arm = place - centre
        arm = np.stack([np.cos(yaw) * arm[0] - np.sin(yaw) * arm[1], np.sin(yaw) * arm[0] + np.cos(yaw) * arm[1]], 1)
        velocity = core[:, NODE_VX:NODE_VX + 2] + np.stack([-rate * arm[:, 1], rate * arm[:, 0]], 1)
        at = node + arm
        whole = momentum + added * velocity
        total = mass + added
        spin += added * (at[:, 0] * velocity[:, 1] - at[:, 1] * velocity[:, 0]) + facts["added_about_z"] * rate
        return CarResult(total, whole, whole / total, rate, yaw, (first_moment + added * at) / total, spin, hourglass)

    def force(self):
        """Middle of each interval, s, and the mean force on the struck car and its moment about its CG in it."""
        steps = np.diff(self.time)
        force = np.diff(self.impulse, axis=0) / steps[:, None]
        place = .5 * (self.cars[0].place[1:] + self.cars[0].place[:-1])
        moment = np.diff(self.impulse_moment) / steps - (place[:, 0] * force[:, 1] - place[:, 1] * force[:, 0])
        return .5 * (self.time[1:] + self.time[:-1]), force, moment

    def energy(self):
        """Whole energy over time, with what the contacts hold and what they rub away, J."""
        return self.overall[:, [INTERNAL, KINETIC_ALL, ROTATION_ALL, CONTACT_ALL]].sum(1)

    def balances(self):
        """What a run must keep: momentum of each car against the impulse, yaw momentum, energy; in percent."""
        size = np.hypot(*self.impulse[-1, :2])
        gained = [car.momentum[-1] - car.momentum[0] for car in self.cars]
        turned = self.cars[0].spin[-1] - self.cars[0].spin[0]
        energy, moment = self.energy(), self.impulse_moment[-1]
        hourglass = sum(car.hourglass[-1] for car in self.cars)
        return dict(
            momentum_residual_target_x_percent=100 * (self.impulse[-1, 0] - gained[0][0]) / size,
            momentum_residual_target_y_percent=100 * (self.impulse[-1, 1] - gained[0][1]) / size,
            momentum_residual_bullet_percent=100 * np.hypot(*(self.impulse[-1, :2] + gained[1])) / size,
            yaw_momentum_residual_percent=100 * abs(moment - turned) / max(abs(moment), abs(turned)),
            energy_error_max_percent=100 * np.abs(energy / energy[0] - 1).max(),
            hourglass_percent=100 * hourglass / max(self.overall[-1, INTERNAL], 1.0),
            mass_added_kg=float(self.overall[-1, MASS_ADDED]))
