"""Chunks are the same bytes whoever computes them: the program, this package, or Dask's workers."""

import hashlib
import json
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from conftest import Run
from distributed import Client, LocalCluster

import impactlab

PLAN = """
name = "PIT by speed and angle"
question = "pit"
n = 20
chunk = 8
seed = 7

[pit]
limit_s = 5

[vary.target_speed_m_s]
uniform = [12.0, 20.0]

[vary.angle_rad]
uniform = [0.1, 0.5]
"""


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    path = tmp_path / "pit.toml"
    path.write_text(PLAN)
    return path


def parts(folder: Path) -> dict[str, str]:
    """Digests of the chunks in a folder by their names."""
    files = sorted(folder.glob("*.parquet"))
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


@pytest.fixture
def of_program(run: Run, plan: Path, tmp_path: Path) -> Path:
    """The sweep as the program computes it on this machine."""
    folder = tmp_path / "program"
    run("sweep", "plan", plan, "--out", folder)
    run("sweep", "run", folder)
    assert len(parts(folder)) == 3
    return folder


def test_a_plan_and_its_chunks_are_those_of_the_program(
    of_program: Path, plan: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "package"
    assert impactlab.plan_sweep(plan, folder) == 3
    assert (folder / "plan.json").read_bytes() == (of_program / "plan.json").read_bytes()
    paths = [impactlab.run_chunk(folder, i) for i in reversed(range(3))]
    assert parts(folder) == parts(of_program)
    assert sorted(paths) == sorted(str(path) for path in folder.glob("*.parquet"))
    assert sum(pq.read_table(path).num_rows for path in paths) == 20


def test_a_chunk_goes_into_another_folder(of_program: Path, tmp_path: Path) -> None:
    out = tmp_path / "elsewhere"
    path = impactlab.run_chunk(of_program / "plan.json", 1, out=out)
    assert Path(path).parent == out
    assert parts(out).items() <= parts(of_program).items()
    assert len(parts(out)) == 1


def test_dask_computes_the_same_bytes(of_program: Path, plan: Path, tmp_path: Path) -> None:
    folder = tmp_path / "dask"
    n = impactlab.plan_sweep(plan, folder)
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with Client(cluster) as client:
            client.gather(client.map(impactlab.run_chunk, [str(folder)] * n, range(n)))
    assert parts(folder) == parts(of_program)


def test_rows_of_a_request_have_the_kinds_of_their_caveats(tmp_path: Path) -> None:
    question = {
        "question": "simulate",
        "source": {"drive": {"speed_m_s": 20.0, "yaw_rate_rad_s": 0.0}},
        "vehicle": {"Preset": "reference-2000"},
        "duration_s": 1.0,
        "until_rest": True,
    }
    (tmp_path / "ask.json").write_text(json.dumps(question))
    (tmp_path / "plan.toml").write_text("""
question = "request"
design = "grid"
n = 1
[request]
file = "ask.json"
outcomes = [{ name = "x_m", at = "/end/x_m", unit = "m" }]
[vary.until_rest]
at = "/until_rest"
list = [false, true]
""")
    impactlab.plan_sweep(tmp_path / "plan.toml", tmp_path / "sweep")
    table = pq.read_table(impactlab.run_chunk(tmp_path / "sweep", 0))
    assert table["caveats"].to_pylist() == ["", "not_at_rest;driver_open"]
    told = impactlab.ask(question)["caveats"]
    assumed = {"assumed", "not_used", "note"}
    assert {of["kind"] for of in told} - assumed == {"not_at_rest", "driver_open"}


def test_what_cannot_be_run_is_refused(of_program: Path, tmp_path: Path) -> None:
    with pytest.raises(impactlab.ImpactlabError, match="there is no chunk 3"):
        impactlab.run_chunk(of_program, 3)
    with pytest.raises(impactlab.ImpactlabError):
        impactlab.run_chunk(tmp_path / "missing", 0)
    with pytest.raises(OverflowError):
        impactlab.run_chunk(of_program, -1)
