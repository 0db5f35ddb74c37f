//! Random switches, pulses and controlwords.
use crate::axis::PERIOD;
use crate::methods::params;
use servobench_base::Setpoint;
use servobench_cia402::Controlword;
use servobench_drive::Demand;
use servobench_drive::modes::homing::{Method, Params, State, step};
use servobench_drive::modes::{Actual, Moment, Targets};
use servobench_fuzz::{ValueGenerator, check, fuzz, produce};

/// Number of steps, and the bits of the inputs and the controlword in them.
type Act = (u8, u8, u16);

fn acts() -> impl ValueGenerator<Output = Vec<Act>> {
    produce::<Vec<Act>>().with().len(0..60_usize)
}

#[test]
fn searches() {
    let methods: Vec<Method> = Method::all().collect();
    fuzz(check!(), 2_000, (0..32_usize, produce::<bool>(), acts()), |(method, has_jerk, acts)| {
        let number = methods[*method].number();
        let params = Params { jerk: has_jerk.then_some(200.0), ..params(number) };
        let (mut last, mut word) = (Setpoint::at_rest(0.0), Controlword::default());
        let mut moment =
            Moment { targets: Targets::default(), actual: Actual::default(), demanded: last, period: PERIOD };
        let mut state = State::begin(&moment);
        for (steps, inputs, bits) in acts {
            // Bit 4 set more often than not, and some words without halt.
            word = Controlword::from_bits(if inputs & 0x40 == 0 { *bits } else { word.bits() & 0xFEFF | 0x10 });
            for k in 0..*steps {
                moment.targets.controlword = word;
                moment.demanded = last.after(PERIOD);
                moment.actual = Actual {
                    position: moment.demanded.x,
                    velocity: if inputs & 0x20 == 0 { moment.demanded.v } else { -moment.demanded.v },
                    effort: 0.0,
                    negative_limit: inputs & 1 != 0,
                    positive_limit: inputs & 2 != 0,
                    home: (inputs & 4 != 0) != (inputs & 8 != 0 && k % 7 == 0),
                    index: (inputs & 16 != 0 && k % 5 == 0).then_some(moment.demanded.x),
                };
                let output = step(&params, &mut state, &moment);
                let Demand::Position { setpoint, .. } = output.answer.demand else { panic!("{output:?}") };
                let slack = 1.0 + 1e-9;
                assert!(setpoint.x.is_finite() && setpoint.v.abs() <= 0.1 * slack && setpoint.a.abs() <= slack);
                assert!((setpoint.v - last.v).abs() <= PERIOD * slack, "{last:?} {setpoint:?}");
                assert!(!(output.answer.bit_12 && output.answer.bit_13));
                assert!(output.shift.is_none_or(|_| state.is_homed() && output.answer.target_reached));
                last = setpoint;
            }
        }
    });
}
