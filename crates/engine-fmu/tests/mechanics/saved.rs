//! An FMU keeps only its last saved state.
use super::*;
use servobench_base::state::{Reader, words};
use servobench_plant::{BodyState, EngineName, MechanicsError};

/// [`ExactFmu`] with its last state.
struct Saving(ExactFmu, Vec<u64>);

impl Slave for Saving {
    fn step(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        self.0.step(time, length, inputs)
    }

    fn read(&mut self, _: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        self.0.read(None, outputs)
    }

    fn save(&mut self) -> Result<(), SlaveError> {
        self.1.clear();
        self.0.0.save(&mut words(|word| self.1.push(word))).unwrap();
        Ok(())
    }

    fn restore(&mut self) -> Result<(), SlaveError> {
        self.0.0.restore(&mut Reader::new(&self.1)).unwrap();
        Ok(())
    }
}

fn fmu() -> FmuMechanics {
    mechanics(Saving(ExactFmu::new(4.0 * TICK), Vec::new()), &model(4), &IN_SI)
}

/// The bodies after each tick from `first` on.
fn run(fmu: &mut FmuMechanics, first: u32, ticks: u32) -> Vec<BodyState> {
    let tick = |tick: u32| {
        fmu.advance(&input((f64::from(tick) * 0.3).sin(), 20.0)).unwrap();
        fmu.bodies().to_vec()
    };
    (first..first + ticks).flat_map(tick).collect()
}

fn saved(fmu: &mut FmuMechanics) -> Vec<u64> {
    let mut state = Vec::new();
    fmu.save(&mut words(|word| state.push(word))).unwrap();
    state
}

fn restore(fmu: &mut FmuMechanics, state: &[u64]) -> Result<(), MechanicsError> {
    let mut from = Reader::new(state);
    fmu.restore(&mut from)?;
    Ok(from.end()?)
}

/// Between two exchanges, so that sums and motions count.
#[test]
fn the_last_state_goes_on_with_the_same_bits() {
    let mut fmu = fmu();
    run(&mut fmu, 0, 102);
    let state = saved(&mut fmu);
    let expected = run(&mut fmu, 102, 50);
    for _ in 0..2 {
        restore(&mut fmu, &state).unwrap();
        assert_eq!(run(&mut fmu, 102, 50), expected);
    }
}

#[test]
fn an_older_state_or_one_of_another_fmu_is_refused() {
    let superseded = MechanicsError::Superseded { engine: EngineName::Fmu };
    let [mut one, mut other] = [fmu(), fmu()];
    let [first, last, theirs] = [saved(&mut one), saved(&mut one), saved(&mut other)];
    assert_eq!(restore(&mut one, &first), Err(superseded.clone()));
    assert_eq!(restore(&mut one, &theirs), Err(superseded));
    assert!(restore(&mut one, &last[..last.len() - 1]).is_err());
    restore(&mut one, &last).unwrap();
    restore(&mut other, &theirs).unwrap();
}
