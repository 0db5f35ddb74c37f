"""Homing without a motion, and positions that are set."""

from block_programs.program import Program

PROGRAMS = [
    Program(
        "home direct",
        "part5_homing: step_direct_basic",
        8,
        """
        home: MC_HomeDirect position=42
        read: MC_ReadActualPosition
        state: MC_ReadStatus
        at 0: read.enable state.enable
        at 1: home.execute
        at 4: home.execute=false
        """,
        differs="""
        homing takes a cycle: home.Done 1, home.Busy 1, home.Active 1, read.Position 1, state.Homing 1, state.Standstill 1
        """,
    ),
    Program(
        "home direct in motion",
        "part5_homing: step_direct_aborting_takeover",
        8,
        """
        move: MC_MoveAbsolute position=10 velocity=0.125
        home: MC_HomeDirect position=2
        state: MC_ReadStatus
        at 0: state.enable move.execute
        at 2: home.execute
        at 5: home.execute=false
        """,
        differs="""
        homing elsewhere: move.Busy 3-7, move.Active 3-7, move.CommandAborted 3-7, home.Done 2-4, home.Error 2-4, home.ErrorID 2-4
        homing elsewhere: state.Standstill 2-7, state.DiscreteMotion 2-7
        """,
    ),
    Program(
        "home direct in ErrorStop",
        "part5_homing: step_direct_rejects_errorstop_until_reset",
        20,
        """
        home: MC_HomeDirect position=42
        reset: MC_Reset
        state: MC_ReadStatus
        at 0: state.enable
        at 2: axis.fault
        at 4: home.execute
        at 6: home.execute=false axis.fault=false
        at 7: reset.execute
        at 14: home.execute
        """,
        differs="""
        homing takes a cycle: home.Done 14, home.Busy 14, home.Active 14, state.Homing 14
        drive: reset.Done 7, reset.Busy 7, state.ErrorStop 7, state.Standstill 7 14
        """,
    ),
    Program(
        "home direct, buffered",
        "part5_c5: home_direct_finalizes_homing",
        6,
        """
        home: MC_HomeDirect position=42 buffer_mode=buffered
        at 1: home.execute
        """,
        differs="""
        buffered homing: home.Done 2-5, home.Busy 1, home.Active 1, home.Error 1-5, home.ErrorID 1-5
        """,
    ),
    Program(
        "home absolute",
        "part5_homing: home_absolute_source_contract",
        10,
        """
        set: MC_SetPosition position=5
        home: MC_HomeAbsolute
        info: MC_ReadAxisInfo
        read: MC_ReadActualPosition
        at 0: read.enable info.enable set.execute
        at 3: home.execute
        at 7: home.execute=false
        """,
        differs="""
        homing takes a cycle: home.Done 3, home.Busy 3, home.Active 3, info.IsHomed 3, read.Position 3
        simulation: info.Simulation 0-9
        """,
    ),
    Program(
        "home absolute in motion",
        "part5_homing: home_absolute_zero_and_active_takeover",
        8,
        """
        move: MC_MoveAbsolute position=10 velocity=0.125
        home: MC_HomeAbsolute
        at 0: move.execute
        at 2: home.execute
        """,
        differs="""
        homing elsewhere: move.Busy 3-7, move.Active 3-7, move.CommandAborted 3-7, home.Done 2-7, home.Error 2-7, home.ErrorID 2-7
        """,
    ),
    Program(
        "home absolute, buffered",
        "part5_homing: home_absolute_rejects_unsupported_buffer_mode",
        6,
        """
        home: MC_HomeAbsolute buffer_mode=buffered
        at 1: home.execute
        """,
        differs="""
        buffered homing: home.Done 2-5, home.Busy 1, home.Active 1, home.Error 1-5, home.ErrorID 1-5
        """,
    ),
    Program(
        "position set",
        "r3_parameter: set_position",
        24,
        """
        set: MC_SetPosition position=10
        run: MC_MoveVelocity velocity=0.5
        read: MC_ReadActualPosition
        at 0: set.execute read.enable
        at 3: set.execute=false set.position=-1.5 set.relative=true
        at 4: set.execute
        at 6: set.execute=false
        at 8: run.execute
        at 12: set.execute set.position=0 set.relative=false
        """,
        differs="""
        velocity steps: run.InVelocity 9-10, read.Position 9-11
        """,
    ),
    Program(
        "position set in a move",
        "part1_c4: torque_acceleration_and_set_position",
        30,
        """
        move: MC_MoveAbsolute position=10
        set: MC_SetPosition position=100
        state: MC_ReadStatus
        at 0: move.execute state.enable
        at 3: set.execute
        """,
    ),
]
