"""Effective samples of a reconstruction: impactlab against emcee (no gradient) and NUTS of blackjax.

    python benches/peers/sample.py target/release/impactlab

impactlab reconstructs tests/data/evidence/inline.toml: one car hits another from behind, and both slide
to rest on locked wheels. Its posterior has no function in Python, so the peers have the closed form of
that collision, which ten of its variables decide: momentum, restitution, v² = 2 a d. impactlab has 21
more and simulates each motion with the 4DOF model, so that samples a second compare two models; what
compares the samplers is how many evaluations a thousand effective samples take.
Effective sample sizes are of the speed of the striking car from the autocorrelation of the chains, and
of the weights of impactlab's independent draws; an evaluation of NUTS has a gradient. That compiling
and adapting take long is not counted. The speeds are printed: they have to agree.
"""

import argparse
import json
from pathlib import Path

from common import of_call, of_command, shown

import blackjax
import emcee
import jax
import jax.numpy as jnp
import numpy as np
from scipy.special import ndtr

jax.config.update("jax_enable_x64", True)
G, FOOT, MILE_PER_HOUR, POUND = 9.80665, 0.3048, 0.44704, 0.45359237
REST_M, NU = np.array([66.0, 50.5]) * FOOT, 6.0
LOWEST_SPEED, HIGHEST_SPEED = np.array([10.0, 140.0]) * MILE_PER_HOUR
# What was measured, and what impactlab takes its model to err by over the way.
SIGMA_M = np.hypot(0.15, 0.05 + 0.02 * REST_M)
N_DIMENSIONS, N_WALKERS = 10, 40
LEVELS = [0.05, 0.5, 0.95]


def log_density(z, xp, normal_cdf):
    """Log posterior of standard normal variables, as impactlab has them, [..., 10]."""
    uniform = normal_cdf(z[..., :3])
    struck = uniform[..., 0] * 0.5 * MILE_PER_HOUR
    striking = LOWEST_SPEED + (HIGHEST_SPEED - LOWEST_SPEED) * uniform[..., 1]
    restitution = 0.05 * uniform[..., 2]
    road = 0.65 + 0.02 * z[..., 3]
    along, sliding = 1.15 * xp.exp(0.07 * z[..., 4]), 0.8 * xp.exp(0.08 * z[..., 5])
    m_struck = 4000 * POUND * (1 + 0.03 * z[..., 6])
    m_striking = 3000 * POUND * (1 + 0.03 * z[..., 7])
    common = (m_struck * struck + m_striking * striking) / (m_struck + m_striking)
    parting = restitution * (striking - struck) / (m_struck + m_striking)
    after = common + m_striking * parting, common - m_struck * parting
    log_p = -0.5 * (z * z).sum(-1)
    for car in range(2):
        drag = G * road * along * sliding * 1.02 * xp.exp(0.09 * z[..., 8 + car])
        found = REST_M[car]
        squared = ((after[car] ** 2 / (2 * drag) - found) / SIGMA_M[car]) ** 2
        log_p = log_p - 0.5 * (NU + 1) * xp.log1p(squared / NU)
    return log_p


def speeds(z):
    """Speed of the striking car, m/s."""
    return LOWEST_SPEED + (HIGHEST_SPEED - LOWEST_SPEED) * ndtr(z[..., 1])


def row(name, effective, evaluations, spent, interval):
    low, median, high = interval
    print(
        f"| {name} | {effective:.0f} | {evaluations} | {evaluations / effective:.3g}"
        f" | {shown(spent)} | {effective / spent:.3g} | {median:.1f} ({low:.1f} to {high:.1f}) |",
        flush=True,
    )


def by_impactlab(program, particles):
    evidence = Path(__file__).resolve().parents[2] / "tests/data/evidence/inline.toml"
    command = [program, "reconstruct", evidence, "--one-contact", "--particles", particles]
    told, spent = of_command([*command, "--json"])
    report = json.loads(told)
    (of_speed,) = [it for it in report["quantities"] if it["name"] == "bullet_speed_m_s"]
    (interval,) = [it for it in of_speed["intervals"] if it["level"] == 0.9]
    interval = [interval["low"], of_speed["median"], interval["high"]]
    row("impactlab", report["ess"], report["n_simulations"], spent, interval)


def by_emcee(steps, seed):
    density = lambda z: log_density(z, np, ndtr)
    sampler = emcee.EnsembleSampler(N_WALKERS, N_DIMENSIONS, density, vectorize=True)
    sampler.random_state = np.random.RandomState(seed).get_state()
    start = 0.3 * np.random.default_rng(seed).normal(size=(N_WALKERS, N_DIMENSIONS))
    _, spent = of_call(lambda: sampler.run_mcmc(start, steps))
    chain = speeds(sampler.get_chain(discard=steps // 4))
    effective = chain.size / emcee.autocorr.integrated_time(chain[..., None])[0]
    row("emcee", effective, N_WALKERS * steps, spent, np.quantile(chain, LEVELS))


def by_nuts(steps, seed):
    density = lambda z: log_density(z, jnp, jax.scipy.special.ndtr)
    keys = jax.random.split(jax.random.key(seed), 2)

    @jax.jit
    def adapted(key):
        start = jnp.zeros(N_DIMENSIONS)
        return blackjax.window_adaptation(blackjax.nuts, density).run(key, start, 500)[0]

    @jax.jit
    def chain(key, state, parameters):
        kernel = blackjax.nuts(density, **parameters)

        def step(at, key):
            new, info = kernel.step(key, at)
            return new, (new.position, info.num_integration_steps)

        return jax.lax.scan(step, state, jax.random.split(key, steps))[1]

    begin = adapted(keys[0])
    run = lambda key: jax.block_until_ready(chain(key, begin.state, begin.parameters))
    run(keys[0])  # compiles
    (z, n_gradients), spent = of_call(lambda: run(keys[1]))
    found = speeds(np.asarray(z))
    effective = float(blackjax.diagnostics.effective_sample_size(found[None]))
    row("NUTS, after adaptation", effective, int(n_gradients.sum()), spent, np.quantile(found, LEVELS))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("impactlab", type=Path)
    parser.add_argument("--particles", type=int, default=400)
    parser.add_argument("--steps", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    names = ["sampler", "effective samples", "evaluations", "thousands for 1000", "time", "a second"]
    print(f"| {' | '.join(names)} | speed, m/s, 90 % |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    by_impactlab(arguments.impactlab.resolve(), arguments.particles)
    by_emcee(arguments.steps, arguments.seed)
    by_nuts(arguments.steps, arguments.seed)


main()
