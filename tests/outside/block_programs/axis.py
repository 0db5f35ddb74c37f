"""Power, errors, stops, overrides and torque."""

from block_programs.program import Program

PROGRAMS = [
    Program(
        "power on and off",
        "r3_semantics: motion_facades",
        14,
        """
        power: MC_Power
        state: MC_ReadStatus
        at 0: state.enable
        at 2: power.enable
        at 8: power.enable=false
        """,
        differs="""
        drive: power.Status 2, state.Disabled 2, state.Standstill 2
        valid: power.Valid 0-1 8-13
        """,
        is_powered=False,
    ),
    Program(
        "power taken in motion",
        "r3_motion_family: motion_power_abort_observation",
        12,
        """
        power: MC_Power
        move: MC_MoveAbsolute position=3 velocity=0.125
        state: MC_ReadStatus
        at 0: power.enable state.enable
        at 1: move.execute
        at 4: power.enable=false
        at 7: move.execute=false
        """,
        differs="""
        valid: power.Valid 4-11
        """,
    ),
    Program(
        "power lost in motion",
        "part1_c4: power_loss_and_stop_lock",
        12,
        """
        power: MC_Power
        run: MC_MoveVelocity velocity=1
        state: MC_ReadStatus
        at 0: power.enable state.enable
        at 1: run.execute
        at 5: axis.power=false
        """,
        differs="""
        velocity steps: run.InVelocity 2-3
        """,
    ),
    Program(
        "power for one direction",
        "part1_c4: power_direction_and_dynamic_overrides",
        22,
        """
        power: MC_Power enable_negative=false
        down: MC_MoveVelocity velocity=-1
        up: MC_MoveVelocity velocity=1
        at 0: power.enable
        at 2: down.execute
        at 4: up.execute
        at 6: down.execute=false
        """,
        differs="""
        velocity steps: up.InVelocity 5-6
        """,
    ),
    Program(
        "permission for a direction withdrawn",
        "part1_c4: power_direction_and_dynamic_overrides",
        22,
        """
        power: MC_Power
        up: MC_MoveVelocity velocity=1
        state: MC_ReadStatus
        at 0: power.enable state.enable
        at 4: up.execute
        at 10: power.enable_positive=false
        """,
        differs="""
        permission: up.InVelocity 10, power.Valid 11-21, power.Error 11-21, power.ErrorID 11-21, up.Busy 10, up.Active 10
        permission: up.CommandAborted 10-21, up.Error 11-21, up.ErrorID 11-21, state.ErrorStop 11-21, state.Standstill 10-21
        permission: state.ContinuousMotion 10
        velocity steps: up.InVelocity 5-6
        """,
    ),
    Program(
        "stop",
        "part1_c4: power_loss_and_stop_lock",
        24,
        """
        run: MC_MoveVelocity velocity=1
        stop: MC_Stop deceleration=0.5 jerk=0.5
        move: MC_MoveAbsolute position=3
        state: MC_ReadStatus
        at 0: run.execute state.enable
        at 6: stop.execute
        at 14: move.execute
        at 16: move.execute=false
        at 18: stop.execute=false
        """,
        differs="""
        velocity steps: run.InVelocity 1-2
        """,
    ),
    Program(
        "halt",
        "r3_semantics: axis_state_and_motion",
        20,
        """
        run: MC_MoveVelocity velocity=-0.5
        halt: MC_Halt deceleration=0.25 jerk=0.25
        state: MC_ReadStatus
        at 0: run.execute state.enable
        at 6: halt.execute
        at 14: halt.execute=false
        """,
        differs="""
        velocity steps: run.InVelocity 1-2
        halt: state.Stopping 6-8, state.DiscreteMotion 6-8
        """,
    ),
    Program(
        "override lowered",
        "r3_motion_family: override_replanning",
        200,
        """
        override: MC_SetOverride
        move: MC_MoveAbsolute position=8 velocity=0.25
        at 0: override.enable move.execute
        at 20: override.velocity_factor=0.5
        """,
    ),
    Program(
        "override 0 and back",
        "r3_motion_family: override_zero_pause_resume",
        100,
        """
        override: MC_SetOverride
        move: MC_MoveAbsolute position=20 velocity=0.5
        state: MC_ReadStatus
        at 0: override.enable move.execute state.enable
        at 20: override.velocity_factor=0
        at 50: override.velocity_factor=1
        """,
    ),
    Program(
        "override of accelerations",
        "part1_c4: power_direction_and_dynamic_overrides",
        50,
        """
        override: MC_SetOverride acceleration_factor=0.5 jerk_factor=0.5
        move: MC_MoveAbsolute position=20 velocity=1
        at 0: override.enable
        at 1: move.execute
        at 30: override.acceleration_factor=0
        at 34: override.acceleration_factor=1
        at 36: override.jerk_factor=0
        at 40: override.enable=false
        """,
    ),
    Program(
        "axis error ends all commands",
        "part1_c4: axis_error_is_not_command_aborted",
        24,
        """
        move: MC_MoveAbsolute position=20
        next: MC_MoveAbsolute position=30 buffer_mode=buffered
        top: MC_MoveSuperimposed distance=1
        reset: MC_Reset
        state: MC_ReadStatus
        error: MC_ReadAxisError
        at 0: move.execute next.execute state.enable error.enable
        at 1: top.execute
        at 4: axis.fault
        at 8: axis.fault=false
        at 12: reset.execute
        at 20: reset.execute=false
        """,
        differs="""
        axis error on top: top.CommandAborted 4-23, top.Error 4-23, top.ErrorID 4-23, top.CoveredDistance 4-23
        drive: reset.Done 12, reset.Busy 12, state.ErrorStop 12, state.Standstill 12, error.AxisErrorID 12
        """,
    ),
    Program(
        "reset without an error",
        "r3_semantics: axis_state_and_motion",
        6,
        """
        reset: MC_Reset
        at 1: reset.execute
        at 4: reset.execute=false
        """,
    ),
    Program(
        "torque",
        "r3_semantics: motion_facades",
        12,
        """
        torque: MC_TorqueControl torque=3 velocity=5
        run: MC_MoveVelocity velocity=1
        state: MC_ReadStatus
        at 0: torque.execute state.enable
        at 3: torque.execute=false torque.torque=9
        at 6: run.execute
        """,
        differs="""
        torque at once: torque.InTorque 0
        velocity steps: run.InVelocity 7-8
        """,
    ),
    Program(
        "torque by a ramp",
        "part1_c4: torque_acceleration_and_set_position",
        14,
        """
        torque: MC_TorqueControl torque=2 torque_ramp=1 velocity=4 direction=negative continuous_update=true
        at 0: torque.execute
        at 6: torque.torque=1 torque.direction=positive torque.torque_ramp=0.5
        """,
    ),
    Program(
        "torque, buffered",
        "part1_c4: torque_acceleration_and_set_position",
        6,
        """
        torque: MC_TorqueControl torque=2 velocity=4 buffer_mode=buffered
        at 0: torque.execute
        """,
        differs="""
        buffered torque: torque.InTorque 1-5, torque.Busy 0-5, torque.Active 0-5, torque.Error 0-5, torque.ErrorID 0-5
        """,
    ),
]
