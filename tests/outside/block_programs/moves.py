"""Moves to an end, one after the other."""

from block_programs.program import Program

PROGRAMS = [
    Program(
        "absolute move under cyclic power",
        "r3_semantics: cyclic_power_keeps_motion",
        60,
        """
        power: MC_Power
        move: MC_MoveAbsolute position=2 velocity=0.125
        state: MC_ReadStatus
        at 0: power.enable state.enable
        at 2: move.execute
        at 50: move.execute=false
        """,
    ),
    Program(
        "absolute move, Execute gone",
        "part1_c4: execute_falling_edge_keeps_terminal",
        16,
        """
        move: MC_MoveAbsolute position=4 velocity=1
        at 0: move.execute
        at 1: move.execute=false
        """,
    ),
    Program(
        "absolute move to where the axis is",
        "r3_semantics: move_absolute_direction",
        6,
        """
        move: MC_MoveAbsolute position=0
        state: MC_ReadStatus
        at 0: state.enable
        at 1: move.execute
        """,
    ),
    Program(
        "absolute moves, target changed",
        "part1_c4: position_continuous_update",
        20,
        """
        move: MC_MoveAbsolute position=4 continuous_update=true
        at 0: move.execute
        at 4: move.position=6
        """,
    ),
    Program(
        "relative move, distance changed",
        "part1_c4: position_continuous_update",
        20,
        """
        move: MC_MoveRelative distance=4 continuous_update=true
        at 0: move.execute
        at 4: move.distance=6
        """,
    ),
    Program(
        "absolute move, late ContinuousUpdate",
        "part1_c4: position_continuous_update",
        20,
        """
        move: MC_MoveAbsolute position=4
        at 0: move.execute
        at 1: move.continuous_update=true move.position=6
        """,
    ),
    Program(
        "relative move takes over",
        "part1_c4: relative_additive_and_signed_inputs",
        24,
        """
        move: MC_MoveAbsolute position=10
        next: MC_MoveRelative distance=2
        read: MC_ReadParameter parameter=commanded-position
        at 0: move.execute read.enable
        at 3: next.execute
        """,
        differs="""
        rounding: read.Value 4-6
        """,
    ),
    Program(
        "additive move takes over",
        "part1_c4: relative_additive_and_signed_inputs",
        24,
        """
        move: MC_MoveAbsolute position=10
        next: MC_MoveAdditive distance=2
        read: MC_ReadParameter parameter=commanded-position
        at 0: move.execute read.enable
        at 3: next.execute
        """,
    ),
    Program(
        "additive move, slow",
        "r3_motion_family: move_additive",
        40,
        """
        move: MC_MoveAbsolute position=4 velocity=0.125
        next: MC_MoveAdditive distance=2 velocity=0.5 acceleration=0.125 deceleration=0.125 jerk=0.125
        at 0: move.execute
        at 5: next.execute
        """,
        differs="""
        rounding: next.Done 21-23, next.Busy 21-23, next.Active 21-23
        """,
    ),
    Program(
        "additive move, buffered",
        "r3_motion_family: move_additive",
        60,
        """
        move: MC_MoveAbsolute position=8 velocity=0.5
        next: MC_MoveAdditive distance=2 velocity=0.5 buffer_mode=buffered
        back: MC_MoveAdditive distance=-2 velocity=0.5
        at 0: move.execute next.execute
        at 40: back.execute
        """,
    ),
    Program(
        "buffered moves",
        "r3_motion_family: buffered_chain_done_observation",
        40,
        """
        move: MC_MoveAbsolute position=1 velocity=0.25
        next: MC_MoveAbsolute position=2 velocity=0.25 buffer_mode=buffered
        at 0: move.execute next.execute
        """,
    ),
    Program(
        "three buffered moves",
        "r3_semantics: axis_buffering_and_limits",
        40,
        """
        first: MC_MoveAbsolute position=1 velocity=0.25
        second: MC_MoveRelative distance=2 velocity=0.25 buffer_mode=buffered
        third: MC_MoveRelative distance=3 velocity=0.25 buffer_mode=buffered
        at 0: first.execute second.execute third.execute
        """,
    ),
    Program(
        "blended moves",
        "r3_motion_family: velocity_threshold_blending",
        120,
        """
        move: MC_MoveAbsolute position=6 velocity=0.5 acceleration=0.0625 deceleration=0.0625 jerk=0.015625
        next: MC_MoveAbsolute position=12 velocity=0.5 acceleration=0.0625 deceleration=0.0625 jerk=0.015625 buffer_mode=blending-low
        at 0: move.execute next.execute
        """,
        differs="""
        blending: move.Done 18-19, move.Busy 18-19, move.Active 18-19, next.Done 36-47, next.Busy 36-47, next.Active 18-19 36-47
        """,
    ),
    Program(
        "absolute move in a quarter of a cycle",
        "part1_c4: position_continuous_update",
        8,
        """
        move: MC_MoveAbsolute position=0.25 velocity=1 acceleration=1 deceleration=1 jerk=1
        at 0: move.execute
        """,
        differs="""
        rounding: move.Done 2, move.Busy 2, move.Active 2
        """,
    ),
    Program(
        "positions from a table",
        "r3_profile: position_profile_timing_and_scaling",
        40,
        """
        profile: MC_PositionProfile table=10:2,20:4
        at 0: profile.execute
        """,
    ),
    Program(
        "velocities from a table",
        "r3_profile: velocity_profile",
        40,
        """
        profile: MC_VelocityProfile table=5:0.5,10:1
        state: MC_ReadStatus
        at 0: profile.execute state.enable
        """,
        differs="""
        tables: profile.ProfileCompleted 5-14, profile.Busy 15-39, profile.Active 15-39
        """,
    ),
    Program(
        "accelerations from a table",
        "part1_c4: torque_acceleration_and_set_position",
        12,
        """
        profile: MC_AccelerationProfile table=2:1,2:-0.5
        state: MC_ReadStatus
        at 0: profile.execute state.enable
        """,
        differs="""
        tables: profile.Busy 4-11, profile.Active 4-11
        """,
    ),
]
