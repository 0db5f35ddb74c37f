"""Why the blocks differ, and which of the two follow the text of PLCopen part 1, version 2.0: "servobench", "pyplcopen", or
"both", where the text leaves it open.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Reason:
    """Why outputs differ."""

    follows: str
    why: str


# Holds in every program: Busy of blocks with Enable.
BUSY = Reason(
    "servobench",
    "Busy of a block with Enable is set with Enable and stays as long as the block does something (2.4.1); in pyplcopen it is "
    "never TRUE at the end of a call",
)

REASONS = {
    "velocity steps": Reason(
        "servobench",
        "MC_MoveVelocity has Acceleration, Deceleration and Jerk (3.10), as has what goes on after a continuous move; pyplcopen has "
        "another velocity in the next cycle, whatever they are. So InVelocity rises early, and positions are ahead",
    ),
    "rounding": Reason("both", "pyplcopen rounds the parts of a profile up to whole cycles; no text asks for the shortest time"),
    "drive": Reason(
        "both",
        "here the drive answers a cycle after it is asked for power or a reset, MC_Power.Status being that of the power stage "
        "(3.1); pyplcopen has no drive behind its axis",
    ),
    "fed back": Reason("both", "here what is commanded in a cycle is fed back in the next, in pyplcopen in the same"),
    "valid": Reason("servobench", "Valid is TRUE only while Enable is (2.4.1); MC_Power.Valid of pyplcopen is always TRUE"),
    "permission": Reason(
        "both",
        "the text does not say what happens when EnablePositive falls in a motion that needs it: here an axis error from the next "
        "cycle on, in pyplcopen CommandAborted, and Standstill in one cycle from full velocity",
    ),
    "halt": Reason("servobench", "under MC_Halt the axis is in Discrete Motion (3.4); pyplcopen has it in Stopping"),
    "end velocity 0": Reason("both", "the text has no bound for EndVelocity; pyplcopen refuses 0"),
    "stops at an error": Reason(
        "servobench",
        "an error of a block is none of the axis (2.2.2); pyplcopen puts the axis to Standstill in one cycle from full velocity",
    ),
    "update 0": Reason(
        "servobench",
        "the text has no bound for Velocity; pyplcopen refuses 0, and puts the axis to Standstill in one cycle from full velocity",
    ),
    "next takes over": Reason(
        "pyplcopen",
        "after an error of a block the next one in the buffer becomes active (2.2.2); here a command whose update is refused goes "
        "on as it was, and the next one waits for its end",
    ),
    "blending": Reason(
        "servobench",
        "with BlendingLow the axis passes the end of the first move without a stop, at the lower velocity (2.4.2), here that of both; "
        "in pyplcopen the second begins where the first has braked to 30 % of its own, before its end",
    ),
    "behind an endless one": Reason(
        "servobench",
        "a buffered command behind one without an end takes over when that has reached its velocity (2.4.2); in pyplcopen it waits "
        "for ever",
    ),
    "waits as aborted": Reason(
        "servobench",
        "a command in the buffer is Busy (2.4.1); MC_MoveContinuousAbsolute and MC_MoveContinuousRelative of pyplcopen say "
        "CommandAborted as long as they wait, and go on saying it beside Busy",
    ),
    "stopping": Reason(
        "servobench",
        "while the axis is Stopping no other block moves it (3.3); pyplcopen takes a second MC_Stop, which aborts the first, and "
        "MC_MoveSuperimposed, which moves the axis that MC_Stop holds",
    ),
    "tables": Reason(
        "both",
        "the supplier defines the table (3.14 to 3.16). ProfileCompleted is here the end of the table and resets Busy as Done "
        "does; in pyplcopen it is the beginning of the last row, and Busy stays",
    ),
    "standstill on top": Reason(
        "servobench",
        "MC_MoveSuperimposed at Standstill is a Discrete Motion (note of figure 2.1); pyplcopen changes the state a cycle after Busy",
    ),
    "on top of a velocity": Reason(
        "servobench",
        "a motion on top does not change whether the velocity below is reached (3.10); in pyplcopen it does",
    ),
    "nothing on top": Reason(
        "both", "MC_HaltSuperimposed while Stopping, when nothing can be on top: refused here, Done in pyplcopen; the text is silent"
    ),
    "halted on top": Reason(
        "servobench",
        "CommandAborted is set when another command takes over (2.4.1), as it is in both when MC_Halt does; in pyplcopen what is "
        "on top stays Busy until it stands, and its CoveredDistance grows until then",
    ),
    "done and error": Reason(
        "servobench",
        "Done and Error exclude each other (2.4.1); MC_HaltSuperimposed of pyplcopen has both from the second cycle of an error on",
    ),
    "update after the end": Reason(
        "servobench",
        "a block that is Done takes no update any more (2.4.6), and Done excludes Error and CommandAborted (2.4.1); in pyplcopen "
        "it then has all three",
    ),
    "covered distance": Reason("both", "what CoveredDistance is after the end is not said: here it stays, in pyplcopen it is 0"),
    "axis error on top": Reason(
        "servobench",
        "an axis error ends every command with Error (2.2.2); MC_MoveSuperimposed of pyplcopen sets CommandAborted. "
        "CoveredDistance stays here",
    ),
    "torque at once": Reason(
        "both",
        "a torque without a ramp: here the set-point of a cycle is what counts before its calls, as of positions; in pyplcopen "
        "the call itself sets it",
    ),
    "buffered torque": Reason("both", "BufferMode is an optional input (3.13); pyplcopen knows Aborting alone here"),
    "buffered homing": Reason("both", "BufferMode is an optional input of part 5; pyplcopen knows Aborting alone here"),
    "homing takes a cycle": Reason(
        "both", "the state Homing is passed (figure 2.1): here for one cycle, in pyplcopen within the call that is Done"
    ),
    "homing elsewhere": Reason(
        "servobench",
        "homing begins at Standstill (figure 2.1); pyplcopen takes MC_HomeDirect and MC_HomeAbsolute in every state but ErrorStop, "
        "where the axis stands at once, from any velocity",
    ),
    "recorded": Reason(
        "both",
        "the position that is fed back when the trigger comes, here that of the set-point of the cycle before; after Execute it "
        "stays here, and is 0 in pyplcopen",
    ),
    "one probe": Reason(
        "pyplcopen",
        "each trigger has a probe of its own (3.33); here the drive has one, which the later MC_TouchProbe takes, and the earlier "
        "says CommandAborted",
    ),
    "constant at rest": Reason(
        "servobench", "ConstantVelocity includes a velocity of 0 (3.28); that of pyplcopen is FALSE at rest and on a step"
    ),
    "simulation": Reason("both", "Simulation tells of an axis that is simulated (3.29): pyplcopen always, here never"),
    "software limit": Reason(
        "servobench", "LimitSwitchPos is the hardware switch (3.29); that of pyplcopen is also set beyond a software limit"
    ),
    "error over": Reason(
        "both",
        "an error of a block with Enable either clears itself or needs another edge of Enable (2.2.3): here the first, in "
        "pyplcopen the second",
    ),
    "above the system": Reason(
        "both", "here MaxVelocityAppl is at most MaxVelocitySystem; in pyplcopen both are one value, which anything may be written to"
    ),
    "system parameter": Reason("servobench", "MaxVelocitySystem is read-only (table of 3.20); pyplcopen writes it"),
    "optional parameter": Reason("both", "parameters 6 and 7 are optional (table of 3.20); pyplcopen has none of the following error"),
}
