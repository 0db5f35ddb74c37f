//! A loop with matrices known by hand.
use super::*;
use servobench_base::state::{Part, Stateful as _, Writer};

const H: f64 = 1e-3;
const GAIN: f64 = 0.25;
const INTEGRAL: f64 = 0.125;

/// A speed under a PI controller that forms differences of positions; every other tick it holds its command.
#[derive(Default)]
struct Speed {
    position: f64,
    velocity: f64,
    command: f64,
    last: Option<f64>,
    integral: f64,
    asked: f64,
    counted: f64,
    odd: bool,
    gain: f64,
    drifts: bool,
}

impl Running for Speed {
    fn save(&mut self, to: &mut dyn Writer) -> Result<(), LinearError> {
        for (part, numbers) in [
            ("mechanics", &[("position", self.position), ("velocity", self.velocity)][..]),
            (
                "controllers",
                &[
                    ("command", self.command),
                    ("integral", self.integral),
                    ("asked", self.asked),
                    ("counted", self.counted),
                ],
            ),
        ] {
            to.enter(Part::field(part));
            for (name, value) in numbers {
                to.enter(Part::field(name));
                value.save(to);
                to.leave();
            }
            if part == "controllers" {
                to.enter(Part::field("last"));
                self.last.save(to);
                to.leave();
                self.odd.save(to);
            }
            to.leave();
        }
        Ok(())
    }

    fn restore(&mut self, from: &mut Reader<'_>) -> Result<(), LinearError> {
        for number in [
            &mut self.position,
            &mut self.velocity,
            &mut self.command,
            &mut self.integral,
            &mut self.asked,
            &mut self.counted,
        ] {
            number.restore(from)?;
        }
        self.last.restore(from)?;
        Ok(self.odd.restore(from)?)
    }

    fn place(&mut self, position: f64) -> Result<(), LinearError> {
        let (gain, drifts) = (self.gain, self.drifts);
        *self = Self { position, gain, drifts, ..Self::default() };
        Ok(())
    }

    fn tick(&mut self) -> Result<(), LinearError> {
        self.position += H * self.velocity;
        let before = self.last.replace(self.position).unwrap_or(self.position);
        if !self.odd {
            let error = self.command - (self.position - before) / H;
            self.asked = self.gain * (error + self.integral);
            self.integral += INTEGRAL * error;
        }
        self.velocity += self.asked + f64::from(u8::from(self.drifts));
        // Its square is in no loop, and without a slope at rest.
        self.counted += 3.0 * self.velocity * (1.0 + self.velocity);
        self.odd = !self.odd;
        Ok(())
    }

    fn set(&mut self, factors: &Factors) {
        self.gain = GAIN * factors.velocity;
    }
}

fn derived() -> Matrices<'static> {
    // Tick 1 holds, tick 2 controls.
    Matrices::new(Box::new(Speed { gain: GAIN, ..Speed::default() }), &[2, 1]).unwrap()
}

/// Oracle: by hand. Positions are measured from the motor's, so that differences of them do not depend on it, and the position, which is
/// only integrated, is in no loop.
#[test]
fn a_loop_by_hand() {
    let mut derived = derived();
    let names: Vec<&str> = derived.names().collect();
    assert_eq!(names, ["mechanics.velocity", "controllers.integral", "controllers.asked"]);
    let holds = DMatrix::from_row_slice(3, 3, &[1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    assert_eq!(derived.matrix(1, &Factors::ONE).unwrap().matrix, holds);
    for velocity in [0.0, 1.0, 0.5, 3.0] {
        let g = GAIN * velocity;
        let expected = DMatrix::from_row_slice(3, 3, &[1.0 - g, g, 0.0, -INTEGRAL, 1.0, 0.0, -g, g, 0.0]);
        let found = derived.matrix(0, &Factors { velocity, ..Factors::ONE }).unwrap();
        for (found, expected) in found.matrix.iter().zip(expected.iter()) {
            // Powers of two: only h·v/h rounds.
            assert!((found - expected).abs() < 1e-15, "{velocity}: {found} {expected}");
            assert_eq!(*found == 0.0, *expected == 0.0, "{velocity}");
        }
    }
}

#[test]
fn inputs_and_outputs_are_numbers_by_their_names() {
    let mut derived = derived();
    let (inputs, outputs) = (["controllers.command"], ["controllers.counted", "controllers.asked"]);
    let System { b, c, d, .. } = derived.system(0, &inputs, &outputs).unwrap();
    assert_eq!(b.as_slice(), [GAIN, INTEGRAL, GAIN]);
    assert_eq!(d.as_slice(), [3.0 * GAIN, GAIN]);
    assert!((c[(0, 0)] - 3.0 * (1.0 - GAIN)).abs() < 1e-15, "{c}");
    let unknown = derived.system(0, &["controllers.comand"], &outputs).unwrap_err();
    assert_eq!(unknown.to_string(), "the loop that is to be made linear has no number `controllers.comand`");
}

#[test]
fn a_loop_that_does_not_stay_at_rest_is_refused() {
    let drifting = Speed { gain: GAIN, drifts: true, ..Speed::default() };
    let Err(LinearError::NotAtRest(name)) = Matrices::new(Box::new(drifting), &[2, 1]) else { panic!("it drifts") };
    assert!(name.starts_with(MECHANICS), "{name}");
}
