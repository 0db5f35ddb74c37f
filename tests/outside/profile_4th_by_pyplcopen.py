"""The function block Profile4th as Structured Text, in the compiler and virtual machine of pyplcopen, against the block in Rust.

`servobench plc export` writes the text, which pyplcopen 0.21 compiles unchanged with a program that calls the block. For random
moves of orders 2 to 4 every output of every sample has to be the same in all its bits: position, velocity, acceleration, jerk,
snap, pref_add, CmdDone, Ready, Error. A twentieth of the requests is refused, by both. MC_MoveAbsolute is called as well: its
set-points are those of the block below it, from Execute to Done. The PLCopen XML is judged by its schema.

The compiler says how much memory an instance takes, too, which has to be what the head of the file says.

The machine is the C++ of pyplcopen's source package, built here once for each version of it (structured_text_vm.cpp).
The program is `SERVOBENCH`, or the one in the folder of cargo's builds. Size: 1000 moves, scaled by `SERVOBENCH_SWEEP`.
"""

import itertools
import json
import os
import re
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

from lxml import etree

from cpp import build, source
from draws import Random, sweep_size

ROOT = Path(__file__).resolve().parents[2]
VM = Path(__file__).with_name("structured_text_vm.cpp")

VARIABLES = """
    inMethod : SINT := 1;
    inOrder : INT := 4;
    inEnable : BOOL;
    inReversed : BOOL;
    inReference : LREAL;
    inActual : LREAL;
    inSample : LREAL;
    inSettling : LREAL;
    inVelocity : LREAL;
    inAcceleration : LREAL;
    inJerk : LREAL;
    inSnap : LREAL;
    outX : LREAL;
    outV : LREAL;
    outA : LREAL;
    outJ : LREAL;
    outS : LREAL;
    outAdded : LREAL;
    outDone : BOOL;
    outReady : BOOL;
    outError : BOOL;
"""
GENERATOR = f"""
PROGRAM Bench
VAR{VARIABLES}    unit : Profile4th;
END_VAR
unit(ssMethodType := inMethod, pref := inReference, vel_bnd := inVelocity, acc_bnd := inAcceleration,
    jerk_bnd := inJerk, djerk_bnd := inSnap, TriggerEnable := inEnable, ActRefPos := inActual,
    Ts := inSample, T_set := inSettling, ProfileOrder := inOrder, MotorReversed := inReversed);
outX := unit.Position;
outV := unit.Velocity;
outA := unit.Acceleration;
outJ := unit.Jerk;
outS := unit.dJerk;
outAdded := unit.pref_add;
outDone := unit.CmdDone;
outReady := unit.Ready;
outError := unit.Error;
END_PROGRAM
"""
ABSOLUTE = f"""
PROGRAM Bench
VAR{VARIABLES}    unit : MC_MoveAbsolute;
END_VAR
unit(Execute := inEnable, Position := inReference, Velocity := inVelocity, Acceleration := inAcceleration,
    Jerk := inJerk, Snap := inSnap, CommandedPosition := inActual, SampleTime := inSample, Order := inOrder);
outX := unit.SetPosition;
outV := unit.SetVelocity;
outA := unit.SetAcceleration;
outJ := unit.SetJerk;
outS := unit.SetSnap;
outDone := unit.Done;
outReady := NOT unit.Active;
outError := unit.Error;
END_PROGRAM
"""
# A script of its own: a move by a pulse, one that begins where the axis was put meanwhile and is asked for another during it, and
# one that cannot be planned. outS is the status: Done 1, Busy 2, Active 4, Error 8, and 16 times the ErrorID.
SCRIPT = f"""
PROGRAM Bench
VAR{VARIABLES}    unit : MC_MoveAbsolute;
    tick : INT;
    pressed : BOOL;
END_VAR
tick := tick + 1;
pressed := tick = 3 OR tick = 503 OR tick = 603 OR (tick >= 1503 AND tick <= 1505);
unit(Execute := pressed, Position := 0.05 + inReference, Velocity := inVelocity, Acceleration := 5.0, Jerk := 50.0, Snap := 1000.0,
    CommandedPosition := inReference, SampleTime := 0.001, Order := 4);
inReference := 0.0;
inVelocity := 1.0;
IF tick >= 400 THEN
    inReference := 2.0;
END_IF;
IF tick >= 1400 THEN
    inVelocity := -1.0;
END_IF;
outX := unit.SetPosition;
outV := unit.SetVelocity;
outS := 0.0;
IF unit.Done THEN
    outS := 1.0;
END_IF;
IF unit.Busy THEN
    outS := outS + 2.0;
END_IF;
IF unit.Active THEN
    outS := outS + 4.0;
END_IF;
IF unit.Error THEN
    outS := outS + 8.0 + 16.0 * INT_TO_LREAL(unit.ErrorID);
END_IF;
outDone := tick >= 1600;
END_PROGRAM
"""


def draw(random: Random) -> str:
    """A request for two moves, of some dozen to some thousand samples each."""
    if random.random() < 0.25:
        return tight(random)
    order = random.choice((2, 3, 4))
    sample = random.decades(-4, -1.5)
    length, time = random.decades(-4, 2), sample * random.decades(1, 2.7)
    limits = [length / time**n * random.decades(-0.6, 0.6) for n in (1, 2, 3, 4)]
    if random.random() < 0.05:
        limits[random.randrange(order - 1)] = float("inf")
    start = random.choice((0.0, random.uniform(-5, 5) * length))
    targets = [start + random.sign() * length * random.decades(-1.5, 0.7), random.uniform(-3, 3) * length + start]
    if random.random() < 0.05:
        targets[0] = start
    if random.random() < 0.1:
        wrong = random.choice((0.0, -1.0, float("nan"), 1e-31))
        place = random.randrange(6)
        if place < 4:
            # A velocity of 1e-29 is one of more samples than can be counted; a limit above 1e30 is none, but for that of the order.
            limits[place] = random.choice((wrong, 1e-29 if place == 0 else wrong, 1e31, float("inf")))
        else:
            targets[place - 4] = random.choice((float("nan"), 1e31, float("inf"), -1e30))
    settling = random.choice((0.0, sample * random.uniform(0, 20)))
    reversed = random.choice((0, 1))
    return " ".join([str(order), *map(repr, [sample, settling, *limits]), str(reversed), *map(repr, [start, *targets])])


def tight(random: Random) -> str:
    """A request whose bounds are all met, but for rounding: where a length is a whole number and another sample one too many."""
    order, sample = random.choice((2, 3, 4)), random.choice((1e-3, 2.5e-4, 0.01, 1 / 16000, random.decades(-4, -1)))
    boxes: list[int] = []
    for _ in range(order):
        boxes.append(max(1, sum(boxes)) + random.choice((0, 0, 1, random.randrange(30))))
    # From the derivative that is switched down to the position, each the box times the one above it.
    values = [random.choice((1.0, 1000.0, random.decades(-2, 4)))]
    for box in boxes:
        values.append(values[-1] * (box * sample))
    limits = [*reversed(values[:-1]), *(4 - order) * [float("inf")]]
    start = random.choice((0.0, 0.25))
    targets = [start + values[-1], start - random.randrange(1, 4) * values[-1]]
    return " ".join([str(order), *map(repr, [sample, 0.0, *limits]), "0", *map(repr, [start, *targets])])


def export(*options: str) -> str:
    """What `servobench plc export` writes."""
    program = os.environ.get("SERVOBENCH")
    if not program:
        command = ["cargo", "metadata", "--no-deps", "--format-version=1"]
        metadata = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout
        built = Path(json.loads(metadata)["target_directory"]) / "release" / "servobench"
        if not built.exists():
            sys.exit(f"{built} is not there: build it (`cargo build --release -p servobench-cli`), or name another in SERVOBENCH")
        program = str(built)
    return subprocess.run([program, "plc", "export", *options], stdout=subprocess.PIPE, text=True, check=True).stdout


def check_script(rows: list[str]) -> None:
    """What MC_MoveAbsolute says, in runs of calls with the same status; a move of 50 mm has some 350 samples."""
    calls = [[float(word) for word in row.split()] for row in rows]
    status = [(int(value), len(list(group))) for value, group in itertools.groupby(call[4] for call in calls)]
    length = status[2][1]
    expected = [(0, 2), (2, 1), (6, length), (1, 1), (0, 498 - length), (2, 1), (6, 99), (12 + 160, 1), (4, length - 100)]
    expected += [(0, 999 - length), (2, 1), (8 + 32, 2), (0, len(calls) - 1505)]
    if status != expected:
        raise SystemExit(f"MC_MoveAbsolute says {status}, not {expected}")
    # It never jumps: between two calls it goes as far as its velocity says, but where the axis is put elsewhere at rest.
    for before, after in itertools.pairwise(calls):
        if int(before[4]) & 4 and abs(after[0] - before[0] - 0.001 * before[1]) > 1e-12:
            raise SystemExit(f"MC_MoveAbsolute jumps from {before} to {after}")
    places = [calls[k][0] for k in (1, 499, 502, 1400)]
    if places != [0.0, 0.05, 2.0, 2.05]:
        raise SystemExit(f"MC_MoveAbsolute is at {places}")
    print("MC_MoveAbsolute: Done, Busy, Active, Error and ErrorID as they have to be")


def check_memory(exported: str, laid_out: list[str]) -> None:
    """Compares the bytes of instances as the compiler lays them out: those of a block are without those inside it."""
    said = {name: int(number) for name, number in re.findall(r"^ +(\w+) +(\d+) bytes$", exported, re.MULTILINE)}
    takes = {name: int(number) for name, number in map(str.split, laid_out)}
    profile = takes["bench.unit.generator"]
    found = {"Profile4th": profile, "MC_MoveAbsolute": takes["bench.unit"] + profile}
    print("memory of an instance: " + ", ".join(f"{name} {number} bytes" for name, number in found.items()))
    if found != said:
        raise SystemExit(f"the head of the file says {said}")


def check_xml() -> None:
    """Has the PLCopen XML judged by its schema; that for CODESYS says 2.0 by its namespace, and is the same but for that."""
    with tarfile.open(source("plcopen")) as archive:
        [member] = [name for name in archive.getnames() if name.endswith("tc6_xml_v201.xsd")]
        schema = etree.XMLSchema(etree.parse(archive.extractfile(member)))
    for dialect, namespace in ("iec", "tc6_0201"), ("codesys", "tc6_0200"):
        xml = export("--dialect", dialect, "--format", "xml")
        if f"http://www.plcopen.org/xml/{namespace}" not in xml:
            raise SystemExit(f"{dialect}: the namespace is not {namespace}")
        if not schema.validate(etree.fromstring(xml.replace(namespace, "tc6_0201").encode())):
            raise SystemExit(f"{dialect}: the XML is not valid: {schema.error_log}")
    print("PLCopen XML of 2 dialects: valid")


def by_rust(lines: list[str], *arguments: str) -> list[str]:
    """What the block in Rust answers."""
    command = ["cargo", "run", "--quiet", "--release", "--package", "servobench-plcopen", "--example", "generator_lines"]
    return answers([*command, "--", *arguments], lines)


def answers(command: list[str], lines: list[str]) -> list[str]:
    """What a program answers to these requests."""
    asked = "".join(line + "\n" for line in lines)
    return subprocess.run(command, cwd=ROOT, input=asked, stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()


def first_difference(ours: list[str], theirs: list[str]) -> str:
    """The first sample in which two traces differ."""
    for sample, (our, their) in enumerate(zip(ours, theirs)):
        if numbers(our) != numbers(their):
            return f"sample {sample}: Rust {our}, Structured Text {their}"
    return f"Rust has {len(ours)} samples, Structured Text {len(theirs)}"


def numbers(row: str) -> list[str]:
    """A row of a trace, by its bits."""
    return [float(word).hex() for word in row.split()]


def main() -> None:
    """Compares every move."""
    random, size = Random(61131), sweep_size(1000)
    lines = [draw(random) for _ in range((size + 1) // 2)]
    with tempfile.TemporaryDirectory() as folder:
        vm = build(VM)
        exported = export()
        programs = {name: Path(folder) / f"{name}.st" for name in ("generator", "absolute", "script")}
        programs["generator"].write_text(exported + GENERATOR)
        programs["absolute"].write_text(exported + ABSOLUTE)
        programs["script"].write_text(exported + SCRIPT)

        def by_vm(program: str, requests: list[str], *arguments: str) -> list[str]:
            return answers([str(vm), str(programs[program]), *arguments], requests)

        ours, theirs = by_rust(lines), by_vm("generator", lines)
        wrong = [line for line, our, their in zip(lines, ours, theirs, strict=True) if our != their]
        samples = sum(int(our.split()[0]) for our in ours)
        print("Profile4th in Structured Text, in the machine of pyplcopen, against the block in Rust")
        print(f"{2 * len(lines)} moves, {samples} samples, {len(wrong)} requests with a bit that differs")
        if wrong:
            where = first_difference(by_rust(wrong[:1], "trace"), by_vm("generator", wrong[:1], "trace"))
            raise SystemExit(f"{wrong[0]}\n{where}")

        # One axis, many moves, one after the other: MC_MoveAbsolute is never set back.
        targets = [random.uniform(-0.5, 0.5) for _ in range(50)]
        line = " ".join(["4 0.001 0.0 1.0 5.0 50.0 1000.0 0 0.25", *map(repr, targets)])
        ours, theirs = by_rust([line], "trace"), by_vm("absolute", [line], "trace")
        # Done is a call after the last set-point, which the axis has to get before.
        moving = [row for row in theirs if int(row.split()[6]) & 1 == 0]
        motion = [[row[:5] for row in map(numbers, rows)] for rows in (ours, moving)]
        print(f"MC_MoveAbsolute: {len(targets)} moves, {len(theirs)} samples")
        if motion[0] != motion[1]:
            raise SystemExit(f"MC_MoveAbsolute: {first_difference(ours, theirs)}")
        check_script(by_vm("script", ["4 0.001 0 1 5 50 1000 0 0 1"], "trace"))
        check_memory(exported, answers([str(vm), str(programs["absolute"]), "memory"], []))
    check_xml()


if __name__ == "__main__":
    main()
