"""Exported FMUs in the hands of FMPy and of the FMU Manipulation Toolbox, which importers are held against and made with.

For every part of some scenarios and both versions of the standard:
- `fmpy.validation` finds nothing in the model description: schema, names, model structure, start values, units;
- the axis, simulated by FMPy at the base rate, gives what a run of the scenario records, to the bit;
- the toolbox makes one FMU of drive and mechanics, which FMPy simulates: what it gives is the axis in one, to the bit;
- a saved state, and its bytes in another instance, go on to the bit, as FMPy calls them; the bytes are few at any length of the run, and
  with one that is damaged they are refused;
- without a word on times FMPy simulates the whole program (`DefaultExperiment`);
- a step that never fits ends FMPy's simulation with an error: what is discarded it asks for again without end.
"""

import contextlib
import io
import logging
import random
import signal
import tempfile
import time
from pathlib import Path

import fmpy
import numpy
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu
from fmu_manipulation_toolbox.container import FMUContainer

from exports import MEASURED, example, library, recorded

PARTS = ("axis", "drive", "mechanics")
# A move, a table of points from a file, and function blocks over a fieldbus with the states of drive and axis.
SCENARIOS = ("demo/jerk", "setpoints/pvt", "plc/figure-3a")
BODIES = ("motor.", "table.", "load.")
# Steps in base ticks that no whole number of them makes, and the status error of both versions.
MISFITS = (0.3, 0.5, 1.5, 2.01)
ERROR = 3
# Most bytes of a saved state.
MOST_BYTES = 1 << 16
# Real time for a simulation of some steps (s).
CALL_TIMEOUT = 60


def simulated(fmu: str, rate: int, ticks: int) -> numpy.ndarray:
    """What FMPy makes of it, a row for each tick from 0 on."""
    step = 1.0 / rate
    result = fmpy.simulate_fmu(fmu, stop_time=ticks * step, step_size=step, output_interval=step)
    if len(result) != ticks + 1:
        raise SystemExit(f"{fmu}: {len(result)} rows instead of {ticks + 1}")
    return result


def check_run(name: str, fmu: str, rate: int, channels: dict[str, numpy.ndarray]) -> int:
    """Compares a simulation with the recording; how many values were equal."""
    ticks = len(next(iter(channels.values()))) - 1
    result = simulated(fmu, rate, ticks)
    equal = 0
    for channel, values in channels.items():
        # Bodies are where they are at the end of a step, everything else is of the tick that has ended.
        found, wanted = (result[channel], values) if channel.startswith(BODIES) else (result[channel][1:], values[:-1])
        wrong = numpy.flatnonzero(found.view(numpy.uint64) != wanted.view(numpy.uint64))
        if len(wrong):
            at = wrong[0]
            raise SystemExit(f"{name}: `{channel}` differs in row {at}: {found[at]!r}, recorded {wanted[at]!r}")
        equal += len(wanted)
    return equal


def check_container(folder: Path, version: int, rate: int, axis: str) -> None:
    """Makes one FMU of drive and mechanics and compares it with the axis."""
    drive, mechanics = (f"{part}{version}.fmu" for part in ("drive", "mechanics"))
    container = FMUContainer("both", folder, fmi_version=version)
    for fmu in (drive, mechanics):
        container.get_fmu(fmu)
    container.add_link(drive, "effort.motor", mechanics, "effort.motor")
    for name in MEASURED:
        container.add_link(mechanics, name, drive, name)
    container.add_output(mechanics, "load.position", "position")
    container.add_implicit_rule(auto_input=False, auto_output=False, auto_link=False)
    both = str(folder / f"both{version}.fmu")
    container.make_fmu(both, step_size=1.0 / rate, sequential=True)
    found, wanted = simulated(both, rate, 8_000)["position"], simulated(axis, rate, 8_000)["load.position"]
    if not (found == wanted).all():
        raise SystemExit(f"FMI {version}: drive and mechanics in a container differ by {abs(found - wanted).max()} m")


def check_states(fmu: str, rate: int) -> str:
    """Saves a state and its bytes, goes on, and goes on from them again; damages the bytes. Says how many they are, and what they take."""
    description = fmpy.read_model_description(fmu)
    slave = {"2.0": FMU2Slave, "3.0": FMU3Slave}[description.fmiVersion]
    is_two = slave is FMU2Slave
    given = [one for one in description.modelVariables if one.causality == "output"]
    references = [one.valueReference for one in given if one.type in ("Real", "Float64")]
    folder = fmpy.extract(fmu, f"{fmu}.unpacked")

    def begun():  # type: ignore[no-untyped-def]
        instance = slave(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="axis",
        )
        instance.instantiate()
        if is_two:
            instance.setupExperiment(startTime=0.0)
        instance.enterInitializationMode()
        instance.exitInitializationMode()
        return instance

    def outputs(instance, first):  # type: ignore[no-untyped-def]
        all_of_them = []
        for tick in range(first, first + 500):
            instance.doStep(currentCommunicationPoint=tick / rate, communicationStepSize=1.0 / rate)
            all_of_them += (instance.getReal if is_two else instance.getFloat64)(references)
        return all_of_them

    one, other = begun(), begun()
    outputs(one, 0)
    # FMPy has names for both versions that differ in their capitals.
    calls = ["getFMUstate", "serializeFMUstate", "deSerializeFMUstate", "setFMUstate"]
    if not is_two:
        calls = ["getFMUState", "serializeFMUState", "deserializeFMUState", "setFMUState"]
    get, serialize = (getattr(one, call) for call in calls[:2])
    deserialize = getattr(other, calls[2])

    def now() -> bytes:
        return bytes(serialize(get()))

    state = get()
    content = now()
    restore = [(one, getattr(one, calls[3]), state), (other, getattr(other, calls[3]), deserialize(content))]
    accepted = 0
    draws = random.Random(40)
    for _ in range(1_000):
        damaged = bytearray(content)
        damaged[draws.randrange(len(damaged))] ^= 1 << draws.randrange(8)
        # FMPy prints what the FMU says of each.
        with contextlib.suppress(FMICallException), contextlib.redirect_stdout(io.StringIO()):
            deserialize(bytes(damaged))
            accepted += 1
    if accepted:
        raise SystemExit(f"{fmu}: {accepted} states with a damaged byte were accepted")
    wanted = outputs(one, 500)
    for instance, go_back, saved in restore:
        go_back(saved)
        if outputs(instance, 500) != wanted:
            raise SystemExit(f"{fmu}: what follows a saved state is not what followed it")
    one.doStep(currentCommunicationPoint=1_000 / rate, communicationStepSize=4_000 / rate)
    times, later = [], b""
    for _ in range(20):
        begin = time.perf_counter()
        later = now()
        times.append(time.perf_counter() - begin)
    if max(len(content), len(later)) > MOST_BYTES:
        raise SystemExit(f"{fmu}: a state has {len(content)} bytes, {len(later)} later; {MOST_BYTES} is the most")
    for instance in (one, other):
        instance.terminate()
        instance.freeInstance()
    return f"a state has {len(content)} bytes at tick 500 and {len(later)} at 5 000, saved in {1e6 * min(times):.0f} us"


def check_default(name: str, fmu: str, channels: dict[str, numpy.ndarray], rate: int) -> None:
    """Simulates it as it says itself, and compares its end with that of the recording."""
    result, ticks = fmpy.simulate_fmu(fmu), len(next(iter(channels.values()))) - 1
    if abs(result["time"][-1] - ticks / rate) > 1e-9:
        raise SystemExit(f"{name}: it ends at {result['time'][-1]} s by itself, a run at {ticks / rate} s")
    for channel, values in channels.items():
        if channel.startswith(BODIES) and result[channel][-1] != values[-1]:
            raise SystemExit(f"{name}: `{channel}` is {result[channel][-1]!r} at its end, recorded {values[-1]!r}")


def check_misfits(name: str, fmu: str, rate: int) -> None:
    """Steps that never fit: each is an error, and none goes on for ever."""
    for ticks in MISFITS:
        step = ticks / rate
        signal.alarm(CALL_TIMEOUT)
        try:
            fmpy.simulate_fmu(fmu, stop_time=100 / rate, step_size=step, output_interval=step)
        except FMICallException as refused:
            if refused.status != ERROR or not refused.function.endswith("DoStep"):
                raise SystemExit(f"{name}: {refused} for a step of {ticks} ticks") from refused
        else:
            raise SystemExit(f"{name}: FMPy simulates it by steps of {ticks} ticks")
        finally:
            signal.alarm(0)


def main() -> None:
    # It tells of every input and output that is not connected; what fails raises an exception.
    logging.getLogger("fmu_manipulation_toolbox").setLevel(logging.CRITICAL)
    inside = library()
    for scenario in SCENARIOS:
        path = f"scenarios/{scenario}.toml"
        rate, channels = recorded(path)
        for version in (2, 3):
            with tempfile.TemporaryDirectory() as room:
                folder = Path(room)
                for part in PARTS:
                    fmu = str(folder / f"{part}{version}.fmu")
                    example("export_fmu", path, str(version), part, inside, fmu)
                    if problems := validate_fmu(fmu):
                        raise SystemExit(f"{scenario}, FMI {version}, {part}: {problems}")
                axis = str(folder / f"axis{version}.fmu")
                equal = check_run(f"{scenario}, FMI {version}", axis, rate, channels)
                size = Path(axis).stat().st_size
                print(f"{scenario:<16} FMI {version}: valid, {size / 1e6:.1f} MB, {equal} values equal to the bit", end="")
                if scenario != SCENARIOS[1]:
                    print(f"; {check_states(axis, rate)}", end="")
                if scenario == SCENARIOS[0]:
                    check_container(folder, version, rate, axis)
                    check_default(f"{scenario}, FMI {version}", axis, channels, rate)
                    for part in PARTS:
                        check_misfits(f"FMI {version}, {part}", str(folder / f"{part}{version}.fmu"), rate)
                    print("; drive and mechanics in a container are the axis; saved states go on; ends and misfits", end="")
                print()


if __name__ == "__main__":
    main()
