"""What is computed: a Latin hypercube over the collisions that people drive in, and where the cars stand.

World axes: origin on the ground under the centre of gravity of the struck car, X along its heading, Y to the
left. Every collision is computed with the striking car on the right of the struck one (`side` right); of a
collision from the left that is the mirror image, and its results are mirrored back (y -> -y).
"""

from dataclasses import asdict, dataclass

import numpy as np
from scipy.interpolate import griddata
from scipy.stats import qmc

from bodies import AHEAD_OF_CONTACT_M, REAR_CORE_X, SHAPES, Body

# Distance at which the contact of two cars begins, and what is left free before it, m.
CONTACT_GAP_M = 0.010
CLEARANCE_M = 0.003
# Masses that cars of each body have, kg.
MASSES_KG = {"A": (1200.0, 2200.0), "B": (1700.0, 2700.0), "C": (1050.0, 1600.0)}
# Furthest ahead that a struck car is deformable, m: in front of that its wheel house begins.
FURTHEST_CORE_X = 0.85
KINDS = ("pit", "side", "rear")
# Cars whose points of contact part at first touch somewhere else later.
LEAST_APPROACH_M_S = 0.3


@dataclass(frozen=True)
class Collision:
    """A collision as it is told in the table of cases; SI units, rad.

    - `kind`: "pit" (flank, along the road), "side" (flank, across) or "rear".
    - `place`: where the striking car is aimed at: X of the flank that its corner or the middle of its front
      meets; for "rear" the distance of its middle from the middle line of the struck car.
    - `heading`: of the striking car against the struck one, positive with the striking car on the right.
    """

    name: str
    kind: str
    side: str
    bodies: tuple
    masses: tuple
    velocities: tuple
    yaw_rates: tuple
    heading: float
    place: float

    @property
    def sign(self):
        """+1 with the striking car on the right of the struck one, where it is computed; -1 on the left."""
        return 1 if self.side == "right" else -1

    def mirrored(self):
        """The same collision with the striking car on the right."""
        if self.side == "right":
            return self
        flip = dict(velocities=tuple((vx, -vy) for vx, vy in self.velocities), heading=-self.heading,
                    yaw_rates=tuple(-rate for rate in self.yaw_rates), side="right")
        if self.kind == "rear":
            flip["place"] = -self.place
        return Collision(**{**asdict(self), **flip})


def between(low, high, share):
    return low + (high - low) * share


def sample(n, seed, prefix):
    """`n` collisions; the same seed gives the same ones. A sixth of them into the side or the rear."""
    shares = qmc.LatinHypercube(d=13, rng=np.random.default_rng(seed)).random(n)
    return [_collision(f"{prefix}{i + 1:03d}", i, share) for i, share in enumerate(shares)]


def _collision(name, i, u):
    side = "right" if u[0] < .5 else "left"
    sign = 1 if side == "right" else -1
    kind = ("side", "rear")[i // 6 % 2] if i % 6 == 5 else "pit"
    struck = "A" if u[1] < .55 else "B"
    striking = "ABC"[min(2, int(3 * u[2]))]
    masses = between(*MASSES_KG[struck], u[3]), between(*MASSES_KG[striking], u[4])
    rates = between(-1, 1, u[5]), between(-1, 1, u[6])
    vx, vy = between(8, 40, u[7]), between(-1, 1, u[8])
    shape = SHAPES[struck]
    if kind == "pit":
        heading = np.radians(between(0, 45, u[9]))
        closing = 0.5 + 11.5 * u[10]**1.6
        velocity = vx + between(-3, 8, u[11]), vy + closing
        place = between(shape.x_rear + .15, FURTHEST_CORE_X, u[12])
    elif kind == "side":
        heading = np.radians(between(60, 90, u[9]))
        # The striking car drives along its heading; how fast it closes decides its speed.
        speed = between(2, 12, u[10]) / np.sin(heading)
        vx = between(0, 20, u[7])
        velocity = speed * np.cos(heading), speed * np.sin(heading)
        place = between(shape.x_rear + .5, FURTHEST_CORE_X, u[12])
    else:
        heading = np.radians(between(-15, 15, u[9]))
        velocity = vx + between(1, 12, u[10]), vy + between(-1, 1, u[11])
        place = between(-1.1, 1.1, u[12])
    if kind != "rear" and _approach(shape, SHAPES[striking], heading, place, velocity[1] - vy, rates) <= LEAST_APPROACH_M_S:
        # The other way round turning brings the points of contact together.
        rates = -rates[0], -rates[1]
    velocities = (vx, sign * vy), (velocity[0], sign * velocity[1])
    if kind == "rear":
        place, heading = sign * place, sign * heading
    else:
        heading = sign * heading
    return Collision(name, kind, side, (struck, striking), tuple(float(m) for m in masses),
                     tuple((float(a), float(b)) for a, b in velocities),
                     tuple(float(sign * rate) for rate in rates), float(heading), float(place))


def _approach(struck, striking, heading, place, closing, rates):
    """Speed at which the corner of the striking car comes nearer to the flank, turning included, m/s."""
    corner = rotation(heading) @ np.array([striking.x_front - .25, striking.width / 2])
    return closing + rates[1] * corner[0] - rates[0] * place


def reference(name="t0"):
    """A PIT at 20 m/s: bullet and target of 2000 kg, 15 degrees, at the rear axle."""
    return Collision(name, "pit", "right", ("A", "A"), (2000.0, 2000.0), ((20.0, 0.0), (21.0, 2.5)), (0.0, 0.0),
                     float(np.radians(15)), SHAPES["A"].x_rear_axle)


@dataclass
class Placed:
    """Both cars of a collision where they stand: `at` is the place of the striking car, world axes, m.

    - `contact`: first place of the skins to come close, body axes of the struck car.
    """

    collision: Collision
    struck: Body
    striking: Body
    at: np.ndarray
    contact: np.ndarray


def rotation(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def placed(collision, parts=1):
    """The cars of a collision that is computed (on the right), with their skins a clearance apart."""
    assert collision.side == "right", "the mirror image is computed"
    struck_shape, striking_shape = (SHAPES[name] for name in collision.bodies)
    core_x = REAR_CORE_X
    if collision.kind != "rear":
        # A car that is faster slides ahead along the flank.
        slide = max(0.0, collision.velocities[1][0] - collision.velocities[0][0]) * 0.15
        wide = striking_shape.width / 2 if collision.kind == "side" else 0.0
        needed = collision.place + AHEAD_OF_CONTACT_M + slide + wide
        core_x = min(FURTHEST_CORE_X, max(REAR_CORE_X, needed))
    struck = Body(struck_shape, "rear", -1, collision.masses[0], parts, core_x)
    striking = Body(striking_shape, "front", +1, collision.masses[1], parts)
    skin = striking.skin()
    skin[:, :2] = skin[:, :2] @ rotation(collision.heading).T
    if collision.kind == "rear":
        shift = np.array([0.0, collision.place])
        along, across = 0, 1
        surface = struck.end_skin()
    else:
        shift = np.array([collision.place - _aim(collision, striking, skin), 0.0])
        along, across = 1, 0
        surface = struck.side_skin()
    moved = skin.copy()
    moved[:, :2] += shift
    # Both come from below: from behind along X, or from the right along Y.
    within = [(moved[:, axis] > surface[:, axis].min()) & (moved[:, axis] < surface[:, axis].max())
              for axis in (across, 2)]
    moved = moved[within[0] & within[1]]
    level = griddata(surface[:, [across, 2]], surface[:, along], moved[:, [across, 2]], method="linear")
    free = level - moved[:, along]
    if not np.isfinite(free).any():
        raise ValueError(f"{collision.name}: the cars pass each other")
    first = int(np.nanargmin(free))
    shift[along] += free[first] - (CONTACT_GAP_M + CLEARANCE_M)
    contact = moved[first].copy()
    contact[along] = level[first]
    return Placed(collision, struck, striking, shift, contact)


def _aim(collision, striking, skin):
    """X of what is aimed: the leading corner of the front, or its middle where it drives across."""
    if collision.kind == "side":
        ahead = rotation(collision.heading) @ np.array([striking.shape.x_front, 0.0])
        return ahead[0]
    local = striking.skin()
    is_corner = (local[:, 0] > striking.shape.x_front - 0.6) & (local[:, 2] < striking.shape.z[9])
    corner = skin[is_corner]
    return corner[np.argmax(corner[:, 1])][0]
