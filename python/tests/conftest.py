"""What the tests share: the program that was built, and questions that are answered in seconds."""

import json
import os
import subprocess
from pathlib import Path
from typing import Any, Protocol

import pytest

ROOT = Path(__file__).resolve().parents[2]

SCENARIO: dict[str, Any] = {"file": "pit-right-rear"}

IMPACT: dict[str, Any] = {"question": "impact", "scenario": SCENARIO}
FORCE: dict[str, Any] = {"question": "predict_force", "collision": {"scenario": SCENARIO}}
SIMULATION: dict[str, Any] = {
    "question": "simulate",
    "source": {"scenario": {"scenario": SCENARIO}},
    "vehicle_draws": 4,
}
FORECAST: dict[str, Any] = {
    "question": "predict_motion",
    "motion": {
        "source": {"scenario": {"scenario": SCENARIO}},
        "duration_s": 2.0,
        "vehicle_draws": 8,
    },
    "force": {"predicted": "shipped"},
    "draws": 8,
}
RECONSTRUCTION: dict[str, Any] = {
    "question": "reconstruct",
    "evidence": {"file": "./datasets/staged/evidence/s00.toml"},
    "particles": 100,
}
QUESTIONS = [IMPACT, FORCE, SIMULATION, FORECAST, RECONSTRUCTION]


class Run(Protocol):
    """Runs the program in the root folder of the repository."""

    def __call__(
        self, *arguments: str | Path, fails: bool = False
    ) -> subprocess.CompletedProcess[str]: ...


@pytest.fixture(scope="session")
def run() -> Run:
    """The program of the same source; a test that needs it fails where it is missing."""
    program = os.environ.get("IMPACTLAB_PROGRAM")
    assert program, "IMPACTLAB_PROGRAM has to be the path of the program"

    def run(*arguments: str | Path, fails: bool = False) -> subprocess.CompletedProcess[str]:
        done = subprocess.run([program, *arguments], cwd=ROOT, capture_output=True, text=True)
        assert (done.returncode != 0) == fails, done.stderr
        return done

    return run


@pytest.fixture(autouse=True)
def in_root(monkeypatch: pytest.MonkeyPatch) -> None:
    """Relative paths begin where those of the program do."""
    monkeypatch.chdir(ROOT)


@pytest.fixture
def asked(run: Run, tmp_path: Path) -> Any:
    """Asks the program and gives what it prints."""

    def asked(question: dict[str, Any], fails: bool = False) -> str:
        path = tmp_path / "request.json"
        path.write_text(json.dumps(question))
        done = run("ask", path, fails=fails)
        return done.stderr if fails else done.stdout

    return asked
