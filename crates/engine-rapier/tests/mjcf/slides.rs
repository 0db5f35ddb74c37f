//! A table with a flexible load on it: bodies in bodies, springs and dampers in joints.
use super::{H, build, effort, state, world};
use nalgebra::{DMatrix, DVector, dvector};
use servobench_plant::BodyState;

/// 20 kg on slide `m` (10 N·s/m to the ground), and on it 10 kg on slide `load` (6e5 N/m).
fn nested(damping: f64) -> String {
    world(&format!(
        r#"<body><joint name="m" type="slide" axis="1 0 0" damping="10"/>
             <inertial pos="0 0 0" mass="20" diaginertia="1 1 1"/>
             <body pos="0 0 0.2"><joint name="load" type="slide" axis="1 0 0" stiffness="6e5" springref="2e-4" damping="{damping}"/>
               <inertial pos="0 0 0" mass="10" diaginertia="1 1 1"/>
           </body></body>"#
    ))
}

/// Table and load after `end` seconds under constant forces on both, by the matrix exponential.
fn exact(damping: f64, forces: [f64; 2], initial: &[BodyState; 2], end: f64) -> DVector<f64> {
    // 20·x1'' = f1 + c·(s − rest) + d·s' − 10·x1', 10·x2'' = f2 − c·(s − rest) − d·s', stretch s = x2 − x1.
    let mut a = DMatrix::<f64>::zeros(5, 5);
    a[(0, 2)] = 1.0;
    a[(1, 3)] = 1.0;
    for (row, mass, sign, force) in [(2, 20.0, 1.0, forces[0]), (3, 10.0, -1.0, forces[1])] {
        for (column, gain) in [(1, 6e5), (0, -6e5), (3, damping), (2, -damping)] {
            a[(row, column)] = sign * gain / mass;
        }
        a[(row, 4)] = (force - sign * 6e5 * 2e-4) / mass;
    }
    a[(2, 2)] -= 10.0 / 20.0;
    let [table, load] = initial;
    (a * end).exp() * dvector![table.position, load.position, table.velocity, load.velocity, 1.0]
}

#[test]
fn joints_in_joints_converge_with_order_two() {
    let (end, efforts) = (0.1237, [80.0, -30.0]);
    let initial = [state(0.1, 0.3), state(0.101, 0.1)];
    for damping in [0.0, 500.0] {
        let errors = [1_979, 3_958, 7_916].map(|ticks| {
            let mut axis = build(&nested(damping), "load", end / f64::from(ticks), initial.to_vec());
            for _ in 0..ticks {
                let mut input = effort(efforts[0]);
                input.load_disturbance = efforts[1];
                axis.advance(&input).unwrap();
            }
            let exact = exact(damping, efforts, &initial, end);
            let [table, load] = axis.bodies() else { panic!("two joints") };
            let found = dvector![table.position, load.position, table.velocity, load.velocity, 1.0];
            let error = found - exact;
            [error.rows(0, 2).amax(), error.rows(2, 2).amax()]
        });
        for (quantity, i) in [("position", 0), ("velocity", 1)] {
            for pair in errors.windows(2) {
                let order = (pair[0][i] / pair[1][i]).log2();
                // The next term of the error is (ω·h)² ≤ 1e-3 of the first.
                assert!((order - 2.0).abs() < 0.02, "damping {damping}: {quantity} of order {order}: {errors:?}");
            }
        }
    }
}

/// Oracle: an undamped mode keeps its amplitude.
#[test]
fn the_scheme_adds_no_damping() {
    let mut axis =
        build(&nested(0.0).replace(r#"damping="10""#, ""), "load", H, vec![state(0.0, 0.0), state(1e-3, 0.0)]);
    let ring: Vec<f64> = (0..160_000)
        .map(|_| {
            axis.advance(&effort(0.0)).unwrap();
            axis.bodies()[1].position - axis.bodies()[0].position - 2e-4
        })
        .collect();
    let amplitude = |part: &[f64]| part.iter().fold(0.0_f64, |peak, x| peak.max(x.abs()));
    let (first, last) = (amplitude(&ring[..1_600]), amplitude(&ring[158_400..]));
    // ω = √(6e5·30/200) = 300 rad/s.
    let damping = (first / last).ln() / (300.0 * 9.9);
    assert!(damping.abs() < 1e-7, "damping ratio {damping:e}");
}

/// Oracle: a frictional joint at rest stays where it is bit for bit, and yields above its bound with (F − f)/m.
#[test]
fn dry_friction_sticks_and_slips() {
    let xml = world(
        r#"<body><joint name="m" type="slide" axis="1 0 0" frictionloss="20"/>
             <inertial pos="0 0 0" mass="4" diaginertia="1 1 1"/></body>"#,
    );
    let mut axis = build(&xml, "m", H, vec![state(0.3, 0.0)]);
    for k in 0..10_000 {
        axis.advance(&effort(19.9 * (f64::from(k) * 0.01).sin())).unwrap();
        assert_eq!(axis.bodies()[0], state(0.3, 0.0), "tick {k}");
    }
    let start = axis.bodies()[0].position;
    for _ in 0..1_600 {
        axis.advance(&effort(28.0)).unwrap();
    }
    // 2 m/s² for 0.1 s.
    let found = axis.bodies()[0];
    assert!((found.velocity - 0.2).abs() < 2e-4 && (found.position - start - 0.01).abs() < 2e-5, "{found:?}");
    for _ in 0..3_200 {
        axis.advance(&effort(0.0)).unwrap();
    }
    // Stops after v²·m/(2·f), within the tick of the stop: a·h² = 2e-8 m, and v·h of the start.
    let stop = axis.bodies()[0];
    assert_eq!(stop.velocity.to_bits(), 0.0_f64.to_bits());
    let way = found.velocity.powi(2) * 4.0 / 40.0;
    assert!((stop.position - found.position - way).abs() < 1e-6, "{} {way}", stop.position - found.position);
}

/// Oracle: armature adds to the inertia, disturbances add to the efforts, the gear of the motor cancels out.
#[test]
fn efforts_and_inertia_add_up() {
    let xml = world(
        r#"<body><joint name="m" type="slide" axis="0 2 0" armature="1.5"/>
             <inertial pos="0 0 0" mass="2.5" diaginertia="1 1 1"/></body>"#,
    );
    for gear in ["", r#" gear="5""#] {
        let xml = xml.replace(r#"joint="m"/>"#, &format!(r#"joint="m"{gear}/>"#));
        let mut axis = build(&xml, "m", H, vec![]);
        for _ in 0..16_000 {
            let mut input = effort(7.0);
            (input.motor_disturbance, input.load_disturbance) = (3.0, -2.0);
            axis.advance(&input).unwrap();
        }
        let found = axis.bodies()[0];
        // 8 N on 4 kg for a second; 16 000 roundings.
        assert!((found.velocity - 2.0).abs() < 1e-11 && (found.position - 1.0).abs() < 1e-11, "{found:?}");
    }
}
