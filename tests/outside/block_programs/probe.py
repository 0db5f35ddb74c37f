"""Touch probe."""

from block_programs.program import Program

PROGRAMS = [
    Program(
        "touch probe",
        "r3_probe: touch_probe_capture",
        40,
        """
        move: MC_MoveAbsolute position=4 velocity=0.0625
        probe: MC_TouchProbe trigger_input=home-switch-met
        at 0: probe.execute
        at 1: move.execute
        at 9: axis.input.2
        at 12: probe.execute=false
        at 13: probe.execute
        at 16: axis.input.2=false
        at 18: axis.input.2
        """,
        differs="""
        recorded: probe.RecordedPosition 9-39
        """,
    ),
    Program(
        "touch probe at rest",
        "r3_probe: touch_probe_capture",
        14,
        """
        set: MC_SetPosition position=3
        probe: MC_TouchProbe trigger_input=index-pulse
        at 0: set.execute
        at 2: probe.execute
        at 5: axis.input.3
        at 8: probe.execute=false
        """,
        differs="""
        recorded: probe.RecordedPosition 8-13
        """,
    ),
    Program(
        "touch probe aborted",
        "r3_probe: abort_trigger",
        12,
        """
        probe: MC_TouchProbe trigger_input=home-switch-met
        abort: MC_AbortTrigger
        at 0: abort.execute
        at 2: abort.execute=false probe.execute
        at 4: abort.execute
        at 7: probe.execute=false
        at 8: abort.execute=false
        """,
    ),
    Program(
        "touch probes on two triggers",
        "r3_probe: independent_probes",
        12,
        """
        first: MC_TouchProbe trigger_input=home-switch-met
        second: MC_TouchProbe trigger_input=index-pulse
        at 0: first.execute second.execute
        at 3: axis.input.3
        at 6: axis.input.2
        """,
        differs="""
        one probe: first.Done 6-11, first.Busy 1-5, first.CommandAborted 1-11
        """,
    ),
    Program(
        "touch probe with a window",
        "r3_probe: window_only",
        80,
        """
        move: MC_MoveAbsolute position=4 velocity=0.03125
        probe: MC_TouchProbe trigger_input=home-switch-met first_position=1 last_position=2
        wrong: MC_TouchProbe trigger_input=index-pulse first_position=2 last_position=1
        at 0: probe.execute
        at 1: move.execute
        at 14: axis.input.2
        at 62: axis.input.2=false
        at 63: axis.input.2
        at 70: wrong.execute
        """,
        differs="""
        recorded: probe.RecordedPosition 63-79
        """,
    ),
    Program(
        "touch probe, Execute gone",
        "r3_probe: probe_error_paths",
        8,
        """
        probe: MC_TouchProbe trigger_input=home-switch-met
        at 0: probe.execute
        at 1: probe.execute=false
        at 3: axis.input.2
        """,
    ),
]
