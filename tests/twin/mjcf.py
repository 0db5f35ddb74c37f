"""The bodies of an axis as a file of MuJoCo, as a user's own: a carriage and a load on one rail, or two rotors on one shaft."""

from verdict_classes.case import Tree

from machine import Axis


def can_be(axis: Axis) -> bool:
    """Whether there is such a file of the axis: without a transmission, gravity and end stops."""
    return axis.lead is None and axis.pmsm is None and axis.load is not None


def table(axis: Axis, file: str) -> Tree:
    """`[axis]` with that file."""
    parts = {"file": file, "motor_joint": "motor", "load_joint": "load", "actuator": "drive"}
    return {"motion": "linear" if axis.linear_axis else "rotary", "mjcf": parts}


def text(axis: Axis) -> str:
    """The file."""
    kind = "slide" if axis.linear_axis else "hinge"
    bodies = [body(name, kind, of, axis.linear_axis) for name, of in (("motor", axis.motor), ("load", axis.load))]
    joints = '<joint joint="motor" coef="1"/><joint joint="load" coef="-1"/>'
    return "\n".join(
        [
            '<mujoco model="twin">',
            '<compiler angle="radian" inertiafromgeom="false"/>',
            f'<option timestep="{1 / axis.base!r}" gravity="0 0 0" integrator="RK4"/>',
            "<worldbody>",
            *bodies,
            "</worldbody>",
            f'<tendon><fixed name="coupling" stiffness="{axis.stiffness!r}" damping="{axis.damping!r}" springlength="0">{joints}</fixed></tendon>',
            '<actuator><motor name="drive" joint="motor"/></actuator>',
            "</mujoco>",
            "",
        ]
    )


def body(name: str, kind: str, of: object, is_linear: bool) -> str:
    """One of the bodies."""
    inertia = f'mass="{of.inertia!r}" diaginertia="1 1 1"' if is_linear else f'mass="1" diaginertia="{of.inertia!r} {of.inertia!r} {of.inertia!r}"'
    friction = f' frictionloss="{of.coulomb!r}"' if of.coulomb else ""
    joint = f'<joint name="{name}" type="{kind}" axis="1 0 0" damping="{of.viscous!r}"{friction}/>'
    return f'<body name="{name}">{joint}<inertial pos="0 0 0" {inertia}/></body>'
