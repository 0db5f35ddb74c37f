"""Blocks: programs of function blocks, put together of pieces of which the documentation says how they end.

A piece is a function of a program, which it makes longer. Good ones end without an error, whatever stands beside them; each bad
one has one call that is not executed, does not come to what it is for, or ends in an error that nobody expects.
"""

from collections.abc import Callable

from .case import NOTHING, Case, quantity
from .machine import RANGE, Program, draw_machine
from draws import Random

EXECUTED = frozenset({"executed"})
ARRIVES = frozenset({"arrives"})
EXPECTED = frozenset({"expected"})
CUT = frozenset({"stopped", "follows"})
"""What a run that ends while the axis still moves may break, too."""


def absolute(p: Program) -> None:
    p.move()


def slower(p: Program) -> None:
    share = p.random.uniform(0.5, 0.95)
    p.move(velocity=f"{share * p.machine.bounds.v} m/s")
    p.time += p.machine.bounds.duration(RANGE) * (1 / share - 1)


def relative(p: Program) -> None:
    block = p.random.choice(("MC_MoveRelative", "MC_MoveAdditive"))
    distance = round(p.random.sign() * p.random.uniform(0.03, 0.2), 4)
    name = p.call(block, p.then(), distance=f"{distance} m")
    p.went(None if p.at is None else p.at + distance, name)


def taken_over(p: Program) -> str:
    """A move that another one takes over on its way; returns the name of the first."""
    is_first = p.at == 0.0 and p.time < 0.1
    if p.at is None:
        p.move()
    way = p.far() - p.at
    name = p.call("MC_MoveAbsolute", p.then(), position=f"{p.at + way} m")
    share = p.random.uniform(0.2, 0.8)
    # A position that was passed before would start it at once.
    where = {"above" if way > 0 else "below": f"{share * way} m"}
    when = {"after": f"{name}.Active", "delay": quantity(round(share * p.machine.bounds.duration(way), 3), "s")}
    other = p.call("MC_MoveAbsolute", where if is_first else when, position=f"{p.target()} m")
    p.at = None
    p.went(None, other)
    p.time += 0.5
    return name


def aborted(p: Program) -> None:
    taken_over(p)


def aborted_and_awaited(p: Program) -> None:
    """Its `CommandAborted` starts a block, or an optional call waits in vain for its `Done`."""
    name = taken_over(p)
    if p.random.random() < 0.5:
        p.call("MC_ReadStatus", f"{name}.CommandAborted")
    else:
        p.call("MC_MoveRelative", f"{name}.Done", distance="0.1 m", optional=True)


def halted(p: Program) -> None:
    name = p.call("MC_MoveVelocity", p.then(), velocity=f"{p.random.sign() * p.random.uniform(0.2, 1) * p.machine.bounds.v} m/s")
    delay = round(p.random.uniform(0.02, 0.2), 3)
    halt = p.call("MC_Halt", {"after": f"{name}.InVelocity", "delay": f"{delay} s"})
    p.went(None, halt)


def stopped(p: Program) -> None:
    name = p.call("MC_MoveRelative", p.then(), distance=f"{p.random.sign() * 0.3} m")
    stop = p.call("MC_Stop", {"after": f"{name}.Active", "delay": f"{round(p.random.uniform(0.02, 0.1), 3)} s"})
    # Until Execute of MC_Stop has fallen the axis takes no command.
    read = p.call("MC_ReadStatus", {"after": f"{stop}.Done", "delay": "30 ms"})
    p.went(None, read, "Valid")


def in_a_row(p: Program) -> None:
    modes = ("buffered", "blending-low", "blending-previous", "blending-next", "blending-high")
    start, name = p.then(), ""
    for number in range(p.random.randint(2, 4)):
        mode = {"buffer_mode": p.random.choice(modes)} if number else {}
        target = p.target()
        name = p.call("MC_MoveAbsolute", start, position=f"{target} m", **mode)
        p.went(target, name)
    p.after = f"{name}.Done"


def passing(p: Program) -> None:
    if p.at is None:
        p.move()
    target = p.far()
    speed = p.random.uniform(0.1, 0.9) * p.machine.bounds.v * 0.5
    name = p.call("MC_MoveContinuousAbsolute", p.then(), position=f"{target} m", end_velocity=f"{speed} m/s")
    p.went(None, p.call("MC_Halt", f"{name}.InEndVelocity"))


def on_error_of_none(p: Program) -> None:
    name = p.move()
    waiting = p.call("MC_Reset", f"{name}.Error")
    if p.random.random() < 0.5:
        p.call("MC_MoveRelative", f"{waiting}.Done", distance="0.05 m")


def on_abort_of_none(p: Program) -> None:
    p.call("MC_MoveRelative", f"{p.move()}.CommandAborted", distance="0.05 m")


def read(p: Program) -> None:
    block = p.random.choice(("MC_ReadStatus", "MC_ReadActualPosition", "MC_ReadActualVelocity", "MC_ReadAxisError"))
    p.after = f"{p.call(block, p.then())}.Valid"


def override(p: Program) -> None:
    factor = round(p.random.uniform(0.6, 1), 3)
    p.after = f"{p.call('MC_SetOverride', p.then(), velocity_factor=factor)}.Enabled"
    p.time += 0.3
    for _ in range(2):
        p.move()
        p.time += p.machine.bounds.duration(RANGE)


def superimposed(p: Program) -> None:
    b = p.machine.bounds
    share = {"velocity": f"{0.4 * b.v} m/s", "acceleration": f"{0.4 * b.a} m/s2", "jerk": f"{0.4 * b.j} m/s3"}
    name = p.call("MC_MoveRelative", p.then(), distance=f"{p.random.sign() * 0.25} m", **share)
    on_top = {"velocity_difference": f"{0.3 * b.v} m/s", "acceleration": f"{0.3 * b.a} m/s2", "jerk": f"{0.3 * b.j} m/s3"}
    p.call("MC_MoveSuperimposed", {"after": f"{name}.Active", "delay": "40 ms"}, distance="0.01 m", **on_top)
    p.went(None, name)
    p.time += 1.5


def refused(p: Program) -> tuple[str, str]:
    """A call that ends in an error: its name and its ErrorID."""
    b = p.machine.bounds
    kind = p.random.choice(("velocity", "acceleration", "jerk", "state"))
    if kind == "state":
        name, code = p.call("MC_Reset", p.then()), "2001h"
    else:
        most, unit = {"velocity": (b.v, "m/s"), "acceleration": (b.a, "m/s2"), "jerk": (b.j, "m/s3")}[kind]
        above = {kind: f"{most * p.random.uniform(1.02, 3)} {unit}"}
        name, code = p.call("MC_MoveAbsolute", p.then(), position=f"{p.target()} m", **above), "1002h"
    p.after = f"{name}.Error"
    return name, code


def refused_as_expected(p: Program) -> None:
    p.expect(*refused(p))


def at_rest(p: Program) -> None:
    p.after = f"{p.call('MC_Halt', p.then())}.Done"


def shifted(p: Program) -> None:
    """Another number for the place where the axis is; nothing moves."""
    by = round(p.random.uniform(-0.2, 0.2), 3)
    p.after = f"{p.call('MC_SetPosition', p.then(), position=f'{by} m', relative=True)}.Done"
    p.at = None if p.at is None else p.at + by


GOOD = (absolute, absolute, slower, relative, aborted, aborted_and_awaited, halted, stopped, in_a_row, passing)
GOOD += (on_error_of_none, on_abort_of_none, read, override, superimposed, refused_as_expected, at_rest, shifted)

Bad = tuple[frozenset[str], frozenset[str]]
"""What a bad piece breaks, and what it may break besides."""


def refused_unexpected(p: Program) -> Bad:
    refused(p)
    return EXECUTED, NOTHING


def refused_otherwise(p: Program) -> Bad:
    """Another code is expected, of another call, or at another time."""
    name, code = refused(p)
    match p.random.randrange(3):
        case 0:
            p.expect(name, p.random.choice(("1001h", "2002h", "4001h")))
        case 1:
            p.expect("c0", code)
        case 2:
            p.expect(name, code, end=0.001)
    return EXECUTED | EXPECTED, NOTHING


def while_stopping(p: Program) -> Bad:
    """The axis takes no command while MC_Stop holds it."""
    name = p.call("MC_MoveRelative", p.then(), distance=f"{p.random.sign() * 0.3} m")
    stop = p.call("MC_Stop", {"after": f"{name}.Active", "delay": "60 ms"})
    refused = p.call("MC_MoveRelative", {"after": f"{stop}.Busy", "delay": "4 ms"}, distance="0.1 m")
    p.went(None, p.call("MC_ReadStatus", {"after": f"{stop}.Done", "delay": "30 ms"}), "Valid")
    if p.random.random() < 0.3:
        p.expect(refused, "2002h")
        return EXECUTED | EXPECTED, NOTHING
    return EXECUTED, NOTHING


def too_fast_together(p: Program) -> Bad:
    """A superimposed motion on one that uses all of the velocity."""
    name = p.call("MC_MoveRelative", p.then(), distance=f"{p.random.sign() * 0.5} m")
    on_top = {"velocity_difference": f"{p.random.uniform(0.3, 1) * p.machine.bounds.v} m/s", "distance": "0.05 m"}
    p.call("MC_MoveSuperimposed", {"after": f"{name}.Active", "delay": "20 ms"}, **on_top)
    p.went(None, name)
    return EXECUTED, NOTHING


def done_of_aborted(p: Program) -> Bad:
    p.call("MC_MoveRelative", f"{taken_over(p)}.Done", distance="0.1 m")
    return EXECUTED, NOTHING


def never_there(p: Program) -> Bad:
    """A position that is never reached, and in the end a time-out."""
    where = p.random.choice(({"above": "50 m"}, {"below": "-50 m"}))
    limited = {"timeout": f"{round(p.random.uniform(0.1, 0.3), 3)} s"} if p.random.random() < 0.5 else {}
    p.call("MC_Halt", where, **limited)
    return EXECUTED, ARRIVES | EXPECTED if limited else NOTHING


def before_power(p: Program) -> Bad:
    p.call("MC_MoveAbsolute", position=f"{p.target()} m")
    return EXECUTED, NOTHING


def not_homed(p: Program) -> Bad:
    """No absolute move without a reference; nothing comes after it."""
    p.machine.tree["plc"] = {"homing_required": True}
    p.move()
    return EXECUTED, NOTHING


def too_short(p: Program) -> Bad:
    """The run ends on the way of the last move: `tree` is told when. Its block has no Done, and does not arrive either."""
    return EXECUTED, ARRIVES


BAD: tuple[Callable[[Program], Bad], ...] = (
    refused_unexpected,
    refused_otherwise,
    while_stopping,
    too_fast_together,
    done_of_aborted,
    never_there,
    before_power,
    not_homed,
    too_short,
)


def draw(random: Random) -> Case:
    """Two to five pieces; of half of the programs one is bad."""
    p = Program(draw_machine(random), random)
    p.power()
    homing = random.random()
    if homing < 0.3:
        p.machine.tree["drive"]["objects"] = {"6098h": random.choice((35, 37))}
        p.after = f"{p.call('MC_Home', p.after, position='0 m')}.Done"
        p.time += 0.05
    else:
        p.machine.tree["plc"] = {"homing_required": False}
    bad = random.choice(BAD) if random.random() < 0.5 else None
    if bad is too_short:
        return cut_short(p)
    pieces = [random.choice(GOOD) for _ in range(random.randint(1, 4))]
    if bad is not None:
        pieces.insert(random.randint(0, len(pieces)), bad)
    if bad is not_homed:
        if homing < 0.3:
            return draw(random)
        pieces = [piece for piece in pieces if piece in (read, relative, halted, not_homed)]
    breaks, may_break = NOTHING, NOTHING
    for piece in pieces:
        if piece is bad:
            breaks, may_break = piece(p)
        else:
            piece(p)
    if bad is not_homed:
        may_break = NOTHING
    return Case(p.tree(), breaks, may_break | CUT, note=", ".join(piece.__name__ for piece in pieces))


def cut_short(p: Program) -> Case:
    """Moves to positions, and a run that ends from a fifth to four fifths of the way of the last one."""
    for _ in range(p.random.randint(0, 3)):
        p.move()
    begun = p.time + 0.012 * len(p.calls)
    p.at = 0.0 if p.at is None else p.at
    target = p.at + p.random.sign() * p.random.uniform(0.25, 0.4)
    name = p.call("MC_MoveAbsolute", p.then(), position=f"{target} m")
    lasts = p.machine.bounds.duration(target - p.at)
    p.went(target, name)
    duration = begun + p.random.uniform(0.3, 0.8) * lasts
    breaks, may_break = too_short(p)
    return Case(p.tree(duration), breaks, may_break | CUT, note=f"the last move needs {lasts:.3f} s, from {begun:.3f} s on")
