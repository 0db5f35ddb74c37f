//! Digital inputs and outputs, and the touch probe.
use crate::bench::Bench;
use servobench_fieldbus::{ProbeFeedback, ProbeTrigger};
use servobench_plcopen::{
    AbortTrigger, AbortTriggerInputs, Axis, AxisParams, ErrorId, FunctionBlock, ReadDigitalInput,
    ReadDigitalInputInputs, ReadDigitalOutput, ReadDigitalOutputInputs, SetPosition, SetPositionInputs, TouchProbe,
    TouchProbeInputs, TouchProbeOutputs, WriteDigitalOutput, WriteDigitalOutputInputs,
};

#[test]
fn bits_are_read_and_written_one_by_one() {
    let mut bench = Bench::standstill();
    bench.feedback.digital_inputs = 0b101;
    let input = |axis: &mut Axis, input_number| {
        ReadDigitalInput::default().step(axis, &ReadDigitalInputInputs { enable: true, input_number })
    };
    let read = bench.cycle(|axis| [0, 1, 2, 31].map(|bit| input(axis, bit).value));
    assert_eq!(read, [true, false, true, false]);
    let wrong = bench.cycle(|axis| input(axis, 32));
    assert_eq!((wrong.valid, wrong.busy, wrong.error, wrong.error_id), (false, true, true, ErrorId::Input));
    let write = |axis: &mut Axis, output_number, value| {
        let inputs = WriteDigitalOutputInputs { execute: true, output_number, value };
        WriteDigitalOutput::default().step(axis, &inputs).done
    };
    assert!(bench.cycle(|axis| write(axis, 3, true) && write(axis, 31, true) && !write(axis, 32, true)));
    assert_eq!(bench.command.unwrap().digital_outputs, 1 << 3 | 1 << 31);
    let read = bench.cycle(|axis| {
        assert!(write(axis, 3, false));
        [3, 31].map(|output_number| {
            ReadDigitalOutput::default().step(axis, &ReadDigitalOutputInputs { enable: true, output_number }).value
        })
    });
    assert_eq!((read, bench.command.unwrap().digital_outputs), ([false, true], 1 << 31));
}

/// The error message lasts as long as the error.
#[test]
fn a_number_that_is_no_bit_is_an_error_in_words() {
    let (mut bench, mut input, mut output) =
        (Bench::standstill(), ReadDigitalInput::default(), ReadDigitalOutput::default());
    for (enable, number) in [(true, 32), (true, 31), (true, 33), (false, 33)] {
        let both = bench.cycle(|axis| {
            let read = input.step(axis, &ReadDigitalInputInputs { enable, input_number: number });
            (read, output.step(axis, &ReadDigitalOutputInputs { enable, output_number: number }))
        });
        let said = [input.error(), output.error()].map(|error| error.map(ToString::to_string));
        let expected =
            [("MC_ReadDigitalInput", "InputNumber"), ("MC_ReadDigitalOutput", "OutputNumber")].map(|(block, input)| {
                let words = format!("{block}: `{input}` must be a bit from 0 to 31, got {number}: correct the input");
                (enable && number > 31).then_some(words)
            });
        assert_eq!(said, expected);
        assert_eq!([both.0.error, both.1.error], said.map(|error| error.is_some()));
        assert_eq!([both.0.busy, both.1.busy], [enable; 2]);
    }
}

const MET: TouchProbeInputs =
    TouchProbeInputs { execute: true, trigger: ProbeTrigger::HomeSwitchMet, first_position: None, last_position: None };

/// Runs a cycle in which the drive answers the previous request of the probe with `position`.
fn answered(
    bench: &mut Bench,
    probe: &mut TouchProbe,
    inputs: &TouchProbeInputs,
    position: Option<f64>,
) -> TouchProbeOutputs {
    let asked = bench.command.and_then(|command| command.touch_probe);
    bench.feedback.touch_probe = ProbeFeedback { number: asked.map_or(0, |asked| asked.number), position };
    bench.cycle(|axis| probe.step(axis, inputs))
}

#[test]
fn a_position_is_recorded_as_the_program_counts() {
    let (mut bench, mut probe) = (Bench::standstill(), TouchProbe::default());
    let shift = SetPositionInputs { execute: true, position: 0.5, relative: true };
    bench.cycle(|axis| SetPosition::default().step(axis, &shift));
    assert!(bench.cycle(|axis| probe.step(axis, &MET)).busy);
    assert_eq!(bench.command.unwrap().touch_probe.unwrap().trigger, ProbeTrigger::HomeSwitchMet);
    assert!(answered(&mut bench, &mut probe, &MET, None).busy);
    let outputs = answered(&mut bench, &mut probe, &MET, Some(0.1234));
    assert!(outputs.done && !outputs.busy);
    assert_eq!(outputs.recorded_position.to_bits(), (0.1234_f64 + 0.5).to_bits());
    assert_eq!(bench.command.unwrap().touch_probe, None, "the drive is asked no more");
    assert!(answered(&mut bench, &mut probe, &MET, None).done, "as long as Execute is TRUE");
}

/// An answer to an earlier request does not count for the present one.
#[test]
fn an_earlier_answer_does_not_count() {
    let (mut bench, mut probe) = (Bench::standstill(), TouchProbe::default());
    bench.feedback.touch_probe = ProbeFeedback { number: 7, position: Some(0.3) };
    for _ in 0..3 {
        assert!(bench.cycle(|axis| probe.step(axis, &MET)).busy);
    }
}

#[test]
fn what_comes_outside_the_window_is_asked_for_again() {
    let (mut bench, mut probe) = (Bench::standstill(), TouchProbe::default());
    let inputs = TouchProbeInputs { first_position: Some(0.2), last_position: Some(0.3), ..MET };
    bench.cycle(|axis| probe.step(axis, &inputs));
    for outside in [0.199_999, 0.300_001, -4.0] {
        assert!(answered(&mut bench, &mut probe, &inputs, Some(outside)).busy, "{outside}");
    }
    let outputs = answered(&mut bench, &mut probe, &inputs, Some(0.3));
    assert_eq!((outputs.done, outputs.recorded_position.to_bits()), (true, 0.3_f64.to_bits()));
    let crossed = TouchProbeInputs { first_position: Some(0.3), last_position: Some(0.2), ..MET };
    let mut probe = TouchProbe::default();
    assert_eq!(bench.cycle(|axis| probe.step(axis, &crossed)).error_id, ErrorId::Input);
    assert_eq!(
        probe.error().unwrap().to_string(),
        "MC_TouchProbe: `LastPosition` must be at FirstPosition or beyond it, got 0.2: correct the input"
    );
}

/// From 0.9 m over the zero to 0.1 m of an axis that comes round after 1 m; the drive counts on.
#[test]
fn a_window_goes_over_the_zero_of_a_modulo_axis() {
    let params = AxisParams { modulo: Some(1.0), ..Bench::params() };
    let inputs = TouchProbeInputs { first_position: Some(0.9), last_position: Some(0.1), ..MET };
    for (position, counts) in [(0.5, false), (0.89, false), (0.95, true), (3.0, true), (-3.95, true), (7.11, false)] {
        let (mut bench, mut probe) = (Bench::powered(params), TouchProbe::default());
        assert!(bench.cycle(|axis| probe.step(axis, &inputs)).busy);
        let outputs = answered(&mut bench, &mut probe, &inputs, Some(position));
        assert_eq!((outputs.done, outputs.busy), (counts, !counts), "{position}");
    }
}

#[test]
fn a_probe_is_aborted_by_its_block_and_by_another_probe() {
    let (mut bench, mut one, mut two) = (Bench::standstill(), TouchProbe::default(), TouchProbe::default());
    bench.cycle(|axis| one.step(axis, &MET));
    let (first, second) = bench.cycle(|axis| {
        let second = two.step(axis, &TouchProbeInputs { trigger: ProbeTrigger::IndexPulse, ..MET });
        (one.step(axis, &MET), second)
    });
    assert!(first.command_aborted && second.busy);
    bench.cycle(|axis| assert!(AbortTrigger::default().step(axis, &AbortTriggerInputs { execute: true }).done));
    assert_eq!(bench.command.unwrap().touch_probe, None);
    assert!(bench.cycle(|axis| two.step(axis, &MET)).command_aborted);
}
