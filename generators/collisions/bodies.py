"""Car bodies of shell elements: a deformable end on a rigid core.

The bodies are written for this purpose. Shapes, thicknesses and steels are usual ones; nothing is fitted to
a crash test. Axes of a car: origin on the ground under the centre of gravity of the undeformed car, x ahead,
y to the left, z up. Units: kg, m, s.

All panels are faces of one structured lattice of x, y and z stations, which is then bent into the shape of a
car, so that panels that meet share their nodes.
"""

from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class Material:
    """A material: Johnson-Cook, elastic, or without strength.

    Flow stress (yield + hardening * strain**exponent) * (1 + rate * ln(strain rate)), at most `largest`, Pa.
    """

    modulus: float
    poisson: float
    density: float
    yield_stress: float = 0.0
    hardening: float = 0.0
    exponent: float = 0.0
    rate: float = 0.0
    largest: float = 0.0
    is_void: bool = False


STEEL = dict(modulus=210e9, poisson=0.30, density=7850.0)
MATERIALS = {
    "mild": Material(**STEEL, yield_stress=180e6, hardening=420e6, exponent=0.50, rate=0.010, largest=480e6),
    "hsla": Material(**STEEL, yield_stress=300e6, hardening=450e6, exponent=0.50, rate=0.008, largest=580e6),
    "hss": Material(**STEEL, yield_stress=350e6, hardening=500e6, exponent=0.50, rate=0.008, largest=680e6),
    "pp": Material(modulus=1.8e9, poisson=0.38, density=1100.0, yield_stress=20e6, hardening=30e6, exponent=0.60,
                   rate=0.030, largest=45e6),
    "tyre": Material(modulus=60e6, poisson=0.45, density=1200.0),
    "void": Material(**STEEL, is_void=True),
}

# Panels: material and thickness, m.
PANELS = {
    "side": ("mild", 0.75e-3), "qinner": ("mild", 0.75e-3), "whouse": ("mild", 0.80e-3),
    "floor": ("mild", 0.80e-3), "bulk": ("mild", 0.70e-3), "endpan": ("mild", 0.80e-3),
    "gutter": ("mild", 0.80e-3), "cpillar": ("mild", 1.00e-3), "sill": ("hsla", 1.40e-3),
    "rail": ("hsla", 1.80e-3), "crash": ("hsla", 1.50e-3), "xmem": ("hsla", 1.50e-3), "beam": ("hss", 1.80e-3),
    "fascia": ("pp", 3.00e-3), "absorb": ("pp", 2.50e-3), "axle": ("hss", 2.50e-3), "bracket": ("mild", 0.70e-3),
    "rim": ("hss", 2.50e-3), "tyre": ("tyre", 14.0e-3), "shotgun": ("hsla", 1.20e-3), "skin": ("void", 0.90e-3),
}
PANEL_NAMES = list(PANELS)
# Panels that may touch other panels of their own car.
SELF_CONTACT = ("side", "qinner", "whouse", "fascia", "beam", "rail", "crash", "rim", "tyre", "shotgun", "endpan",
                "xmem", "axle")

# Rearmost stations of the rigid core of a struck car: its rear alone deforms, or its doors too.
REAR_CORE_X = -0.50
# The deformable part reaches this far ahead of the place of contact at least.
AHEAD_OF_CONTACT_M = 0.75


@dataclass(frozen=True)
class Shape:
    """Dimensions of a body, m, and what scales its structure."""

    name: str
    length: float
    width: float
    x_front: float
    x_rear: float
    x_front_axle: float
    x_rear_axle: float
    # Where the rigid core of the striking car begins.
    x_front_core: float
    # Heights of the lattice: ground clearance to roof.
    z: tuple
    wheel_radius: float
    wheel_height: float
    # Factors of the thickness of the steel panels and of the bumper beam.
    steel: float
    beam: float
    # Yaw moment of inertia over mass, m².
    gyration2: float


SALOON = Shape("A", 4.80, 1.85, 2.18, -2.62, 1.26, -1.54, 0.70,
               (.04, .14, .24, .34, .44, .54, .62, .70, .79, .88, .96, 1.10, 1.24, 1.38), .33, .34, 1.00, 1.00, 1.80)
SUV = Shape("B", 5.00, 1.95, 2.37, -2.63, 1.42, -1.53, 0.86,
            (.05, .17, .29, .41, .53, .65, .74, .83, .93, 1.03, 1.13, 1.27, 1.41, 1.55), .37, .37, 1.20, 1.25, 1.98)
HATCHBACK = Shape("C", 4.15, 1.76, 1.95, -2.20, 1.16, -1.42, 0.55,
                  (.05, .15, .25, .35, .45, .55, .63, .71, .80, .89, .97, 1.13, 1.29, 1.45), .31, .32, 0.90, 0.90, 1.45)
SHAPES = {shape.name: shape for shape in (SALOON, SUV, HATCHBACK)}
# Width of the car in which the stations across are told.
NOMINAL_WIDTH = 1.85


def stations(low, high, spacing):
    """Evenly spaced stations from `low` to `high`, both included."""
    return list(np.linspace(low, high, max(1, int(round(abs(high - low) / spacing))) + 1))


def refined(values, parts):
    """The stations with each interval cut into `parts`."""
    out = [values[0]]
    for low, high in zip(values[:-1], values[1:]):
        out += [low + (high - low) * (k + 1) / parts for k in range(parts)]
    return out


@dataclass
class Inertia:
    """What is added to the shells at one node of the rigid core, so that the car has its mass and moments."""

    mass: float
    place: np.ndarray
    about_z: float
    # Centre of gravity of the whole core.
    core_place: np.ndarray
    # Yaw moment of inertia of the whole core about its centre of gravity.
    core_about_z: float
    products: tuple
    deformable_mass: float


@dataclass
class Body:
    """One end of a car as shells.

    - `end`: "rear" of a struck car, "front" of a striking one.
    - `wheel_side`: the side that has its wheel, +1 left, -1 right.
    - `mass`: of the whole car, kg.
    - `parts`: each interval of the lattice is cut into so many.
    - `core_x`: where the rigid core of a rear end begins.
    """

    shape: Shape
    end: str
    wheel_side: int
    mass: float
    parts: int = 1
    core_x: float = REAR_CORE_X
    spacing: float = 0.08
    nodes: np.ndarray = field(init=False)
    elements: list = field(init=False, default_factory=list)

    def __post_init__(self):
        self._index, self._places, self._faces, self.core = {}, [], set(), set()
        self._lattice()
        (self._rear if self.end == "rear" else self._front)()
        self.nodes = np.array(self._places)
        self._weigh()

    # -- lattice

    def _lattice(self):
        shape, scale = self.shape, self.shape.width / NOMINAL_WIDTH
        across = [y * scale for y in (0, .15, .30, .45, .55, .64, .73, .80, .925)]
        if self.parts > 1:
            across = refined(across, self.parts)
        # A plane of its own for the wheel and the axle, which other panels pass over.
        self.wheel_y = .893 * scale
        across = sorted(across + [self.wheel_y])
        z = refined(shape.z, self.parts) if self.parts > 1 else list(shape.z)
        if self.end == "rear":
            ends = [shape.x_rear, shape.x_rear + .08, shape.x_rear + .17]
            soft = ends + stations(shape.x_rear + .17, self.core_x, self.spacing)[1:]
            hard = stations(self.core_x, max(self.core_x + .32, REAR_CORE_X + 1.6), .32)[1:]
            x = (refined(soft, self.parts) if self.parts > 1 else soft) + hard
        else:
            soft = stations(shape.x_front_core, shape.x_front - .20, self.spacing)
            soft += [shape.x_front - .10, shape.x_front]
            hard = stations(shape.x_front_core - 1.28, shape.x_front_core, .32)[:-1]
            x = hard + (refined(soft, self.parts) if self.parts > 1 else soft)
        self.x = np.array(x)
        self.y = np.array([-y for y in across[::-1]][:-1] + across)
        self.z = np.array(z)
        self._without_wheel = [j for j, y in enumerate(self.y) if abs(abs(y) - self.wheel_y) > 1e-9]

    def bent(self, x, y, z):
        """A place of the lattice in the shape of a car: rounded ends, curved sides, roof drawn in."""
        shape = self.shape
        levels, half = shape.z, shape.width / 2
        aside = min(1.0, abs(y) / half)
        bent_x, bent_y = x, y
        if x > shape.x_front - .55:
            s = (x - (shape.x_front - .55)) / .55
            bent_y = y * (1 - .16 * s * s)
            bent_x = x - .20 * aside**3 * s
            if z > levels[7]:
                up = min(1.0, (z - levels[7]) / (levels[10] - levels[7]))
                bent_y *= 1 - .09 * s * up
                bent_x -= .16 * s * up
        elif x < shape.x_rear + .50:
            s = ((shape.x_rear + .50) - x) / .50
            bent_y = y * (1 - .10 * s * s)
            bent_x = x + .13 * aside**3 * s
        if z <= levels[10]:
            up = (z - levels[5]) / (levels[10] - levels[5])
            bent_y *= 1 - (.055 if up > 0 else .035) * up * up
        else:
            bent_y *= (1 - .055) * (1 - .22 * (z - levels[10]) / (levels[13] - levels[10]))
        return bent_x, bent_y, z

    def _node(self, i, j, k):
        number = self._index.get((i, j, k))
        if number is None:
            number = len(self._places)
            self._index[i, j, k] = number
            self._places.append(self.bent(self.x[i], self.y[j], self.z[k]))
        return number

    def _quad(self, panel, *corners):
        nodes = [self._node(*corner) for corner in corners]
        if frozenset(nodes) not in self._faces:
            self._faces.add(frozenset(nodes))
            self.elements.append((panel, *nodes))

    @staticmethod
    def _intervals(values, low, high):
        return [i for i in range(len(values) - 1) if values[i] >= low - 1e-6 and values[i + 1] <= high + 1e-6]

    def _across(self, low, high):
        to_wheel = abs(max(abs(low), abs(high)) - self.wheel_y) <= 1e-6
        chosen = range(len(self.y)) if to_wheel else self._without_wheel
        chosen = [j for j in chosen if low - 1e-6 <= self.y[j] <= high + 1e-6]
        return list(zip(chosen[:-1], chosen[1:]))

    def _at_x(self, x):
        return int(np.argmin(np.abs(self.x - x)))

    def _x(self, x):
        return float(self.x[self._at_x(x)])

    def _y(self, y):
        y *= self.shape.width / NOMINAL_WIDTH
        return float(self.y[int(np.argmin(np.abs(self.y - y)))])

    def _span(self, side, low, high):
        low, high = side * self._y(low), side * self._y(high)
        return min(low, high), max(low, high)

    def _face_x(self, panel, x, y, z):
        """Panel across the car at a station: `y` and `z` are its spans."""
        i = self._at_x(x)
        for j, j1 in self._across(*y):
            for k in self._intervals(self.z, *z):
                self._quad(panel, (i, j, k), (i, j1, k), (i, j1, k + 1), (i, j, k + 1))

    def _face_y(self, panel, y, x, z):
        """Panel along the car; `panel` may be a function of the middle of an element, or give None."""
        j = int(np.argmin(np.abs(self.y - y)))
        for i in self._intervals(self.x, *x):
            for k in self._intervals(self.z, *z):
                middle = .5 * (self.x[i] + self.x[i + 1]), .5 * (self.z[k] + self.z[k + 1])
                name = panel(*middle) if callable(panel) else panel
                if name is not None:
                    self._quad(name, (i, j, k), (i + 1, j, k), (i + 1, j, k + 1), (i, j, k + 1))

    def _face_z(self, panel, z, x, y):
        """Level panel."""
        k = int(np.argmin(np.abs(self.z - z)))
        for i in self._intervals(self.x, *x):
            for j, j1 in self._across(*y):
                self._quad(panel, (i, j, k), (i + 1, j, k), (i + 1, j1, k), (i, j1, k))

    def _box(self, panel, x, y, z):
        """Four walls along the car."""
        for side in y:
            self._face_y(panel, side, x, z)
        for level in z:
            self._face_z(panel, level, x, y)

    def _wheel(self, side, x_axle, x):
        shape = self.shape

        def panel(px, pz):
            radius = np.hypot(px - x_axle, pz - shape.wheel_height)
            if radius >= shape.wheel_radius:
                return None
            return "rim" if radius < .6 * shape.wheel_radius else "tyre"

        self._face_y(panel, side * self._y(.893), x, (shape.z[0], shape.z[6]))

    def _axle(self, x_axle, inner):
        """A tube across, out to the wheel on the side that has one. `inner`: where a bare side ends."""
        z, side = self.shape.z, self.wheel_side
        first, last = self._x(x_axle - .04), self._x(x_axle + .045)
        if abs(last - first) < 1e-6:
            last = self._x(x_axle + .09)
        left = self._y(.893) if side == 1 else self._y(inner)
        right = -self._y(.893) if side == -1 else -self._y(inner)
        for x in (first, last):
            self._face_x("axle", x, (right, left), (z[3], z[4]))
        self._face_z("axle", z[3], (first, last), (right, left))
        return first, last, right, left

    # -- structures

    def _rear(self):
        shape, z, half, y = self.shape, self.shape.z, self.shape.width / 2, self._y
        x_rear, x_core, x_axle = shape.x_rear, self.core_x, shape.x_rear_axle
        beam_x = x_rear + .08, x_rear + .17
        house = self._x(x_axle - .40), self._x(x_axle + .40)
        seat = house[1]

        def outer(px, pz):
            if np.hypot(px - x_axle, pz - shape.wheel_height) < shape.wheel_radius + .035:
                return None
            return "fascia" if px < x_rear + .50 and pz < z[7] else "side"

        for side in (1, -1):
            self._face_y(outer, side * half, (x_rear, x_core), (z[2], z[10]))
            self._face_z("whouse", z[7], house, self._span(side, .64, .925))
            for x in house:
                self._face_x("whouse", x, self._span(side, .64, .925), (z[4], z[7]))
            self._face_y("whouse", side * y(.64), house, (z[3], z[7]))
            self._face_y("qinner", side * y(.80), (beam_x[1], seat), (z[7], z[10]))
            self._face_z("gutter", z[10], (beam_x[1], x_core), self._span(side, .80, .925))
            self._face_y("qinner", side * y(.80), (seat, x_core), (z[7], z[10]))
            self._face_y("sill", side * y(.80), (seat, x_core), (z[3], z[4]))
            for level in (z[4], z[3]):
                self._face_z("sill", level, (seat, x_core), self._span(side, .80, .925))
            pillars = [(self._x(x_axle - .40), self._x(x_axle + .16), z[10], z[13])]
            if x_core > 0.2:
                # The pillar between the doors.
                pillars.append((self._x(-.16), self._x(-.02), z[4], z[10]))
            for low, high, bottom, top in pillars:
                for plane in (side * half, side * y(.80)):
                    self._face_y("cpillar", plane, (low, high), (bottom, top))
                for x in (low, high):
                    self._face_x("cpillar", x, self._span(side, .80, .925), (bottom, top))
            rail = self._span(side, .45, .55)
            self._box("rail", (beam_x[1], x_core), rail, (z[4], z[5]))
            self._face_x("rail", beam_x[1], rail, (z[4], z[5]))
            self._face_x("endpan", beam_x[1], self._span(side, .80, .925), (z[4], z[10]))
            if side == self.wheel_side:
                inside = [float(self.x[self._at_x(x) + step * self.parts]) for x, step in zip(house, (1, -1))]
                self._wheel(side, x_axle, inside)
            self._face_z("floor", z[4], (beam_x[1], house[0]), self._span(side, .64, .925))
            self._face_z("floor", z[4], (house[1], x_core), self._span(side, .64, .80))
        self._face_z("floor", z[4], (beam_x[1], x_core), (-y(.64), y(.64)))
        self._face_x("endpan", beam_x[1], (-y(.80), y(.80)), (z[4], z[9]))
        self._face_x("bulk", seat, (-y(.80), y(.80)), (z[4], z[10]))
        first, last, right, left = self._axle(x_axle, .64)
        self._face_z("axle", z[4], (first, last), (right, -y(.64)))
        self._face_z("axle", z[4], (first, last), (y(.64), left))
        members = [seat]
        if x_core > 0.2:
            # The cross member of the front seats, from sill to sill.
            members.append(self._x(.10))
        for x in members:
            ahead, wide = float(self.x[self._at_x(x) + self.parts]), y(.45) if x == seat else y(.80)
            for plane in (x, ahead):
                self._face_x("xmem", plane, (-wide, wide), (z[3], z[4]))
            self._face_z("xmem", z[3], (x, ahead), (-wide, wide))
        self._bumper(x_rear, beam_x, z[7])
        self._face_z("fascia", z[7], (x_rear, beam_x[1]), (-half, half))
        self._face_y("skin", self.wheel_side * half, (x_core, float(self.x[-1])), (z[2], z[10]))
        for number, (px, _, pz) in enumerate(self._places):
            if px >= x_core - 1e-6 or pz >= z[13] - 1e-6:
                self.core.add(number)
        # Mass without strength, spread over panels, kg.
        self.carried = [(130.0, ("axle", "rim", "xmem")), (110.0, ("floor",)), (45.0, ("endpan", "bulk", "gutter"))]

    def _front(self):
        shape, z, half, y = self.shape, self.shape.z, self.shape.width / 2, self._y
        x_front, x_core, x_axle = shape.x_front, shape.x_front_core, shape.x_front_axle
        support = x_front - .20
        beam_x = support, x_front - .10
        junction = self._x(support - .24)

        def outer(px, pz):
            if np.hypot(px - x_axle, pz - shape.wheel_height) < shape.wheel_radius + .035:
                return None
            is_bumper = (px > x_front - .45 and pz < z[8]) or (px > x_axle and pz < z[4])
            return "fascia" if is_bumper else "side"

        for side in (1, -1):
            self._face_y(outer, side * half, (x_core, x_front), (z[2], z[10]))
            self._box("shotgun", (x_core, support), self._span(side, .73, .80), (z[8], z[9]))
            self._face_z("bracket", z[9], (x_core, support), self._span(side, .80, .925))
            self._face_y("whouse", side * y(.64), (x_core, support), (z[4], z[8]))
            self._face_z("whouse", z[8], (x_core, support), self._span(side, .64, .73))
            self._face_z("whouse", z[5], (x_core, support), self._span(side, .55, .64))
            rail = self._span(side, .45, .55)
            self._box("rail", (x_core, junction), rail, (z[4], z[5]))
            self._box("crash", (junction, support), rail, (z[4], z[5]))
            for span, bottom, top in (((.45, .55), 3, 8), ((.55, .80), 6, 8), ((.73, .80), 8, 10), ((.80, .925), 8, 10)):
                self._face_x("xmem", support, self._span(side, *span), (z[bottom], z[top]))
            if side == self.wheel_side:
                self._wheel(side, x_axle, (x_core, x_front))
        first, last, right, left = self._axle(x_axle, .55)
        self._face_z("axle", z[4], (first, last), (right, left))
        for bottom, top in ((7, 8), (3, 4)):
            self._face_x("xmem", support, (-y(.45), y(.45)), (z[bottom], z[top]))
        self._bumper(x_front, beam_x, z[8])
        self._face_z("fascia", z[8], (support, x_front), (-half, half))
        self._face_y("skin", self.wheel_side * half, (float(self.x[0]), x_core), (z[2], z[10]))
        for number, (px, _, _) in enumerate(self._places):
            if px <= x_core + 1e-6:
                self.core.add(number)
        self.carried = [(130.0, ("axle", "rim")), (35.0, ("xmem",)), (40.0, ("whouse", "shotgun", "crash", "rail"))]

    def _bumper(self, x_end, beam_x, top):
        """Beam of two plates and two webs, fascia, and what absorbs between them."""
        z, half, wide = self.shape.z, self.shape.width / 2, self._y(.73)
        for x in beam_x:
            self._face_x("beam", x, (-wide, wide), (z[4], z[5]))
        for level in (z[4], z[5]):
            self._face_z("beam", level, beam_x, (-wide, wide))
        self._face_x("fascia", x_end, (-half, half), (z[2], top))
        near = min(beam_x, key=lambda x: abs(x - x_end))
        for level in (z[4], z[5]):
            self._face_z("absorb", level, tuple(sorted((x_end, near))), (-wide, wide))

    # -- masses

    def _weigh(self):
        """Thicknesses, densities, and what the rigid core needs to give the car its mass and moments."""
        shape = self.shape
        self.thickness = {}
        for panel, (material, thickness) in PANELS.items():
            factor = shape.steel if material in ("mild", "hsla") else 1.0
            self.thickness[panel] = thickness * factor * (shape.beam if panel == "beam" else 1.0)
        shells = [(panel, list(nodes), self._shell_mass(panel, nodes)) for panel, *nodes in self.elements]
        of_panel = {}
        for panel, _, mass in shells:
            of_panel[panel] = of_panel.get(panel, 0.0) + mass
        self.density_factor = dict.fromkeys(PANEL_NAMES, 1.0)
        for mass, panels in self.carried:
            factor = 1 + mass / sum(of_panel.get(panel, 0.0) for panel in panels)
            self.density_factor.update(dict.fromkeys(panels, factor))
        masses = np.zeros(len(self.nodes))
        for panel, nodes, mass in shells:
            masses[nodes] += mass * self.density_factor[panel] / 4
        core = np.zeros(len(masses), bool)
        core[list(self.core)] = True
        self.inertia = self._core_inertia(masses, core)

    def _shell_mass(self, panel, nodes):
        material = MATERIALS[PANELS[panel][0]]
        if material.is_void:
            return 0.0
        corner = self.nodes[nodes]
        area = .5 * np.linalg.norm(np.cross(corner[2] - corner[0], corner[3] - corner[1]))
        return material.density * area * self.thickness[panel]

    def _core_inertia(self, masses, core):
        about_z = self.shape.gyration2 * self.mass
        soft, place = masses[~core], self.nodes[~core]
        core_mass = self.mass - soft.sum()
        # The centre of gravity of the whole car lies above the origin, that of the core at 0.55 m.
        centre = -(soft[:, None] * place).sum(0) / core_mass
        centre[2] = .55
        core_about_z = about_z - (soft * (place[:, 0]**2 + place[:, 1]**2)).sum()
        core_about_z -= core_mass * (centre[0]**2 + centre[1]**2)
        shells, place = masses[core], self.nodes[core]
        added = core_mass - shells.sum()
        at = (core_mass * centre - (shells[:, None] * place).sum(0)) / added
        arm, added_arm = place - centre, at - centre
        own = core_about_z - (shells * (arm[:, 0]**2 + arm[:, 1]**2)).sum()
        own -= added * (added_arm[0]**2 + added_arm[1]**2)
        products = [(shells * arm[:, a] * arm[:, b]).sum() + added * added_arm[a] * added_arm[b]
                    for a, b in ((0, 1), (1, 2), (0, 2))]
        if added <= 0 or own <= 0:
            raise ValueError(f"{self.mass:.0f} kg are too few for this body: the shells alone are heavier")
        return Inertia(added, at, own, centre, core_about_z, tuple(products), float(soft.sum()))

    # -- outer surface

    def side_skin(self):
        """A dense sample of the side with the wheel."""
        low, high = float(self.x[0]), float(self.x[-1])
        half, heights = self.shape.width / 2, self._heights()
        return np.array([self.bent(x, self.wheel_side * half, z)
                         for z in heights for x in np.arange(low, high + 1e-9, .02)])

    def end_skin(self):
        """A dense sample of the bumper."""
        shape = self.shape
        end, top = (shape.x_rear, shape.z[7]) if self.end == "rear" else (shape.x_front, shape.z[8])
        across = np.arange(-shape.width / 2, shape.width / 2 + 1e-9, .02)
        return np.array([self.bent(end, y, z) for z in self._heights() if z <= top + 1e-9 for y in across])

    def skin(self):
        """A dense sample of the outer surface that can be touched."""
        return np.concatenate([self.side_skin(), self.end_skin()])

    def _heights(self):
        return np.linspace(self.shape.z[2], self.shape.z[10], 19)
