"""The function blocks of pyplcopen beside those of the crate `plcopen`: the same programs, every edge of every output.

The programs are those that the test suite of pyplcopen 0.21 runs on one axis (block_programs/). Both sides get the same inputs in
the same cycles, on an axis that follows its set-points, each in its own way, and say what every output is in every cycle. Of
ErrorID it counts whether it is 0, since the text leaves its numbers to the supplier. Where outputs differ, the program says in
which cycles and for which reason (block_programs/reasons.py): a difference that is not declared is wrong, and so is a declared one
that is not there, down to the cycle.

The blocks of pyplcopen are the C++ of its source package, built here once for each version of it (function_blocks.cpp); those in
Rust are called by the example `block_lines`.
"""

import subprocess
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from block_programs import PROGRAMS, Program
from block_programs.program import Differences, spans_of
from block_programs.reasons import BUSY, REASONS
from cpp import build

ROOT = Path(__file__).resolve().parents[2]
HARNESS = Path(__file__).with_name("function_blocks.cpp")
RUST = ["cargo", "run", "--quiet", "--release", "--package", "servobench-plcopen", "--example", "block_lines"]
# Outputs beside those of the standard.
OWN_OUTPUTS = {"DriveCode"}
# By how much numbers may differ: rounding, where both plan the same motion in another way.
ROUNDING = 1e-9


@dataclass
class Trace:
    """What a program does on one side: the outputs of each instance, and the values of each output where they change."""

    outputs: dict[str, list[str]] = field(default_factory=dict)
    edges: dict[str, dict[int, float]] = field(default_factory=dict)

    def series(self, output: str, cycles: int) -> list[float]:
        """The value in every cycle."""
        values, edges = [0.0], self.edges.get(output, {})
        for cycle in range(cycles):
            values.append(edges.get(cycle, values[-1]))
        return values[1:]


def traces(command: list[str], programs: list[Program]) -> list[Trace]:
    """What an implementation makes of the programs."""
    asked = "".join(program.request for program in programs)
    told = subprocess.run(command, cwd=ROOT, input=asked, stdout=subprocess.PIPE, text=True, check=True).stdout
    done, trace = [], Trace()
    for line in told.splitlines():
        match line.split():
            case ["end"]:
                done.append(trace)
                trace = Trace()
            case ["outputs", instance, *outputs]:
                trace.outputs[instance] = [output for output in outputs if output not in OWN_OUTPUTS]
            case [cycle, instance, output, value]:
                trace.edges.setdefault(f"{instance}.{output}", {})[int(cycle)] = float(value)
    return done


def compare(program: Program, ours: Trace, theirs: Trace) -> tuple[Differences, int]:
    """The outputs that differ, with the cycles, and in how many cycles Busy of a block with Enable does."""
    found: Differences = {}
    busy = 0
    for instance, outputs in ours.outputs.items():
        if sorted(outputs) != sorted(theirs.outputs[instance]):
            raise SystemExit(f"{program.name}: {instance} has {outputs}, that of pyplcopen {theirs.outputs[instance]}")
        for output in outputs:
            name = f"{instance}.{output}"
            one, other = (trace.series(name, program.cycles) for trace in (ours, theirs))
            if output.endswith("ErrorID"):
                one, other = ([float(value != 0) for value in values] for values in (one, other))
            differ = [cycle for cycle in range(program.cycles) if not abs(one[cycle] - other[cycle]) <= ROUNDING]
            if output == "Busy" and {"Valid", "Enabled"} & set(outputs) and not any(other):
                # TRUE wherever another output says that the block is enabled.
                said = [ours.series(f"{instance}.{say}", program.cycles) for say in ("Valid", "Enabled", "Error")]
                if differ == [cycle for cycle, values in enumerate(zip(*said)) if any(values)]:
                    busy += len(differ)
                    continue
            if differ:
                found[name] = differ
    return found, busy


def check(program: Program, found: Differences) -> list[str]:
    """What is found and not declared, or declared and not found."""
    declared: Differences = {}
    for reason, differences in program.declared.items():
        if reason not in REASONS:
            raise SystemExit(f"{program.name}: there is no reason `{reason}`")
        for name, cycles in differences.items():
            if set(cycles) & set(declared.get(name, [])):
                raise SystemExit(f"{program.name}: {name} is declared twice")
            declared[name] = sorted(declared.get(name, []) + cycles)
    wrong = []
    for name in sorted(found.keys() | declared.keys()):
        one, other = found.get(name, []), declared.get(name, [])
        if one != other:
            wrong.append(f"{name} differs in {spans_of(one) or 'no cycle'}, declared is {spans_of(other) or 'no cycle'}")
    return wrong


def main() -> None:
    """Compares every program."""
    ours, theirs = (traces(command, PROGRAMS) for command in (RUST, [str(build(HARNESS))]))
    print("Function blocks against those of pyplcopen: programs of its test suite")
    print(f"{'program':<55} {'outputs':>7} {'edges':>5} {'differ':>6} {'cycles':>6}  follows the text")
    wrong: list[str] = []
    reasons: Counter[str] = Counter()
    equal = outputs = edges = busy = 0
    for program, one, other in zip(PROGRAMS, ours, theirs, strict=True):
        found, cycles_of_busy = compare(program, one, other)
        wrong += [f"{program.name} ({program.test}): {what}" for what in check(program, found)]
        reasons.update(program.declared.keys())
        follows = ", ".join(sorted({REASONS[reason].follows for reason in program.declared}))
        own = sum(map(len, one.outputs.values()))
        changes = sum(len(changed) for name, changed in one.edges.items() if name.split(".")[1] not in OWN_OUTPUTS)
        cycles = len({cycle for differ in found.values() for cycle in differ})
        print(f"{program.name:<55} {own:>7} {changes:>5} {len(found) or '-':>6} {cycles or '-':>6}  {follows or '-'}")
        outputs, edges, busy, equal = outputs + own, edges + changes, busy + bool(cycles_of_busy), equal + (not found)
    print(f"{len(PROGRAMS)} programs, {outputs} outputs with {edges} edges: {equal} programs without a difference")
    print(f"  {BUSY.follows:<10} in {busy:>2}: {BUSY.why}")
    for reason, count in reasons.most_common():
        print(f"  {REASONS[reason].follows:<10} in {count:>2}: {reason}: {REASONS[reason].why}")
    if unused := REASONS.keys() - reasons.keys():
        wrong.append(f"no program has a difference for {', '.join(sorted(unused))}")
    if wrong:
        raise SystemExit("\n".join(wrong))


if __name__ == "__main__":
    main()
