"""Data sets from their files: impactlab against pandas and polars, one thread each.

    python benches/peers/load.py target/release/impactlab

That of impactlab is the whole command `check`, which finds out columns and units, checks every case
and reports, less the same command about one short file; the peers parse the tables of all cases and
of the data set and nothing else. The last row is one table of a million samples.
"""

import argparse
import tempfile
from pathlib import Path

from common import in_turn, of_call, of_command, row

import pandas
import polars


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("impactlab", type=Path)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--rows", type=int, default=1_000_000)
    arguments = parser.parse_args()
    program = arguments.impactlab.resolve()
    datasets = Path(__file__).resolve().parents[2] / "datasets"
    sets = [datasets / "fea", datasets / "trajectories-fea"]
    with tempfile.TemporaryDirectory() as folder:
        short, long = Path(folder) / "short.csv", Path(folder) / "long.csv"
        for path, n in (short, 10), (long, arguments.rows):
            with path.open("w") as file:
                file.write("time_s,fx_n,fy_n\n")
                for i in range(n):
                    file.write(f"{i / 1000:.3f},{i % 1000 / 10},{7 * i % 1000 / 10}\n")
        for path in [*sets, long]:
            files = [path, *sorted(path.rglob("*.csv"))] if path.is_dir() else [path]
            files = [file for file in files if file.is_file()]
            command = [program, "check", path, "--json"]
            start = [program, "check", short, "--json"]
            measures = [
                lambda: of_command(command)[1] - of_command(start)[1],
                lambda: of_call(lambda: [pandas.read_csv(file) for file in files])[1],
                lambda: of_call(lambda: [polars.read_csv(file) for file in files])[1],
            ]
            ours, by_pandas, by_polars = in_turn(arguments.runs, measures)
            name = f"{arguments.rows} rows of a force" if path is long else f"`{path.name}`"
            row(f"{name}, {len(files)} tables", "pandas", ours, by_pandas)
            row(f"{name}, {len(files)} tables", "polars", ours, by_polars)


main()
