"""Tables of a data set, and which part of it a name belongs to."""

import csv
import hashlib


def is_held_out(name):
    """Whether a car or case of this name is kept for tests alone: a quarter of them, whoever else there is."""
    return int(hashlib.sha256(f"0:{name}".encode()).hexdigest(), 16) % 4 == 0


def write_number(value, digits):
    text = f"{value:.{digits}f}"
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return "0" if text in ("", "-0") else text


def write_table(rows, path):
    with open(path, "w", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        table.writeheader()
        for of_row in rows:
            table.writerow({name: f"{value:.6g}" if isinstance(value, float) else value
                            for name, value in of_row.items()})


def read_table(path):
    if not path.exists():
        return []
    with open(path, newline="") as file:
        return list(csv.DictReader(file))
