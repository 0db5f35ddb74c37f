"""Continuous moves and velocities."""

from block_programs.program import Program

PROGRAMS = [
    Program(
        "continuous move by a distance",
        "r3_motion_family: move_continuous_relative_and_update",
        60,
        """
        set: MC_SetPosition position=1
        move: MC_MoveContinuousRelative distance=2 velocity=0.25 end_velocity=0.125
        state: MC_ReadStatus
        at 0: set.execute state.enable
        at 1: set.execute=false
        at 2: move.execute
        at 40: move.execute=false
        """,
    ),
    Program(
        "continuous move, taken over",
        "r3_motion_family: move_continuous",
        120,
        """
        move: MC_MoveContinuousAbsolute position=4 velocity=0.25 end_velocity=0.125
        takeover: MC_MoveAbsolute position=3 velocity=0.5 acceleration=0.125 deceleration=0.125 jerk=0.125
        state: MC_ReadStatus
        at 0: move.execute state.enable
        at 60: takeover.execute
        """,
        differs="""
        rounding: takeover.Done 79-84, takeover.Busy 79-84, takeover.Active 79-84, state.Standstill 79-84
        rounding: state.DiscreteMotion 79-84
        """,
    ),
    Program(
        "continuous move, target changed",
        "r3_motion_family: move_continuous_relative_and_update",
        140,
        """
        move: MC_MoveContinuousAbsolute position=4 velocity=0.125 end_velocity=0.0625 continuous_update=true
        at 0: move.execute
        at 10: move.position=7
        """,
    ),
    Program(
        "continuous move, distance changed",
        "r3_motion_family: move_continuous_relative_and_update",
        140,
        """
        move: MC_MoveContinuousRelative distance=4 velocity=0.125 end_velocity=0.0625 continuous_update=true
        at 0: move.execute
        at 10: move.distance=7
        """,
    ),
    Program(
        "continuous move, end velocity 0",
        "r3_motion_family: move_continuous_relative_and_update",
        60,
        """
        move: MC_MoveContinuousRelative distance=5 velocity=0.25 end_velocity=0
        at 0: move.execute
        """,
        differs="""
        end velocity 0: move.InEndVelocity 23-59, move.Busy 0-59, move.Active 0-59, move.Error 0-59, move.ErrorID 0-59
        """,
    ),
    Program(
        "continuous move downwards, override",
        "part1_c4: relative_additive_and_signed_inputs",
        40,
        """
        override: MC_SetOverride
        move: MC_MoveContinuousAbsolute position=-3 velocity=1 end_velocity=-0.5
        at 0: move.execute
        at 20: move.execute=false move.end_velocity=5
        at 24: override.enable override.velocity_factor=0.5
        """,
        differs="""
        velocity steps: move.InEndVelocity 25
        """,
    ),
    Program(
        "continuous move, update not a number",
        "r3_motion_family: motion_invalid_updates",
        12,
        """
        move: MC_MoveContinuousAbsolute position=4 velocity=0.25 end_velocity=0.125 continuous_update=true
        state: MC_ReadStatus
        at 0: move.execute state.enable
        at 3: move.position=nan
        """,
        differs="""
        stops at an error: state.Standstill 3-11, state.ContinuousMotion 3-11
        """,
    ),
    Program(
        "velocity",
        "r3_motion_family: move_velocity_continuous_update",
        16,
        """
        run: MC_MoveVelocity velocity=0.5
        state: MC_ReadStatus
        at 0: run.execute state.enable
        at 10: run.execute=false
        """,
        differs="""
        velocity steps: run.InVelocity 1-2
        """,
    ),
    Program(
        "velocity, changed",
        "r3_motion_family: move_velocity_continuous_update",
        24,
        """
        run: MC_MoveVelocity velocity=0.5 continuous_update=true
        at 0: run.execute
        at 10: run.velocity=0.2 run.direction=negative
        """,
        differs="""
        velocity steps: run.InVelocity 1-2 11-13
        """,
    ),
    Program(
        "velocity, late ContinuousUpdate",
        "part1_c4: continuous_update_permission_is_edge_latched",
        24,
        """
        run: MC_MoveVelocity velocity=1
        at 0: run.execute
        at 10: run.velocity=3 run.continuous_update=true
        """,
        differs="""
        velocity steps: run.InVelocity 1-2
        """,
    ),
    Program(
        "velocity taken over by its own instance",
        "part1_c4: continuous_update_permission_is_edge_latched",
        40,
        """
        run: MC_MoveVelocity velocity=1
        other: MC_MoveVelocity velocity=1
        at 0: run.execute
        at 6: run.execute=false
        at 8: other.execute
        at 16: run.execute run.velocity=2 run.continuous_update=true
        at 24: run.velocity=4
        """,
        differs="""
        velocity steps: run.InVelocity 1-2 17-18 25-28, other.InVelocity 8
        """,
    ),
    Program(
        "velocity with two signs",
        "part1_c4: relative_additive_and_signed_inputs",
        40,
        """
        override: MC_SetOverride
        run: MC_MoveVelocity velocity=-2 direction=negative
        shortest: MC_MoveVelocity velocity=1 direction=shortest
        at 0: run.execute
        at 10: run.velocity=5
        at 12: override.enable override.velocity_factor=0.5
        at 30: run.execute=false
        at 32: shortest.execute
        """,
        differs="""
        velocity steps: run.InVelocity 1-2 13
        """,
    ),
    Program(
        "velocity, update 0",
        "r3_motion_family: motion_invalid_updates",
        12,
        """
        run: MC_MoveVelocity velocity=0.25 continuous_update=true
        state: MC_ReadStatus
        at 0: run.execute state.enable
        at 3: run.velocity=0
        """,
        differs="""
        update 0: run.InVelocity 6-11, run.Busy 3-11, run.Active 3-11, run.Error 3-11, run.ErrorID 3-11, state.Standstill 3-11
        update 0: state.ContinuousMotion 3-11
        velocity steps: run.InVelocity 1-2
        """,
    ),
    Program(
        "velocity taken over",
        "r3_motion_family: motion_takeover_observation",
        24,
        """
        run: MC_MoveVelocity velocity=0.25 continuous_update=true
        move: MC_MoveAbsolute position=2 velocity=0.25
        at 0: run.execute
        at 4: move.execute
        """,
        differs="""
        velocity steps: run.InVelocity 1-2
        """,
    ),
    Program(
        "velocity, update refused before a buffered move",
        "part1_c4: runtime_error_and_enable_latch",
        20,
        """
        run: MC_MoveVelocity velocity=1 acceleration=0.125 continuous_update=true
        next: MC_MoveAbsolute position=40 buffer_mode=buffered
        at 0: run.execute
        at 1: next.execute
        at 2: run.velocity=nan
        """,
        differs="""
        velocity steps: run.InVelocity 1
        next takes over: next.Active 2-8
        """,
    ),
]
