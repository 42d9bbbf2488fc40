"""Reads the time histories that OpenRadioss writes (NAMET01): big-endian records of known length."""

import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np

# Length of a title by the version of the file.
TITLE_LENGTHS = {3040: 40, 3041: 80, 3050: 100}
NEWEST_TITLE_LENGTH = 100


class _Records:
    def __init__(self, data):
        self.data, self.at = data, 0

    def next(self):
        if self.at + 4 > len(self.data):
            raise EOFError
        (length,) = struct.unpack_from(">i", self.data, self.at)
        if length < 0 or self.at + 8 + length > len(self.data):
            raise EOFError
        record = self.data[self.at + 4:self.at + 4 + length]
        self.at += length + 8
        return record

    def integers(self):
        record = self.next()
        return list(struct.unpack(f">{len(record) // 4}i", record))

    def reals(self):
        return np.frombuffer(self.next(), ">f4").astype(float)


@dataclass
class Group:
    """Histories of some entities: `values` has samples, entities, variables."""

    title: str
    n_entities: int
    n_variables: int
    values: np.ndarray = None


@dataclass
class Histories:
    """All histories of a run; a sample that was being written when the run ended is left out."""

    time: np.ndarray
    overall: np.ndarray
    of_part: dict
    groups: list

    def group(self, title):
        return next(group for group in self.groups if group.title == title)

    def even(self, interval):
        """Without a last sample that comes too early: a solver that is stopped writes one, and a force over
        so short an interval is rounding alone."""
        if len(self.time) < 2 or self.time[-1] - self.time[-2] > interval / 2:
            return self
        for group in self.groups:
            group.values = group.values[:-1]
        of_part = {part: {name: values[:-1] for name, values in of.items()} for part, of in self.of_part.items()}
        return Histories(self.time[:-1], self.overall[:-1], of_part, self.groups)

    @classmethod
    def read(cls, path):
        records = _Records(Path(path).read_bytes())
        version = struct.unpack(">i", records.next()[:4])[0]
        records.next()
        title_length = TITLE_LENGTHS.get(version, NEWEST_TITLE_LENGTH)
        start = records.at
        extra = records.next()
        if len(extra) == 4:
            (n_extra,) = struct.unpack(">i", extra)
            (title_length,) = struct.unpack(">i", records.next())
            for _ in range(n_extra - 1):
                records.next()
        else:
            records.at = start
        n_parts, n_materials, n_properties, n_subsets, n_groups, n_overall = records.integers()
        if n_overall:
            records.integers()
        parts = []
        for _ in range(n_parts):
            head = records.next()
            (number,), (n_variables,) = struct.unpack(">i", head[:4]), struct.unpack(">i", head[-4:])
            parts.append((number, records.integers() if n_variables else []))
        for _ in range(n_materials + n_properties):
            records.next()
        n_subset_values = sum(cls._subset(records) for _ in range(n_subsets))
        groups = [cls._group(records) for _ in range(n_groups)]
        return cls._samples(records, bool(n_overall), parts, n_subset_values, groups)

    @staticmethod
    def _subset(records):
        _, _, n_children, n_parts, n_variables = struct.unpack(">5i", records.next()[:20])
        for count in (n_children, n_parts):
            if count:
                records.next()
        return len(records.integers()) if n_variables else 0

    @staticmethod
    def _group(records):
        head = records.next()
        _, _, _, n_entities, n_variables = struct.unpack(">5i", head[:20])
        for _ in range(n_entities):
            records.next()
        records.integers()
        return Group(head[20:].decode("latin1").strip(), n_entities, n_variables)

    @classmethod
    def _samples(cls, records, has_overall, parts, n_subset_values, groups):
        times, overall, of_parts, rows = [], [], [], []
        try:
            while True:
                time = records.reals()[0]
                whole = records.reals() if has_overall else None
                of_part = records.reals() if any(variables for _, variables in parts) else None
                if n_subset_values:
                    records.reals()
                row = [records.reals() for _ in groups]
                times.append(time), overall.append(whole), of_parts.append(of_part), rows.append(row)
        except EOFError:
            pass
        for i, group in enumerate(groups):
            values = np.array([row[i] for row in rows])
            group.values = values.reshape(len(rows), group.n_entities, group.n_variables)
        table, column, by_part = np.array(of_parts), 0, {}
        for number, variables in parts:
            by_part[number] = {name: table[:, column + k] for k, name in enumerate(variables)}
            column += len(variables)
        return cls(np.array(times), np.array(overall), by_part, groups)
