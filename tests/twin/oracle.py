"""The judge of the judges: by how much a run does not do what its task asks, phase by phase.

Nothing here is taken from the program but positions, velocities and efforts of its runs, the set-point that the healthy twin was given,
and at which times calls began and ended.
"""

from dataclasses import dataclass
from math import inf, isfinite
from typing import Any

import numpy

from task import Phase

POWERED = 0.02
"""So long after its power the set-point of a drive over a bus is that of its master (s)."""

FEWEST = 16
"""Rows of a phase, at least."""


@dataclass
class Run:
    """A run as the oracle sees it."""

    t: numpy.ndarray
    values: dict[str, numpy.ndarray]
    signals: dict[str, list[tuple[float, str]]]
    start: float = 0.0
    """When its program began (s), which times of phases count from."""
    powered: float = 0.0
    """When its power came (s)."""
    offset: float = 0.0
    """Position of the machine less that of the task, once it has homed."""
    silence: tuple[float, float] | None = None
    """From when to when nothing is asked, because a fault of the bus that its file orders loses or delays values, until the set-point is
    where it would be without."""

    @property
    def load(self) -> numpy.ndarray:
        return self.values["load.position"]

    def rises(self, output: str) -> float:
        """When an output becomes TRUE for the first time; infinite: never."""
        output, _, wanted = output.partition("=")
        values = (wanted,) if wanted else ("TRUE", "true", "1")
        return next((time for time, value in self.signals.get(output, []) if value in values), inf)

    def time(self, of: Any) -> float:
        """The time of a beginning or an end, at most that of the end of the run."""
        time = self.rises(of) if isinstance(of, str) else self.start + of
        return min(time, float(self.t[-1]))


@dataclass(frozen=True)
class Tolerance:
    """What is not seen. Issue 38 has for it the window at rests, 1 % of distance, velocity or effort elsewhere, 10 increments, 5 σ, and four
    times the spread of two sisters. Besides:

    - A rest without a given window has the default of the product, a thousandth of the way.
    - A window is at most 5 % of the way, since a file that looks away (a window as wide as the way) must not decide what is bad. Where the
      axis only stands there is no way, and the window is all that the file says.
    - Standing has no distance: 5e-5 of the span of the task where no window is given (with 1 % of it 13 of 600 reds that are right were
      false).
    - Loops without an integral are displaced by friction and bias, healthy or not, and by more where a sabotage makes more of these.
    - The error of an effort is its median over the last half. The requirement allows what takes less than half of a phase; with the mean
      4 of 300 pairs more are bad, each by a loss that is over, or comes, in that time.
    """

    window: float | None
    """At rests (axis unit)."""
    span: float
    """Of the task."""
    increment: float
    noise: float
    droop: float
    """By how much friction and bias displace loops without an integral."""

    def of_bad(self, phase: Phase) -> float:
        """What is bad by four times of it: the same, but for standing without a window. That is not good from 5e-5 of the span on, and bad by
        a thousandth of it, which is the default window of a rest; in between the deflection that friction and bias explain decides."""
        return max(self.of(phase), 1e-3 * self.span if phase.kind == "stand" and self.window is None else 0.0)

    def of(self, phase: Phase) -> float:
        least = max(10 * self.increment, 5 * self.noise)
        match phase.kind:
            case "rest" | "swing" | "calm":
                # Without a window a thousandth of the way; one as wide as the way says nothing of an arrival.
                window = 1e-3 * phase.size if self.window is None else self.window
                return max(min(window, 0.05 * phase.size), least) + self.droop
            case "stand":
                return max(5e-5 * self.span if self.window is None else self.window, least) + self.droop
            case "way":
                return max(0.01 * phase.size, least)
            case _:
                return 0.01 * abs(phase.target)


@dataclass
class Settling:
    """Times that a healthy axis takes."""

    rest: float
    """A rest has to be so long to be judged (s)."""
    stand: float
    """What stands is judged so long after it began, and after a step of a disturbance (s)."""
    velocity: float
    """A velocity is judged that is held so long (s)."""
    steps: tuple[float, ...] = ()
    """When disturbances step (s)."""

    def is_settled(self, t: numpy.ndarray, since: float) -> numpy.ndarray:
        """Where what stands `since` then has come to rest again."""
        found = t >= since + self.stand
        for step in self.steps:
            found &= (t < step) | (t >= step + self.stand)
        return found


def swept(phase: Phase, healthy: Run, run: Run, settling: Settling) -> float:
    """How far the load gets about before a stand has come to rest, which D leaves out."""
    begin, end = healthy.time(phase.begin), healthy.time(phase.end)
    shift = run.rises(phase.begin) - begin if isinstance(phase.begin, str) else run.start - healthy.start
    early = (run.t >= begin + shift) & (run.t <= end + shift) & ~settling.is_settled(run.t, begin + shift)
    return float(numpy.ptp(run.load[early])) if early.any() else 0.0


def stops_late(phase: Phase, healthy: Run, run: Run) -> bool:
    """Whether the load has neither stopped nor swings about where it does when twice the planned time has passed, as the healthy one has:
    D, which is the speed at the end, does not see it."""
    assert isinstance(phase.begin, str)
    mean = 0.01

    def still_moves(one: Run) -> bool:
        done = one.rises(phase.begin)
        due = done + planned
        before = (one.t >= done - planned) & (one.t <= due)
        if not due < one.t[-1] or before.sum() < FEWEST or all(reversals(one.load[before], 0.05 * float(numpy.ptp(one.load[before])))):
            return False
        way = numpy.interp(due + mean, one.t, one.load) - numpy.interp(due - mean, one.t, one.load)
        return abs(float(way)) / (2 * mean) > 0.01 * abs(phase.target)

    planned = healthy.rises(phase.begin) - healthy.rises(phase.begin.replace("Done", "Busy"))
    return still_moves(run) and not still_moves(healthy)


def deviations(phases: list[Phase], healthy: Run, run: Run, settling: Settling, tolerance: Tolerance) -> list[float]:
    """D of each phase: infinite where the run never came to it, not a number where the phase is too short to be judged."""
    return [deviation(phase, healthy, run, settling, 0.2 * tolerance.of(phase)) for phase in phases]


def deviation(phase: Phase, healthy: Run, run: Run, settling: Settling, grain: float) -> float:
    begin, end = healthy.time(phase.begin), healthy.time(phase.end)
    if phase.end == inf and run.t[-1] > healthy.t[-1] + 1e-9:
        # It runs longer, and is judged to its end.
        end += float(run.t[-1] - healthy.t[-1])
    shift = run.start - healthy.start
    if not isfinite(shift):
        return inf
    if phase.kind == "homing":
        return numpy.nan
    if isinstance(phase.begin, str):
        came = run.rises(phase.begin)
        if not isfinite(came):
            return inf if isfinite(healthy.rises(phase.begin)) else numpy.nan
        shift = came - begin
    if not length_suffices(phase.kind, end - begin, settling):
        return numpy.nan
    # Of a phase that the run's end cuts off what is there is judged, if it is the most of it.
    inside = (run.t >= begin + shift) & (run.t <= end + shift)
    expected = (end - begin) * len(healthy.t) / max(healthy.t[-1], 1e-9)
    if run.silence is not None and is_left_out(phase, run, begin + shift, end + shift):
        return numpy.nan
    if inside.sum() < FEWEST or inside.sum() < 0.9 * expected:
        return inf if run.t[-1] < end + shift - 0.1 * (end - begin) and run.t[-1] < healthy.t[-1] - 1e-6 else numpy.nan
    t, load = run.t[inside] - shift, run.load[inside] - run.offset
    match phase.kind:
        case "way":
            return float(numpy.max(numpy.abs(load - numpy.interp(t, healthy.t, healthy.values["reference"] - healthy.offset))))
        case "rest":
            if run.silence is not None and run.silence[1] > begin + shift:
                # What counts is where it is at the end.
                load = load[-FEWEST:]
            return abs(mean_of_cycles(load, grain) - phase.target)
        case "swing":
            return swing(load) / 2
        case "calm":
            last = load[-len(load) // 3 :]
            return float(last.max() - last.min()) / 2
        case "stand":
            late = settling.is_settled(t + shift, t[0] + shift)
            # Over a bus it stands where it was when its power came.
            held = healthy.load[settling.is_settled(healthy.t, begin) & (healthy.t <= end)]
            target = phase.target if healthy.start == 0.0 else float(held.mean()) if len(held) else numpy.nan
            if not late.any():
                return numpy.nan
            # One that has sagged before its power came stands where the drive first found it.
            found = float(numpy.interp(run.powered + POWERED, run.t, run.values["setpoint.position"])) - run.offset
            targets = [target] if healthy.start == 0.0 else [target, found]
            return min(float(numpy.max(numpy.abs(load[late] - one))) for one in targets)
        case "velocity":
            half = len(t) // 2
            return abs(float(load[-1] - load[half]) / float(t[-1] - t[half]) - phase.target)
        case "effort":
            late = t >= (t[0] + t[-1]) / 2
            return float(numpy.median(numpy.abs(run.values["effort.motor"][inside][late] - phase.target)))
        case "stop":
            # Of the velocity at its beginning what is left at its end; a load that rings has stopped.
            length = t[-1] - t[0]
            heard = -inf if run.silence is None else min(run.silence[1] - shift, t[-1] - 0.1 * length)
            late = t >= max(t[0] + 0.5 * length, heard)
            return abs(velocity_of_cycles(t[late], load[late]))
    raise ValueError(phase.kind)


def is_left_out(phase: Phase, run: Run, begin: float, end: float) -> bool:
    """Whether a silence interrupts what is judged of a phase. Nothing is asked then (section A1 of issue 38), but where the machine is at the
    end counts: a last rest and a last stop are judged in any case."""
    assert run.silence is not None
    if phase.kind in ("rest", "stop") and phase.end == inf:
        return False
    first = (begin + end) / 2 if phase.kind in ("velocity", "effort", "stop") else begin
    return run.silence[0] < end and run.silence[1] > first


def silence(run: Run, healthy: Run, start: float, end: float, seen: float) -> tuple[float, float]:
    """Of a fault of the bus between two times (s): it lasts until the link interpolates again, and the set-point of the drive is, by less
    than `seen`, where that of the healthy twin is at the same time."""
    states = run.signals.get("link.interpolation", [])
    for (since, state), (until, _) in zip(states, [*states[1:], (inf, "")]):
        if state in ("Run2", "Run3", "Underflow") and since <= end + 0.01 and until > start:
            end = max(end, until)
    after = run.t > end
    expected = numpy.interp(run.t[after] - run.start + healthy.start, healthy.t, healthy.values["setpoint.position"])
    away = numpy.flatnonzero(abs(run.values["setpoint.position"][after] - expected) > seen)
    return start, float(run.t[after][away[-1]]) if len(away) else end


ALTERNATIONS = 9
"""So many from one limit to the other, one after the other, are a cycle."""


def cycles(run: Run, limits: dict[str, float], floor: float) -> bool:
    """Whether the motor goes on to swing about its reference between two limits: in nine swings that follow each other, larger than `floor`
    and equal within a third, an effort or a voltage comes to within a tenth of its two limits in turn."""
    error = run.values["motor.position"] - run.values["reference"]
    peaks, valleys = reversals(error, floor)
    ends = sorted([*peaks, *valleys])
    sizes = numpy.abs(numpy.diff(error[ends]))
    for first in range(len(ends) - ALTERNATIONS):
        some = sizes[first : first + ALTERNATIONS]
        if some.max() > 1.5 * some.min():
            continue
        for name, limit in limits.items():
            between = [run.values[name][a : b + 1] for a, b in zip(ends[first:], ends[first + 1 : first + ALTERNATIONS + 1])]
            if all(part.max() >= 0.9 * limit or part.min() <= -0.9 * limit for part in between):
                both = numpy.concatenate(between)
                if both.max() >= 0.9 * limit and both.min() <= -0.9 * limit:
                    return True
    return False


@dataclass(frozen=True)
class Harm:
    """What a machine suffers although it may do its task."""

    kind: str
    size: float
    """By how much it is beyond what it bears, as a share of what is bad."""


def harms(run: Run, homed: str | None, stops: tuple[float, float] | None, hottest: float | None, seen: float) -> list[Harm]:
    """Contacts with stops, by how far the load is in one (bad: more than `seen`, axis unit), but for those before power and in the
    search of the switch, until `homed`; the temperature of the winding (bad: more than a twentieth above the hottest that it bears); and
    what the trajectory buffer of the drive reports."""
    found = []
    if stops is not None:
        # Until the search has ended it may touch one; where it never ends all of it is one.
        after = run.t >= max(run.start if isfinite(run.start) else inf, run.rises(homed) if homed else 0.0)
        beyond = numpy.maximum(stops[0] - run.load[after], run.load[after] - stops[1])
        if len(beyond) and beyond.max() > 0:
            found.append(Harm("end stop", float(beyond.max()) / seen))
    winding = run.values.get("temperature.winding")
    if hottest is not None and winding is not None and winding.max() > hottest:
        found.append(Harm("winding", float(winding.max() - hottest) / (0.05 * hottest)))
    reports = {state for _, state in run.signals.get("drive.buffer", [])} - {"none"}
    if reports:
        found.append(Harm(f"buffer: {', '.join(sorted(reports))}", inf))
    return found


def swing(x: numpy.ndarray) -> float:
    """Peak to peak of a swing that goes on: the last quarter has at least two cycles, as large as those of the quarter before (less is a weak damping); else 0."""
    quarter = len(x) // 4
    before, last = x[-2 * quarter : -quarter], x[-quarter:]
    if quarter < FEWEST:
        return 0.0
    middle = (last.max() + last.min()) / 2
    above = last > middle
    cycles = int((above[1:] & ~above[:-1]).sum())
    size = float(last.max() - last.min())
    return size if cycles >= 2 and size >= 0.98 * float(before.max() - before.min()) else 0.0


def goes_on(t: numpy.ndarray, x: numpy.ndarray, since: float, floor: float) -> bool:
    """Whether a swing about a line grows or stays for ever after a push at `since`."""
    after = t > since
    line = numpy.polynomial.Polynomial.fit(t[after], x[after], 1)
    return swing(x[after] - line(t[after])) > floor


def length_suffices(kind: str, length: float, settling: Settling) -> bool:
    match kind:
        case "rest" | "swing" | "calm":
            return length >= settling.rest
        case "stand":
            return length > settling.stand
        case "velocity":
            return length >= settling.velocity
        case "effort":
            return length >= 0.05
    return length > 0


def slope(t: numpy.ndarray, x: numpy.ndarray) -> float:
    """Mean velocity, by least squares."""
    if len(t) < 2:
        return numpy.nan
    s = t - t.mean()
    return float(s @ (x - x.mean()) / (s @ s))


def velocity_of_cycles(t: numpy.ndarray, x: numpy.ndarray) -> float:
    """Mean velocity over the last whole cycle, from peak to peak; over all where it swings without one, over the last half where nothing
    swings."""
    line = numpy.polynomial.Polynomial.fit(t, x, 1)
    rest = x - line(t)
    both = reversals(rest, 0.1 * float(rest.max() - rest.min()))
    for ends in both:
        if len(ends) >= 2:
            first, last = ends[-2], ends[-1]
            return float(x[last] - x[first]) / float(t[last] - t[first])
    half = 0 if all(both) else len(t) // 2
    return slope(t[half:], x[half:])


def mean_of_cycles(x: numpy.ndarray, grain: float) -> float:
    """Mean over the last whole cycle, from peak to peak; of the last tenth where nothing swings by more than `grain`, be it from the last
    fifth on, and of all where it swings without such a cycle."""
    last = x[-max(1, len(x) // 5) :]
    if float(last.max() - last.min()) <= grain:
        return float(x[-max(1, len(x) // 10) :].mean())
    peaks, valleys = reversals(x, max(0.02 * float(x.max() - x.min()), grain))
    half = len(x) // 2
    for ends in (peaks, valleys):
        if len(ends) >= 2 and ends[-1] >= half:
            return float(x[ends[-2] : ends[-1]].mean())
    if peaks and valleys and max(peaks[-1], valleys[-1]) >= half:
        return float(x.mean())
    return float(x[-max(1, len(x) // 10) :].mean())


def reversals(x: numpy.ndarray, hysteresis: float) -> tuple[list[int], list[int]]:
    """Indices of maxima and minima from which it goes back by more than a hysteresis."""
    peaks: list[int] = []
    valleys: list[int] = []
    low = high = 0
    rising = None
    values = x.tolist()
    for at, value in enumerate(values):
        if value > values[high]:
            high = at
        if value < values[low]:
            low = at
        if rising is not False and value < values[high] - hysteresis:
            if rising:
                peaks.append(high)
            rising, low = False, at
        elif rising is not True and value > values[low] + hysteresis:
            if rising is False:
                valleys.append(low)
            rising, high = True, at
    return peaks, valleys


@dataclass(frozen=True)
class Judgement:
    """Of a sabotaged run."""

    word: str
    """`bad`, `good` or `between`."""
    phase: str
    """The worst one."""
    share: float
    """Its D as a share of what is bad."""
    found: float
    tolerance: float
    of_healthy: float


def judgement(
    phases: list[Phase], found: list[float], of_healthy: list[float], spread: list[float], tolerance: Tolerance
) -> Judgement:
    """Bad, good, or between both."""
    word, worst = "good", Judgement("good", "", 0.0, 0.0, 0.0, 0.0)
    for number, (phase, d, h, s) in enumerate(zip(phases, found, of_healthy, spread)):
        if numpy.isnan(d) or numpy.isnan(h):
            # What is not judged, because a silence interrupted it for example, is not known to be good.
            if word == "good" and numpy.isnan(d) and not numpy.isnan(h):
                word = "between"
            continue
        tol = max(tolerance.of(phase), 4 * s)
        bad, good = max(8 * h, 4 * max(tolerance.of_bad(phase), 4 * s)), max(2 * h, tol)
        # A load that swings and dies out as its damping says is not bad, but neither is it good.
        if phase.kind == "calm":
            bad = inf
        if d > bad:
            word = "bad"
        elif d > good and word == "good":
            word = "between"
        share = d / bad if bad > 0 else (inf if d > 0 else 0.0)
        if share >= worst.share:
            worst = Judgement(word, f"{phase.kind} {number}", share, d, tol, h)
    return Judgement(word, worst.phase, worst.share, worst.found, worst.tolerance, worst.of_healthy)
