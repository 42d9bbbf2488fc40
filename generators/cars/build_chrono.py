"""Builds the drivers on the smallest part of Project Chrono that they need, from a git clone of its source.

    git clone https://github.com/projectchrono/chrono
    python3 build_chrono.py chrono OUT [--jobs 2]

Makes OUT/drive_car, OUT/drive_pair for pairs of cars, and OUT/chrono/data/vehicle, the descriptions of vehicles
that run.py reads. Needs g++ and the headers of Eigen 3 (libeigen3-dev). It compiles 180 files of Chrono, 5 to 40
minutes on two cores, and goes on where it was stopped. No build system: the files follow from what the linker misses.
"""

import argparse
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

COMMIT = "7689fbc02d12c5419fa6acad8791100fd89979dd"
SOURCE_FOLDERS = ("src/chrono", "src/chrono_vehicle", "src/chrono_thirdparty")
DATA_FOLDER = "data/vehicle"
GENERATORS = Path(__file__).resolve().parent.parent
# Folders with the sources of each driver, that of its main.cpp first.
CAR_SOURCES, PAIR_SOURCES = GENERATORS / "cars/driver", GENERATORS / "pairs/driver"
DRIVERS = {"drive_car": (CAR_SOURCES,), "drive_pair": (PAIR_SOURCES, CAR_SOURCES)}
EIGEN = "/usr/include/eigen3"

# Parts of Chrono that the drivers never call. What refers to them stays open in the executable.
NEVER_CALLED = ("/gpu", "/collision/bullet", "/collision/multicore", "/cosim", "/fmi", "/visualization",
                "/multicore_math", "tracked_vehicle", "test_rig", "/fea")
# Files that define something of another name than theirs, which a search by names does not find.
OF_OTHER_NAMES = """
    ChLinkMate ChFunctionBase ChLoadsBody ChIntegrable ChObject ChQuaternion ChMassProperties
    ChTimestepperExplicit ChRotation ChVector3 ChIterativeSolverLS ChArchiveASCII ChShaftBodyConstraint
    ChProfiler ChCoordsys ChArchive ChUtilsJSON ChDataPath ChSubsysDefs ChConstraintTwoGeneric ChLoad ChCamera
    ChForceFunctors""".split()
# More rounds than the linker ever needs.
MOST_ROUNDS = 40
COMPILER_FLAGS = ["-std=c++17", "-O2", "-DNDEBUG", "-DEIGEN_NO_DEBUG", "-ffunction-sections",
                  "-fdata-sections", "-w"]
# Parts that are not called are taken out again.
LINKER_FLAGS = ["-O2", "-Wl,--gc-sections", "-no-pie"]
VERSION = {"CHRONO_VERSION": "10.0.0", "CHRONO_VERSION_MAJOR": "10", "CHRONO_VERSION_MINOR": "0",
           "CHRONO_VERSION_PATCH": "0", "CH_VERSION": "0x000A0000"}
PRECOMPILED = """\
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>
#include <map>
#include <memory>
#include <iostream>
#include <sstream>
#include <fstream>
#include <algorithm>
#include "chrono/core/ChMatrix33.h"
#include "chrono/physics/ChSystem.h"
#include "chrono/physics/ChBodyAuxRef.h"
#include "chrono/physics/ChLink.h"
"""


class Git:
    """Reads files of the commit from a clone, bare or not. The wanted ones are read one by one: a whole tree
    cannot be taken from a clone that leaves large files out."""

    def __init__(self, folder):
        self.folder = folder

    def _run(self, *arguments):
        command = ["git", "-C", str(self.folder), *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout

    def files(self, *folders):
        """Path and object of every file below the folders."""
        for line in self._run("ls-tree", "-r", COMMIT, *folders).splitlines():
            what, path = line.split("\t")
            _, kind, name = what.split()
            if kind == "blob":
                yield path, name

    def text(self, path):
        return self._run("show", f"{COMMIT}:{path}")

    def extract(self, files, destination):
        """Writes the files that are not there yet."""
        wanted = [(destination / path, name) for path, name in files if not (destination / path).exists()]
        command = ["git", "-C", str(self.folder), "cat-file", "--batch"]
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as reader:
            for path, name in wanted:
                reader.stdin.write(f"{name}\n".encode())
                reader.stdin.flush()
                answer = reader.stdout.readline().split()
                if answer[-1] == b"missing":
                    raise RuntimeError(f"{path}: the clone does not hold it")
                content = reader.stdout.read(int(answer[2]))
                reader.stdout.read(1)
                path.parent.mkdir(parents=True, exist_ok=True)
                waiting = path.with_name(path.name + ".part")
                waiting.write_bytes(content)
                waiting.rename(path)
            reader.stdin.close()


def configured(template):
    """A header without the options of the build system: single features that are off, a version."""
    text = re.sub(r"^@CHRONO_VEHICLE@", "#define CHRONO_VEHICLE", template, flags=re.MULTILINE)
    text = re.sub(r"^@[A-Z0-9_]+@$", "", text, flags=re.MULTILINE)
    for name, value in {**VERSION, "SOURCE_PATH_SIZE": "0"}.items():
        text = text.replace(f"@{name}@", value)
    return text


class Build:
    """The folders of a build and what is compiled in it."""

    def __init__(self, out, jobs):
        self.out, self.jobs = out, jobs
        self.source, self.generated, self.objects = out / "chrono/src", out / "gen", out / "obj"
        self.header = out / "pch.h"
        source = self.source
        folders = (self.generated, self.generated / "chrono", self.generated / "chrono_vehicle", source,
                   source / "chrono", source / "chrono_thirdparty", source / "chrono_thirdparty/rapidjson",
                   source / "chrono/collision/bullet", source / "chrono/collision", Path(EIGEN))
        self.flags = COMPILER_FLAGS + [f"-I{folder}" for folder in folders]

    def gather(self, git):
        data = ((path, name) for path, name in git.files(DATA_FOLDER) if path.endswith(".json"))
        git.extract([*git.files(*SOURCE_FOLDERS), *data], self.out / "chrono")
        headers = {"chrono/ChConfig.h": "src/ChConfig.h.in", "chrono/ChVersion.h": "src/ChVersion.h.in",
                   "chrono_vehicle/ChConfigVehicle.h": "src/chrono_vehicle/ChConfigVehicle.h.in"}
        for name, template in headers.items():
            write_if_changed(self.generated / name, configured(git.text(template)))
        write_if_changed(self.header, PRECOMPILED)
        self.objects.mkdir(exist_ok=True)

    def precompile(self):
        result = self.out / "pch.h.gch"
        if not result.exists() or result.stat().st_mtime < self.header.stat().st_mtime:
            self._compile(["-x", "c++-header", str(self.header)], result)

    def driver(self, name):
        """Compiles a driver if one of its files is newer."""
        result = self.out / f"{name}.o"
        newest = max(path.stat().st_mtime for folder in DRIVERS[name] for path in folder.iterdir())
        if not result.exists() or result.stat().st_mtime < newest:
            main = DRIVERS[name][0] / "main.cpp"
            self._compile(["-include", str(self.header), "-c", str(main)], result)

    def part(self, path):
        """Compiles a file of Chrono; returns what the compiler says if it refuses it."""
        result = self.objects / f"{path.stem}.o"
        if result.exists():
            return None
        try:
            self._compile(["-include", str(self.header), "-c", str(path)], result)
        except RuntimeError as error:
            return str(error)
        return None

    def parts(self, paths):
        """Compiles files side by side; returns those that the compiler refuses."""
        paths = list(paths)
        with ThreadPoolExecutor(self.jobs) as pool:
            refusals = dict(zip(paths, pool.map(self.part, paths)))
        for path, refusal in refusals.items():
            told = "compiled" if refusal is None else f"refused: {refusal[:200]}"
            print(f"  {path.stem}: {told}", flush=True)
        return {path.stem for path, refusal in refusals.items() if refusal}

    def link(self, driver, result, unresolved):
        """Links a driver with all that is compiled. `unresolved`: "report-all" or "ignore-all"."""
        objects = sorted(map(str, self.objects.glob("*.o")))
        command = ["g++", *LINKER_FLAGS, f"-Wl,--unresolved-symbols={unresolved}", "-Wl,--no-demangle",
                   "-o", str(result), str(self.out / f"{driver}.o"), *objects, "-lpthread"]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def missing(self):
        """Names that no compiled file defines, as they are written in C++."""
        told = "".join(self.link(driver, "/dev/null", "report-all").stderr for driver in DRIVERS)
        names = sorted(set(re.findall(r"undefined reference to `([^']+)'", told)))
        if not names:
            return []
        told = subprocess.run(["c++filt"], input="\n".join(names), capture_output=True, text=True, check=True)
        return told.stdout.splitlines()

    def _compile(self, arguments, result):
        waiting = result.with_name(result.name + ".part")
        command = ["g++", *self.flags, *arguments, "-o", str(waiting)]
        ended = subprocess.run(command, capture_output=True, text=True, check=False)
        if ended.returncode != 0:
            raise RuntimeError(ended.stderr[-3000:])
        waiting.rename(result)


class Definitions:
    """Which file of Chrono defines a name: by the name of the file, or by its header."""

    def __init__(self, source):
        self.files, self.headers = {}, {}
        for folder in ("chrono", "chrono_vehicle"):
            for path in sorted((source / folder).rglob("*")):
                place = f"/{path.parent.relative_to(source)}"
                if path.suffix == ".cpp" and not any(part in place for part in NEVER_CALLED):
                    self.files[path.stem] = path
                if path.suffix == ".h":
                    self.headers[path.stem] = path.read_text(errors="replace")

    def of(self, symbol):
        """Files that may define a symbol, most likely ones first."""
        plain = symbol.replace("[abi:cxx11]", "")
        plain = re.sub(r"^(vtable|typeinfo|VTT|typeinfo name|guard variable|(non-)?virtual thunk to) (for )?",
                       "", plain)
        words = re.findall(r"[A-Za-z_][A-Za-z0-9_]*", plain.split("(")[0])
        by_name = [word for word in words if word in self.files]
        if by_name:
            return by_name
        by_class = [stem for word in words
                    for stem in self._declaring(rf"\b(class|struct)\b[^;{{]*\b{word}\b")]
        if by_class:
            return by_class[:2]
        return self._declaring(rf"\b{re.escape(words[-1])}\s*[(;\[=]")[:3] if words else []

    def _declaring(self, pattern):
        return [stem for stem, text in self.headers.items()
                if stem in self.files and re.search(pattern, text)]


def write_if_changed(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def close(build, definitions):
    """Compiles what the linker misses until nothing more is found; returns the names that stay open."""
    refused = build.parts(definitions.files[name] for name in OF_OTHER_NAMES if name in definitions.files)
    for count in range(MOST_ROUNDS):
        missing = build.missing()
        present = {path.stem for path in build.objects.glob("*.o")}
        wanted = {name for symbol in missing for name in definitions.of(symbol)} - present - refused
        print(f"round {count + 1}: {len(missing)} names are missing, {len(wanted)} more files", flush=True)
        if not wanted:
            return missing
        refused |= build.parts(definitions.files[name] for name in sorted(wanted))
    return build.missing()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("chrono", type=Path, help="a git clone of projectchrono/chrono, bare or not")
    parser.add_argument("out", type=Path)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    args = parser.parse_args()
    build = Build(args.out.resolve(), args.jobs)
    build.gather(Git(args.chrono))
    build.precompile()
    for name in DRIVERS:
        build.driver(name)
    still_open = close(build, Definitions(build.source))
    (build.out / "open.txt").write_text("\n".join(still_open) + "\n")
    for name in DRIVERS:
        ended = build.link(name, build.out / name, "ignore-all")
        if ended.returncode != 0:
            sys.exit(ended.stderr[-3000:])
    print(f"{', '.join(DRIVERS)} in {build.out}; {len(still_open)} names that are never called stay open: open.txt")


if __name__ == "__main__":
    main()
