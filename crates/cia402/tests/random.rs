//! A random master, plant and supervision over a million cycles.
use servobench_cia402::{
    Controlword, DisableOperationOption, DriveFunction, FaultReactionOption, HaltOption, PowerInputs, PowerMemory,
    PowerParams, QuickStopOption, ShutdownOption, TRANSITIONS, step,
};
use servobench_testkit::Random;

/// Words with an effect: with random words alone, hardly one in a thousand sequences reaches Operation enabled.
const SENSIBLE: [u16; 7] = [0x0000, 0x0002, 0x0006, 0x0007, 0x000F, 0x0080, 0x010F];
const CYCLES: u64 = 1_000_000;
/// Cycles after which the drive restarts with other option codes.
const LIFE: u64 = 1_000;

#[test]
fn no_controlword_leads_out_of_the_diagram_or_powers_an_axis_that_is_not_enabled() {
    let mut random = Random::seeded(402);
    let (mut params, mut memory, mut drive) = start(&mut random);
    let mut taken = [0_u64; TRANSITIONS.len()];
    for cycle in 0..CYCLES {
        if cycle % LIFE == 0 {
            (params, memory, drive) = start(&mut random);
        }
        let (before, powered) = (memory.state(), drive != DriveFunction::Disabled);
        let (word, inputs) = (controlword(&mut random), inputs(&mut random));
        let outputs = step(&params, &mut memory, word, inputs);
        let after = memory.state();
        assert_eq!(outputs.statusword.state(), Some(after), "cycle {cycle}");
        let number = outputs.transition.map(|transition| {
            assert!(transition.from.contains(&before) && transition.to == after, "cycle {cycle}: {transition:?}");
            taken[usize::from(transition.number)] += 1;
            transition.number
        });
        assert!(number.is_some() || after == before, "cycle {cycle}: {before} to {after} without a transition");
        let is_powered = outputs.drive != DriveFunction::Disabled;
        assert!(!is_powered || after.is_drive_function_enabled(), "cycle {cycle}: powered in {after}");
        assert!(!is_powered || powered || number == Some(4), "cycle {cycle}: powered by transition {number:?}");
        drive = outputs.drive;
    }
    // Every transition but the start; otherwise the test would not cover those that matter.
    assert!(taken[1..].iter().all(|times| *times > 100), "{taken:?}");
}

fn start(random: &mut Random) -> (PowerParams, PowerMemory, DriveFunction) {
    let params = PowerParams {
        quick_stop: QuickStopOption::try_from(random.one_of(QuickStopOption::CODES)).unwrap(),
        shutdown: ShutdownOption::try_from(random.one_of(ShutdownOption::CODES)).unwrap(),
        disable_operation: DisableOperationOption::try_from(random.one_of(DisableOperationOption::CODES)).unwrap(),
        halt: HaltOption::try_from(random.one_of(HaltOption::CODES)).unwrap(),
        fault_reaction: FaultReactionOption::try_from(random.one_of(FaultReactionOption::CODES)).unwrap(),
    };
    (params, PowerMemory::default(), DriveFunction::Disabled)
}

fn controlword(random: &mut Random) -> Controlword {
    let any = u16::try_from(random.next() >> 48).unwrap();
    Controlword::from_bits(if random.once_in(2) { any } else { random.one_of(&SENSIBLE) })
}

fn inputs(random: &mut Random) -> PowerInputs {
    PowerInputs {
        initialised: random.once_in(4),
        fault: random.once_in(32),
        standstill: random.once_in(4),
        remote: !random.once_in(8),
        main_voltage: random.once_in(2),
        warning: random.once_in(2),
        target_reached: random.once_in(2),
        internal_limit: random.once_in(2),
    }
}
