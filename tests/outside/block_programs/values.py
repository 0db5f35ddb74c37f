"""What is read and written: states, values, parameters, inputs and outputs."""

from block_programs.program import Program

PROGRAMS = [
    Program(
        "motion state",
        "r3_io: read_motion_state",
        170,
        """
        state: MC_ReadMotionState
        run: MC_MoveVelocity velocity=0.5
        halt: MC_Halt deceleration=0.25 jerk=0.25
        move: MC_MoveRelative distance=10 velocity=0.125 acceleration=0.015625 deceleration=0.015625 jerk=0.0078125
        at 0: state.enable
        at 2: run.execute
        at 10: halt.execute
        at 20: move.execute
        at 165: state.enable=false
        """,
        differs="""
        constant at rest: state.ConstantVelocity 0-4 13-20 110-164
        velocity steps: state.Accelerating 3-4, run.InVelocity 3-4
        """,
    ),
    Program(
        "axis information",
        "r3_io: read_axis_info",
        20,
        """
        info: MC_ReadAxisInfo
        power: MC_Power
        home: MC_HomeDirect position=-2
        at 0: info.enable
        at 2: power.enable
        at 6: home.execute
        at 10: axis.input.2 axis.warning
        at 12: axis.input.1 axis.input.0 axis.input.2=false axis.warning=false
        at 14: axis.input.1=false axis.input.0=false
        at 16: info.enable=false
        """,
        differs="""
        simulation: info.Simulation 0-15
        drive: power.Status 2
        valid: power.Valid 0-1
        homing takes a cycle: home.Done 6, home.Busy 6, home.Active 6
        """,
        is_powered=False,
    ),
    Program(
        "axis information beyond a software limit",
        "r3_io: read_axis_info",
        8,
        """
        limit: MC_WriteParameter parameter=sw-limit-pos value=-1
        hold: MC_WriteBoolParameter bool_parameter=enable-limit-pos bool_value=true
        info: MC_ReadAxisInfo
        at 0: info.enable
        at 1: limit.execute hold.execute
        """,
        differs="""
        software limit: info.LimitSwitchPos 1-7
        simulation: info.Simulation 0-7
        """,
    ),
    Program(
        "digital input read",
        "r3_io: digital_io",
        12,
        """
        read: MC_ReadDigitalInput input_number=2
        at 0: axis.input.2 read.enable
        at 3: axis.input.2=false
        at 5: axis.input.2
        at 7: read.enable=false
        at 9: read.enable read.input_number=99
        """,
    ),
    Program(
        "digital input, error gone",
        "part1_c4: runtime_error_and_enable_latch",
        12,
        """
        read: MC_ReadDigitalInput input_number=99
        at 0: axis.input.2
        at 1: read.enable
        at 4: read.input_number=2
        at 7: read.enable=false
        at 9: read.enable
        """,
        differs="""
        error over: read.Valid 4-6, read.Error 4-6, read.ErrorID 4-6, read.Value 4-6
        """,
    ),
    Program(
        "digital output written",
        "r3_io: digital_io",
        14,
        """
        write: MC_WriteDigitalOutput output_number=1 bool_value=true
        read: MC_ReadDigitalOutput output_number=1
        at 0: read.enable
        at 2: write.execute
        at 5: write.execute=false
        at 6: write.execute write.bool_value=false
        at 9: write.execute=false
        at 10: write.execute write.output_number=99
        """,
    ),
    Program(
        "parameter read and written",
        "r3_parameter: parameter_facades",
        22,
        """
        read: MC_ReadParameter parameter=max-velocity-appl
        write: MC_WriteParameter parameter=max-velocity-appl value=8
        at 0: read.enable
        at 2: write.execute
        at 4: write.execute=false
        at 6: read.enable=false
        at 7: read.enable read.parameter=max-acceleration-system
        at 9: write.execute write.value=20
        at 12: write.execute=false
        at 13: read.parameter=commanded-position
        at 15: read.parameter=max-jerk-appl
        """,
        differs="""
        above the system: write.Done 9-11, write.Error 9-11, write.ErrorID 9-11
        """,
    ),
    Program(
        "parameter that pyplcopen lacks",
        "r3_parameter: parameter_facades",
        8,
        """
        read: MC_ReadParameter parameter=max-position-lag
        lag: MC_ReadBoolParameter bool_parameter=enable-pos-lag-monitoring
        at 1: read.enable lag.enable
        """,
        differs="""
        optional parameter: read.Valid 1-7, read.Error 1-7, read.ErrorID 1-7, read.Value 1-7, lag.Valid 1-7, lag.Error 1-7, lag.ErrorID 1-7
        """,
    ),
    Program(
        "parameters refused",
        "r3_parameter: numeric_parameter_write_contract",
        30,
        """
        write: MC_WriteParameter parameter=max-velocity-appl value=nan
        neg: MC_WriteBoolParameter bool_parameter=enable-limit-neg bool_value=true
        pos: MC_WriteBoolParameter bool_parameter=enable-limit-pos bool_value=true
        read: MC_ReadParameter parameter=sw-limit-pos
        at 0: write.execute
        at 2: write.execute=false
        at 3: write.execute write.value=0
        at 5: write.execute=false
        at 6: write.execute write.value=-1
        at 8: write.execute=false write.parameter=sw-limit-pos write.value=7.5
        at 9: write.execute
        at 10: write.execute=false write.parameter=sw-limit-neg write.value=-3 read.enable
        at 11: write.execute pos.execute neg.execute
        at 13: write.execute=false write.value=8
        at 14: write.execute
        at 16: write.execute=false write.parameter=sw-limit-pos write.value=-4
        at 17: write.execute
        at 19: write.execute=false write.value=8
        at 20: write.execute
        at 22: write.execute=false write.parameter=commanded-position write.value=1
        at 23: write.execute
        """,
    ),
    Program(
        "system parameter written",
        "r3_parameter: numeric_parameter_write_contract",
        5,
        """
        write: MC_WriteParameter parameter=max-velocity-system value=9
        at 1: write.execute
        """,
        differs="""
        system parameter: write.Done 1-4, write.Error 1-4, write.ErrorID 1-4
        """,
    ),
    Program(
        "bool parameter written",
        "r3_parameter: parameter_facades",
        8,
        """
        write: MC_WriteBoolParameter bool_parameter=enable-limit-pos bool_value=true
        read: MC_ReadBoolParameter bool_parameter=enable-limit-pos
        at 0: read.enable
        at 2: write.execute
        at 5: write.execute=false
        """,
    ),
    Program(
        "target beyond a software limit",
        "r3_semantics: axis_buffering_and_limits",
        12,
        """
        limit: MC_WriteParameter parameter=sw-limit-pos value=10
        hold: MC_WriteBoolParameter bool_parameter=enable-limit-pos bool_value=true
        move: MC_MoveAbsolute position=16
        at 0: limit.execute hold.execute
        at 2: move.execute
        at 5: move.execute=false
        """,
    ),
    Program(
        "actual values",
        "r3_parameter: state_read_facades",
        20,
        """
        set: MC_SetPosition position=3
        torque: MC_TorqueControl torque=1.25 velocity=5
        run: MC_MoveVelocity velocity=0.5
        position: MC_ReadActualPosition
        velocity: MC_ReadActualVelocity
        effort: MC_ReadActualTorque
        at 0: set.execute position.enable velocity.enable effort.enable
        at 2: torque.execute
        at 5: run.execute
        at 15: position.enable=false velocity.enable=false effort.enable=false
        """,
        differs="""
        torque at once: torque.InTorque 2
        velocity steps: run.InVelocity 6-7, position.Position 6-14, velocity.Velocity 6-8
        fed back: effort.Torque 3
        """,
    ),
]
