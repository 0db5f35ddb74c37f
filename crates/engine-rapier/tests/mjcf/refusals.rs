//! Everything that is refused, by its name, and all of it in one go.
use super::{H, effort, file, state, try_build, world};
use servobench_base::Setpoint;
use servobench_engine_rapier::Rapier;
use servobench_plant::{Actuation, Drive, Engine, Input, MechanicsError, MechanicsSetup, Model, Refusal, RefusedAt};

/// A slide with 1 kg.
const BODY: &str = r#"<body name="b"><joint name="m" type="slide" axis="1 0 0"/>
<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>"#;

/// What the file is refused for, beside the axis that it is to have.
fn refusals(xml: &str) -> Vec<String> {
    match try_build(file(xml, "m"), H, vec![]).err() {
        Some(MechanicsError::Refused { refusals, .. }) => refusals.into_iter().map(|one| one.message).collect(),
        other => panic!("{other:?}: {xml}"),
    }
}

/// The only refusal of the file, as text.
fn refusal(xml: &str) -> String {
    let all = refusals(xml);
    assert_eq!(all.len(), 1, "{xml}: {all:?}");
    all[0].clone()
}

/// `<mujoco>` with this element beside its world.
fn beside(element: &str) -> String {
    world(BODY).replace("</mujoco>", &format!("{element}</mujoco>"))
}

/// [`BODY`] with this in it.
fn inside(element: &str) -> String {
    world(&BODY.replace("</body>", &format!("{element}</body>")))
}

#[test]
fn elements_outside_the_subset_are_refused_by_name() {
    for (name, xml) in [
        ("equality", beside("<equality><weld body1='b'/></equality>")),
        ("include", beside("<include file='more.xml'/>")),
        ("extension", beside("<extension/>")),
        ("deformable", beside("<deformable/>")),
        ("spatial", beside("<tendon><spatial/></tendon>")),
        ("position", beside("<actuator><position joint='m'/></actuator>")),
        ("velocity", beside("<actuator><velocity joint='m'/></actuator>")),
        ("general", beside("<actuator><general joint='m'/></actuator>")),
        ("muscle", beside("<actuator><muscle joint='m'/></actuator>")),
        ("pair", beside("<contact><pair geom1='a' geom2='b'/></contact>")),
        ("mesh", beside("<asset><mesh file='a.stl'/></asset>")),
        ("hfield", beside("<asset><hfield name='h'/></asset>")),
        ("tendon", beside("<default><tendon/></default>")),
        ("freejoint", inside("<freejoint/>")),
        ("frame", inside("<frame/>")),
        ("composite", inside("<composite/>")),
        ("flexcomp", inside("<flexcomp/>")),
        ("replicate", inside("<replicate/>")),
        ("attach", inside("<attach/>")),
        ("plugin", inside("<plugin/>")),
        ("site", beside("<tendon><fixed><site/></fixed></tendon>")),
    ] {
        let text = refusal(&xml);
        assert!(text.starts_with("line ") && text.contains(&format!("`<{name}>`")), "{name}: {text}");
        assert!(text.contains("there can be "), "{name}: {text}");
    }
}

#[test]
fn attributes_outside_the_subset_are_refused_by_name() {
    let joint = |attribute: &str| world(&BODY.replace("<joint ", &format!("<joint {attribute} ")));
    let option = |attribute: &str| world(BODY).replace("<option ", &format!("<option {attribute} "));
    let compiler = |attribute: &str| world(BODY).replace("<compiler ", &format!("<compiler {attribute} "));
    let motor = |attribute: &str| world(BODY).replace("<motor ", &format!("<motor {attribute} "));
    let geom = |attribute: &str| inside(&format!("<geom size='0.1' {attribute}/>"));
    for (name, xml) in [
        ("range", joint("range='0 1'")),
        ("ref", joint("ref='1'")),
        ("springdamper", joint("springdamper='1 1'")),
        ("actuatorfrcrange", joint("actuatorfrcrange='0 1'")),
        ("solreffriction", joint("solreffriction='1 1'")),
        ("wind", option("wind='1 0 0'")),
        ("density", option("density='1'")),
        ("viscosity", option("viscosity='1'")),
        ("magnetic", option("magnetic='0 0 1'")),
        ("settotalmass", compiler("settotalmass='3'")),
        ("boundmass", compiler("boundmass='1'")),
        ("balanceinertia", compiler("balanceinertia='true'")),
        ("inertiagrouprange", compiler("inertiagrouprange='0 1'")),
        ("ctrlrange", motor("ctrlrange='-1 1'")),
        ("forcerange", motor("forcerange='-1 1'")),
        ("tendon", motor("tendon='t'")),
        ("site", motor("site='s'")),
        ("mesh", geom("mesh='a'")),
        ("fluidshape", geom("fluidshape='ellipsoid'")),
        ("shellinertia", geom("shellinertia='true'")),
        ("gravcomp", world(&BODY.replace("<body ", "<body gravcomp='1' "))),
        ("mocap", world(&BODY.replace("<body ", "<body mocap='true' "))),
        ("gravity", beside("<option><flag gravity='disable'/></option>")),
        ("frictionloss", beside("<tendon><fixed frictionloss='1'><joint joint='m'/></fixed></tendon>")),
        ("range", beside("<tendon><fixed range='0 1'><joint joint='m'/></fixed></tendon>")),
        ("pos", beside("<default><geom pos='0 0 1'/></default>")),
    ] {
        let text = refusal(&xml);
        assert!(text.starts_with("line ") && text.contains(&format!("attribute `{name}` of `<")), "{name}: {text}");
        assert!(text.contains("it can have "), "{name}: {text}");
    }
}

#[test]
fn values_outside_the_subset_are_refused_by_name() {
    let joint = |attribute: &str| world(&BODY.replace(r#"type="slide""#, attribute));
    for (expected, xml) in [
        (r#"`type="ball"` of `<joint>`"#, joint("type='ball'")),
        (r#"`type="free"` of `<joint>`"#, joint("type='free'")),
        (r#"`limited="true"` of `<joint>`"#, joint("limited='true'")),
        (r#"`damping="-1"` of `<joint>`"#, joint("damping='-1'")),
        (r#"`damping="stiff"` of `<joint>`"#, joint("damping='stiff'")),
        (r#"`stiffness="1 2"` of `<joint>`"#, joint("stiffness='1 2'")),
        (r#"`frictionloss="nan"` of `<joint>`"#, joint("frictionloss='nan'")),
        (r#"`armature="inf"` of `<joint>`"#, joint("armature='inf'")),
        (r#"`axis="0 0 0"` of `<joint>`"#, world(&BODY.replace("1 0 0", "0 0 0"))),
        (r#"`axis="1 0"` of `<joint>`"#, world(&BODY.replace("1 0 0", "1 0"))),
        (r#"`type="mesh"` of `<geom>`"#, inside("<geom type='mesh'/>")),
        (r#"`type="hfield"` of `<geom>`"#, inside("<geom type='hfield'/>")),
        (r#"`type="sdf"` of `<geom>`"#, inside("<geom type='sdf'/>")),
        (r#"`mass="-2"` of `<geom>`"#, inside("<geom size='1' mass='-2'/>")),
        (r#"`coordinate="global"` of `<compiler>`"#, world(BODY).replace("<compiler", "<compiler coordinate='global'")),
        (r#"`angle="grad"` of `<compiler>`"#, world(BODY).replace("radian", "grad")),
        (r#"`gravity="0 0"` of `<option>`"#, world(BODY).replace("0 0 0\"/><world", "0 0\"/><world")),
        (r#"`ctrllimited="true"` of `<motor>`"#, world(BODY).replace("<motor", "<motor ctrllimited='true'")),
        (
            r#"`springlength="-1"` of `<fixed>`"#,
            beside("<tendon><fixed springlength='-1'><joint joint='m'/></fixed></tendon>"),
        ),
        (
            r#"`springlength="0 1"` of `<fixed>`"#,
            beside("<tendon><fixed springlength='0 1'><joint joint='m'/></fixed></tendon>"),
        ),
        (r#"`class="hard"` of `<default>`"#, beside("<default class='hard'/>")),
    ] {
        let text = refusal(&xml);
        assert!(text.starts_with("line ") && text.contains(expected), "{expected}: {text}");
        assert!(text.contains("it must be "), "{expected}: {text}");
    }
}

#[test]
fn what_is_missing_is_named() {
    let tendon = beside("<tendon>\n<fixed stiffness='1'><joint joint='m'/></fixed></tendon>");
    assert_eq!(refusal(&tendon), "line 4: `<fixed>` needs the attribute `springlength`");
    let class = beside("<default><default><joint/></default></default>");
    assert!(refusal(&class).ends_with("`<default>` needs the attribute `class`"), "{}", refusal(&class));
    let unknown = world(&BODY.replace("<joint", "<joint class='hard'"));
    assert_eq!(refusal(&unknown), "there is no default class `hard`; there is `main`");
    let tendon = beside("<tendon><fixed><joint joint='q'/></fixed></tendon>");
    assert_eq!(refusal(&tendon), "there is no joint `q`; there is `m`");
}

#[test]
fn bodies_that_cannot_move_as_written_are_refused() {
    let two = refusal(&inside("<joint type='slide' axis='0 1 0'/>"));
    assert_eq!(two, "body `b` has 2 joints; one is simulated: give each further joint a body of its own");
    let no_mass = world("<body><joint name='m' type='slide'/></body>");
    assert!(refusal(&no_mass).starts_with("joint `m` moves nothing that has mass"), "{}", refusal(&no_mass));
    let no_inertia = world("<body><joint name='m'/><inertial pos='0 0 0' mass='1' diaginertia='0 0 0'/></body>");
    assert!(refusal(&no_inertia).contains("inertia about its axis"), "{}", refusal(&no_inertia));
    let in_line = format!("<body><joint name='q' type='slide' axis='1 0 0'/>{BODY}</body>");
    assert!(refusal(&world(&in_line)).contains("moves nothing"), "one of two slides in line has nothing of its own");
    let crooked = world(&BODY.replace(r#"diaginertia="1 1 1""#, r#"diaginertia="1 1 3""#));
    assert!(refusal(&crooked).contains("none exceeds the sum of the other two"), "{}", refusal(&crooked));
    let negative = world(&BODY.replace(r#"diaginertia="1 1 1""#, r#"fullinertia="1 1 1 2 0 0""#));
    assert!(refusal(&negative).contains("not negative"), "{}", refusal(&negative));
}

#[test]
fn geoms_that_could_touch_are_refused_with_three_ways_out() {
    let geom = "<geom size='0.1'/>";
    let text = refusal(&inside(geom).replace("<worldbody>", &format!("<worldbody>{geom}")));
    assert!(text.starts_with("geoms of body `world` and body `b` could touch"), "{text}");
    assert!(
        text.contains("contype=\"0\"") && text.contains("exclude") && text.contains("contact=\"disable\""),
        "{text}"
    );
}

#[test]
fn every_mistake_is_found_in_one_go_with_its_line() {
    let xml = "<mujoco>\n<equality/>\n<worldbody><body>\n<joint type='ball' range='0 1'/></body></worldbody></mujoco>";
    let all = refusals(xml);
    assert_eq!(all.len(), 3, "{all:?}");
    assert!(all[0].starts_with("line 2: `<equality>` in `<mujoco>`"), "{all:?}");
    assert!(all[1].starts_with("line 4: `type=\"ball\"`"), "{all:?}");
    assert!(all[2].starts_with("line 4: attribute `range`"), "{all:?}");
}

/// What reads the file calls itself for each of them: 700 bodies have ended the program. The thread of a test has 2 MiB of stack, as those
/// of a suite have.
#[test]
fn elements_within_elements_without_end_are_refused_at_their_line() {
    let nested = |element: &str, count: usize| {
        let (open, close) = (format!("\n<{element}>").repeat(count), format!("</{element}>").repeat(count));
        format!("{open}{close}")
    };
    for count in [101, 700, 20_000] {
        let deep = format!("<mujoco><worldbody>{}</worldbody></mujoco>", nested("body", count));
        let said = refusal(&deep);
        assert!(said.starts_with("line 100: `<body>` is nested more than 100 elements deep"), "{said}");
        let said = refusal(&format!(
            "<mujoco>{}</mujoco>",
            nested("default class='a'", count).replace("</default class='a'>", "</default>")
        ));
        assert!(said.starts_with("line 101: `<default>` is nested more than 100"), "{said}");
    }
    // Bodies beside each other are not deep, and as many within each other as there may be are simulated.
    let massive = "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>";
    let rigid = format!("<body>{massive}").repeat(95) + &"</body>".repeat(95);
    try_build(file(&inside(&rigid), "m"), H, vec![]).unwrap();
    try_build(file(&inside(&format!("<body>{massive}</body>").repeat(500)), "m"), H, vec![]).unwrap();
}

#[test]
fn what_is_no_mjcf_is_refused() {
    for (xml, said) in [("<mujoco>", "axis.xml: "), ("<robot/>", "the root element is <robot>")] {
        match try_build(file(xml, "m"), H, vec![]).err() {
            Some(MechanicsError::Model { message, .. }) => assert!(message.contains(said), "{message}"),
            other => panic!("{other:?}: {xml}"),
        }
    }
}

#[test]
fn the_parts_of_the_axis_must_be_there() {
    let refused = |xml: &str, change: fn(&mut servobench_plant::MjcfModel)| {
        let mut model = file(xml, "m");
        change(&mut model);
        match try_build(model, H, vec![]).err() {
            Some(MechanicsError::Refused { refusals, .. }) => refusals,
            other => panic!("{other:?}"),
        }
    };
    let named = |name: &str, message: &str| Refusal { place: RefusedAt::Name(name.into()), message: message.into() };
    let xml = world(BODY);
    let load = refused(&xml, |model| model.load_joint = "q".into());
    assert_eq!(load, [named("q", "there is no joint `q`; there is `m`")]);
    let motor = refused(&xml, |model| model.actuator = "v".into());
    assert_eq!(motor, [named("v", "there is no motor `v`; there is `u`")]);
    let idle = refused(&world(BODY).replace("gravity", "integrator").replace("<motor", "<motor gear='0'"), |_| {});
    assert!(idle[0].message.starts_with("motor `u` has no gear") && idle[0].place == RefusedAt::Name("u".into()));
    let other = world(&format!("{BODY}{}", BODY.replace("\"m\"", "\"q\""))).replace("joint=\"m\"/>", "joint=\"q\"/>");
    assert!(refused(&other, |_| {})[0].message.starts_with("motor `u` acts on joint `q`; it must act on joint `m`"));
    let light = world(&BODY.replace("mass=\"1\"", "mass=\"0\""));
    let both = refused(&light, |model| model.actuator = "v".into());
    assert_eq!(both.iter().map(|one| &one.place).collect::<Vec<_>>(), [&RefusedAt::Name("v".into()), &RefusedAt::File]);
}

#[test]
fn the_engine_says_the_same_and_names_the_file() {
    let setup =
        |drive, xml: &str| MechanicsSetup { model: Model::Mjcf(file(xml, "m")), drive, step: H, initial: vec![] };
    let error = Rapier.build(&setup(Drive::Effort, &beside("\n<equality/>"))).err().unwrap();
    let text = error.to_string();
    assert!(text.contains("axis.xml: line 4: `<equality>`") && text.contains("`mujoco`"), "{text}");
    let MechanicsError::Refused { refusals, .. } = error else { panic!("{text}") };
    assert_eq!(refusals[0].place, RefusedAt::Line(4));
    let error = Rapier.build(&setup(Drive::Effort, "<mujoco>")).err().unwrap();
    assert!(matches!(&error, MechanicsError::Model { message, .. } if message.starts_with("axis.xml: ")), "{error}");
    let error = Rapier.build(&setup(Drive::Prescribed, &world(BODY))).err().unwrap().to_string();
    assert!(error.contains("a prescribed motion of an MJCF model"), "{error}");
}

#[test]
fn a_run_ends_when_it_leaves_the_finite_numbers() {
    let build = || try_build(file(&world(BODY), "m"), H, vec![state(0.0, 0.0)]).unwrap();
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(matches!(build().advance(&effort(bad)), Err(MechanicsError::Diverged { .. })), "{bad}");
    }
    let mut axis = build();
    let end = (0..100_000).find_map(|_| axis.advance(&effort(1e308)).err());
    assert!(matches!(end, Some(MechanicsError::Diverged { .. })), "{end:?}");
    let motion = Actuation::Motion(Setpoint::default());
    let input = Input { actuation: motion, motor_disturbance: 0.0, load_disturbance: 0.0 };
    assert!(matches!(build().advance(&input), Err(MechanicsError::Unsupported { .. })));
}
