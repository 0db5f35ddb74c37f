"""Verdicts of sabotaged machines against an oracle of our own: nothing bad is green, nothing good is red.

A healthy machine is drawn with a task, and sabotaged. The example `twin` runs both and judges the sabotaged one by the file of the healthy
one, so that every tolerance comes from there. By how much it does not do its task says `oracle.py`. See docs/testing.md.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter, defaultdict
from dataclasses import dataclass, field, replace
from math import inf, isfinite
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "outside"))

import numpy

import fmu
from bus_task import BUS, ENABLED
from linear import is_stable
from machine import Axis
from oracle import Harm, Judgement, Run, cycles, deviations, goes_on, harms, judgement, silence, stops_late, swept
from sabotages import CABLES, SABOTAGES
from task import Phase, Task
from twins import ENGINES, HOTTEST, PROGRAMS, Drawn, Family, Pair, draw_family, write, write_longer

MOST_OF_MOVE = 0.1
"""A healthy machine that is off by more of its move is left out."""
OF_TARGET = ("velocity", "effort", "stop")
"""Phases whose D is a share of what is asked for, and not of a way."""
MOST_DISCARDED = 0.1
FEWEST_OF_CELL = 40
MANY = 4000
"""So many families give each cell of program and sabotage its pairs."""
CHUNK = 20
"""So many families are run at a time: their recordings are thrown away before the next are made."""
UNSTABLE_COUPLING = "the coupling `"
"""In the error of a run that the exchange with an FMU ended."""
UNSENDABLE = "cannot be sent in a point"
"""In the error of a file whose unit is finer than a velocity in it can be."""
FASTEST = 0.5
"""A current loop does not follow currents that turn by more in one of its periods (rad)."""
EXCUSED = ("stable", "rings")
"""Requirements that are broken by a swing about what was asked for."""


@dataclass(frozen=True)
class Check:
    """A pair that does its task and is red by `stable` or `rings` alone."""

    folder: Path
    family: Family
    pair: Pair
    line: str


@dataclass
class Tally:
    """What came of the pairs."""

    is_traced: bool = False
    """Whether each pair is shown."""
    families: int = 0
    discarded: Counter[str] = field(default_factory=Counter)
    """Healthy machines that are left out, by reason."""
    cells: dict[tuple[str, str], Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    lines: list[str] = field(default_factory=list)
    kinds: Counter[str] = field(default_factory=Counter)
    checks: list[Check] = field(default_factory=list)
    by_swing: Counter[str] = field(default_factory=Counter)
    noticed: Counter[str] = field(default_factory=Counter)
    """Wrong cables, by what found them."""
    alone: Counter[str] = field(default_factory=Counter)
    """Bad pairs that are red by one requirement alone: without it each would be a false green."""

    def discard(self, family: Family, why: str) -> bool:
        """Leaves a healthy machine out."""
        self.discarded[why] += 1
        self.cells[family.program, "(none)"]["discarded"] += 1
        if self.is_traced:
            print("discarded", family.name, family.program, why)
        return True

    def note(self, kind: str, line: str) -> None:
        self.kinds[kind] += 1
        self.lines.append(f"{kind}: {line}")


class Runner:
    """The example `twin`, which runs and judges."""

    def __init__(self, program: Path) -> None:
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def results(self, jobs: list[dict[str, Any]]) -> dict[str, dict[str, Any]]:
        """Of all jobs, by their names."""
        lines = "".join(json.dumps(job) + "\n" for job in jobs)

        def give() -> None:
            self.process.stdin.write(lines)
            self.process.stdin.flush()

        giver = threading.Thread(target=give)
        giver.start()
        found = {}
        for _ in jobs:
            one = json.loads(self.process.stdout.readline())
            found[one["id"]] = one
        giver.join()
        return found

    def end(self) -> None:
        self.process.stdin.close()
        self.process.wait()


def run_of(path: Path, outcome: dict[str, Any], task: Task, axis: Axis) -> Run:
    """Of a result and the rows that were written for it."""
    names = outcome["channels"]
    rows = numpy.fromfile(path).reshape(-1, max(1, len(names)))
    values = {name: rows[:, number] for number, name in enumerate(names)}
    values["reference"] = values.get("reference.position", values["setpoint.position"])
    run = Run(numpy.arange(len(rows)) / outcome["rate"], values, outcome["signals"])
    if task.is_bus:
        # The first cycle of the task in which its power is on.
        run.start = run.powered = run.rises(ENABLED)
    if task.name == "homing" and isfinite(run.rises("move.Active")):
        at = numpy.searchsorted(run.t, run.rises("move.Active"))
        # As its encoder has it: a load on a spring may swing.
        encoded = values["load.position"] if axis.from_load else values["motor.position"]
        run.offset = float((encoded - values["bus.position"])[max(0, min(at, len(run.t)) - 1)])
    return run


def begun(phases: list[Phase], healthy: Run) -> float:
    """When the program of moves began by the set-point of the healthy twin: from the middle of the first way."""
    way = next(phase for phase in phases if phase.kind == "way")
    reference = healthy.values["reference"]
    passed = numpy.flatnonzero(abs(reference - reference[0]) >= 0.5 * way.size)
    middle = healthy.t[passed[0]] if len(passed) else inf
    return float(middle - (way.begin + way.end) / 2)


def judge_family(folder: Path, family: Family, results: dict[str, dict[str, Any]], tally: Tally) -> bool:
    """Compares the verdicts of a family with the oracle; whether all were right."""
    tally.families += 1
    phases = family.twin.task.phases

    def result(name: str) -> dict[str, Any]:
        return results[f"{family.name}/{name}"]

    late = 0.0

    def run(name: str) -> Run:
        found = run_of(folder / f"{name}.f64", result(name)["outcome"], family.twin.task, family.twin.axis)
        found.start += late
        return found

    for name in ("healthy", "sister-0", "sister-1", *(("refined",) if family.is_alone else ())):
        if UNSTABLE_COUPLING in result(name).get("error", ""):
            return tally.discard(family, "the exchange with its FMU is unstable")
        if UNSENDABLE in result(name).get("error", ""):
            return tally.discard(family, "its points do not go into the words of its bus")
        if "error" in result(name):
            tally.note("not run", f"{folder / name}.toml: {result(name)['error'][:600]}")
            return False
    healthy = run("healthy")
    # The program begins a few cycles after power: when the set-point passes the middle of its first way.
    late = begun(phases, healthy) - healthy.start if family.twin.task.is_bus and not family.twin.task.tables.get("call") else 0.0
    healthy.start += late
    of_healthy = deviations(phases, healthy, healthy, family.settling, family.tolerance)
    of_sisters = [deviations(phases, healthy, run(f"sister-{number}"), family.settling, family.tolerance) for number in (0, 1)]
    apart = [[abs(d - h) for d in ds if not numpy.isnan(d - h)] for h, *ds in zip(of_healthy, *of_sisters)]
    spread = [max(ds, default=0.0) for ds in apart]
    sizes = [abs(phase.target) if phase.kind in OF_TARGET else phase.size or family.twin.task.span for phase in phases]
    if any(d > MOST_OF_MOVE * size for d, size in zip(of_healthy, sizes)):
        return tally.discard(family, "off by more than a tenth of its move")
    if turns_in_period(family) > FASTEST:
        return tally.discard(family, "its currents turn too fast for their loop")
    if any(phase.kind == "rest" and d > family.tolerance.of(phase) for phase, d in zip(phases, of_healthy)):
        return tally.discard(family, "does not come into its window")
    if harms_of(family, None, healthy):
        return tally.discard(family, "harmed")
    if family.is_alone:
        of_refined = deviations(phases, healthy, run("refined"), family.settling, family.tolerance)
        for phase, d, fine in zip(phases, of_healthy, of_refined):
            if d > max(family.tolerance.of(phase), 2 * fine):
                return tally.discard(family, f"its encoder keeps it from its {phase.kind}")
    if not result("healthy")["outcome"]["passed"] and is_cycling(family, family.twin.axis, healthy):
        return tally.discard(family, "swings between its limits")
    right = True
    outcome = result("healthy")["outcome"]
    if not outcome["passed"]:
        right = False
        tally.note("healthy is red", f"{folder}/healthy.toml [{family.program}, {family.engine}]\n    {'; '.join(outcome['reasons'])[:400]}")
    for pair in family.pairs:
        of_pair = result(pair.name)
        cell = tally.cells[family.program, pair.sabotage]
        if "error" in of_pair:
            cell["error"] += 1
            if UNSTABLE_COUPLING in of_pair["error"]:
                # A run that ends so has no verdict, and nobody takes it for a good one.
                continue
            tally.note("not run", f"{folder / pair.name}.toml [{pair.sabotage}]: {of_pair['error'][:400]}")
            right = False
            continue
        outcome = of_pair["outcome"]
        twin = run(pair.name)
        twin.silence = silence_of(family, pair, healthy, twin)
        found = deviations(phases, healthy, twin, family.settling, family.tolerance)
        tolerance = family.tolerance
        if pair.judge is not None and pair.judge.window is not None:
            tolerance = replace(tolerance, window=max(pair.judge.window, tolerance.window or 0.0))
        judged = judgement(phases, found, of_healthy, spread, tolerance)
        if judged.word == "good" and is_restless(phases, healthy, twin, family):
            judged = replace(judged, word="between")
        if all(numpy.isnan(d) or numpy.isnan(h) for d, h in zip(found, of_healthy)):
            # A silence to the end, or over all that is judged.
            judged = Judgement("between", "silence", 0.0, 0.0, 0.0, 0.0)
        lost = ended_calls(outcome) - ended_calls(result("healthy")["outcome"])
        if outcome["ended"] or lost:
            judged = Judgement("bad", ", ".join(lost) or "end", numpy.inf, 0, 0, 0)
        suffered = harms_of(family, pair, twin)
        worst = max(suffered, key=lambda harm: harm.size, default=None)
        if worst is not None and judged.word != "bad":
            judged = Judgement("bad" if worst.size > 1 else "between", worst.kind, worst.size, worst.size, 1.0, 0.0)
        if judged.word == "bad" and len(broken(outcome)) == 1:
            tally.alone.update(broken(outcome))
        cell[judged.word] += 1
        if pair.sabotage in CABLES:
            tally.noticed[noticed(outcome)] += 1
        kind = wrong(judged, outcome, pair)
        if tally.is_traced:
            by_phase = [f"{phase.kind} {d:.3g}" for phase, d in zip(phases, found)]
            print(pair.name, family.program, pair.change.note, judged, outcome["passed"], outcome["reasons"][:2], by_phase)
        if kind:
            right = False
            cell[kind] += 1
            looks_away = f", {pair.judge.note}" if pair.judge else ""
            where = f"{folder / pair.name}.toml [{family.program}, {pair.sabotage}, {family.engine}] {pair.change.note}{looks_away}"
            told = f"D {judged.found:.4g} at {judged.phase}, healthy {judged.of_healthy:.3g}, tol {judged.tolerance:.3g}"
            line = f"{where}\n    {told}; {'; '.join(outcome['reasons'])[:300]}"
            if kind == "to be checked" and is_cycling(family, pair.change.axis, twin):
                tally.by_swing["swings between limits"] += 1
                cell[kind] -= 1
            elif kind == "to be checked":
                tally.checks.append(Check(folder, family, pair, line))
            else:
                tally.note(kind, line)
    return right


def turns_in_period(family: Family) -> float:
    """By which angle the currents turn in a period of their loop, at most."""
    axis = family.twin.axis
    if axis.pmsm is None:
        return 0.0
    return axis.pmsm.pole_pairs * family.twin.task.velocity / axis.r * axis.current_every / axis.base


def harms_of(family: Family, pair: Pair | None, run: Run) -> list[Harm]:
    """What a machine of a family suffers."""
    task, motor = family.twin.task, family.twin.axis.pmsm
    homed = "home.Done" if task.name == "homing" else None
    hottest = HOTTEST if motor is not None and "motor.thermal" in motor.extras else None
    seen = max(family.tolerance.window or 1e-3 * task.span, 10 * family.tolerance.increment)
    return harms(run, homed, pair.change.stops if pair else None, hottest, seen)


def silence_of(family: Family, pair: Pair, healthy: Run, run: Run) -> tuple[float, float] | None:
    """From when to when the first fault of its bus silences a run."""
    faults = pair.change.tables.get("bus", {}).get("fault")
    if not faults or not isfinite(run.start):
        return None

    def seconds(text: str) -> float:
        value, unit = text.split()
        return float(value) * {"s": 1.0, "ms": 1e-3}[unit]

    start = seconds(faults[0]["start"])
    if "duration" in faults[0]:
        end = start + seconds(faults[0]["duration"])
    else:
        end = start + faults[0]["cycles"] * seconds(pair.change.tables["bus"]["cycle"])
    return silence(run, healthy, start, end, 0.01 * family.twin.task.span)


def is_cycling(family: Family, axis: Axis, run: Run) -> bool:
    """Whether a machine swings between its limits."""
    limits = {"effort.motor": axis.limit}
    if axis.pmsm is not None:
        limits["voltage.q"] = axis.pmsm.dc_link / 3**0.5
    floor = max(4 * axis.r * (axis.increment or 0.0), 5 * axis.r * axis.noise, 1e-7 * family.twin.task.span)
    return cycles(run, limits, floor)


def is_restless(phases: list[Phase], healthy: Run, twin: Run, family: Family) -> bool:
    """Whether what stands gets about farther than the healthy one before it has come to rest, or what stops does so late, where the verdict
    looks and D does not: it is not known to be good."""
    def gets_about(phase: Phase) -> bool:
        of_healthy, of_twin = (swept(phase, healthy, run, family.settling) for run in (healthy, twin))
        return of_twin > max(family.tolerance.of(phase), 2 * of_healthy)

    if any(stops_late(phase, healthy, twin) for phase in phases if phase.kind == "stop"):
        return True
    stands = [phase for phase in phases if phase.kind == "stand"]
    if family.twin.task.is_bus and not stands:
        # What moves later stands from its power, and from its homing, to its first motion.
        first = next((phase.begin for phase in phases if phase.kind in ("way", "velocity") and isinstance(phase.begin, str)), None)
        begin = "home.Done" if family.twin.task.name == "homing" else 0.0
        stands = [] if first is None else [Phase("stand", begin, first.replace(".InVelocity", ".Busy"))]
    return any(gets_about(phase) for phase in stands)


def settle_checks(runner: Runner, tally: Tally) -> None:
    """A red by a swing is right where the linear loop is unstable, or where a run four times as long grows or goes on after a push."""
    waiting, jobs = [], []
    for check in tally.checks:
        family, change = check.family, check.pair.change
        if not change.hooks and change.then is None and not change.tables and not is_stable(change.axis):
            tally.by_swing["unstable by its eigenvalues"] += 1
            continue
        waiting.append(check)
        jobs.append(write_longer(check.folder, family, check.pair))
    results = runner.results(jobs)
    for check, job in zip(waiting, jobs):
        result = results[job["id"]]
        axis, pushed = check.family.twin.axis, check.family.twin.duration
        if "error" in result or result["outcome"]["ended"]:
            tally.by_swing["diverges in a longer run"] += 1
            continue
        run = run_of(Path(job["rows"]), result["outcome"], check.family.twin.task, axis)
        floor = max(4 * axis.r * (axis.increment or 0.0), 5 * axis.r * axis.noise, 1e-7 * check.family.twin.task.span)
        if any(goes_on(run.t, run.values[name], pushed + 0.01, floor) for name in ("motor.position", "load.position")):
            tally.by_swing["grows or goes on in a longer run"] += 1
        else:
            tally.cells[check.family.program, check.pair.sabotage]["false red"] += 1
            tally.note("false red", check.line)
    tally.checks.clear()


def wrong(judged: Judgement, outcome: dict[str, Any], pair: Pair) -> str | None:
    """What is wrong about a verdict, if anything is."""
    if outcome["passed"]:
        # What a lift lets pass is said.
        is_said = pair.judge is not None and any(why.startswith(f"{pair.judge.lifted}:") for why in outcome["reasons"])
        return "false green" if judged.word == "bad" and not is_said else None
    if judged.word != "good" or pair.change.harms or has_fault(outcome):
        return None
    if broken(outcome) & set(EXCUSED):
        return "to be checked"
    return "false red"


def broken(outcome: dict[str, Any]) -> set[str]:
    """The requirements that are broken."""
    return {name for name, standing in outcome["standing"].items() if standing == "broken"}


def ended_calls(outcome: dict[str, Any]) -> set[str]:
    """The calls that did not come to what they are for."""
    return {name for name, _, fate in outcome["calls"] if fate != "executed"}


def noticed(outcome: dict[str, Any]) -> str:
    """By which fault of the drive a mistake was noticed, or by which requirement; or nothing was."""
    faults = [value for _, value in outcome["signals"].get("drive.fault", []) if value != "none"]
    if faults:
        return faults[0]
    return "nothing: green" if outcome["passed"] else "the verdict alone"


def has_fault(outcome: dict[str, Any]) -> bool:
    """Whether drive or link have come to a fault, which is a harm."""
    return any(value != "none" for name in ("drive.fault", "link.fault") for _, value in outcome["signals"].get(name, []))


def report(tally: Tally) -> None:
    """By program and by sabotage."""
    words = ("bad", "good", "between", "false green", "false red", "to be checked", "error", "discarded")
    for title, index in (("program", 0), ("sabotage", 1)):
        sums: dict[str, Counter[str]] = defaultdict(Counter)
        for cell, counts in tally.cells.items():
            sums[cell[index]].update(counts)
        print(f"\n{title:18} {'pairs':>6} " + " ".join(f"{word:>13}" for word in words))
        for name in sorted(sums):
            of = sums[name]
            pairs = of["bad"] + of["good"] + of["between"]
            idle = ""
            if index == 1 and pairs >= 40 and (of["bad"] < 0.3 * pairs or of["good"] < 0.2 * pairs):
                idle = "  idle: another range"
            print(f"{name:18} {pairs:>6} " + " ".join(f"{of[word]:>13}" for word in words) + idle)
    few = {cell: sum(counts[word] for word in words[:3]) for cell, counts in tally.cells.items()}
    few = {cell: pairs for cell, pairs in few.items() if pairs < FEWEST_OF_CELL}
    if tally.families >= MANY:
        print(f"\n{len(tally.cells)} cells of program and sabotage, {len(few)} with fewer than {FEWEST_OF_CELL} pairs: {few}")
    if tally.noticed:
        print(f"\nfound by: {dict(tally.noticed.most_common())}")
    print(f"\nred by a swing, rightly: {dict(tally.by_swing)}")
    print(f"{tally.families} healthy machines, {tally.discarded.total()} discarded {dict(tally.discarded)}; {dict(tally.kinds)}")


def options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=Path, required=True, help="the example `twin`")
    parser.add_argument("--mujoco", action="store_true", help="it has the engine `mujoco`")
    parser.add_argument("--pairs", type=int, default=400)
    parser.add_argument("--each", type=int, default=5, help="pairs of a healthy machine")
    parser.add_argument("--healthy", type=int, help="so many healthy axes alone")
    parser.add_argument("--cables", type=int, help="so many wrong cables and commutations of supervised axes with little friction")
    parser.add_argument("--proof", type=int, help="so many pairs, among them some for each requirement that pass without it")
    parser.add_argument("--seed", default="1")
    parser.add_argument("--only", help="a family, by its seed: its pairs are shown, its files are kept")
    parser.add_argument("--programs", nargs="*", default=list(PROGRAMS))
    parser.add_argument("--sabotages", nargs="*", default=list(SABOTAGES))
    parser.add_argument("--keep", type=Path, help="where the scenarios of wrong verdicts go")
    parser.add_argument("--lines", type=int, default=40, help="wrong verdicts that are shown, of each kind")
    return parser.parse_args()


def sweep(given: argparse.Namespace, pairs: int, room: Path) -> Tally:
    """So many pairs."""
    tally, runner = Tally(is_traced=bool(given.only)), Runner(given.program)
    count = given.healthy or -(-pairs // given.each)
    names = [given.only] if given.only else [f"{given.seed}-{number}" for number in range(count)]
    drawn = Drawn(
        programs=list(BUS) if given.cables else given.programs,
        sabotages=list(CABLES) if given.cables else given.sabotages,
        pairs=0 if given.healthy else given.each,
        lifts=[] if given.proof or given.cables else requirements(given.program),
        engines=ENGINES if given.mujoco else tuple(name for name in ENGINES if name != "mujoco"),
        is_coarse=bool(given.healthy),
        is_smooth=bool(given.cables),
    )
    fmu.build(room)
    for first in range(0, len(names), CHUNK):
        families = [draw_family(name, drawn) for name in names[first : first + CHUNK]]
        jobs = [job for family in families for job in write(room / family.name, family)]
        results = runner.results(jobs)
        right = {family.name: judge_family(room / family.name, family, results, tally) for family in families}
        settle_checks(runner, tally)
        for name, is_right in right.items():
            for file in (room / name).iterdir():
                if not given.only and (is_right or file.suffix == ".f64"):
                    file.unlink()
            if not any((room / name).iterdir()):
                (room / name).rmdir()
    runner.end()
    if not given.only and not any(path.is_dir() for path in room.iterdir()):
        (room / fmu.FILE).unlink()
    return tally


def requirements(program: Path) -> list[str]:
    """The names of all of them."""
    return subprocess.run([program, "--requirements"], stdout=subprocess.PIPE, text=True, check=True).stdout.split()


def proof(tally: Tally, names: list[str]) -> int:
    """With any requirement switched off something bad would pass; one if not."""
    print("\nbad pairs that are red by one requirement alone, and would pass without it")
    for name in names:
        print(f"{name:18} {tally.alone[name]:>6}")
    return 0 if all(tally.alone[name] for name in names) else 1


def main() -> int:
    """Draws, runs, judges; one if any verdict is wrong."""
    given, begun = options(), time.monotonic()
    room = given.keep or Path(tempfile.mkdtemp(prefix="servobench-twins-"))
    room.mkdir(parents=True, exist_ok=True)
    print(f"seed {given.seed}")
    tally = sweep(given, given.proof or given.cables or given.pairs, room)
    for kind in ("not run", "healthy is red", "false green", "false red"):
        for line in [line for line in tally.lines if line.startswith(kind + ":")][: given.lines]:
            print(line)
    report(tally)
    unproven = proof(tally, requirements(given.program)) if given.proof else 0
    print(f"{time.monotonic() - begun:.1f} s; files of wrong verdicts are in {room}, and a family comes again with --only")
    return 1 if tally.kinds or tally.discarded.total() > MOST_DISCARDED * tally.families or unproven else 0


if __name__ == "__main__":
    sys.exit(main())
