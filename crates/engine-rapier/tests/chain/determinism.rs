//! The same run gives the same bits.
use super::{H, build, effort, feed_axis};
use servobench_plant::{Body, Chain, Drive, DryFriction, Mechanics};

/// The feed axis with dry friction on its table: four lumps in two scenes, held now and then.
fn sticky() -> Chain {
    let axis = feed_axis();
    let mut bodies: Vec<Body> = axis.bodies().to_vec();
    bodies[2].friction.dry = DryFriction { coulomb: 60.0, breakaway: 80.0, stribeck_velocity: 1e-3 };
    Chain::new(bodies, axis.links().to_vec()).unwrap()
}

fn torque(k: u32) -> f64 {
    1.5 * (f64::from(k) * 0.002).sin()
}

fn bits(axis: &dyn Mechanics) -> Vec<[u64; 2]> {
    axis.bodies().iter().map(|state| [state.position.to_bits(), state.velocity.to_bits()]).collect()
}

#[test]
fn alone_again_and_beside_others() {
    let start = || build(&sticky(), Drive::Effort, H, vec![]);
    let (mut alone, mut first, mut second) = (start(), start(), start());
    let reference: Vec<_> = (0..20_000)
        .map(|k| {
            alone.advance(&effort(torque(k))).unwrap();
            bits(alone.as_ref())
        })
        .collect();
    assert!(reference.windows(2).any(|pair| pair[0][2] == pair[1][2]), "the table never stuck");
    assert!(alone.bodies()[0].position.abs() > 10.0, "the motor never changed its centre");
    for (k, expected) in (0..).zip(&reference) {
        first.advance(&effort(torque(k))).unwrap();
        assert_eq!(&bits(first.as_ref()), expected, "tick {k}");
        // Another axis in between, one tick behind.
        if k > 0 {
            second.advance(&effort(torque(k - 1))).unwrap();
            assert_eq!(bits(second.as_ref()), reference[k as usize - 1], "tick {k}");
        }
    }
}

#[test]
fn on_another_thread() {
    let run = || {
        let mut axis = build(&sticky(), Drive::Effort, H, vec![]);
        for k in 0..5_000 {
            axis.advance(&effort(torque(k))).unwrap();
        }
        bits(axis.as_ref())
    };
    let elsewhere = std::thread::spawn(run).join().unwrap();
    assert_eq!(elsewhere, run());
}
