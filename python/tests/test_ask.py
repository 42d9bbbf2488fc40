"""Package and program give the same answers and the same errors."""

import json
import shutil
from collections import ChainMap
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest
from conftest import FORECAST, IMPACT, QUESTIONS, RECONSTRUCTION, ROOT, SIMULATION, Run

import impactlab


@pytest.mark.parametrize("question", QUESTIONS, ids=lambda question: question["question"])
def test_the_answer_is_that_of_the_program_to_the_last_bit(question: Any, asked: Any) -> None:
    answer = impactlab.ask(question)
    # Texts of numbers are those that JSON reads back to the bit, so that equal texts are equal bits.
    assert json.dumps(answer) == json.dumps(json.loads(asked(question)))
    assert impactlab.ask(json.dumps(question)) == answer


def test_the_answer_beside_the_arrays_is_the_same() -> None:
    assert impactlab.simulate(SIMULATION).report == impactlab.ask(SIMULATION)
    assert impactlab.predict(FORECAST).report == impactlab.ask(FORECAST)
    assert impactlab.reconstruct(RECONSTRUCTION).report == impactlab.ask(RECONSTRUCTION)


def test_errors_are_the_lines_of_the_program(asked: Any) -> None:
    for question in [
        {**SIMULATION, "friction": 20.0},
        {**IMPACT, "scenario": {"file": "missing.toml"}},
        {**RECONSTRUCTION, "particles": 1},
    ]:
        line = asked(question, fails=True)
        with pytest.raises(impactlab.ImpactlabError) as error:
            impactlab.ask(question)
        assert line == f"error: {error.value}\n"
        assert isinstance(error.value, ValueError)


def test_what_is_no_question_is_refused() -> None:
    for question in ["{", "[]", {}, {"question": "horoscope"}, {"question": "impact"}]:
        with pytest.raises(impactlab.ImpactlabError, match="^request: is no request: "):
            impactlab.ask(question)
    with pytest.raises(impactlab.ImpactlabError, match="another question than simulate"):
        impactlab.simulate(IMPACT)
    with pytest.raises(ValueError, match="JSON"):
        impactlab.ask({**SIMULATION, "friction": float("nan")})
    with pytest.raises(TypeError):
        impactlab.ask({**SIMULATION, "friction": object()})


def test_a_key_that_stands_twice_is_refused_however_it_is_asked(tmp_path: Path) -> None:
    """With a folder, and by the functions of one question, the last one was taken."""
    unsaid = {key: value for key, value in SIMULATION.items() if key != "question"}
    for question in [SIMULATION, unsaid]:
        twice = json.dumps(question)[:-1] + ', "seed": 1, "seed": 2}'
        for folder in [None, tmp_path]:
            with pytest.raises(impactlab.ImpactlabError, match="duplicate field `seed`"):
                impactlab.simulate(twice, folder=folder)
    twice = json.dumps(SIMULATION)[:-1] + ', "seed": 1, "seed": 2}'
    with pytest.raises(impactlab.ImpactlabError, match="duplicate field `seed`"):
        impactlab.ask(twice, folder=tmp_path)


def test_numbers_of_numpy_and_paths_are_taken() -> None:
    question = {
        **SIMULATION,
        "friction": np.float64(0.75),
        "seed": np.int64(3),
        "source": {"scenario": {"scenario": {"file": Path("pit-right-rear")}}},
    }
    assert impactlab.ask(question) == impactlab.ask({**SIMULATION, "friction": 0.75, "seed": 3})


def test_mappings_that_are_no_dictionaries_and_paths_of_bytes_are_taken() -> None:
    question = MappingProxyType(
        {
            **SIMULATION,
            "source": {"scenario": ChainMap({"scenario": {"file": b"pit-right-rear"}})},
        }
    )
    assert impactlab.ask(question) == impactlab.ask(SIMULATION)
    assert impactlab.simulate(question).report == impactlab.ask(SIMULATION)


def test_the_kind_of_a_question_need_not_be_said() -> None:
    unsaid = {key: value for key, value in SIMULATION.items() if key != "question"}
    assert impactlab.simulate(unsaid).report == impactlab.simulate(SIMULATION).report


def test_paths_begin_at_the_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scenario = ROOT / "assets/scenarios/pit_right_rear.toml"
    shutil.copy(scenario, tmp_path / "here.toml")
    question = {**IMPACT, "scenario": {"file": "./here.toml"}}
    monkeypatch.chdir("/")
    here = impactlab.ask(question, folder=tmp_path)
    assert here == impactlab.ask(question, folder=str(tmp_path))
    assert here == impactlab.ask({**IMPACT, "scenario": {"file": scenario}})
    with pytest.raises(impactlab.ImpactlabError):
        impactlab.ask(question)


def test_a_file_that_changes_is_read_anew(tmp_path: Path) -> None:
    path = tmp_path / "motion.csv"
    shutil.copy(ROOT / "datasets/trajectories-pulse/trajectories/P000.csv", path)
    question = {
        "question": "simulate",
        "source": {"trajectory": {"file": {"path": path}}},
        "vehicle_draws": 0,
    }
    impactlab.ask(question)
    path.write_text("no table")
    with pytest.raises(impactlab.ImpactlabError):
        impactlab.ask(question)


def test_schemas_and_version_are_those_of_the_program(run: Run) -> None:
    assert run("--version").stdout == f"impactlab {impactlab.__version__}\n"
    schemas = impactlab.schema()
    listed = json.loads(run("schema", "--json").stdout)["questions"]
    assert [kind["name"] for kind in listed] == list(schemas)
    for name, schema in schemas.items():
        assert schema["request"] == json.loads(run("schema", name).stdout)
        assert schema["answer"] == json.loads(run("schema", name, "--answer").stdout)
