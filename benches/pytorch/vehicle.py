"""The 4DOF vehicle, its effects and its features as vectorised PyTorch: the formulas of
src/vehicle and src/response/{step,effects,features}.rs for a car that does not steer.

States are [rows, 8]: v_x, v_y, ψ, r, φ, φ̇, X, Y; forces [rows, 3]: F_x, F_y, M_z in body axes.
"""

import torch

STEP_S = 0.01
G = 9.80665
MASS, SPRUNG, IZZ, IXX, IXZ = 2000.0, 1700.0, 3961.6, 786.8, 134.4
FRONT, REAR, TRACK, CG_HEIGHT, CONTACT_HEIGHT = 1.2668, 1.4901, 1.5, 0.5113, 0.52
ROLL_ARM, ROLL_AXIS, ROLL_STIFFNESS, ROLL_DAMPING, FRONT_SHARE = 0.45, 0.06, 1.18e5, 1.9e4, 0.55
FRICTION, SLIDING, RESISTANCE = 0.8, 0.8, (0.01, 1e-4, 2e-5)
CORNERING = torch.tensor([13.3, 13.3, 20.9, 20.9]).double()
WHEEL_X = torch.tensor([FRONT, FRONT, -REAR, -REAR]).double()
WHEEL_Y = torch.tensor([0.5, -0.5, 0.5, -0.5]).double() * TRACK
AXLE_X, AXLE_CORNERING = WHEEL_X[::2], CORNERING[::2]
KNOTS = torch.tensor([0.01, 0.025, 0.05, 0.09, 0.15, 0.25, 0.4, 0.6, 0.85, 1.2]).double()
WIDTHS = torch.diff(KNOTS, prepend=torch.zeros(1).double())
WHEEL_MASS = 2 * MASS * torch.tensor([0.0075, 0.03]).double()
SLOW = 0.5


def solve_yaw_roll(yaw_moment, roll_moment):
    determinant = IZZ * IXX - IXZ * IXZ
    yaw = (yaw_moment * IXX - roll_moment * IXZ) / determinant
    return yaw, (roll_moment * IZZ - yaw_moment * IXZ) / determinant


def loads(to_front, to_right):
    weight = MASS * G
    front = ((to_front + weight * REAR) / (FRONT + REAR)).clamp(0, weight)
    half = 0.5 * torch.stack([front, weight - front], -1)
    share = torch.tensor([FRONT_SHARE, 1 - FRONT_SHARE]) / TRACK
    shift = torch.maximum(-half, torch.minimum(to_right.unsqueeze(-1) * share, half))
    return torch.stack([half - shift, half + shift], -1).flatten(-2)


def evaluate(x, force):
    """Derivative [rows, 8], acceleration of the CG [rows, 2], loads [rows, 4]."""
    vx, vy, yaw, r, roll, roll_rate, _, _ = x.unbind(-1)
    fx, fy, mz = force.unbind(-1)
    u = vx.unsqueeze(-1) - r.unsqueeze(-1) * WHEEL_Y
    w = vy.unsqueeze(-1) + r.unsqueeze(-1) * WHEEL_X
    speed = u.abs()
    slip = -torch.atan(w / (speed + SLOW))
    friction = FRICTION * (1 - (1 - SLIDING) * (1 - torch.exp(-slip * slip / 0.25)))
    stiffness = slip * (CORNERING / FRICTION)
    lateral = stiffness * torch.rsqrt(stiffness * stiffness + 1)
    resistance = RESISTANCE[0] + speed * (RESISTANCE[1] + speed * RESISTANCE[2])
    rolling = -resistance * torch.tanh(u / 0.05)
    leaning = torch.sin(roll) * (SPRUNG * G * ROLL_ARM)
    arm = CONTACT_HEIGHT - CG_HEIGHT
    load = loads(torch.zeros_like(vx), torch.zeros_like(vx))
    for i in range(3):
        limit = friction * load
        along = torch.maximum(-limit, torch.minimum(rolling * load, limit))
        across = lateral * (limit * limit - along * along).clamp_min(1e-9).sqrt()
        along_sum, across_sum = along.sum(-1), across.sum(-1)
        if i < 2:
            to_right = across_sum * CG_HEIGHT - fy * arm + leaning
            load = loads(fx * arm - along_sum * CG_HEIGHT, to_right)
    ax, ay = (along_sum + fx) / MASS, (across_sum + fy) / MASS
    yaw_moment = (across * WHEEL_X - along * WHEEL_Y).sum(-1) + mz
    roll_moment = leaning + ay * (SPRUNG * ROLL_ARM) - roll * ROLL_STIFFNESS
    roll_moment = roll_moment - roll_rate * ROLL_DAMPING - fy * (CONTACT_HEIGHT - ROLL_AXIS)
    yaw_rate, roll_acceleration = solve_yaw_roll(yaw_moment, roll_moment)
    sin, cos = torch.sin(yaw), torch.cos(yaw)
    rate = [ax + vy * r, ay - vx * r, r, yaw_rate, roll_rate, roll_acceleration]
    rate = torch.stack([*rate, vx * cos - vy * sin, vx * sin + vy * cos], -1)
    return rate, torch.stack([ax, ay], -1), load


def energy(x):
    return 0.5 * MASS * x[:, :2].square().sum(-1) + 0.5 * IZZ * x[:, 3].square()


def step(x, force, residual):
    """A Runge–Kutta step with a residual acceleration [rows, 4] of v_x, v_y, r, φ̇."""
    none = torch.zeros_like(residual[:, :1])
    vx, vy, yaw, roll = residual.split(1, -1)
    added = torch.cat([vx, vy, none, yaw, none, roll, none, none], -1)
    f = lambda x: evaluate(x, force)[0] + added
    k1 = f(x)
    k2 = f(x + k1 * (STEP_S / 2))
    k3 = f(x + k2 * (STEP_S / 2))
    k4 = f(x + k3 * STEP_S)
    after = x + (k1 + 2 * (k2 + k3) + k4) * (STEP_S / 6)
    grows = (energy(after) > energy(x)) & (force == 0).all(-1)
    share = torch.where(grows, (energy(x) / energy(after)).sqrt(), 1.0).unsqueeze(-1)
    none = torch.ones_like(share)
    return after * torch.cat([share, share, none, share, none, none, none, none], -1)


def features(x, force, now, time_s):
    vx, vy, _, r, roll, roll_rate, _, _ = x.unbind(-1)
    rate, acceleration, _ = now
    speed = (vx * vx + vy * vy + 1e-12).sqrt() + SLOW
    slip = torch.atan((vy.unsqueeze(-1) + r.unsqueeze(-1) * AXLE_X) / (vx.abs() + SLOW).unsqueeze(-1))
    columns = [vx / 20, vy / 10, r / 1.5, roll_rate * 3, roll / 0.05]
    columns += [force[:, 0] / (MASS * 10), force[:, 1] / (MASS * 10), force[:, 2] / (IZZ * 5)]
    columns += [slip[:, 0], slip[:, 1], rate[:, 0] / 20, rate[:, 1] / 20, rate[:, 3] / 4]
    columns += [rate[:, 5] / 4, acceleration[:, 0] / 5, acceleration[:, 1] / 5]
    columns += [vx / speed, vy / speed, torch.exp(-time_s / 0.2), time_s / 4]
    return torch.stack(columns, -1)


def side_forces(x, now):
    """Forces of the effects of the axles across [rows, 2, 14] and along [rows, 2, 6], N."""
    rate, _, load = now
    u, r = x[:, :1], x[:, 3:4]
    w = x[:, 1:2] + r * AXLE_X
    load = load.unflatten(-1, (2, 2))
    transfer = (load[..., 0] - load[..., 1]) / (load.sum(-1) + 1)
    load = load.sum(-1)
    slip = -torch.atan(w / (u.abs() + SLOW))
    grip, side, size = load * FRICTION, torch.sign(slip), slip.abs()
    ramp = ((size.unsqueeze(-1) * (0.8 / FRICTION) - KNOTS) / WIDTHS + 1).clamp(0, 1)
    hats = torch.cat([ramp[..., :-1] - ramp[..., 1:], ramp[..., -1:]], -1)
    sin, cos = torch.sin(size), torch.cos(size)
    shapes = torch.stack([sin, sin * sin, 2 * sin * cos, cos], -1)
    drag = -shapes * (grip * torch.tanh(u / SLOW) * 0.125).unsqueeze(-1)
    uw, ww, rw, gw = (of.unsqueeze(-1) for of in (u, w, r, grip))
    rest = ww * ww + 0.1
    lag_slip = ww.abs() + 0.3
    for _ in range(4):
        lag = lag_slip * WHEEL_MASS / (gw + 100)
        turned = rw * lag
        along = uw - (uw - turned * ww) / (turned * turned + 1)
        lag_slip = (along * along + rest).sqrt()
    lag_along = -0.3 * gw * along / lag_slip
    lag_across = -0.3 * gw * (ww / lag_slip - ww / rest.sqrt())
    stiffness = slip * (AXLE_CORNERING / FRICTION)
    flattening = stiffness * stiffness + 1
    squared = u * u + w * w + SLOW * SLOW
    across = rate[:, 1:2] + rate[:, 3:4] * AXLE_X
    turning = -(across * u.abs() - w * rate[:, :1] * torch.sign(u)) / squared
    slope = load * AXLE_CORNERING / (flattening * flattening.sqrt())
    relaxation = -slope * turning * 0.1 * torch.rsqrt(squared)
    relaxation = torch.maximum(-0.5 * load, torch.minimum(relaxation, 0.5 * load))
    lost = grip * stiffness * torch.rsqrt(flattening) * transfer * transfer * 0.3
    characteristic = hats * (grip * side * 0.125).unsqueeze(-1)
    others = torch.stack([relaxation, lost], -1)
    return torch.cat([characteristic, lag_across, others], -1), torch.cat([drag, lag_along], -1)


def body_effects(x, force, now):
    """What is not of an axle and in which number of the acceleration it stands, [rows, 11]."""
    rate, acceleration, _ = now
    fx, fy, mz = (force / torch.tensor([MASS, MASS, IZZ])).unbind(-1)
    roll, roll_rate = x[:, 4], x[:, 5]
    columns = [-rate[:, 0] * 0.05, roll * 100, roll_rate * 10, acceleration[:, 1], fy]
    columns += [fx * 0.1, fy * 0.1, mz * 0.1, roll_rate, roll_rate, rate[:, 5] * 0.05]
    return torch.stack(columns, -1), [0, 3, 3, 3, 3, 0, 1, 2, 1, 2, 2]


def by_side_force():
    """Acceleration by 1 N across at each axle, [2, 4]."""
    yaw, roll = solve_yaw_roll(AXLE_X, SPRUNG * ROLL_ARM / MASS)
    return torch.stack([torch.zeros(2), torch.full((2,), 1 / MASS), yaw, roll], -1)


def combined(forces, x, force, now, strengths):
    """Σ c_k e_k, [rows, 4], summed as forces first."""
    across, along = forces
    c_across, c_along, c_body = strengths.split([28, 12, 11], -1)
    side = (across * c_across.unflatten(-1, (2, 14))).sum(-1)
    drag = (along * c_along.unflatten(-1, (2, 6))).sum((-1, -2))
    body, places = body_effects(x, force, now)
    places = torch.nn.functional.one_hot(torch.tensor(places), 4).double()
    first = torch.tensor([1.0 / MASS, 0.0, 0.0, 0.0])
    return side @ by_side_force() + drag.unsqueeze(-1) * first + (body * c_body) @ places


def effects(x, force, now):
    """Every effect by itself, [rows, 51, 4]."""
    eye = torch.eye(51)
    forces = side_forces(x, now)
    return torch.stack([combined(forces, x, force, now, one.expand(len(x), 51)) for one in eye], 1)
