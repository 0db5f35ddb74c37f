"""Every command in every state, aborting and buffered."""

from block_programs.program import Program

TEST = "state_transition_matrix: axis_submit_admissibility_matrix"
# With BufferMode, and without.
BUFFERED = {
    "MC_MoveAbsolute": "position=12",
    "MC_MoveRelative": "distance=6",
    "MC_MoveAdditive": "distance=6",
    "MC_MoveVelocity": "velocity=1",
    "MC_MoveContinuousAbsolute": "position=12 end_velocity=0.5",
    "MC_MoveContinuousRelative": "distance=6 end_velocity=0.5",
    "MC_Halt": "deceleration=0.5 jerk=0.5",
    "MC_TorqueControl": "torque=2 velocity=5",
    "MC_HomeDirect": "position=3",
}
OTHERS = {
    "MC_Stop": "deceleration=0.5 jerk=0.5",
    "MC_MoveSuperimposed": "distance=2 velocity_difference=0.5",
    "MC_HaltSuperimposed": "deceleration=0.5 jerk=0.5",
    "MC_SetPosition": "position=3",
    "MC_Reset": "",
}
COMMANDS = [(f"{block}{mode}", block, inputs + mode) for mode in ("", " buffer_mode=buffered") for block, inputs in BUFFERED.items()]
COMMANDS += [(block, block, inputs) for block, inputs in OTHERS.items()]
# States in which commands are accepted: how the axis gets there, and when.
ACCEPTING = {
    "Standstill": ("", 2),
    "Discrete Motion": ("first: MC_MoveAbsolute position=8\nat 0: first.execute", 4),
    "Continuous Motion": ("first: MC_MoveContinuousRelative distance=4 end_velocity=0.5\nat 0: first.execute", 9),
}
# States in which they are refused, but for what pyplcopen accepts and then is in another state.
REFUSING = {
    "Disabled": ("", 2),
    "Stopping": ("first: MC_MoveAbsolute position=20\nstop: MC_Stop deceleration=0.5 jerk=0.5\nat 0: first.execute\nat 5: stop.execute", 6),
    "ErrorStop": ("at 0: axis.fault", 2),
}
# What differs, by state and command.
DIFFERS: dict[str, str] = {
    "commands in Disabled": """
        done and error: command17.Done 20-29
    """,
    "commands in Stopping": """
        nothing on top: command17.Done 23-33, command17.Error 23-33, command17.ErrorID 23-33
    """,
    "commands in ErrorStop": """
        done and error: command17.Done 20-29
        drive: command19.Done 21, command19.Busy 21, state.ErrorStop 21, state.Standstill 21
    """,
    "MC_HomeDirect in Disabled": """
        homing elsewhere: command.Done 2-33, command.Error 2-33, command.ErrorID 2-33
    """,
    "MC_HomeDirect in Stopping": """
        homing elsewhere: stop.Done 8-37, stop.Busy 7, stop.CommandAborted 7-37, command.Done 6-37, command.Error 6-37, command.ErrorID 6-37
        homing elsewhere: state.Stopping 6-37, state.Standstill 6-37
    """,
    "MC_Stop in Stopping": """
        stopping: stop.Done 8-37, stop.Busy 7, stop.CommandAborted 7-37, command.Done 9-37, command.Busy 6-8, command.Error 6-37
        stopping: command.ErrorID 6-37
    """,
    "MC_MoveSuperimposed in Stopping": """
        stopping: command.Done 13-37, command.Busy 6-12, command.Error 6-37, command.ErrorID 6-37, command.CoveredDistance 7-37
    """,
    "MC_MoveVelocity in Standstill": """
        velocity steps: command.InVelocity 3-4
    """,
    "MC_Halt in Standstill": """
        halt: state.Stopping 2, state.DiscreteMotion 2
    """,
    "MC_TorqueControl in Standstill": """
        torque at once: command.InTorque 2
    """,
    "MC_HomeDirect in Standstill": """
        homing takes a cycle: command.Done 2, command.Busy 2, command.Active 2, state.Homing 2, state.Standstill 2
    """,
    "MC_MoveVelocity, buffered in Standstill": """
        velocity steps: command.InVelocity 3-4
    """,
    "MC_Halt, buffered in Standstill": """
        halt: state.Stopping 2, state.DiscreteMotion 2
    """,
    "MC_TorqueControl, buffered in Standstill": """
        buffered torque: command.InTorque 3-33, command.Busy 2-33, command.Active 2-33, command.Error 2-33, command.ErrorID 2-33
        buffered torque: state.Standstill 2-33, state.ContinuousMotion 2-33
    """,
    "MC_HomeDirect, buffered in Standstill": """
        buffered homing: command.Done 3-33, command.Busy 2, command.Active 2, command.Error 2-33, command.ErrorID 2-33, state.Homing 2
        buffered homing: state.Standstill 2
    """,
    "MC_MoveSuperimposed in Standstill": """
        standstill on top: state.Standstill 2, state.DiscreteMotion 2
    """,
    "MC_MoveRelative in Discrete Motion": """
        rounding: command.Done 12-13, command.Busy 12-13, command.Active 12-13, state.Standstill 12-13, state.DiscreteMotion 12-13
    """,
    "MC_MoveVelocity in Discrete Motion": """
        velocity steps: command.InVelocity 4
    """,
    "MC_Halt in Discrete Motion": """
        halt: state.Stopping 4-6, state.DiscreteMotion 4-6
    """,
    "MC_TorqueControl in Discrete Motion": """
        torque at once: command.InTorque 4
    """,
    "MC_HomeDirect in Discrete Motion": """
        homing elsewhere: first.Done 11-35, first.Busy 5-10, first.Active 5-10, first.CommandAborted 5-35, command.Done 4-35
        homing elsewhere: command.Error 4-35, command.ErrorID 4-35, state.Standstill 4-10, state.DiscreteMotion 4-10
    """,
    "MC_MoveVelocity, buffered in Discrete Motion": """
        velocity steps: command.InVelocity 12-13
    """,
    "MC_MoveContinuousAbsolute, buffered in Discrete Motion": """
        waits as aborted: command.Busy 4-10, command.CommandAborted 4-35
    """,
    "MC_MoveContinuousRelative, buffered in Discrete Motion": """
        waits as aborted: command.Busy 4-10, command.CommandAborted 4-35
    """,
    "MC_Halt, buffered in Discrete Motion": """
        halt: state.Stopping 11, state.DiscreteMotion 11
    """,
    "MC_TorqueControl, buffered in Discrete Motion": """
        buffered torque: command.InTorque 12-35, command.Busy 4-35, command.Active 11-35, command.Error 4-35, command.ErrorID 4-35
        buffered torque: state.Standstill 11-35, state.ContinuousMotion 11-35
    """,
    "MC_HomeDirect, buffered in Discrete Motion": """
        buffered homing: command.Done 12-35, command.Busy 4-11, command.Active 11, command.Error 4-35, command.ErrorID 4-35
        buffered homing: state.Homing 11, state.Standstill 11
    """,
    "MC_MoveAbsolute in Continuous Motion": """
        rounding: command.Done 18-19, command.Busy 18-19, command.Active 18-19, state.Standstill 18-19, state.DiscreteMotion 18-19
    """,
    "MC_MoveVelocity in Continuous Motion": """
        velocity steps: command.InVelocity 10
    """,
    "MC_Halt in Continuous Motion": """
        halt: state.Stopping 9-10, state.DiscreteMotion 9-10
    """,
    "MC_TorqueControl in Continuous Motion": """
        torque at once: command.InTorque 9
    """,
    "MC_HomeDirect in Continuous Motion": """
        homing elsewhere: first.InEndVelocity 10-40, first.Busy 10-40, first.Active 10-40, first.CommandAborted 10-40, command.Done 9-40
        homing elsewhere: command.Error 9-40, command.ErrorID 9-40, state.Standstill 9-40, state.ContinuousMotion 9-40
    """,
    "MC_MoveAbsolute, buffered in Continuous Motion": """
        behind an endless one: first.InEndVelocity 10-40, first.Busy 10-40, first.Active 10-40, first.CommandAborted 10-40
        behind an endless one: command.Done 18-40
        behind an endless one: command.Busy 18-40, command.Active 10-17, state.Standstill 18-40, state.DiscreteMotion 10-17
        behind an endless one: state.ContinuousMotion 10-40
    """,
    "MC_MoveRelative, buffered in Continuous Motion": """
        behind an endless one: first.InEndVelocity 10-40, first.Busy 10-40, first.Active 10-40, first.CommandAborted 10-40
        behind an endless one: command.Done 18-40
        behind an endless one: command.Busy 18-40, command.Active 10-17, state.Standstill 18-40, state.DiscreteMotion 10-17
        behind an endless one: state.ContinuousMotion 10-40
    """,
    "MC_MoveAdditive, buffered in Continuous Motion": """
        behind an endless one: first.InEndVelocity 10-40, first.Busy 10-40, first.Active 10-40, first.CommandAborted 10-40
        behind an endless one: command.Done 18-40
        behind an endless one: command.Busy 18-40, command.Active 10-17, state.Standstill 18-40, state.DiscreteMotion 10-17
        behind an endless one: state.ContinuousMotion 10-40
    """,
    "MC_MoveVelocity, buffered in Continuous Motion": """
        behind an endless one: first.InEndVelocity 10-40, first.Busy 10-40, first.Active 10-40, first.CommandAborted 10-40
        behind an endless one: command.InVelocity 12-40, command.Active 10-40
    """,
    "MC_MoveContinuousAbsolute, buffered in Continuous Motion": """
        behind an endless one: first.InEndVelocity 10-40, first.Busy 10-40, first.Active 10-40, first.CommandAborted 10-40
        behind an endless one: command.InEndVelocity 17-40, command.Active 10-40
        waits as aborted: command.Busy 9-40, command.CommandAborted 9-40
    """,
    "MC_MoveContinuousRelative, buffered in Continuous Motion": """
        behind an endless one: first.InEndVelocity 10-40, first.Busy 10-40, first.Active 10-40, first.CommandAborted 10-40
        behind an endless one: command.InEndVelocity 17-40, command.Active 10-40
        waits as aborted: command.Busy 9-40, command.CommandAborted 9-40
    """,
    "MC_Halt, buffered in Continuous Motion": """
        behind an endless one: first.InEndVelocity 10-40, first.Busy 10-40, first.Active 10-40, first.CommandAborted 10-40
        behind an endless one: command.Done 12-40
        behind an endless one: command.Busy 12-40, command.Active 10-11, state.Standstill 12-40, state.DiscreteMotion 10-11
        behind an endless one: state.ContinuousMotion 10-40
    """,
    "MC_TorqueControl, buffered in Continuous Motion": """
        behind an endless one: first.InEndVelocity 10-40, first.Busy 10-40, first.Active 10-40, first.CommandAborted 10-40
        buffered torque: command.InTorque 11-40, command.Busy 9-40, command.Active 10-40, command.Error 9-40, command.ErrorID 9-40
    """,
    "MC_MoveSuperimposed in Continuous Motion": """
        on top of a velocity: first.InEndVelocity 10-15
    """,
}


TAKEN = ("MC_HomeDirect", "MC_Stop", "MC_MoveSuperimposed")


def single(state: str, name: str, block: str, inputs: str) -> Program:
    """One command in a state."""
    setup, cycle = (ACCEPTING | REFUSING)[state]
    lines = f"{setup}\ncommand: {block} {inputs}\nstate: MC_ReadStatus\nat 0: state.enable\nat {cycle}: command.execute"
    title = f"{name.replace(' buffer_mode=buffered', ', buffered')} in {state}"
    return Program(title, TEST, cycle + 32, lines, DIFFERS.get(title, ""), is_powered=state != "Disabled")


def refused(state: str) -> Program:
    """The other commands in a state, one in each cycle."""
    setup, cycle = REFUSING[state]
    commands = [command for command in COMMANDS if command[0] not in TAKEN]
    blocks = "\n".join(f"command{k}: {block} {inputs}" for k, (_, block, inputs) in enumerate(commands))
    executions = "\n".join(f"at {cycle + k}: command{k}.execute" for k in range(len(commands)))
    lines = f"{setup}\n{blocks}\nstate: MC_ReadStatus\nat 0: state.enable\n{executions}"
    title = f"commands in {state}"
    cycles = cycle + len(commands) + 8
    return Program(title, TEST, cycles, lines, DIFFERS.get(title, ""), is_powered=state != "Disabled")


PROGRAMS = [refused(state) for state in REFUSING]
PROGRAMS += [single(state, *command) for state in REFUSING for command in COMMANDS if command[0] in TAKEN]
PROGRAMS += [single(state, *command) for state in ACCEPTING for command in COMMANDS]
