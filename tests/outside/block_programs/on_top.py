"""Motions on top of others."""

from block_programs.program import Program

PROGRAMS = [
    Program(
        "motion on top",
        "r3_motion_family: move_superimposed",
        170,
        """
        base: MC_MoveAbsolute position=5 velocity=0.0625
        top: MC_MoveSuperimposed distance=2 velocity_difference=0.0625
        state: MC_ReadStatus
        at 0: base.execute state.enable
        at 5: top.execute
        """,
    ),
    Program(
        "motion on top, halted",
        "r3_motion_family: halt_superimposed",
        240,
        """
        base: MC_MoveAbsolute position=8 velocity=0.0625
        top: MC_MoveSuperimposed distance=6 velocity_difference=0.015625
        halt: MC_HaltSuperimposed deceleration=0.00390625 jerk=0.001953125
        wrong: MC_HaltSuperimposed deceleration=0
        at 0: base.execute top.execute
        at 40: halt.execute
        at 230: wrong.execute
        """,
        differs="""
        halted on top: top.Busy 41-45, top.CommandAborted 41-45, top.CoveredDistance 41-239
        done and error: wrong.Done 231-239
        """,
    ),
    Program(
        "nothing on top to halt",
        "r3_motion_family: motion_rejection_propagation",
        6,
        """
        halt: MC_HaltSuperimposed
        at 1: halt.execute
        at 3: halt.execute=false
        """,
    ),
    Program(
        "halt on top without power",
        "r3_motion_family: motion_rejection_propagation",
        6,
        """
        halt: MC_HaltSuperimposed
        at 1: halt.execute
        at 3: halt.execute=false
        """,
        differs="""
        done and error: halt.Done 2
        """,
        is_powered=False,
    ),
    Program(
        "motion on top, distance changed",
        "r3_motion_family: superimposed_continuous_update",
        50,
        """
        top: MC_MoveSuperimposed distance=2 velocity_difference=0.125 continuous_update=true
        state: MC_ReadStatus
        at 0: top.execute state.enable
        at 10: top.distance=4
        """,
        differs="""
        standstill on top: state.Standstill 0, state.DiscreteMotion 0
        """,
    ),
    Program(
        "motion on top, distance changed at its end",
        "r3_motion_family: superimposed_continuous_update",
        30,
        """
        top: MC_MoveSuperimposed distance=2 velocity_difference=0.125 continuous_update=true
        at 0: top.execute
        at 20: top.distance=4
        """,
        differs="""
        update after the end: top.Error 20-29, top.ErrorID 20-29
        """,
    ),
    Program(
        "motion on top at standstill",
        "part1_c4: superimposed_and_sync_out",
        12,
        """
        top: MC_MoveSuperimposed distance=2 velocity_difference=0.5
        state: MC_ReadStatus
        at 0: state.enable top.execute
        """,
        differs="""
        standstill on top: state.Standstill 0, state.DiscreteMotion 0
        """,
    ),
    Program(
        "motion on top, aborted with its base",
        "r3_motion_family: superimposed_boundaries",
        40,
        """
        top: MC_MoveSuperimposed distance=4 velocity_difference=0.0625
        move: MC_MoveAbsolute position=4 velocity=0.5 acceleration=0.0625 deceleration=0.0625 jerk=0.0625
        wrong: MC_MoveSuperimposed distance=1 velocity_difference=0
        at 0: top.execute
        at 10: move.execute
        at 30: wrong.execute
        """,
        differs="""
        covered distance: top.CoveredDistance 11-39
        rounding: move.Done 25-26, move.Busy 25-26, move.Active 25-26
        """,
    ),
]
