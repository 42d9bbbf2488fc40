"""Time per epoch of fine-tuning the response network: impactlab against PyTorch, in turn, on one
thread and in double precision.

    python benches/pytorch/response.py target/release/impactlab

Both learn from 20 trajectories of datasets/trajectories-fea, single steps and then rollouts of 50
steps, with the same layers, sizes, frozen layers, losses, batches and optimiser.
PyTorch runs the batch through vectorised formulas and takes their gradients by autograd; with
--compile, step, features and effects of a rollout are compiled before the clock starts.
Where it differs, it has less to do: the car does not steer and has one friction and one size, and all
instants stand ready as tensors, those for the physics among them.
"""

import argparse
import csv
import itertools
import json
import os
import statistics
import struct
import subprocess
import tempfile
import time
from pathlib import Path

import torch
from torch import nn
from torch.nn.functional import scaled_dot_product_attention, silu, softplus

from vehicle import STEP_S, combined, effects, evaluate, features, side_forces, step

N_CASES, N_BATCH, N_FAR, LENGTH, N_WINDOWS = 20, 256, 64, 50, 10
J, N_EFFECTS = 3, 51
UNIT = torch.tensor([0.3, 0.3, 0.3, 1.0]).double()
BOUND = torch.tensor([5.0, 5.0, 5.0, 10.0]).double()
FEATURE_MIRROR = torch.tensor(
    [1, -1, -1, -1, -1, 1, -1, -1, -1, -1, 1, -1, -1, -1, 1, -1, 1, -1, 1, 1]
).double()
OUTPUT_MIRROR = torch.tensor([1, -1, -1, -1, 1, 1, 1, 1, 1]).double()
STATE_UNIT = torch.tensor([0.3, 0.3, 0.03, 0.1, 0.02, 0.2, 0.1, 0.1]).double()
IS_VELOCITY = torch.tensor([1, 1, 0, 1, 1, 1, 0, 0]).double()
JERK_UNIT = torch.tensor([100, 100, 100, 50, 50, 200, 100, 100]).double()
STATE_BOUND = torch.tensor([60.0, 60.0, 8.0, 4.0, 0.5]).double()
BOUNDED = [0, 1, 3, 5, 4]
MIN_STD, FAR_FACTOR = 0.01, 0.9


class Network(nn.Module):
    def __init__(self):
        super().__init__()
        token = lambda: nn.Sequential(
            nn.Linear(5, 8), nn.SiLU(), nn.Linear(8, 8), nn.SiLU(), nn.Linear(8, 8), nn.SiLU()
        )
        self.encoder = nn.Linear(20, 32)
        self.tokens = nn.ModuleList(token() for _ in range(4))
        self.query, self.out = nn.Linear(32, 32), nn.Linear(32, 32)
        self.key, self.value = nn.Linear(8, 32), nn.Linear(8, 32)
        self.trunk, self.head = nn.Linear(32, 32), nn.Linear(32, J * 9)
        self.strengths = nn.Parameter(0.1 * torch.randn(J, N_EFFECTS))
        self.log_scale = nn.Parameter(torch.zeros(5))
        for frozen in (self.encoder, self.tokens):
            frozen.requires_grad_(False)

    def forward(self, x, tokens, known):
        """[n, t, 20], [n, 4, 5], [n, t, J or 1, 4] to residual, remainder, log variance, logits."""
        n, t, _ = x.shape
        hidden = silu(self.encoder(torch.cat([x, x * FEATURE_MIRROR], 1)))
        seen = torch.stack([net(tokens[:, i]) for i, net in enumerate(self.tokens)], 1)
        heads = lambda of: of.unflatten(-1, (2, 16)).transpose(1, 2)
        mixed = scaled_dot_product_attention(
            heads(self.query(hidden)), heads(self.key(seen)), heads(self.value(seen))
        )
        hidden = hidden + self.out(mixed.transpose(1, 2).flatten(2))
        raw = self.head(silu(self.trunk(hidden))).view(n, 2 * t, J, 9)
        raw = 0.5 * (raw[:, :t] + raw[:, t:] * OUTPUT_MIRROR)
        mean = raw[..., :4]
        residual = BOUND * torch.tanh((mean * UNIT + known) / BOUND)
        return residual, mean, raw[..., 4:8], raw[..., 8]


def diversity(values):
    pairs = [(j, k) for j in range(J) for k in range(j + 1, J)]
    near = sum(torch.exp(-0.125 * (values[:, j] - values[:, k]).square().sum(-1)) for j, k in pairs)
    return near.mean()


def boundary(network, states):
    beyond = (states[:, BOUNDED].abs() / STATE_BOUND - 1) / (0.05 * network.log_scale.exp())
    return softplus(beyond).square().sum(-1).mean()


def single_step_loss(network, data, idx):
    known = (network.strengths.detach() @ data["effects"][idx]).unsqueeze(1)
    x = data["features"][idx]
    x = x + 0.02 * torch.randn_like(x)
    tokens = data["tokens"].expand(len(idx), 4, 5)
    residual, remainder, log_variance, logits = network(x, tokens, known)
    weights = logits.softmax(-1)
    off = residual - data["targets"][idx]
    scaled = (off * weights.unsqueeze(-1)).sum(2) / UNIT
    loss = ((scaled.square() + 1).sqrt() - 1).mean()
    variance = log_variance.exp() + MIN_STD**2
    exponent = -0.5 * ((off * STEP_S).square() / variance + variance.log()).sum(-1)
    loss = loss - 0.05 / 4 * (exponent + (weights + 1e-12).log()).logsumexp(-1).mean()
    far = torch.randint(len(data["features"]), (N_FAR,))
    none = torch.zeros(1, 1, 1, 4)
    _, of_far, _, _ = network(data["features"][far], data["tokens"].expand(N_FAR, 4, 5), none)
    physics = (1 - FAR_FACTOR) * remainder.square().mean() + FAR_FACTOR * of_far.square().mean()
    loss = loss + 0.1 * physics + 0.01 * diversity((residual / UNIT).squeeze(1))
    return loss + 0.1 * boundary(network, data["states"][idx])


def huber(squares):
    return (squares.sum(-1) + 1).sqrt() - 1


def rollout_loss(network, data, cases, starts, mechanics):
    n, eye = len(cases), torch.eye(J).view(1, J, J, 1)
    record = torch.stack([data["records"][c, s : s + LENGTH + 1] for c, s in zip(cases, starts)])
    forces = torch.stack([data["forces"][c, s : s + LENGTH] for c, s in zip(cases, starts)])
    forces, times = forces.repeat_interleave(J, 0), starts.repeat_interleave(J).double() * STEP_S
    tokens = data["tokens"].expand(n, 4, 5)
    strengths = network.strengths.repeat(n, 1)
    x = record[:, :1].expand(n, J, 8)
    fit = trajectory = physics = smoothness = distance = logit_sum = 0.0
    past = []
    for t in range(LENGTH):
        flat, force = x.reshape(n * J, 8), forces[:, t]
        seen, known = mechanics["see"](flat, force, times + t * STEP_S, strengths)
        output = network(seen.view(n, J, 20), tokens, known.view(n, J, 1, 4))
        residual, remainder, _, logits = output
        own = (residual * eye).sum(2).view(n * J, 4)
        x = mechanics["step"](flat, force, own).view(n, J, 8)
        squares = ((x - record[:, t + 1 : t + 2]) / STATE_UNIT).square()
        logits = logits.mean(1)
        weights = logits.softmax(-1)
        fit = fit + (huber(squares * IS_VELOCITY) * weights).sum()
        trajectory = trajectory + (huber(squares * (1 - IS_VELOCITY)) * weights).sum()
        physics = physics + (remainder * eye).sum(2).square().mean()
        distance, logit_sum = distance + huber(squares), logit_sum + logits
        past.append(x)
        if len(past) > 2:
            second = (past[-3] + past[-1] - 2 * past[-2]) / STEP_S**2 / JERK_UNIT
            smoothness = smoothness + (second.square() * IS_VELOCITY).mean()
    weights = (logit_sum / LENGTH).softmax(-1)
    joint = (weights + 1e-12).log() - distance * (10 / LENGTH)
    loss = (fit + trajectory) / (LENGTH * n) - 0.05 / 10 * joint.logsumexp(-1).mean()
    loss = loss + 0.1 * physics / LENGTH + 1e-3 * smoothness / LENGTH
    loss = loss + 0.01 * diversity(x / STATE_UNIT)
    return loss + 0.1 * boundary(network, x.view(n * J, 8))


def see(x, force, time_s, strengths):
    now = evaluate(x, force)
    return features(x, force, now, time_s), combined(side_forces(x, now), x, force, now, strengths)


def take(optimizer, network, loss):
    optimizer.zero_grad()
    loss.backward()
    nn.utils.clip_grad_norm_(network.parameters(), 1.0)
    optimizer.step()


def single_step_epoch(network, optimizer, data):
    for idx in torch.randperm(len(data["features"])).split(N_BATCH):
        take(optimizer, network, single_step_loss(network, data, idx))


def rollout_epoch(network, optimizer, data, mechanics):
    last = data["records"].shape[1] - 1 - LENGTH
    for cases in torch.randperm(N_CASES).split(N_WINDOWS):
        starts = torch.randint(last + 1, (len(cases),)) * (torch.rand(len(cases)) < 0.5)
        take(optimizer, network, rollout_loss(network, data, cases, starts, mechanics))


def load(folder):
    """States, forces and what can be computed once."""
    columns = ["vx_m_s", "vy_m_s", "yaw_rad", "yaw_rate_rad_s", "roll_rad", "roll_rate_rad_s"]
    columns += ["x_m", "y_m", "fx_body_n", "fy_body_n", "mz_nm"]
    cases = []
    for path in sorted((folder / "trajectories").glob("*.csv"))[:N_CASES]:
        rows = csv.DictReader(path.open())
        cases.append([[float(row[name]) for name in columns] for row in rows])
    cases = torch.tensor(cases)
    records, forces = cases[..., :8], 0.5 * (cases[:, :-1, 8:] + cases[:, 1:, 8:])
    x, force = records[:, :-1].reshape(-1, 8), forces.reshape(-1, 3)
    time_s = (torch.arange(records.shape[1] - 1) * STEP_S).repeat(N_CASES).double()
    now = evaluate(x, force)
    off = (records[:, 1:].reshape(-1, 8) - step(x, force, torch.zeros(len(x), 4))) / STEP_S
    return {
        "records": records,
        "forces": forces,
        "states": x,
        "features": features(x, force, now, time_s).unsqueeze(1),
        "targets": off[:, [0, 1, 3, 5]].view(-1, 1, 1, 4),
        "effects": effects(x, force, now),
        "tokens": torch.rand(4, 5),
    }


def ours(program, folder, n_epochs):
    """Seconds of the epochs of impactlab, single steps and rollouts."""
    with tempfile.TemporaryDirectory() as scratch:
        config, out = Path(scratch, "config.toml"), Path(scratch, "model.safetensors")
        config.write_text(
            f"[single_steps]\nepochs = {n_epochs}\n[calibration]\nfolds = 0\n"
            f"[rollouts]\nlengths = [{LENGTH}]\nepochs = {n_epochs}\n"
        )
        model = folder.parent.parent / "assets/models/response_pretrained.safetensors"
        command = [program, "fine-tune", "response", "--model", model, "--data", folder]
        command += ["--trajectories", str(N_CASES), "--config", config, "--out", out]
        one_thread = {**os.environ, "RAYON_NUM_THREADS": "1"}
        subprocess.run(command, check=True, capture_output=True, env=one_thread)
        # The checkpoint has the seconds of every epoch, those of the pre-trained model as null.
        with Path(f"{out}.training").open("rb") as file:
            header = json.loads(file.read(struct.unpack("<Q", file.read(8))[0]))
    metadata = json.loads(header["__metadata__"]["impactlab"])["metadata"]
    own = [epoch["stage"] != "pretraining" for epoch in metadata["history"]]
    seconds = list(itertools.compress(metadata["epoch_seconds"], own))
    return seconds[:n_epochs], seconds[n_epochs:]


def theirs(data, mechanics, n_epochs):
    network = Network()
    trained = [weight for weight in network.parameters() if weight.requires_grad]
    optimizer = torch.optim.AdamW(trained, lr=3e-4, weight_decay=1e-2, fused=True)
    kinds = [
        lambda: single_step_epoch(network, optimizer, data),
        lambda: rollout_epoch(network, optimizer, data, mechanics),
    ]
    seconds = [[], []]
    for epoch, of_kind in zip(kinds, seconds):
        epoch()
        for _ in range(n_epochs):
            started = time.perf_counter()
            epoch()
            of_kind.append(time.perf_counter() - started)
    return seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path, help="release build of impactlab")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--epochs", type=int, default=5, help="of each kind in a round")
    parser.add_argument("--compile", action="store_true")
    args = parser.parse_args()
    torch.set_num_threads(1)
    torch.set_default_dtype(torch.float64)
    torch.manual_seed(1)
    folder = Path(__file__).resolve().parents[2] / "datasets/trajectories-fea"
    data = load(folder)
    mechanics = {"see": see, "step": step}
    if args.compile:
        mechanics = {name: torch.compile(part) for name, part in mechanics.items()}
    pairs = [[[], []], [[], []]]
    for _ in range(args.rounds):
        for side, (single, rollouts) in enumerate(
            (ours(args.program, folder, args.epochs), theirs(data, mechanics, args.epochs))
        ):
            pairs[0][side] += single
            pairs[1][side] += rollouts
    for name, (here, there) in zip(("single steps", f"rollouts of {LENGTH}"), pairs):
        here, there = ([1e3 * s for s in sorted(of)] for of in (here, there))
        median = [statistics.median(of) for of in (here, there)]
        print(
            f"{name}: here {median[0]:.1f} ms ({here[0]:.1f} to {here[-1]:.1f}), "
            f"PyTorch {median[1]:.1f} ms ({there[0]:.1f} to {there[-1]:.1f}), "
            f"ratio {median[0] / median[1]:.2f}"
        )


if __name__ == "__main__":
    main()
