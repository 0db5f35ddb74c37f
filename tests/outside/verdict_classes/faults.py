"""Faults: of link and drive, that come or do not, and that are expected, lifted, or neither."""

from dataclasses import dataclass

import numpy

from draws import Random

from .case import NOTHING, Case, quantity
from .course import course
from .machine import Program, draw_machine

OTHERWISE = ("code", "who", "time")
"""In what an expectation may be wrong."""
LATE = 0.1
"""Power-up, bus and braking: so much later than its cause a fault may come (s)."""


@dataclass(frozen=True)
class Fault:
    """A fault that comes in the run, by whom, and when at about."""

    who: str
    name: str
    time: float
    mover: str
    """The call that is under way and ends in its error."""


NO_FAULT = frozenset({"no_fault"})
EXECUTED = frozenset({"executed"})
EXPECTED = frozenset({"expected"})


def passes(p: Program, target: float, position: float) -> float:
    """When the set-point of a move from zero passes a position (s from its start)."""
    way = course([(0.0, target)], p.machine.bounds)
    t = numpy.linspace(0, way.moves[0].end, 2000)
    return float(t[numpy.abs(way.at(t)[0]) >= abs(position)][0])


def switch(p: Program) -> Fault | None:
    """A limit switch beyond the target of a move or on its way."""
    p.power()
    begun = p.time + 0.01
    target = p.random.sign() * p.random.uniform(0.15, 0.4)
    end = "positive" if target > 0 else "negative"
    is_hit = p.random.random() < 0.6
    position = target * (p.random.uniform(0.3, 0.9) if is_hit else p.random.uniform(1.02, 1.5))
    p.machine.tree["axis"]["switches"] = {end: f"{position} m"}
    name = p.call("MC_MoveAbsolute", p.after, position=f"{target} m")
    p.went(target, name)
    if not is_hit:
        if p.random.random() < 0.5:
            # Another one, on this side of the switch.
            following = p.random.uniform(0, 0.8) * target
            p.went(following, p.call("MC_MoveAbsolute", p.then(), position=f"{following} m"))
        return None
    return Fault("link", f"{end} limit switch", begun + passes(p, target, position), name)


def back(p: Program) -> None:
    """Another move after it."""
    if p.random.random() < 0.5:
        p.move()


def window(p: Program) -> Fault | None:
    """A following error window around the lag at constant velocity, and a time-out that ends before the move or behind it."""
    p.power()
    begun = p.time + 0.01
    b, target = p.machine.bounds, p.random.sign() * p.random.uniform(0.3, 0.6)
    ramp, whole = b.v / b.a + b.a / b.j, b.duration(target)
    lag = b.v / p.machine.gain
    share = p.random.choice((p.random.uniform(0.2, 0.8), p.random.uniform(1.2, 3)))
    timeout = p.random.choice((0, p.random.randint(1, 30), round(1e3 * b.duration(1.2) + 500)))
    p.machine.tree["drive"]["objects"] = {"6065h": round(share * lag / 1e-7), "6066h": timeout}
    name = p.call("MC_MoveAbsolute", p.after, position=f"{target} m")
    p.went(target, name)
    # The lag follows the velocity a few time constants behind.
    if share > 1 or 1e-3 * timeout > whole:
        back(p)
        return None
    if 1e-3 * timeout > 0.5 * (whole - 2 * ramp):
        raise Undecided
    return Fault("drive", "8611h", begun + 0.6 * ramp + 1e-3 * timeout, name)


class Undecided(Exception):
    """A draw whose outcome the documentation does not tell."""


def on_its_way(p: Program, least: float, most: float) -> tuple[float, float, str]:
    """A move by so much either way: when it begins, how long it lasts, and its call."""
    p.power()
    begun = p.time + 0.02
    target = p.random.sign() * p.random.uniform(least, most)
    name = p.call("MC_MoveAbsolute", p.after, position=f"{target} m")
    p.went(target, name)
    return begun, p.machine.bounds.duration(target), name


def lost(p: Program) -> Fault | None:
    """Frames that are lost during a move, as many as the drive bridges or more."""
    begun, whole, name = on_its_way(p, 0.2, 0.4)
    start = round(begun + p.random.uniform(0.2, 0.7) * whole, 3)
    cycles = p.random.choice((1, 2, p.random.randint(4, 12)))
    p.machine.tree["bus"]["fault"] = [{"kind": "lost", "start": f"{start} s", "cycles": cycles}]
    if cycles <= 2:
        back(p)
        return None
    return Fault("drive", "8700h", start, name)


def outside(p: Program) -> Fault | None:
    """The external fault signal during a move, or none."""
    begun, whole, name = on_its_way(p, 0.2, 0.4)
    if p.random.random() < 0.4:
        back(p)
        return None
    start = round(begun + p.random.uniform(0.2, 0.7) * whole, 3)
    p.machine.tree["bus"]["fault"] = [{"kind": "external-fault", "start": f"{start} s", "duration": "50 ms"}]
    return Fault("link", "external fault", start, name)


def silent(p: Program) -> Fault | None:
    """A drive that is silent during a move, for half as long as the master waits or for longer."""
    begun, whole, name = on_its_way(p, 0.3, 0.5)
    start, call_timeout = round(begun + p.random.uniform(0.1, 0.3) * whole, 3), round(0.2 * whole, 3)
    lasts = p.random.choice((0.5, p.random.uniform(1.3, 2))) * call_timeout
    p.machine.tree["bus"] |= {"drive_timeout": f"{call_timeout} s"}
    p.machine.tree["bus"]["fault"] = [{"kind": "drive-silent", "start": f"{start} s", "duration": quantity(lasts, "s")}]
    return Fault("link", "drive time-out", start + call_timeout, name) if lasts > call_timeout else None


KINDS = (switch, switch, window, window, lost, outside, silent)


def draw(random: Random) -> Case | None:
    """One fault that comes or not, and what the scenario says of it."""
    if random.random() < 0.06:
        return reversed_switches(random)
    kind = random.choice(KINDS)
    machine = draw_machine(random, follows=kind is not window)
    machine.tree["plc"] = {"homing_required": False}
    p = Program(machine, random)
    try:
        fault = kind(p)
    except Undecided:
        return None
    if fault is None:
        breaks = nothing_comes(p)
    else:
        breaks = it_comes(p, fault) | (afterwards(p, fault) if kind is not window else NOTHING)
    note = f"{kind.__name__}: {'nothing' if fault is None else f'{fault.name} of {fault.who} at {fault.time:.3f} s'} comes"
    return Case(p.tree(), breaks, note=note)


def nothing_comes(p: Program) -> frozenset[str]:
    """Nothing is said, something is lifted, or a fault is expected that does not come."""
    if p.random.random() < 0.2:
        p.machine.tree["requirements"] = {p.random.choice(("no_fault", "executed", "arrives", "stable")): False}
    if p.random.random() < 0.25:
        codes = [("drive", "8611h"), ("link", "positive limit switch"), ("axis", "ErrorStop"), (p.calls[1]["name"], "4001h")]
        p.expect(*p.random.choice(codes))
        return EXPECTED
    return NOTHING


def it_comes(p: Program, fault: Fault) -> frozenset[str]:
    """Nobody expects it, or someone does: rightly, or another fault, of another, at another time, or not all of it."""
    around = {"start": max(0.0, fault.time - LATE), "end": fault.time + 2 * LATE}
    anyhow = p.random.choice(({}, around))
    wanted = p.random.choice(("nothing", "all", "all", "lifted", "lifted", "lifted by half", "half", "axis", *OTHERWISE))

    def mover() -> None:
        p.expect(fault.mover, "4001h", **anyhow)

    match wanted:
        case "nothing":
            return NO_FAULT | EXECUTED
        case "all":
            p.expect(fault.who, fault.name, **anyhow)
            if p.random.random() < 0.3:
                p.expect("axis", "ErrorStop", **anyhow)
            mover()
            return NOTHING
        case "lifted":
            p.machine.tree["requirements"] = {"no_fault": False, "executed": False}
            return NOTHING
        case "lifted by half":
            name, other = p.random.choice((("no_fault", "executed"), ("executed", "no_fault")))
            p.machine.tree["requirements"] = {name: False}
            return frozenset({other})
        case "half":
            if p.random.random() < 0.5:
                p.expect(fault.who, fault.name, **anyhow)
                return EXECUTED
            mover()
            return NO_FAULT
        case "axis":
            # That the axis stops is expected, but not why.
            p.expect("axis", "ErrorStop", **anyhow)
            mover()
            return NO_FAULT
        case "code":
            other = {"drive": ["3220h", "8611h", "8700h"], "link": ["positive limit switch", "negative limit switch"]}
            p.expect(fault.who, p.random.choice([name for name in other[fault.who] if name != fault.name]), **anyhow)
        case "who":
            p.expect(*{"drive": ("link", "external fault"), "link": ("drive", "8611h")}[fault.who], **anyhow)
        case "time":
            late = {"start": fault.time + 2 * LATE, "end": fault.time + 4 * LATE}
            p.expect(fault.who, fault.name, **p.random.choice(({"end": max(0.001, fault.time - LATE)}, late)))
    mover()
    return NO_FAULT | EXPECTED


def afterwards(p: Program, fault: Fault) -> frozenset[str]:
    """The axis is reset and moves back, or is asked to move before that, which is refused; or nothing more."""
    what = p.random.choice(("nothing", "nothing", "back", "back", "too early", "too early as expected"))
    if what == "nothing":
        return NOTHING
    p.time += 1.2 + p.machine.bounds.duration(0.5)
    error = {"after": f"{fault.mover}.Error"}
    breaks = NOTHING
    if what != "back":
        early = p.call("MC_MoveAbsolute", error | {"delay": "50 ms"}, position="0 m")
        if what == "too early as expected":
            p.expect(early, "2001h")
        elif p.machine.tree.get("requirements", {}).get("executed", True):
            breaks = EXECUTED
    reset = p.call("MC_Reset", error | {"delay": "0.5 s"})
    p.call("MC_MoveAbsolute", {"after": f"{reset}.Done", "delay": "0.2 s"}, position="0 m")
    return breaks


def reversed_switches(random: Random) -> Case:
    """Switches taken for normally closed on an axis that has none: the inputs are open, and both seem to be met from the start."""
    p = Program(draw_machine(random), random)
    p.machine.tree |= {"plc": {"homing_required": False}}
    p.machine.tree["bus"]["reverse_switches"] = True
    p.power()
    name = p.move()
    if random.random() < 0.5:
        return Case(p.tree(), NO_FAULT | EXECUTED, note="reversed switches")
    p.expect("link", "positive limit switch")
    p.expect(name, "4001h")
    return Case(p.tree(), NOTHING, note="reversed switches, expected")
