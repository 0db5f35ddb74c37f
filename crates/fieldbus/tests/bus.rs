//! The wire: the ticks of its cycles, and the frames that arrive.
use servobench_base::{Divider, Rate, Tick};
use servobench_cia402::{Actuals, Commands};
use servobench_fieldbus::bus::{self, BusFault, BusFaultKind, Cycle, Params, State};

const CYCLE: u64 = 16;

fn cycle() -> Divider {
    let base = Rate::new(16_000).unwrap();
    base.divider(Rate::new(1_000).unwrap()).unwrap()
}

/// The cycles of `ticks` ticks, with the tick at which each happened.
fn cycles(faults: &[BusFault], ticks: u64) -> Vec<(u64, Cycle)> {
    let (params, mut state) = (Params::new(cycle(), 1, faults).unwrap(), State::default());
    (0..ticks).filter_map(|tick| bus::step(&params, &mut state, Tick(tick)).map(|cycle| (tick, cycle))).collect()
}

fn fault(kind: BusFaultKind, cycles: core::ops::Range<u64>) -> BusFault {
    BusFault { kind, cycles }
}

#[test]
fn cycles_happen_when_they_are_due() {
    let seen = cycles(&[], 1_000);
    assert_eq!(seen.len(), 63);
    for (number, (tick, cycle)) in seen.iter().enumerate() {
        assert_eq!((*tick, cycle.number, cycle.due.0), (number as u64 * CYCLE, number as u64, *tick));
        assert!(!cycle.is_lost && !cycle.is_silent && !cycle.master_stopped && !cycle.external_fault);
    }
}

#[test]
fn a_late_cycle_is_late_alone_and_a_very_late_one_holds_the_next_ones_up() {
    let late = |by, range| cycles(&[fault(BusFaultKind::Late { by }, range)], 96).into_iter().map(|(tick, _)| tick);
    assert!(late(5, 2..3).eq([0, 16, 37, 48, 64, 80]));
    // Cycle 2 happens when 4 is due: 3 and 4 follow tick by tick.
    assert!(late(32, 2..3).eq([0, 16, 64, 65, 66, 80]));
    assert!(late(3, 0..1).eq([3, 16, 32, 48, 64, 80]));
}

#[test]
fn late_times_add_up() {
    let faults = [fault(BusFaultKind::Late { by: 3 }, 1..3), fault(BusFaultKind::Late { by: 5 }, 2..4)];
    assert!(cycles(&faults, 64).into_iter().map(|(tick, _)| tick).eq([0, 19, 40, 53]));
}

#[test]
fn jitter_is_within_its_bound_uses_all_of_it_and_is_the_same_every_time() {
    let jitter = |seed| [fault(BusFaultKind::Jitter { by: 7, seed }, 0..u64::MAX)];
    let seen = cycles(&jitter(1), 16_000);
    assert_eq!(seen, cycles(&jitter(1), 16_000));
    assert_ne!(seen, cycles(&jitter(2), 16_000));
    let mut counts = [0_u32; 8];
    for (tick, cycle) in &seen {
        counts[usize::try_from(tick - cycle.due.0).unwrap()] += 1;
    }
    // 1000 cycles over 8 values: 125 of each, with a standard deviation of 10.5.
    assert!(counts.iter().all(|count| (80..170).contains(count)), "{counts:?}");
}

#[test]
fn frames_arrive_after_the_delay_unless_they_are_lost() {
    for delay in 0..=Params::LONGEST_DELAY {
        let faults = [fault(BusFaultKind::Lost, 20..23), fault(BusFaultKind::DriveSilent, 30..32)];
        let (params, mut state) = (Params::new(cycle(), delay, &faults).unwrap(), State::default());
        for tick in 0..60 * CYCLE {
            let Some(cycle) = bus::step(&params, &mut state, Tick(tick)) else { continue };
            let number = u16::try_from(cycle.number).unwrap();
            let sent = cycle.number.checked_sub(delay.into());
            let actuals = Actuals { error_code: number, ..Actuals::default() };
            let commands = Commands { target_position: number.into(), ..Commands::default() };
            let heard = state.to_master(&params, &cycle, actuals).map(|actuals| u64::from(actuals.error_code));
            let told = state
                .to_drive(&params, &cycle, commands)
                .map(|commands| u64::try_from(commands.target_position).unwrap());
            assert_eq!(told, sent.filter(|sent| !(20..23).contains(sent)), "delay {delay}, cycle {number}");
            assert_eq!(heard, sent.filter(|sent| !(20..23).contains(sent) && !(30..32).contains(sent)));
        }
    }
}

#[test]
fn signals_hold_for_their_cycles() {
    let faults = [fault(BusFaultKind::MasterStopped, 3..5), fault(BusFaultKind::ExternalFault, 4..6)];
    for (_, cycle) in cycles(&faults, 160) {
        assert_eq!(cycle.master_stopped, (3..5).contains(&cycle.number));
        assert_eq!(cycle.external_fault, (4..6).contains(&cycle.number));
    }
}

#[test]
fn a_delay_that_is_not_kept_is_refused() {
    let error = Params::new(cycle(), 16, &[]).unwrap_err();
    assert_eq!(error.to_string(), "`delay` must be at most 15 bus cycles, got 16: take a longer cycle");
}
