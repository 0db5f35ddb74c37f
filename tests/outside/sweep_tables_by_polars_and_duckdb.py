"""The tables that `servobench sweep` writes, as polars and DuckDB read them.

A small sweep is run into a temporary folder: numbers with and without a unit, texts with commas, quotes, a line break and letters
beyond ASCII, on two engines, and rows that could not be run, which have no numbers. Both readers read `sweep.csv` and
`sweep.parquet`. Columns have the same names, each row is in its place, every number has the bits that it has in `results.json`, one
that is missing is null, texts are whole, and units are found: in the heading of the CSV, in the key-value metadata of the Parquet file.
The metadata of its Arrow fields, which none of the two shows, are tested in the crate `trace`.

The program is `SERVOBENCH`, or the one in the folder of cargo's builds (`cargo build --release`).
"""

import json
import struct
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import duckdb
import polars

from built import program

AXIS = """
[run]
base_rate = "4 kHz"
duration = "0.2 s"
[axis]
motion = "linear"
[axis.motor_side]
mass = "20 kg"
[motor]
kind = "ideal-source"
[drive.velocity]
rate = "4 kHz"
bandwidth = "80 Hz"
kind = "p"
[drive.position]
rate = "4 kHz"
gain = "60 1/s"
[setpoint]
order = 3
velocity = "0.5 m/s"
acceleration = "10 m/s2"
jerk = "1000 m/s3"
[[program]]
move_to = "20 mm"
"""
ENGINES = ("exact", "rapier")
ORDERS = (2, 3)
AVERAGES = ('["1 ms"]', '["1 ms", "1.25 ms"]', '"two\nlines", ünïcode', "[]")
"""Lists of moving averages as a scenario has them; the third is none."""
JERKS = 5
METRICS = {
    "settling_time": "s",
    "following_error_peak_motor": "m",
    "residual_vibration_rms": "m",
    "setpoint_velocity_ratio": "",
    "torque_peak": "N",
}
"""What is measured, in the order of docs/metrics.md, and its unit. Without a window there is no settling time, nor a column of it."""
SWEEP = f"""
scenario = "axis.toml"
engine = {json.dumps(ENGINES)}
metrics = {json.dumps(list(METRICS))}
[[vary]]
key = "setpoint.order"
values = {json.dumps(ORDERS)}
[[vary]]
key = "setpoint.averages"
values = {json.dumps(AVERAGES)}
[[vary]]
key = "setpoint.jerk"
range = {{ from = "300 m/s3", to = "2000 m/s3", count = {JERKS}, spacing = "log" }}
"""

Cell = float | str | None


@dataclass(frozen=True)
class Column:
    """A column of a table: its name, its unit, and what is in its rows."""

    name: str
    unit: str
    cells: Sequence[Cell]


def run(servobench: Path, folder: Path) -> Path:
    """The folder of the results."""
    (folder / "axis.toml").write_text(AXIS, encoding="utf-8")
    (folder / "a.sweep.toml").write_text(SWEEP, encoding="utf-8")
    command = [servobench, "sweep", folder / "a.sweep.toml", "--quiet", "--out", folder / "out"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    # Invalid rows end it with 2.
    if done.returncode != 2:
        sys.exit(f"exit code {done.returncode}, not 2:\n{done.stdout}{done.stderr}")
    return folder / "out"


def expected(results: list[dict]) -> list[Column]:
    """The table, from `results.json` and what was asked for."""
    grid = [(order, averages, jerk) for order in ORDERS for averages in AVERAGES for jerk in range(JERKS)]
    keys = [grid[row % len(grid)] for row in range(len(ENGINES) * len(grid))]
    assert len(results) == len(keys), f"{len(results)} results of {len(keys)} runs"

    def jerk(row: int) -> float:
        """What the run was given, by its results."""
        key, value = results[row]["overrides"][2].split("=")
        number, unit = value.split(" ")
        assert (key, unit) == ("setpoint.jerk", "m/s3"), f"{key} in {unit}"
        return float(number)

    def measured(row: int, name: str) -> float | None:
        metric = results[row].get("metrics", {}).get(name)
        return None if metric is None else metric.get("value")

    rows = range(len(keys))
    table = [
        Column("point", "", [float(row % len(grid) + 1) for row in rows]),
        Column("engine", "", [ENGINES[row // len(grid)] for row in rows]),
        Column("setpoint.order", "", [float(order) for order, _, _ in keys]),
        Column("setpoint.averages", "", [averages for _, averages, _ in keys]),
        Column("setpoint.jerk", "m/s3", [jerk(row) for row in rows]),
        Column("verdict", "", [results[row]["verdict"] for row in rows]),
    ]
    for name, unit in METRICS.items():
        cells = [measured(row, name) for row in rows]
        if any(cell is not None for cell in cells):
            table.append(Column(name, unit, cells))
    return table


def of_csv(heading: Sequence[str], cells: Callable[[str], Sequence[Cell]]) -> list[Column]:
    """Columns of a CSV, whose unit is in brackets at the end of a name."""
    columns = []
    for name in heading:
        bare, bracket, unit = name.removesuffix("]").rpartition(" [")
        columns.append(Column(bare, unit, cells(name)) if bracket else Column(name, "", cells(name)))
    return columns


def polars_csv(path: Path) -> list[Column]:
    """The CSV as polars guesses its types."""
    frame = polars.read_csv(path)
    return of_csv(frame.columns, lambda name: frame[name].to_list())


def polars_parquet(path: Path) -> list[Column]:
    """The Parquet file; polars shows no metadata of a field, but those of the file."""
    frame, units = polars.read_parquet(path), json.loads(polars.read_parquet_metadata(path)["servobench:units"])
    return [Column(name, units[name], frame[name].to_list()) for name in frame.columns]


def by_duckdb(source: str, path: Path) -> tuple[list[str], dict[str, list[Cell]]]:
    """Names and columns of a table that DuckDB reads by its function `source`."""
    # Whatever is not in the package is not fetched.
    with duckdb.connect(config={"autoinstall_known_extensions": "false"}) as database:
        relation = database.sql(f"SELECT * FROM {source}($path)", params={"path": str(path)})
        names = relation.columns
        return names, dict(zip(names, map(list, zip(*relation.fetchall(), strict=True)), strict=True))


def duckdb_csv(path: Path) -> list[Column]:
    """The CSV as DuckDB guesses dialect and types."""
    names, columns = by_duckdb("read_csv", path)
    return of_csv(names, columns.__getitem__)


def duckdb_parquet(path: Path) -> list[Column]:
    """The Parquet file and its key-value metadata."""
    names, columns = by_duckdb("read_parquet", path)
    _, metadata = by_duckdb("parquet_kv_metadata", path)
    pairs = dict(zip(metadata["key"], metadata["value"], strict=True))
    units = json.loads(pairs[b"servobench:units"])
    return [Column(name, units[name], columns[name]) for name in names]


READERS = {
    "polars": (polars.__version__, {"sweep.csv": polars_csv, "sweep.parquet": polars_parquet}),
    "duckdb": (duckdb.__version__, {"sweep.csv": duckdb_csv, "sweep.parquet": duckdb_parquet}),
}


def same(one: Cell, other: Cell) -> bool:
    """Equal texts, equal bits, or both missing. A CSV has no types: a column of whole numbers is read as such."""
    if isinstance(one, str) or isinstance(other, str) or one is None or other is None:
        return type(one) is type(other) and one == other
    return struct.pack("d", one) == struct.pack("d", other)


def differences(found: Sequence[Column], wanted: Sequence[Column]) -> list[str]:
    """What is read differently, in words."""
    heads = [[(column.name, column.unit) for column in table] for table in (found, wanted)]
    if heads[0] != heads[1]:
        return [f"columns {heads[0]}, not {heads[1]}"]
    told = []
    for own, right in zip(found, wanted, strict=True):
        if len(own.cells) != len(right.cells):
            told.append(f"{own.name}: {len(own.cells)} rows, not {len(right.cells)}")
            continue
        pairs = enumerate(zip(own.cells, right.cells, strict=True))
        told += [f"{own.name}, row {row}: {a!r}, not {b!r}" for row, (a, b) in pairs if not same(a, b)]
    return told


def main() -> int:
    """Runs the sweep, reads its tables; one if anything is read differently."""
    wrong = []
    with tempfile.TemporaryDirectory(prefix="servobench-tables-") as room:
        out = run(program(), Path(room))
        wanted = expected(json.loads((out / "results.json").read_text(encoding="utf-8"))["scenarios"])
        cells = [cell for column in wanted for cell in column.cells]
        kinds = {kind: sum(isinstance(cell, kind) for cell in cells) for kind in (float, str, type(None))}
        # What is to be read has to be there.
        assert all(kinds.values()), f"{kinds}"
        print("reader         file           columns  rows  numbers  texts  missing  units  different")
        for reader, (version, files) in READERS.items():
            for name, read in files.items():
                found = read(out / name)
                told = differences(found, wanted)
                all_cells = [cell for column in found for cell in column.cells]
                texts, missing = (sum(isinstance(cell, kind) for cell in all_cells) for kind in (str, type(None)))
                counts = (len(found), len(found[0].cells), len(all_cells) - texts - missing, texts, missing)
                counts += (sum(column.unit != "" for column in found), len(told))
                widths = (7, 4, 7, 5, 7, 5, 9)
                numbers = "  ".join(f"{count:>{width}}" for count, width in zip(counts, widths, strict=True))
                print(f"{f'{reader} {version}':<13}  {name:<13}  {numbers}")
                wrong += [f"{reader}, {name}: {line}" for line in told]
    for line in wrong[:20]:
        print(line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
