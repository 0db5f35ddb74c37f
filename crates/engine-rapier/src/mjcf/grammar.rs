//! The subset of MJCF that this engine simulates, as a table: elements, their places, and their attributes.
//!
//! Features that MuJoCo simulates and this engine does not are left out, so that they are refused by name. Features that only concern
//! looks, measurement or tuning of MuJoCo's own solver are accepted without effect.

/// An element.
pub(crate) struct Element {
    pub(crate) name: &'static str,
    /// Allowed attributes.
    pub(crate) attributes: &'static [(&'static str, Values)],
    /// Allowed child elements.
    pub(crate) children: &'static [&'static Element],
    /// True if neither the element nor its contents affect the motion: it is not examined.
    pub(crate) idle: bool,
}

/// Values that an attribute may hold.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Values {
    /// Anything: a name, or a value without effect here.
    Any,
    /// A list of numbers, from the first to the second length.
    Numbers(usize, usize),
    /// One number that is not negative.
    NotNegative,
    /// One of these words.
    OneOf(&'static [&'static str]),
}
use Values::{Any, NotNegative, Numbers, OneOf};

const fn element(
    name: &'static str,
    attributes: &'static [(&'static str, Values)],
    children: &'static [&'static Element],
) -> Element {
    Element { name, attributes, children, idle: false }
}

const fn idle(name: &'static str) -> Element {
    Element { name, attributes: &[], children: &[], idle: true }
}

/// `<mujoco>`.
pub(crate) static ROOT: Element = element(
    "mujoco",
    &[("model", Any)],
    &[
        &COMPILER, &OPTION, &DEFAULT, &WORLDBODY, &TENDON, &ACTUATOR, &CONTACT, &ASSET, &VISUAL, &STATISTIC, &SENSOR,
        &KEYFRAME, &SIZE, &CUSTOM,
    ],
);

static COMPILER: Element = element(
    "compiler",
    &[
        ("angle", OneOf(&["radian", "degree"])),
        ("coordinate", OneOf(&["local"])),
        ("eulerseq", Any),
        ("inertiafromgeom", OneOf(&["true", "false", "auto"])),
        ("autolimits", Any),
        ("meshdir", Any),
        ("texturedir", Any),
        ("assetdir", Any),
    ],
    &[],
);

static OPTION: Element = element(
    "option",
    &[
        ("gravity", Numbers(3, 3)),
        // The tick comes from the base rate, the method from this engine.
        ("timestep", Any),
        ("integrator", Any),
        ("solver", Any),
        ("iterations", Any),
        ("tolerance", Any),
        ("ls_iterations", Any),
        ("ls_tolerance", Any),
        ("cone", Any),
        ("jacobian", Any),
    ],
    &[&FLAG],
);
static FLAG: Element = element("flag", &[("contact", OneOf(&["enable", "disable"]))], &[]);

static DEFAULT: Element = element(
    "default",
    &[("class", Any)],
    &[&DEFAULT, &DEFAULT_JOINT, &DEFAULT_GEOM, &DEFAULT_MOTOR, &MATERIAL, &SITE, &CAMERA, &LIGHT],
);
static DEFAULT_JOINT: Element = element("joint", JOINT_ATTRIBUTES, &[]);
static DEFAULT_GEOM: Element = element("geom", GEOM_ATTRIBUTES, &[]);
static DEFAULT_MOTOR: Element = element("motor", &[("gear", Numbers(1, 6)), ("group", Any)], &[]);

static WORLDBODY: Element = element("worldbody", &[], &[&BODY, &GEOM, &SITE, &CAMERA, &LIGHT]);
static BODY: Element = element(
    "body",
    &[
        ("name", Any),
        ("childclass", Any),
        ("pos", Numbers(3, 3)),
        ("quat", Numbers(4, 4)),
        ("axisangle", Numbers(4, 4)),
        ("euler", Numbers(3, 3)),
        ("xyaxes", Numbers(6, 6)),
        ("zaxis", Numbers(3, 3)),
    ],
    &[&BODY, &JOINT, &INERTIAL, &GEOM, &SITE, &CAMERA, &LIGHT],
);
static INERTIAL: Element = element(
    "inertial",
    &[
        ("pos", Numbers(3, 3)),
        ("quat", Numbers(4, 4)),
        ("axisangle", Numbers(4, 4)),
        ("euler", Numbers(3, 3)),
        ("xyaxes", Numbers(6, 6)),
        ("zaxis", Numbers(3, 3)),
        ("mass", NotNegative),
        ("diaginertia", Numbers(3, 3)),
        ("fullinertia", Numbers(6, 6)),
    ],
    &[],
);

static JOINT: Element = element("joint", JOINT_ATTRIBUTES, &[]);
const JOINT_ATTRIBUTES: &[(&str, Values)] = &[
    ("name", Any),
    ("class", Any),
    ("type", OneOf(&["hinge", "slide"])),
    ("pos", Numbers(3, 3)),
    ("axis", Numbers(3, 3)),
    ("damping", NotNegative),
    ("stiffness", NotNegative),
    ("springref", Numbers(1, 1)),
    ("frictionloss", NotNegative),
    ("armature", NotNegative),
    ("limited", OneOf(&["false"])),
    ("group", Any),
];

static GEOM: Element = element("geom", PLACED_GEOM_ATTRIBUTES, &[]);
/// Attributes of a geom in `<default>`: without a place.
const GEOM_ATTRIBUTES: &[(&str, Values)] = PLACED_GEOM_ATTRIBUTES.split_at(18).0;
const PLACED_GEOM_ATTRIBUTES: &[(&str, Values)] = &[
    ("class", Any),
    ("type", OneOf(&["sphere", "capsule", "ellipsoid", "cylinder", "box", "plane"])),
    ("size", Numbers(1, 3)),
    ("mass", NotNegative),
    ("density", NotNegative),
    ("contype", Numbers(1, 1)),
    ("conaffinity", Numbers(1, 1)),
    ("rgba", Any),
    ("material", Any),
    ("group", Any),
    // Attributes of contacts; a file in which geoms can touch is refused.
    ("condim", Any),
    ("friction", Any),
    ("margin", Any),
    ("gap", Any),
    ("priority", Any),
    ("solmix", Any),
    ("solref", Any),
    ("solimp", Any),
    ("name", Any),
    ("fromto", Numbers(6, 6)),
    ("pos", Numbers(3, 3)),
    ("quat", Numbers(4, 4)),
    ("axisangle", Numbers(4, 4)),
    ("euler", Numbers(3, 3)),
    ("xyaxes", Numbers(6, 6)),
    ("zaxis", Numbers(3, 3)),
];

static TENDON: Element = element("tendon", &[], &[&FIXED]);
static FIXED: Element = element(
    "fixed",
    &[
        ("name", Any),
        ("stiffness", NotNegative),
        ("damping", NotNegative),
        ("springlength", Numbers(1, 1)),
        ("group", Any),
        ("rgba", Any),
    ],
    &[&FIXED_JOINT],
);
static FIXED_JOINT: Element = element("joint", &[("joint", Any), ("coef", Numbers(1, 1))], &[]);

static ACTUATOR: Element = element("actuator", &[], &[&MOTOR]);
static MOTOR: Element = element(
    "motor",
    &[
        ("name", Any),
        ("class", Any),
        ("joint", Any),
        ("gear", Numbers(1, 6)),
        ("ctrllimited", OneOf(&["false"])),
        ("forcelimited", OneOf(&["false"])),
        ("group", Any),
    ],
    &[],
);

static CONTACT: Element = element("contact", &[], &[&EXCLUDE]);
static EXCLUDE: Element = element("exclude", &[("name", Any), ("body1", Any), ("body2", Any)], &[]);

static ASSET: Element = element("asset", &[], &[&TEXTURE, &MATERIAL]);
static TEXTURE: Element = idle("texture");
static MATERIAL: Element = idle("material");
static SITE: Element = idle("site");
static CAMERA: Element = idle("camera");
static LIGHT: Element = idle("light");
static VISUAL: Element = idle("visual");
static STATISTIC: Element = idle("statistic");
static SENSOR: Element = idle("sensor");
static KEYFRAME: Element = idle("keyframe");
static SIZE: Element = idle("size");
static CUSTOM: Element = idle("custom");
